// SPDX-License-Identifier: MIT
#include "mcmc/mutations/delayed_rejection.h"

#include <cassert>

#include "mcmc/mutations/hamiltonian_step.h"
#include "mcmc/mutations/langevin_step.h"
#include "mcmc/mutations/mutation_options.h"
#include "render/core/index.h"
#include "render/core/unit_interval.h"

namespace h2mc {

float DelayedRejection::back(float x, float y, float z) const { return wrap(z - (y - x)); }

Proposal DelayedRejection::proposeAgain(ChainState& current, const ChainState& refused,
                                        ChainState& proposed, ChainState& back,
                                        MutationContext& context) {
  const Proposal proposal = second_->propose(current, proposed, context);
  if (!proposal.made()) return proposal;
  assert(!proposal.isDecided() && proposed.path.technique == current.path.technique);
  const PrimarySample &x = current.path.sample, &y = refused.path.sample, &z = proposed.path.sample;
  PrimarySample& to = back.path.sample;
  const Technique& technique = back.path.technique = current.path.technique;
  for (int i = 0; i < technique.dimension(); ++i)
    to.u[at(i)] = this->back(x.u[at(i)], y.u[at(i)], z.u[at(i)]);
  for (int i = 0; i < technique.choices(); ++i)
    to.choice[at(i)] = this->back(x.choice[at(i)], y.choice[at(i)], z.choice[at(i)]);
  to.time = x.time;
  to.aperture = x.aperture;
  const SharedCoordinates shared = target_.shared();
  float a[kMostShared], b[kMostShared], c[kMostShared];
  getShared(shared, x, a);
  getShared(shared, y, b);
  getShared(shared, z, c);
  for (int i = 0; i < shared.count(); ++i) c[i] = this->back(a[i], b[i], c[i]);
  setShared(shared, c, to);
  if (!target_.evaluate(back.path)) back.path.target = 0;
  return proposal;
}

namespace {

constexpr Parameter kFirstSigmaParameter = {
    "firstSigma", ParameterType::kNumber, "0.01",
    "standard deviation of the first, isotropic try of delayed rejection"};

void checkFirst(const OptionSet& options) { requireRange(options, "firstSigma", 1e-9, 1); }

std::unique_ptr<Mutation> delayed(const MutationSetup& setup, std::string_view name,
                                  std::unique_ptr<Mutation> second) {
  return std::make_unique<DelayedRejection>(setup.target, name,
                                            static_cast<float>(setup.options.number("firstSigma")),
                                            std::move(second));
}

}  // namespace

MutationPlugin isotropicThenTimid() {
  static constexpr Parameter kParameters[] = {
      kFirstSigmaParameter,
      {"secondSigma", ParameterType::kNumber, "0.001",
       "standard deviation of the second, isotropic try of delayed rejection"},
  };
  return {"isotropicThenTimid",
          "an isotropic step and, where it is refused, a smaller one [Rioux-Lavoie et al. 2020]",
          kParameters,
          [](const MutationSetup& setup) {
            return delayed(setup, "isotropicThenTimid",
                           std::make_unique<IsotropicStep>(
                               setup.target, StepShape::kGaussian,
                               static_cast<float>(setup.options.number("secondSigma"))));
          },
          [](const OptionSet& options) {
            checkFirst(options);
            requireRange(options, "secondSigma", 1e-9, 1);
          }};
}

MutationPlugin isotropicThenHamiltonian() {
  static constexpr Parameter kParameters[] = {kFirstSigmaParameter, kSigmaParameter,
                                              kTrajectoryLengthParameter, kMaxDriftParameter};
  return {
      "isotropicThenHamiltonian",
      "an isotropic step and, where it is refused, a Hamiltonian one [Rioux-Lavoie et al. 2020]",
      kParameters,
      [](const MutationSetup& setup) {
        return delayed(setup, "isotropicThenHamiltonian", hamiltonianStep().create(setup));
      },
      [](const OptionSet& options) {
        checkFirst(options);
        hamiltonianStep().check(options);
      }};
}

MutationPlugin isotropicThenLangevin() {
  static constexpr Parameter kParameters[] = {kFirstSigmaParameter,       kSigmaParameter,
                                              kStepSizeParameter,         kMaxDriftParameter,
                                              kTargetAcceptanceParameter, kPreconditionerParameter};
  return {"isotropicThenLangevin",
          "an isotropic step and, where it is refused, a Langevin one [Rioux-Lavoie et al. 2020]",
          kParameters,
          [](const MutationSetup& setup) {
            return delayed(setup, "isotropicThenLangevin", langevinStep().create(setup));
          },
          [](const OptionSet& options) {
            checkFirst(options);
            langevinStep().check(options);
          }};
}

}  // namespace h2mc
