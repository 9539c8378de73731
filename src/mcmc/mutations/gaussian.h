// SPDX-License-Identifier: MIT
// The Hessian-Hamiltonian proposal in closed form [Li et al. 2015, section 4 and appendix].
#pragma once

#include "render/core/random.h"
#include "render/path/derivative.h"

namespace h2mc {

struct HamiltonianSettings {
  float sigma = 0.01f;            // standard deviation of the isotropic prior
  float trajectory = 1.5707963f;  // L, the length of the simulated trajectory
  float maxDrift = 3;             // longest drift along an eigenvector, in its own deviations
};

// A Gaussian over offsets in primary space: eigenvectors, a standard deviation and a mean for each.
struct Gaussian {
  int dimension = 0;
  bool alongAxes = false;  // eigenvectors are the axes and not stored
  float deviation[kMaxCoordinates];
  float mean[kMaxCoordinates];                       // along the eigenvectors
  float vectors[kMaxCoordinates * kMaxCoordinates];  // one after the other
  double logNormalisation = 0;  // -sum of log(deviation); the power of 2 pi is left out

  // An offset drawn from it.
  void sample(Random& random, float* offset) const;
  // Log density at an offset, up to the same constant for every Gaussian of this dimension.
  double logDensity(const float* offset) const;
};

// The Gaussian at a state with these derivatives. With H = Q diag(l) Q^T, the mass matrix |H|, a
// Gaussian start velocity and a trajectory of length L on the quadratic approximation, the end point
// is Gaussian along each eigenvector; times the prior N(0, sigma^2 I):
//
//     variance_i = sigma^2 s2 / (s2 + sigma^2 |l_i|),  mean_i = (c / s2) variance_i (Q^T g)_i,
//
// with (c, s2) = (1 - cos L, sin^2 L) for l < 0 and (cosh L - 1, sinh^2 L) for l > 0. The drift is
// bounded to settings.maxDrift deviations. Where no variance would be 5 % below the prior's, and the drift no
// twentieth of a deviation, it is the prior and nothing is decomposed. A function of the derivatives alone.
// False, and the prior, when they are not finite or the eigendecomposition fails.
bool hamiltonianGaussian(const Derivative& derivative, const HamiltonianSettings& settings,
                         Gaussian& gaussian);

// N(0, sigma^2 I).
void isotropicGaussian(int dimension, float sigma, Gaussian& gaussian);

}  // namespace h2mc
