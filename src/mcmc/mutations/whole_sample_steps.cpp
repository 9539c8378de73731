// SPDX-License-Identifier: MIT
#include "mcmc/mutations/whole_sample_steps.h"

#include "mcmc/chain/statistics.h"
#include "mcmc/mutations/mutation_options.h"
#include "render/core/unit_interval.h"

namespace h2mc {
namespace {

// What all kernels of a mixture share.
std::shared_ptr<WholeSamples> wholeSamples(const MutationSetup& setup) {
  return setup.slots.workplace<WholeSamples>(setup.target, setup.minLength,
                                             setup.slots.shared<WholeSample>());
}

// The coordinates of one point a step away from those of another.
template <class Step>
class MovedCoordinates final : public SampleCoordinates {
 public:
  MovedCoordinates(LazyPoint& from, LazyPoint& to, Random& random, const Step& step)
      : from_(from), to_(to), random_(random), step_(step) {
    to.follow(from);
  }
  float read(int place) override {
    const float value = step_(place, from_.read(place, random_, step_));
    to_.set(place, value);
    return value;
  }
  void set(int place, float value) override { to_.set(place, value); }

 private:
  LazyPoint &from_, &to_;
  Random& random_;
  const Step& step_;
};

}  // namespace

WholeSampleStep::WholeSampleStep(const MutationSetup& setup, const Settings& settings)
    : wholeSamples_(setup.wholeSamples),
      settings_(settings),
      sizes_(settings.targetAcceptance),
      samples_(wholeSamples(setup)) {}

float WholeSampleStep::moved(int place, float value, Random& random) const {
  const float to = value + sizes_.of(0) * stepOffset(settings_.shape, settings_.sigma, random);
  return place < kMostShared ? reflect(to) : wrap(to);
}

Proposal WholeSampleStep::propose(ChainState& current, ChainState& proposed,
                                  MutationContext& context) {
  Random& random = *context.random;
  const auto step = [&](int place, float value) { return moved(place, value, random); };
  MovedCoordinates coordinates(samples_->around(current, context).coordinates,
                               samples_->of(proposed).coordinates, random, step);
  return samples_->propose(current, proposed, coordinates, context);
}

void WholeSampleStep::splatProposal(const ChainState& proposed, double weight,
                                    const Division& division, StateFilm& film) const {
  if (wholeSamples_)
    samples_->of(proposed).connections.splatStates(weight, division, film);
  else
    splatPath(proposed.path, weight, division, film);
}

void WholeSampleStep::learn(const ChainStatistics& statistics, std::size_t kind) {
  AcceptanceCount all;
  for (const AcceptanceCount& count : statistics.acceptance[kind]) all.add(count);
  sizes_.learn({all});
}

WholeLargeStep::WholeLargeStep(const MutationSetup& setup) : samples_(wholeSamples(setup)) {}

Proposal WholeLargeStep::propose(ChainState& current, ChainState& proposed,
                                 MutationContext& context) {
  WholeSample& to = samples_->of(proposed);
  to.coordinates.begin(samples_->places());
  NewCoordinates coordinates(to.coordinates, *context.random);
  const Proposal proposal = samples_->propose(current, proposed, coordinates, context);
  lastEstimate_ = to.connections.luminance();
  return proposal;
}

MutationPlugin wholeSampleStep() {
  static constexpr Parameter kParameters[] = {
      kSigmaParameter,
      kTargetAcceptanceParameter,
      smallStepParameter("kelemen"),
  };
  return {"wholeSample",
          "all coordinates of a bidirectional sample around the path move a little, and one of its "
          "connections becomes the path [Kelemen et al. 2002]",
          kParameters,
          [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
            const WholeSampleStep::Settings settings{
                smallStep(setup.options), static_cast<float>(setup.options.number("sigma")),
                setup.options.number("targetAcceptance")};
            return std::make_unique<WholeSampleStep>(setup, settings);
          },
          [](const OptionSet& options) {
            requireRange(options, "sigma", 1e-9, 1);
            requireAcceptance(options);
          },
          true};
}

}  // namespace h2mc
