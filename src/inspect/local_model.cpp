// SPDX-License-Identifier: MIT
#include "inspect/local_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ad/symmetric_eigen.h"
#include "render/core/index.h"

namespace h2mc {
namespace {

void decompose(const Derivative& derivative, LocalModel& model) {
  const int n = model.dimension;
  Gaussian gaussian;
  ad::SymmetricEigen<kMaxCoordinates> eigen;
  double matrix[kMaxCoordinates * kMaxCoordinates];
  for (int i = 0, k = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j, ++k) matrix[i * n + j] = derivative.hessian[k];
  // The Gaussian makes the same decomposition: its vectors come in the same order.
  if (!hamiltonianGaussian(derivative, model.settings, gaussian) || !eigen.compute(matrix, n, n)) {
    model.reason = "the eigenvalues of its Hessian were not found";
    return;
  }
  model.available = true;
  model.gradient.assign(derivative.gradient, derivative.gradient + n);
  model.hessian.assign(derivative.hessian, derivative.hessian + n * (n + 1) / 2);
  for (int i = 0; i < n; ++i) {
    EigenDirection e;
    e.value = eigen.value(i);
    e.deviation = gaussian.deviation[i];
    e.mean = gaussian.mean[i];
    e.vector.assign(eigen.vector(i), eigen.vector(i) + n);
    e.slope = dotProduct(e.vector, model.gradient);
    model.eigen.push_back(std::move(e));
  }
  std::stable_sort(model.eigen.begin(), model.eigen.end(), [](const auto& a, const auto& b) {
    return std::abs(a.value) > std::abs(b.value);
  });
}

}  // namespace

double dotProduct(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

LocalModel localModel(const Scene& scene, const Path& path, const HamiltonianSettings& settings) {
  LocalModel model;
  model.dimension = path.dimension();
  model.shared = path.shared();
  model.settings = settings;
  model.logTarget = std::log(double(path.target));
  Derivative derivative;
  differentiate(scene, path, derivative);
  if (derivative.finite())
    decompose(derivative, model);
  else
    model.reason = "its derivatives are not finite";
  return model;
}

double LocalModel::logRatio(const std::vector<double>& offset) const {
  double sum = 0;
  for (const EigenDirection& e : eigen) {
    const double along = dotProduct(e.vector, offset);
    sum += along * (e.slope + 0.5 * e.value * along);
  }
  return sum;
}

double LocalModel::deviationAlong(const std::vector<double>& direction) const {
  if (!available) return settings.sigma;
  double variance = 0;
  for (const EigenDirection& e : eigen)
    variance += squared(dotProduct(e.vector, direction) * e.deviation);
  return std::sqrt(variance);
}

double LocalModel::driftAlong(const std::vector<double>& direction) const {
  double sum = 0;
  for (const EigenDirection& e : eigen) sum += dotProduct(e.vector, direction) * e.mean;
  return sum;
}

std::vector<std::string> LocalModel::names() const {
  std::vector<std::string> all;
  for (std::size_t i = 1; i <= eigen.size(); ++i) all.push_back(fmt::format("e{}", i));
  for (int i = 0; i < dimension - shared.count(); ++i) all.push_back(fmt::format("u{}", i));
  if (shared.aperture) all.insert(all.end(), {"aperture0", "aperture1"});
  if (shared.time) all.emplace_back("time");
  return all;
}

Direction LocalModel::direction(const std::string& name) const {
  const std::vector<std::string> all = names();
  const auto found = std::find(all.begin(), all.end(), name);
  if (found == all.end()) return {};
  const auto index = at(found - all.begin());
  if (index < eigen.size()) return {name, eigen[index].vector};
  Direction coordinate{name, std::vector<double>(static_cast<std::size_t>(dimension), 0)};
  coordinate.vector[index - eigen.size()] = 1;
  return coordinate;
}

}  // namespace h2mc
