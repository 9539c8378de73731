// SPDX-License-Identifier: MIT
// Chains on a target whose distribution is known: stationarity of every mutation, alone with large
// steps and mixed, across techniques, at the borders of the unit cube and where coordinates wrap.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <vector>

#include "render/core/index.h"
#include "toy_kernels.h"
#include "toy_target.h"

namespace h2mc::test {
namespace {

constexpr int kPlane = 10, kExtra = 6;

int bin(float x, int count) {
  return std::min(static_cast<int>(x * static_cast<float>(count)), count - 1);
}

// Mass of each of `count` equal intervals of [0, 1), by midpoints.
std::vector<double> masses(int count, const std::function<double(float)>& f) {
  constexpr int kFine = 6000;
  std::vector<double> mass(static_cast<std::size_t>(count), 0);
  for (int i = 0; i < kFine; ++i) {
    const float u = (static_cast<float>(i) + 0.5f) / kFine;
    mass[at(bin(u, count))] += f(u) / kFine;
  }
  return mass;
}

double sum(const std::vector<double>& v) {
  double s = 0;
  for (double x : v) s += x;
  return s;
}

// Histograms of a state: (technique, u0, u1), and for each technique u2, u3 and the choice.
struct Histograms {
  std::vector<std::vector<double>> tables;

  Histograms() : tables(1 + 3 * 3) {
    tables[0].assign(3 * kPlane * kPlane, 0);
    for (std::size_t i = 1; i < tables.size(); ++i) tables[i].assign(kExtra, 0);
  }

  static Histograms expected() {
    Histograms h;
    std::vector<double> plane(kPlane * kPlane, 0);
    constexpr int kFine = 500;
    for (int i = 0; i < kFine; ++i)
      for (int j = 0; j < kFine; ++j) {
        const float u0 = (static_cast<float>(i) + 0.5f) / kFine;
        const float u1 = (static_cast<float>(j) + 0.5f) / kFine;
        plane[at(bin(u0, kPlane) * kPlane + bin(u1, kPlane))] +=
            ToyTarget::plane(u0, u1) / (double(kFine) * kFine);
      }
    const auto even = masses(kExtra, [](float u) { return ToyTarget::even(u); });
    const auto angle = masses(kExtra, [](float u) { return ToyTarget::angle(u); });
    const auto chosen = masses(kExtra, [](float u) { return ToyTarget::chosen(u); });
    for (std::size_t t = 0; t < 3; ++t) {
      const Technique& technique = ToyTarget::kTechniques[t];
      const bool four = technique.dimension() == 4, choice = technique.choices() > 0;
      const double rest = ToyTarget::brightness(technique) * (four ? sum(even) * sum(angle) : 1) *
                          (choice ? sum(chosen) : 1);
      for (std::size_t k = 0; k < plane.size(); ++k)
        h.tables[0][t * plane.size() + k] = plane[k] * rest;
      const double all = sum(plane) * rest;
      for (std::size_t k = 0; k < kExtra; ++k) {
        if (four) h.tables[1 + 3 * t][k] = all * even[k] / sum(even);
        if (four) h.tables[2 + 3 * t][k] = all * angle[k] / sum(angle);
        if (choice) h.tables[3 + 3 * t][k] = all * chosen[k] / sum(chosen);
      }
    }
    const double total = sum(h.tables[0]);
    for (auto& table : h.tables)
      for (double& x : table) x /= total;
    return h;
  }

