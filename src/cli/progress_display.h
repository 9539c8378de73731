// SPDX-License-Identifier: MIT
// How far the render has come, on stderr.
#pragma once

#include <mutex>
#include <string>

#include "render/integrator/integrator.h"

namespace h2mc {

// "950", "12.3 k", "1.23 M", "4.56 G".
std::string withPrefix(double number);
// "12.3 s", "4:05", "1:02:03".
std::string duration(double seconds);

// A bar with rate and time left on a terminal; otherwise a plain line every few seconds.
class ProgressDisplay {
 public:
  enum class Style { kNone, kLines, kBar };

  // By what stderr is.
  static Style styleOfStderr();

  // secondsGiven: the time the render was given, 0 when it was given an amount of work.
  ProgressDisplay(Style style, double secondsGiven);
  ~ProgressDisplay();  // removes the bar

  // May be called as often as one likes, from any thread.
  void update(const RenderProgress& progress);

 private:
  std::string bar(const RenderProgress& progress) const;
  std::string text(const RenderProgress& progress) const;

  Style style_;
  double secondsGiven_;
  std::mutex mutex_;
  double lastShown_ = -1e9;  // in elapsed seconds
  bool barShown_ = false;
};

}  // namespace h2mc
