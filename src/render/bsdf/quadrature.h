// SPDX-License-Identifier: MIT
// Numerical integration for tables made when a scene is read.
#pragma once

#include <vector>

namespace h2mc {

struct QuadratureNode {
  double x, weight;
};

// Gauss-Legendre nodes on [0, 1], exact for polynomials of degree 2 count - 1.
std::vector<QuadratureNode> gaussLegendre(int count);

}  // namespace h2mc
