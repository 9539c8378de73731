// SPDX-License-Identifier: MIT
// Chains on a target of which a part depends on time and a part does not: stationarity of every
// mutation across the border between the two.
#include <gtest/gtest.h>

#include <memory>

#include "ad/dual.h"
#include "render/core/index.h"
#include "toy_kernels.h"

namespace h2mc::test {
namespace {

// Two techniques of different dimension. States with u0 >= border(u1) "touch what moves": a ridge that
// slants through u0, u1 and time. The others do not depend on time, but for a part that something
// hides from their sight at times, which no derivative sees.
class HalfMovingTarget final : public Target {
 public:
  static constexpr Technique kTechniques[] = {{0, 2}, {0, 3}};

  int maxLength() const override { return 2; }
  SharedCoordinates shared() const override { return {false, true}; }

  static bool moving(float u0, float u1) { return u0 >= 0.35f + 0.3f * u1; }
  // Large steps try every technique there is.
  static float brightness(const Technique& t) {
    return t == kTechniques[0] ? 2.f : t == kTechniques[1] ? 1.f : 0.f;
  }

  template <class T>
  static T dependsOnTime(const T& u0, const T& u1, const T& time) {
    using S = Scalar<T>;
    const T across = (u0 - u1 * S(0.4) - time * S(0.5) - S(0.2)) * S(1 / 0.08);
    return (ad::exp(T(across * across * S(-0.5))) + S(0.08)) * (time * S(0.8) + S(0.4));
  }
  template <class T>
  static T independent(const T& u0, const T& u1) {
    using S = Scalar<T>;
    const T across = (u0 + u1 * S(0.3) - S(0.3)) * S(1 / 0.1);
    return ad::exp(T(across * across * S(-0.5))) * S(0.8) + S(0.05);
  }
  static bool hidden(float u1, float time) { return u1 > 0.7f && time < 0.4f; }
  template <class T>
  static T even(const T& u) {
    return u * u + Scalar<T>(0.2);
  }

  template <class T>
  static T density(const Technique& technique, bool moves, const T* u, const T& time) {
    T f = moves ? dependsOnTime(u[0], u[1], time) : independent(u[0], u[1]);
    if (!moves && hidden(value(u[1]), value(time))) return T(0.f);
    for (int i = 2; i < technique.dimension(); ++i) f = f * even(u[i]);
    return f * brightness(technique);
  }

  bool evaluate(Path& path) const override {
    path.wraps = 0;
    path.finite = true;
    path.moving = moving(path.sample.u[0], path.sample.u[1]);
    path.target = density(path.technique, path.moving, path.sample.u.data(), path.sample.time);
    path.contribution = Rgbf(path.target);
    path.filmX = path.sample.u[0];
    path.filmY = path.sample.u[1];
    return path.target > 0;
  }

  void differentiateOnce(const Path& path, Gradient& result) const override {
    Derivative derivative;
    differentiate(path, derivative);
    result.dimension = derivative.dimension;
    std::copy_n(derivative.gradient, derivative.dimension, result.gradient);
  }
  void differentiate(const Path& path, Derivative& result) const override {
    if (path.technique.dimension() == 2)
      derive<2>(path, result);
    else
      derive<4>(path, result);
  }

 private:
  // The N coordinates and time, of which the path may not depend on the last.
  template <int N>
  static void derive(const Path& path, Derivative& result) {
    using D = ad::Dual2<float, N + 1>;
    D u[4];  // as many as any technique has
    for (int i = 0; i < N; ++i) u[i] = D::variable(path.sample.u[at(i)], i);
    const D time = D::variable(path.sample.time, N);
    const D f = ad::log(density(path.technique, path.moving, u, time));
    result.dimension = path.dimension();
    result.logTarget = f.v;
    for (int i = 0, k = 0; i < result.dimension; ++i) {
      result.gradient[i] = f.gradient(i);
      for (int j = 0; j <= i; ++j, ++k) result.hessian[k] = f.hessian(i, j);
    }
  }
};

constexpr int kBins = 7;

int bin(float x) { return std::min(static_cast<int>(x * kBins), kBins - 1); }

// Cells of (technique, u0, u1, time).
struct Histogram {
  std::vector<double> cells = std::vector<double>(2 * kBins * kBins * kBins, 0);

