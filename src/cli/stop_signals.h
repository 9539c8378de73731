// SPDX-License-Identifier: MIT
// Ctrl-C.
#pragma once

#include <atomic>

namespace h2mc {

// While one exists, the first SIGINT, SIGTERM or SIGHUP asks the render to stop, and a second one ends the
// program at once with exit code 130, leaving no half-written file. Only one at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();  // restores what was before
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  // Becomes true when the render is to stop.
  static const std::atomic<bool>& requested();
};

}  // namespace h2mc
