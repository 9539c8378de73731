// SPDX-License-Identifier: MIT
#include "render/bsdf/fresnel.h"

#include "render/bsdf/quadrature.h"

namespace h2mc {

double fresnelDiffuse(double eta) {
  const auto nodes = gaussLegendre(64);
  // Below the critical cosine everything is reflected; above it c^2 = k2 + (1 - k2) s^2 takes the
  // root's singularity away.
  const double k2 = eta < 1 ? 1 - eta * eta : 0;
  double sum = k2;
  for (const auto& [s, weight] : nodes) {
    const double c = k2 > 0 ? std::sqrt(k2 + (1 - k2) * s * s) : s;
    const double cosine = k2 > 0 ? 2 * (1 - k2) * s : 2 * s;  // 2 c dc/ds
    sum += weight * cosine * fresnelDielectric(c, eta);
  }
  return sum;
}

}  // namespace h2mc
