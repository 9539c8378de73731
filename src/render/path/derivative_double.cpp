// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "ad/dual.h"
#include "render/core/index.h"
#include "render/path/local_form.h"
#include "render/path/replay.h"
#include "render/path/replay_double.h"

namespace h2mc {
namespace {

constexpr int kBlock = 4;
using Dual = ad::Dual2<double, 2 * kBlock>;

}  // namespace

ad::DerivativeValues differentiateInDouble(const Scene& scene, const Path& path, const double* u) {
  const int n = path.dimension(), blocks = (n + kBlock - 1) / kBlock;
  ad::DerivativeValues result;
  result.gradient.resize(static_cast<std::size_t>(n));
  result.hessian.resize(static_cast<std::size_t>(n) * static_cast<std::size_t>(n + 1) / 2);
  Dual x[kMaxCoordinates];
  for (int a = 0; a < blocks; ++a) {
    // Every pair; all of them hold each block's own entries. A single block has an empty partner.
    for (int b = a + 1; b < std::max(blocks, 2); ++b) {
      const auto lane = [&](int i) {
        const int block = i / kBlock;
        return block == a ? i % kBlock : block == b ? kBlock + i % kBlock : -1;
      };
      for (int i = 0; i < n; ++i) x[i] = lane(i) >= 0 ? Dual::variable(u[i], lane(i)) : Dual(u[i]);
      const Dual y = replayAt<Dual>(scene, path, x);
      result.value = y.v;
      for (int i = 0; i < n; ++i) {
        if (lane(i) < 0) continue;
        result.gradient[at(i)] = y.gradient(lane(i));
        for (int j = 0; j <= i; ++j)
          if (lane(j) >= 0)
            result.hessian[at(ad::triangleIndex(i, j))] = y.hessian(lane(i), lane(j));
      }
    }
  }
  return result;
}

ad::DerivativeValues differentiateLocallyInDouble(const Scene& scene, const Path& path,
                                                  const double* u) {
  const auto n = at(path.dimension());
  ad::DerivativeValues result;
  result.gradient.resize(n);
  result.hessian.resize(n * (n + 1) / 2);
  result.value = -std::numeric_limits<double>::infinity();
  composeDerivatives(scene, path, u, result.value, result.gradient.data(), result.hessian.data());
  return result;
}

}  // namespace h2mc
