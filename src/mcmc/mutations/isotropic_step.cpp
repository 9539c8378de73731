// SPDX-License-Identifier: MIT
#include "mcmc/mutations/isotropic_step.h"

#include "mcmc/mutations/mutation_options.h"
#include "render/core/index.h"
#include "render/core/unit_interval.h"

namespace h2mc {

Proposal IsotropicStep::propose(ChainState& current, ChainState& proposed,
                                MutationContext& context) {
  const Path& from = current.path;
  Path& to = proposed.path;
  const float size = sizes_.of(from.technique.length());
  to.technique = from.technique;
  for (int i = 0; i < from.technique.dimension(); ++i)
    to.sample.u[at(i)] = wrap(from.sample.u[at(i)] + size * offset(*context.random));
  for (int i = 0; i < from.technique.choices(); ++i)
    to.sample.choice[at(i)] = wrap(from.sample.choice[at(i)] + size * offset(*context.random));
  to.sample.time = from.sample.time;
  to.sample.aperture = from.sample.aperture;
  const SharedCoordinates shared = target_.shared();
  float x[kMostShared];
  getShared(shared, from.sample, x);
  for (int i = 0; i < shared.count(); ++i) {
    const float moved = x[i] + size * offset(*context.random);
    x[i] = sharedWraps_ ? wrap(moved) : reflect(moved);
  }
  setShared(shared, x, to.sample);
  return target_.evaluate(to) ? Proposal::withLogRatio(0) : Proposal::none();
}

MutationPlugin isotropicStep() {
  static constexpr Parameter kParameters[] = {
      kSigmaParameter,
      kTargetAcceptanceParameter,
      smallStepParameter("gaussian"),
  };
  return {"isotropic", "all primary coordinates move a little, each by itself", kParameters,
          [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
            return std::make_unique<IsotropicStep>(
                setup.target, smallStep(setup.options),
                static_cast<float>(setup.options.number("sigma")),
                setup.options.number("targetAcceptance"));
          },
          [](const OptionSet& options) {
            requireRange(options, "sigma", 1e-9, 1);
            requireAcceptance(options);
          }};
}

}  // namespace h2mc
