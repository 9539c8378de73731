// SPDX-License-Identifier: MIT
#include "render/path/replay_double.h"

#include "render/path/replay.h"

namespace h2mc {

double replayInDouble(const Scene& scene, const Path& path, const double* u) {
  return replayAt<double>(scene, path, u);
}

}  // namespace h2mc
