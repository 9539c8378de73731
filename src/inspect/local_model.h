// SPDX-License-Identifier: MIT
// What a chain knows of the target around a path: the quadratic approximation of its logarithm, and the
// Gaussian that Hamiltonian dynamics on it gives.
#pragma once

#include <string>
#include <vector>

#include "mcmc/mutations/gaussian.h"

namespace h2mc {

// A unit vector in a path's primary space.
struct Direction {
  std::string
      name;  // "e1": the eigenvector of the largest |eigenvalue|; "u0": a coordinate; "time"
  std::vector<double> vector;
};

// An eigenvector of the Hessian of the log target, with what happens along it.
struct EigenDirection {
  double value = 0;      // eigenvalue
  double slope = 0;      // of the log target
  double deviation = 0;  // of the Hamiltonian Gaussian
  double mean = 0;       // its drift
  std::vector<double> vector;
};

struct LocalModel {
  int dimension = 0;  // the path's
  SharedCoordinates shared;
  HamiltonianSettings settings;
  bool available = false;  // derivatives are there and finite
  std::string reason;      // why not
  double logTarget = 0;
  std::vector<double> gradient, hessian;  // lower triangle by rows
  std::vector<EigenDirection> eigen;      // by |eigenvalue|, the largest first; signs as they come

  // log(target there / target here) by the quadratic; 0 without derivatives.
  double logRatio(const std::vector<double>& offset) const;
  // Standard deviation and mean of the Gaussian's projection on a unit vector; the prior's without
  // derivatives.
  double deviationAlong(const std::vector<double>& direction) const;
  double driftAlong(const std::vector<double>& direction) const;

  // Names of the directions that there are: e1 ... and u0 ..., aperture0, aperture1, time.
  std::vector<std::string> names() const;
  // The direction of one of these names. An empty vector if there is none.
  Direction direction(const std::string& name) const;
};

// Differentiates a path (with a positive target) and decomposes the Hessian.
LocalModel localModel(const Scene& scene, const Path& path, const HamiltonianSettings& settings);

double dotProduct(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace h2mc
