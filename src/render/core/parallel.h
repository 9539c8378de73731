// SPDX-License-Identifier: MIT
// Work on several threads.
#pragma once

#include <functional>

namespace h2mc {

// Calls work(0 .. count - 1) in parallel on `threads` threads (0: one a core).
void parallelFor(int threads, int count, const std::function<void(int)>& work);

}  // namespace h2mc
