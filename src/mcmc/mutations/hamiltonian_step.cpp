// SPDX-License-Identifier: MIT
#include "mcmc/mutations/hamiltonian_step.h"

#include <limits>

#include "mcmc/mutations/mutation_options.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {

void HamiltonianStep::make(const Path& path, MutationContext& context, Gaussian& gaussian) const {
  const double start = context.timed ? wallClock() : 0;
  Derivative derivative;
  target().differentiate(path, derivative);
  context.derivatives.inDouble += derivative.inDouble;
  const double middle = context.timed ? wallClock() : 0;
  if (!hamiltonianGaussian(derivative, settings_, gaussian))
    ++context.derivatives.notFinite;
  else
    context.derivatives.flat += gaussian.alongAxes;
  if (context.timed) {
    context.seconds.derivatives += middle - start;
    context.seconds.gaussian += wallClock() - middle;
  }
}

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

MutationPlugin hamiltonianStep() {
  static constexpr Parameter kParameters[] = {
      kSigmaParameter,
      kTrajectoryLengthParameter,
      kMaxDriftParameter,
  };
  return {"hamiltonian",
          "a step drawn from the Gaussian that gradient and Hessian give by Hamiltonian dynamics",
          kParameters,
          [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
            return std::make_unique<HamiltonianStep>(
                setup.target, hamiltonianSettings(setup.options), setup.slots);
          },
          [](const OptionSet& options) {
            requireRange(options, "sigma", 1e-9, 1);
            requireRange(options, "trajectoryLength", 1e-3, 3.14);
            requireRange(options, "maxDrift", 0, std::numeric_limits<double>::infinity());
          }};
}

}  // namespace h2mc
