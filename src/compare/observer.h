// SPDX-License-Identifier: MIT
// What a comparison tells on its way, and how it is stopped.
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace h2mc {

struct ComparisonStatus {
  std::string what;  // "run 3 of 24: ring, h2mc, repeat 2"
  double done = 0;   // seconds of rendering in this comparison, by plan
  double total = 0;  // as foreseen; what is there already does not count
};

struct ComparisonObserver {
  std::function<void(const ComparisonStatus&)> status;  // often, from the rendering thread
  std::function<void(const std::string&)> note;         // a line worth keeping
  const std::atomic<bool>* stop = nullptr;

  bool stopped() const { return stop && stop->load(); }
};

}  // namespace h2mc
