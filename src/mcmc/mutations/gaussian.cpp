// SPDX-License-Identifier: MIT
#include "mcmc/mutations/gaussian.h"

#include <algorithm>
#include <cmath>

#include "ad/symmetric_eigen.h"

namespace h2mc {

void isotropicGaussian(int dimension, float sigma, Gaussian& gaussian) {
  gaussian.dimension = dimension;
  gaussian.alongAxes = true;
  std::fill_n(gaussian.deviation, dimension, sigma);
  std::fill_n(gaussian.mean, dimension, 0.f);
  gaussian.logNormalisation = -dimension * std::log(double(sigma));
}

namespace {

// c and s2 of the declaration's formulas: for curvature upwards, and for curvature downwards.
struct Trajectory {
  double c[2], s2[2];

  explicit Trajectory(double length)
      : c{std::cosh(length) - 1, 1 - std::cos(length)},
        s2{squared(std::sinh(length)), squared(std::sin(length))} {}
};

// Below this, relative to the prior's deviation, derivatives are the same as none: the largest variance
// it leaves out is 5 % off the prior's, the longest drift a twentieth of a deviation.
constexpr double kFlat = 0.05;

// Whether neither matters against the prior: |H| by Frobenius' norm, which no eigenvalue exceeds.
bool isFlat(const Derivative& derivative, const Trajectory& trajectory, double sigma) {
  double slope2 = 0, curvature2 = 0;
  for (int i = 0, k = 0; i < derivative.dimension; ++i) {
    slope2 += squared(double(derivative.gradient[i]));
    for (int j = 0; j <= i; ++j, ++k)
      curvature2 += (i == j ? 1 : 2) * squared(double(derivative.hessian[k]));
  }
  // sin^2 is less than sinh^2, and (1 - cos) / sin^2 more than (cosh - 1) / sinh^2.
  const double drift = trajectory.c[1] / trajectory.s2[1] * sigma;
  return slope2 * squared(drift) <= squared(kFlat) &&
         curvature2 * squared(squared(sigma)) <= squared(kFlat * trajectory.s2[1]);
}

// For derivatives of at most kMost coordinates, all finite; `gaussian` is the prior.
template <int kMost>
bool sharpen(const Derivative& derivative, const HamiltonianSettings& settings,
             const Trajectory& trajectory, Gaussian& gaussian) {
  const int n = derivative.dimension;
  // In double: single precision loses the small eigenvalues of graded matrices.
  double matrix[kMost * kMost] = {};
  for (int i = 0, k = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j, ++k) matrix[i * n + j] = derivative.hessian[k];
  ad::SymmetricEigen<kMost> eigen;
  if (!eigen.compute(matrix, n, n)) return false;

  const double prior = squared(double(settings.sigma));
  const auto& [c, s2] = trajectory;
  gaussian.alongAxes = false;
  gaussian.logNormalisation = 0;
  for (int i = 0; i < n; ++i) {
    const double value = eigen.value(i), *const vector = eigen.vector(i);
    const bool negative = value < 0;
    const double variance = prior * s2[negative] / (s2[negative] + prior * std::abs(value));
    const double deviation = std::sqrt(variance);
    double slope = 0;
    for (int k = 0; k < n; ++k) {
      slope += vector[k] * derivative.gradient[k];
      gaussian.vectors[i * n + k] = static_cast<float>(vector[k]);
    }
    const double drift = c[negative] / s2[negative] * variance * slope;
    const double longest = settings.maxDrift * deviation;
    gaussian.mean[i] = static_cast<float>(std::clamp(drift, -longest, longest));
    gaussian.deviation[i] = static_cast<float>(deviation);
    gaussian.logNormalisation -= std::log(deviation);
  }
  return true;
}

}  // namespace

bool hamiltonianGaussian(const Derivative& derivative, const HamiltonianSettings& settings,
                         Gaussian& gaussian) {
  isotropicGaussian(derivative.dimension, settings.sigma, gaussian);
  if (!derivative.finite()) return false;
  const Trajectory trajectory(settings.trajectory);
  if (isFlat(derivative, trajectory, settings.sigma)) return true;
  // Rows as long as they have to be.
  if (derivative.dimension <= 8) return sharpen<8>(derivative, settings, trajectory, gaussian);
  if (derivative.dimension <= 16) return sharpen<16>(derivative, settings, trajectory, gaussian);
  return sharpen<kMaxCoordinates>(derivative, settings, trajectory, gaussian);
}

void Gaussian::sample(Random& random, float* offset) const {
  if (alongAxes) {
    for (int i = 0; i < dimension; ++i) offset[i] = mean[i] + deviation[i] * random.normal();
    return;
  }
  std::fill_n(offset, dimension, 0.f);
  for (int i = 0; i < dimension; ++i) {
    const float along = mean[i] + deviation[i] * random.normal();
    for (int k = 0; k < dimension; ++k) offset[k] += along * vectors[i * dimension + k];
  }
}

double Gaussian::logDensity(const float* offset) const {
  double sum = 0;
  for (int i = 0; i < dimension; ++i) {
    float along = -mean[i];
    if (alongAxes)
      along += offset[i];
    else
      for (int k = 0; k < dimension; ++k) along += vectors[i * dimension + k] * offset[k];
    sum += squared(double(along) / deviation[i]);
  }
  return logNormalisation - 0.5 * sum;
}

}  // namespace h2mc
