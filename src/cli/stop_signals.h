// SPDX-License-Identifier: MIT
// Ctrl-C.
#pragma once

#include <atomic>

namespace h2mc {

// While one exists, the first SIGINT, SIGTERM or SIGHUP asks the render to stop, and another one
// more than a second later ends the program at once, without a picture, with exit code 3; no half-written file is left.
// `ofRanks`: SIGUSR1 too, which mpirun hands on to all ranks without killing them soon after; and another one ends
// nothing, as mpirun asks more than once and kills by itself.
// Only one at a time.
class StopSignals {
 public:
  explicit StopSignals(bool ofRanks = false);
  ~StopSignals();  // restores what was before
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  // Becomes true when the render is to stop.
  static const std::atomic<bool>& requested();
  // Whether one of those has come after which SIGKILL may come soon: any but SIGUSR1.
  static bool isUrgent();
  // What a first signal does.
  static void request();
};

}  // namespace h2mc
