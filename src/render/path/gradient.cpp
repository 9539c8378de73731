// SPDX-License-Identifier: MIT
#include "render/path/gradient.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ad/dual.h"
#include "render/path/replay.h"

namespace h2mc {
namespace {

// The entries of N coordinates from `first` on; others are constants.
template <int N>
void block(const Scene& scene, const Path& path, const float* u, int first, Gradient& result) {
  using D = ad::Dual1<float, N>;
  D x[kMaxCoordinates];
  const int end = std::min(first + N, result.dimension);
  for (int i = 0; i < result.dimension; ++i)
    x[i] = i >= first && i < end ? D::variable(u[i], i - first) : D(u[i]);
  const D y = replayAt<D>(scene, path, x);
  result.logTarget = y.v;
  for (int i = first; i < end; ++i) result.gradient[i] = y.gradient(i - first);
}

}  // namespace

bool Gradient::finite() const {
  float sum = std::abs(logTarget);
  for (int i = 0; i < dimension; ++i) sum += std::abs(gradient[i]);
  return sum <= std::numeric_limits<float>::max();
}

void differentiateOnce(const Scene& scene, const Path& path, Gradient& result) {
  float u[kMaxCoordinates];
  pathCoordinates(path, u);
  result.dimension = path.dimension();
  if (result.dimension <= 8) return block<8>(scene, path, u, 0, result);
  for (int first = 0; first < result.dimension; first += 16)
    block<16>(scene, path, u, first, result);
}

}  // namespace h2mc
