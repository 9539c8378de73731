// Multiplexed Metropolis light transport with Hessian-Hamiltonian small steps [Li et al. 2015].
#include "mcmc/h2mc.h"

#include "mcmc/lens_step.h"
#include "mcmc/metropolis_options.h"
#include "mcmc/small_step.h"

namespace h2mc {
namespace {

constexpr auto kParameters = withShared(std::array{
    Parameter{
        "isotropicProbability", ParameterType::kNumber, "-1",
        "share of isotropic steps among those that are neither large nor of the lens; -1: by what "
        "is accepted at each brightness of a path, which the chains learn"},
    Parameter{"trajectoryLength", ParameterType::kNumber, "1.5707963",
              "length of the Hamiltonian trajectory, 0 < L < pi"},
    Parameter{"maxDrift", ParameterType::kNumber, "3",
              "longest drift of a proposal along an eigenvector, in its standard deviations"},
});

// Of a Hamiltonian step, in isotropic ones: 2.5 to 4 by the benchmark, where the derivatives at the
// present state are there already; after a step of another kind they are not.
constexpr double kHamiltonianCost = 4;

std::vector<KernelMixture::Small> smallSteps(const SceneTarget& target, const OptionSet& options) {
  const HamiltonianSettings settings = hamiltonianSettings(options);
  const double lens = options.number("lensProbability");
  const double wanted = options.number("isotropicProbability");
  const bool learned = wanted < 0;
  const double isotropic = learned ? 0.5 : wanted;
  std::vector<KernelMixture::Small> steps;
  steps.push_back({makeLensStep(target, options), lens, 0});
  steps.push_back({std::make_unique<IsotropicStep>(target, StepShape::kGaussian, settings.sigma),
                   (1 - lens) * isotropic, isotropic, learned ? 1. : 0});
  steps.push_back({std::make_unique<HamiltonianStep>(target, settings),
                   (1 - lens) * (1 - isotropic), 1 - isotropic, learned ? kHamiltonianCost : 0});
  return steps;
}

void check(const OptionSet& options) {
  requireRange(options, "isotropicProbability", -1, 1);
  requireRange(options, "trajectoryLength", 1e-3, 3.14);
  requireRange(options, "maxDrift", 0, kNoLimit);
}

}  // namespace

HamiltonianSettings hamiltonianSettings(const OptionSet& options) {
  HamiltonianSettings settings;
  const auto take = [&](const char* name, float& value) {
    if (options.has(name)) value = static_cast<float>(options.number(name));
  };
  take("sigma", settings.sigma);
  take("trajectoryLength", settings.trajectory);
  take("maxDrift", settings.maxDrift);
  return settings;
}

MetropolisMethod h2mcMethod() {
  return {{"h2mc", "Metropolis light transport with Hessian-Hamiltonian proposals", kParameters},
          smallSteps,
          check};
}

}  // namespace h2mc