  void count(const Path& path) {
    std::size_t t = 0;
    while (!(ToyTarget::kTechniques[t] == path.technique)) ++t;
    const auto& u = path.sample.u;
    tables[0][t * kPlane * kPlane +
              static_cast<std::size_t>(bin(u[0], kPlane) * kPlane + bin(u[1], kPlane))] += 1;
    if (path.technique.dimension() == 4) {
      tables[1 + 3 * t][at(bin(u[2], kExtra))] += 1;
      tables[2 + 3 * t][at(bin(u[3], kExtra))] += 1;
    }
    if (path.technique.choices() > 0)
      tables[3 + 3 * t][at(bin(path.sample.choice[0], kExtra))] += 1;
  }
};

using Mixture = ToyMixture;

class ChainOnToy : public testing::TestWithParam<Mixture> {};

// Many short chains, each started by an exact draw and run for a fixed number of steps: the states
// at the end are independent, and distributed as the target if and only if the kernel keeps it.
TEST_P(ChainOnToy, KeepsTheDistribution) {
  const Mixture& mixture = GetParam();
  const ToyTarget target;
  const TechniqueDistribution techniques = evenly(ToyTarget::kTechniques);
  KernelMixture kernels = toyKernels(target, techniques, mixture);

  constexpr int kChains = 60000, kSteps = 25;
  const Histograms expected = Histograms::expected();
  Histograms seen;
  ChainFilms films;
  ChainStatistics statistics(kernels.kinds(), 2);
  MutationContext context;
  Random random(7, 0, 0);
  Path start(2);
  for (int c = 0; c < kChains; ++c) {
    // An exact draw by rejection: the target is at most 8 * 1.05 * 1 * 1.2 * 1.9 * 1.
    do {
      start.technique = ToyTarget::kTechniques[random.next() % 3];
      for (auto& u : start.sample.u) u = random.uniform();
      for (auto& u : start.sample.choice) u = random.uniform();
      target.evaluate(start);
    } while (start.target < 20 * random.uniform());
    Chain chain(target, start, Random(11, static_cast<std::uint64_t>(c), 0));
    for (int i = 0; i < kSteps; ++i) chain.step(kernels, films, statistics, context);
    films.clear();
    seen.count(chain.path());
  }

  // z-scores of chi-square by Wilson and Hilferty; ten tables, each tested at z = 4: false alarms
  // in about one of 3,000 choices of the seed.
  for (std::size_t t = 0; t < seen.tables.size(); ++t) {
    double chi2 = 0, cells = -1;
    for (std::size_t k = 0; k < seen.tables[t].size(); ++k) {
      const double e = expected.tables[t][k] * kChains;
      if (e < 5) {
        EXPECT_LT(seen.tables[t][k], e + 25) << "table " << t << " cell " << k;
        continue;
      }
      chi2 += (seen.tables[t][k] - e) * (seen.tables[t][k] - e) / e;
      cells += 1;
    }
    if (cells < 1) continue;
    const double z = (std::cbrt(chi2 / cells) - (1 - 2 / (9 * cells))) / std::sqrt(2 / (9 * cells));
    EXPECT_LT(z, 4) << mixture.name << ": table " << t << ", chi-square " << chi2 << " of "
                    << cells;
  }
  // The kernels did move.
  for (const auto& kind : statistics.acceptance)
    for (const AcceptanceCount& count : kind) {
      if (count.proposed > 1000) {
        EXPECT_GT(count.expected, 0.02 * static_cast<double>(count.proposed));
      }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kernels, ChainOnToy,
    testing::Values(Mixture{"large", 1, 0, 0, StepShape::kGaussian, 0.1f},
                    Mixture{"gaussian", 0.2, 1, 0, StepShape::kGaussian, 0.2f},
                    Mixture{"kelemen", 0.2, 1, 0, StepShape::kKelemen, 0.1f},
                    Mixture{"hamiltonian", 0.1, 0, 1, StepShape::kGaussian, 0.2f},
                    Mixture{"hamiltonian_narrow", 0.1, 0, 1, StepShape::kGaussian, 0.03f},
                    Mixture{"delayed", 0.1, 0, 0, StepShape::kGaussian, 0.1f, false, 1},
                    Mixture{"delayed_and_others", 0.1, 0.3, 0.3, StepShape::kGaussian, 0.05f, true,
                            0.4},
                    Mixture{"all", 0.3, 0.3, 0.7, StepShape::kGaussian, 0.1f},
                    Mixture{"learned", 0.1, 0.5, 0.5, StepShape::kGaussian, 0.1f, true}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace h2mc::test
