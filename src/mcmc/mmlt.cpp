// Multiplexed Metropolis light transport [Hachisuka et al. 2014]: isotropic small steps.
#include "mcmc/mmlt.h"

#include "mcmc/lens_step.h"
#include "mcmc/metropolis_options.h"
#include "mcmc/small_step.h"

namespace h2mc {
namespace {

constexpr auto kParameters = withShared(std::array{
    Parameter{"smallStep", ParameterType::kString, "gaussian", "shape of the isotropic step",
              "gaussian|kelemen"},
});

std::vector<KernelMixture::Small> smallSteps(const SceneTarget& target, const OptionSet& options) {
  const auto shape =
      options.string("smallStep") == "kelemen" ? StepShape::kKelemen : StepShape::kGaussian;
  const double lens = options.number("lensProbability");
  std::vector<KernelMixture::Small> steps;
  steps.push_back({makeLensStep(target, options), lens, 0});
  steps.push_back(
      {std::make_unique<IsotropicStep>(target, shape, static_cast<float>(options.number("sigma"))),
       1 - lens, 1});
  return steps;
}

}  // namespace

MetropolisMethod mmltMethod() {
  return {
      {"mmlt", "multiplexed Metropolis light transport with isotropic small steps", kParameters},
      smallSteps};
}

}  // namespace h2mc
