// SPDX-License-Identifier: MIT
// Mutations in path space with the mistakes that are theirs: the test of exactness sees each.
#include <gtest/gtest.h>

#include <functional>

#include "exactness_world.h"
#include "mcmc/mutations/caustic.h"
#include "mcmc/mutations/lens_subpath.h"
#include "mcmc/mutations/multi_chain.h"
#include "mcmc/mutations/veach_bidirectional.h"
#include "mcmc/mutations/veach_lens.h"

namespace h2mc::test {
namespace {

constexpr float kThreshold = 0.1f;

// Goes farther than the way back would.
struct CausticOneWay final : CausticPerturbation {
  using CausticPerturbation::CausticPerturbation;
  bool leadsBack(const FullPath&, int, double) const override { return true; }
};
// Takes the turned direction for one that the BSDF has drawn.
struct CausticSampled final : CausticPerturbation {
  using CausticPerturbation::CausticPerturbation;
  double logTraced(const FullPath& path, const TechniqueDensities& densities,
                   int l) const override {
    return densities.fromLight[at(path.edges)] - densities.fromLight[at(l) + 1];
  }
};
// Does not turn solid angle into area at the first vertex that moves.
struct CausticNoArea final : CausticPerturbation {
  using CausticPerturbation::CausticPerturbation;
  double logTraced(const FullPath& path, const TechniqueDensities& densities,
                   int l) const override {
    return CausticPerturbation::logTraced(path, densities, l) -
           logSpread(scene(), path, l + 1, Side::kLight);
  }
};
// The same of the multi-chain perturbation's directions.
struct MultiChainSampled final : MultiChain {
  using MultiChain::MultiChain;
  double logDirectionDensity(const FullPath&, const TechniqueDensities&, int) const override {
    return 0;
  }
};
// Forgets that it might have gone on.
struct LensSubpathStops final : LensSubpath {
  using LensSubpath::LensSubpath;
  double logStop(const FullPath&, int) const override { return 0; }
};
// Does not count anew among how many windows there is to choose.
struct BidirectionalNoCount final : VeachBidirectional {
  using VeachBidirectional::VeachBidirectional;
  int windows(const FullPath&, int, int) const override { return 1; }
};
// Knows one technique that makes the window, the likeliest, and not their sum.
struct BidirectionalNoSum final : VeachBidirectional {
  using VeachBidirectional::VeachBidirectional;
  double logWindow(const FullPath& path, const TechniqueDensities& densities,
                   const Window& window) const override {
    if (window.l == 0) return VeachBidirectional::logWindow(path, densities, window);
    const auto begin = densities.logDensity.begin();
    return *std::max_element(begin + window.l + 1, begin + window.m + 1) -
           densities.fromLight[at(window.l + 1)] - densities.fromCamera[at(window.m)];
  }
};

// Forgets that the technique was drawn by its weight.
class NoWeights final : public Mutation {
 public:
  NoWeights(const PathTarget& target, float threshold, SlotNumbers& slots)
      : scene_(target.scene()), inner_(target, threshold, slots) {}
  std::string_view name() const override { return inner_.name(); }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override {
    const Proposal proposal = inner_.propose(current, proposed, context);
    if (!proposal.made()) return proposal;
    return Proposal::withLogRatio(proposal.logRatio() + logWeight(proposed.path) -
                                  logWeight(current.path));
  }

 private:
  double logWeight(const Path& path) const {
    FullPath full;
    toFull(scene_, path, full);
    return std::log(densities(scene_, full).weight[at(path.technique.s)]);
  }
  const Scene& scene_;
  VeachLens inner_;
};

using Make = std::function<std::unique_ptr<Mutation>(const PathTarget&, SlotNumbers&)>;
template <class Kernel, class... Arguments>
Make make(Arguments... arguments) {
  return [=](const PathTarget& target, SlotNumbers& slots) -> std::unique_ptr<Mutation> {
    return std::make_unique<Kernel>(target, arguments..., slots);
  };
}

struct Planted {
  const char* name;
  Make make;
  int scene;  // of exactnessScenes(): one on which it matters
};

std::vector<Planted> planted() {
  return {{"caustic_oneWay", make<CausticOneWay>(kThreshold), 2},
          {"caustic_sampled", make<CausticSampled>(kThreshold), 0},
          {"caustic_noArea", make<CausticNoArea>(kThreshold), 0},
          {"multiChain_sampled", make<MultiChainSampled>(kThreshold), 2},
          {"lensSubpath_stops", make<LensSubpathStops>(1, kThreshold), 3},
          {"lens_noWeights", make<NoWeights>(kThreshold), 0},
          {"bidirectional_noCount", make<BidirectionalNoCount>(1), 0},
          {"bidirectional_noSum", make<BidirectionalNoSum>(1), 0}};
}

// A kernel alone, without mistakes or with them.
ExactnessReport reportOn(const World& world, const Make& make, int samples) {
  SlotNumbers slots;
  KernelMixture kernels = world.alone(make(world.target, slots));
  ExactnessPlan plan;
  plan.samples = samples;
  return reportOn(world.target, kernels, plan);
}

// Where almost nothing counts as rough, so that lobes of all widths are traced through, and where all does; every
// kernel on every scene in one of the two.
TEST(PathMutation, KeepsTheTargetWhateverCountsAsRoughSlow) {
  bool all = false;
  for (const ExactnessScene& scene : exactnessScenes()) {
    const World world(scene);
    const auto test = [&](float threshold, const Make& kernel) {
      const ExactnessReport report = reportOn(world, kernel, 200000);
      EXPECT_TRUE(report.passed) << scene.name << ", threshold " << threshold << "\n"
                                 << report.text;
    };
    const float some = all ? 0.7f : 0, others = all ? 0 : 0.7f;
    test(some, make<VeachLens>(some));
    test(others, make<MultiChain>(others));
    test(some, make<CausticPerturbation>(some));
    test(others, make<LensSubpath>(1, others));
    all = !all;
  }
}

class PathMutationMistake : public ::testing::TestWithParam<Planted> {};

TEST_P(PathMutationMistake, IsSeenSlow) {
  const World world(exactnessScenes()[at(GetParam().scene)]);
  ExactnessReport report;
  for (const int samples : {300000, 2000000}) {
    report = reportOn(world, GetParam().make, samples);
    if (!report.passed) break;
  }
  EXPECT_FALSE(report.passed);
}

INSTANTIATE_TEST_SUITE_P(Kernels, PathMutationMistake, ::testing::ValuesIn(planted()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace h2mc::test
