#include "render/path/replay_double.h"

#include <algorithm>

#include "render/path/replay.h"

namespace h2mc {

void pathCoordinates(const Path& path, double* u) {
  std::copy_n(path.sample.u.begin(), path.technique.dimension(), u);
  if (path.moving) u[path.technique.dimension()] = static_cast<double>(path.sample.time);
}

double replayInDouble(const Scene& scene, const Path& path, const double* u) {
  return replayWithTime<double>(scene, path, u);
}

}  // namespace h2mc
