// SPDX-License-Identifier: MIT
#include "render/bsdf/quadrature.h"

#include <cmath>
#include <numbers>

#include "render/core/index.h"
namespace h2mc {

std::vector<QuadratureNode> gaussLegendre(int count) {
  std::vector<QuadratureNode> nodes(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    // Newton's method on the Legendre polynomial, from Tricomi's estimate of its root.
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), derivative = 1;
    for (int step = 0; step < 100; ++step) {
      double p0 = 1, p1 = x;
      for (int k = 2; k <= count; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      derivative = count * (x * p1 - p0) / (x * x - 1);
      const double change = p1 / derivative;
      x -= change;
      if (std::abs(change) < 1e-15) break;
    }
    nodes[at(i)] = {0.5 * (1 - x), 1 / ((1 - x * x) * derivative * derivative)};
  }
  return nodes;
}

}  // namespace h2mc
