// SPDX-License-Identifier: MIT
// A point of a primary space of many dimensions, of which a sample reads a few.
#pragma once

#include <vector>

#include "render/core/index.h"
#include "render/core/random.h"

namespace h2mc {

// All coordinates move at every accepted small step, but nobody needs to know where they are before they are read:
// then a coordinate is drawn, if it never was, or makes the steps that it has missed one by one [Kelemen et al. 2002].
// A coordinate that did not would be one that moves only where it is read, to which no step leads back.
class LazyPoint {
 public:
  // So many coordinates, none of which is known.
  void begin(int count) {
    coordinates_.assign(at(count), {});
    now_ = 0;
  }
  // One accepted small step from `from`: what is not set keeps what it was, and will make that step up.
  void follow(const LazyPoint& from) {
    coordinates_ = from.coordinates_;
    now_ = from.now_ + 1;
  }
  void set(int place, float value) { coordinates_[at(place)] = {value, now_}; }
  // The coordinate as it is now. `step(place, value)` is what it is after a small step.
  template <class Step>
  float read(int place, Random& random, Step&& step) {
    Coordinate& c = coordinates_[at(place)];
    if (c.time == kNever) c = {random.uniform(), now_};
    for (; c.time < now_; ++c.time) c.value = step(place, c.value);
    return c.value;
  }

 private:
  static constexpr int kNever = -1;
  struct Coordinate {
    float value = 0;
    int time = kNever;  // in accepted small steps: when the value was that
  };
  std::vector<Coordinate> coordinates_;
  int now_ = 0;
};

}  // namespace h2mc
