// SPDX-License-Identifier: MIT
// The steps of primary sample space Metropolis light transport [Kelemen et al. 2002].
#pragma once

#include "mcmc/mutations/step_shape.h"
#include "mcmc/mutations/step_sizes.h"
#include "mcmc/mutations/whole_sample.h"

namespace h2mc {

// All coordinates of the whole sample around the state move a little, each by itself; one of the connections there
// becomes the path. Coordinates wrap, but for time and the aperture's, which are reflected.
class WholeSampleStep : public Mutation {
 public:
  struct Settings {
    StepShape shape = StepShape::kKelemen;
    float sigma = 0.01f;
    double targetAcceptance = 0;  // as StepSizes, whatever the path's length
  };
  WholeSampleStep(const MutationSetup& setup, const Settings& settings);
  std::string_view name() const override { return "wholeSample"; }
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override;
  void splatProposal(const ChainState& proposed, double weight, const Division& division,
                     StateFilm& film) const override;
  void learn(const ChainStatistics& statistics, std::size_t kind) override;
  void archive(Archive& archive) override { sizes_.archive(archive); }

 protected:
  // A coordinate after a step: the density of the way back is the same.
  virtual float moved(int place, float value, Random& random) const;

 private:
  bool wholeSamples_;
  Settings settings_;
  StepSizes sizes_;  // as if all samples were paths of length 0
  std::shared_ptr<WholeSamples> samples_;
};

// A whole sample at a uniform point, for mixtures in which all kernels move such samples: as BidirectionalLargeStep,
// but that the state keeps its sample, and that both states count with their expected weights.
class WholeLargeStep final : public LargeStep {
 public:
  explicit WholeLargeStep(const MutationSetup& setup);
  Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) override;
  void splatProposal(const ChainState& proposed, double weight, const Division& division,
                     StateFilm& film) const override {
    splatState(proposed, weight, division, film);
  }
  double density(const Technique&) const override { return 1; }
  void splatSample(const ChainState& proposed, const Division& division,
                   SampleFilm& film) const override {
    samples_->of(proposed).connections.splatSamples(division, film);
  }
  void complete(ChainState& state, MutationContext& context) override {
    samples_->around(state, context);
  }
  void splatState(const ChainState& state, double weight, const Division& division,
                  StateFilm& film) const override {
    samples_->of(state).connections.splatStates(weight, division, film);
  }

 private:
  std::shared_ptr<WholeSamples> samples_;
};

MutationPlugin wholeSampleStep();

}  // namespace h2mc