  double& cell(std::size_t technique, float u0, float u1, float time) {
    return cells[((technique * kBins + at(bin(u0))) * kBins + static_cast<std::size_t>(bin(u1))) *
                     kBins +
                 static_cast<std::size_t>(bin(time))];
  }
};

Histogram expectedShares() {
  Histogram h;
  constexpr int kFine = 140;
  double even = 0;
  for (int i = 0; i < 1000; ++i)
    even += double(HalfMovingTarget::even((static_cast<float>(i) + 0.5f) / 1000)) / 1000;
  const auto center = [](int i) { return (static_cast<float>(i) + 0.5f) / kFine; };
  double total = 0;
  for (int i = 0; i < kFine; ++i)
    for (int j = 0; j < kFine; ++j)
      for (int k = 0; k < kFine; ++k) {
        const float u[2] = {center(i), center(j)}, time = center(k);
        const double f = double(HalfMovingTarget::density(
            HalfMovingTarget::kTechniques[0], HalfMovingTarget::moving(u[0], u[1]), u, time));
        for (std::size_t t = 0; t < 2; ++t) {
          const Technique& technique = HalfMovingTarget::kTechniques[t];
          const double share = f * double(HalfMovingTarget::brightness(technique)) /
                               double(HalfMovingTarget::brightness({0, 2})) *
                               (t == 1 ? even * even : 1);
          h.cell(t, u[0], u[1], time) += share;
          total += share;
        }
      }
  for (double& x : h.cells) x /= total;
  return h;
}

using Mixture = ToyMixture;

class ChainOnHalfMoving : public testing::TestWithParam<Mixture> {};

// As in chain_toy.cpp: many short chains from exact draws.
TEST_P(ChainOnHalfMoving, KeepsTheDistribution) {
  const Mixture& mixture = GetParam();
  const HalfMovingTarget target;
  const TechniqueDistribution techniques = evenly(HalfMovingTarget::kTechniques);
  KernelMixture kernels = toyKernels(target, techniques, mixture);

  constexpr int kChains = 60000, kSteps = 16;
  static const Histogram expected = expectedShares();
  Histogram seen;
  ChainFilms films;
  ChainStatistics statistics(kernels.kinds(), 2);
  MutationContext context;
  Random random(17, 0, 0);
  Path start(2);
  int crossings = 0;
  for (int c = 0; c < kChains; ++c) {
    // An exact draw by rejection: the target is at most 2 * 1.08 * 1.2 * 1.
    do {
      start.technique = HalfMovingTarget::kTechniques[random.next() % 2];
      for (auto& u : start.sample.u) u = random.uniform();
      start.sample.time = random.uniform();
      target.evaluate(start);
    } while (start.target < 3.8f * random.uniform());
    Chain chain(target, start, Random(19, static_cast<std::uint64_t>(c), 0));
    for (int i = 0; i < kSteps; ++i) {
      const bool before = chain.path().moving;
      chain.step(kernels, films, statistics, context);
      crossings += before != chain.path().moving;
    }
    films.clear();
    const Path& path = chain.path();
    seen.cell(path.technique == HalfMovingTarget::kTechniques[0] ? 0 : 1, path.sample.u[0],
              path.sample.u[1], path.sample.time) += 1;
  }

  // Rare cells together; z-score by Wilson and Hilferty.
  double chi2 = 0, cells = -1, rareSeen = 0, rareExpected = 0;
  for (std::size_t k = 0; k < seen.cells.size(); ++k) {
    const double e = expected.cells[k] * kChains;
    if (e < 8) {
      rareSeen += seen.cells[k];
      rareExpected += e;
      continue;
    }
    chi2 += (seen.cells[k] - e) * (seen.cells[k] - e) / e;
    cells += 1;
  }
  if (rareExpected > 8) {
    chi2 += (rareSeen - rareExpected) * (rareSeen - rareExpected) / rareExpected;
    cells += 1;
  }
  const double z = (std::cbrt(chi2 / cells) - (1 - 2 / (9 * cells))) / std::sqrt(2 / (9 * cells));
  std::printf("%s: chi-square %.1f of %g, z %.2f; %d crossings\n", mixture.name, chi2, cells, z,
              crossings);
  EXPECT_GT(cells, 300);
  EXPECT_LT(z, 4);
  EXPECT_GT(crossings, kChains / 10);
}

INSTANTIATE_TEST_SUITE_P(
    Kernels, ChainOnHalfMoving,
    testing::Values(Mixture{"large", 1, 0, 0, StepShape::kGaussian, 0.1f},
                    Mixture{"gaussian", 0.1, 1, 0, StepShape::kGaussian, 0.3f},
                    Mixture{"kelemen", 0.2, 1, 0, StepShape::kKelemen, 0.1f},
                    Mixture{"hamiltonian", 0.05, 0, 1, StepShape::kGaussian, 0.25f},
                    Mixture{"delayed", 0.1, 0, 0, StepShape::kGaussian, 0.2f, false, 1},
                    Mixture{"all", 0.2, 0.3, 0.7, StepShape::kGaussian, 0.1f}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace h2mc::test
