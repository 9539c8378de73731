// SPDX-License-Identifier: MIT
#include "inspect/slice.h"

#include <cmath>
#include <limits>

#include "mcmc/mutations/primary_offset.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {

SliceCell compareTopology(const Path& path, const Path& other) {
  const int s = path.technique.s, t = path.technique.t;
  if (!(path.technique == other.technique) || path.escaped != other.escaped ||
      path.lightIndex != other.lightIndex)
    return SliceCell::kOtherTopology;
  bool primitives = true;
  const auto sameShape = [&](PrimitiveId a, PrimitiveId b) {
    primitives = primitives && a == b;
    return a.shape == b.shape;
  };
  if (s >= 1 && !sameShape(path.lightPrimitive, other.lightPrimitive))
    return SliceCell::kOtherTopology;
  // A subpath's last vertex is joined: it has no lobe.
  const auto sameSubpath = [&](const std::vector<TracedVertex>& a,
                               const std::vector<TracedVertex>& b, int vertices) {
    for (int i = 1; i <= vertices; ++i) {
      const auto k = at(i);
      const bool arrives = !(i == t - 1 && path.escaped && &a == &path.camera);
      if (arrives && !sameShape(a[k].id, b[k].id)) return false;
      if (i < vertices && !(a[k].lobe == b[k].lobe)) return false;
    }
    return true;
  };
  if (!sameSubpath(path.camera, other.camera, t - 1) ||
      !sameSubpath(path.light, other.light, s - 1))
    return SliceCell::kOtherTopology;
  return primitives ? SliceCell::kSame : SliceCell::kOtherPrimitive;
}

Slice traceSlice(const Scene& scene, const Path& path, const Direction& first,
                 const Direction& second, double halfX, double halfY, int resolution, int threads,
                 const std::atomic<bool>* stop) {
  Slice slice;
  slice.halfX = halfX;
  slice.halfY = halfY;
  slice.resolution = resolution;
  const std::size_t count =
      static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution);
  slice.logRatio.assign(count, -std::numeric_limits<float>::infinity());
  slice.cells.assign(count, SliceCell::kDark);
  const int own = path.technique.dimension();
  const double here = std::log(double(path.target));
  parallelFor(threads, resolution, [&](int row) {
    if (stop && *stop) return;
    Path moved = path;
    std::vector<float> offset(static_cast<std::size_t>(path.dimension()));
    for (int column = 0; column < resolution; ++column) {
      const double x = slice.x(column), y = slice.y(row);
      for (std::size_t i = 0; i < offset.size(); ++i)
        offset[i] = static_cast<float>(x * first.vector[i] + y * second.vector[i]);
      const std::size_t at = slice.index(column, row);
      moved.sample = path.sample;
      if (!addOffset(path.sample, offset.data(), own, path.wraps, moved.sample) ||
          !addToShared(path.shared(), path.sample, offset.data() + own, moved.sample)) {
        slice.cells[at] = SliceCell::kOutside;
        continue;
      }
      if (!tracePath(scene, moved)) continue;
      slice.logRatio[at] = static_cast<float>(std::log(double(moved.target)) - here);
      slice.cells[at] = compareTopology(path, moved);
    }
  });
  return slice;
}

}  // namespace h2mc
