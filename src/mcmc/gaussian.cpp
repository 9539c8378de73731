#include "mcmc/gaussian.h"

#include <algorithm>
#include <cmath>

#include "ad/symmetric_eigen.h"

namespace h2mc {

void isotropicGaussian(int dimension, float sigma, Gaussian& gaussian) {
  gaussian.dimension = dimension;
  gaussian.isotropic = true;
  std::fill_n(gaussian.deviation, dimension, sigma);
  std::fill_n(gaussian.mean, dimension, 0.f);
  gaussian.logNormalisation = -dimension * std::log(double(sigma));
}

namespace {

// For derivatives of at most kMost coordinates, all finite; `gaussian` is the prior.
template <int kMost>
bool sharpen(const Derivative& derivative, const HamiltonianSettings& settings,
             Gaussian& gaussian) {
  const int n = derivative.dimension;
  // In double: single precision loses the small eigenvalues of graded matrices.
  double matrix[kMost * kMost];
  for (int i = 0, k = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j, ++k) matrix[i * n + j] = derivative.hessian[k];
  ad::SymmetricEigen<kMost> eigen;
  if (!eigen.compute(matrix, n, n)) return false;

  const double prior = double(settings.sigma) * settings.sigma, length = settings.trajectory;
  const double c[2] = {std::cosh(length) - 1, 1 - std::cos(length)};
  const double s2[2] = {std::sinh(length) * std::sinh(length), std::sin(length) * std::sin(length)};
  gaussian.isotropic = false;
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
  // Rows as long as they have to be.
  if (derivative.dimension <= 8) return sharpen<8>(derivative, settings, gaussian);
  if (derivative.dimension <= 16) return sharpen<16>(derivative, settings, gaussian);
  return sharpen<kMaxDerivativeDimension>(derivative, settings, gaussian);
}

void Gaussian::sample(Random& random, float* offset) const {
  if (isotropic) {
    for (int i = 0; i < dimension; ++i) offset[i] = deviation[i] * random.normal();
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
    float along;
    if (isotropic) {
      along = offset[i];
    } else {
      along = -mean[i];
      for (int k = 0; k < dimension; ++k) along += vectors[i * dimension + k] * offset[k];
    }
    sum += squared(double(along) / deviation[i]);
  }
  return logNormalisation - 0.5 * sum;
}

}  // namespace h2mc
