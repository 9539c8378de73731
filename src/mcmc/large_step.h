// Large steps: proposals that do not depend on the state.
#pragma once

#include "mcmc/mutation.h"
#include "mcmc/technique_distribution.h"
#include "render/path/bidirectional.h"

namespace h2mc {

class LargeStep : public Mutation {
 public:
  std::string_view name() const override { return "large"; }
  // An unbiased estimate of the film's mean luminance that the last proposal gives; zero if it was
  // dark.
  double lastEstimate() const { return lastEstimate_; }
  // With which density proposals cover the primary space of a technique.
  virtual double density(const Technique& technique) const = 0;
  // Adds the last proposal to a film, a sample by itself, with `share` / (target + share * density)
  // as weight of each path: see KernelMixture::brightness.
  virtual void splatSample(const ChainState& proposed, double share, SummedFilm& film) const = 0;

 protected:
  double lastEstimate_ = 0;
};

// One technique, drawn from fixed probabilities, at a uniform sample [Hachisuka et al. 2014].
class MultiplexedLargeStep final : public LargeStep {
 public:
  // Keeps references.
  MultiplexedLargeStep(const Target& target, const TechniqueDistribution& techniques)
      : target_(target), techniques_(techniques) {}
  bool propose(ChainState& current, ChainState& proposed, MutationContext& context,
               double& logRatio) override;
  double density(const Technique& technique) const override {
    return techniques_.probability(technique);
  }
  void splatSample(const ChainState& proposed, double share, SummedFilm& film) const override;

 private:
  const Target& target_;
  const TechniqueDistribution& techniques_;
};

// A whole bidirectional sample, of which one connection is drawn in proportion to its target.
//
// The chain's space is extended by the coordinates of the sample that its path does not use: they
// are uniform and independent of everything, so they may be drawn when they are needed. On the
// extended space, proposing a sample X' with connections i of target f_i' and picking i with
// probability f_i' / W(X'), W = sum of f_i, is accepted with probability min(1, W(X') / W(X)): the
// connection picked cancels. W varies less than any one technique's f.
//
// propose() decides by itself, and returns only what is accepted: of the rest it leaves technique, sample,
// film position and target, but no vertices.
class BidirectionalLargeStep final : public LargeStep {
 public:
  BidirectionalLargeStep(const SceneTarget& target, int minLength)
      : target_(target), minLength_(minLength), sampler_(target.maxLength()) {}
  bool propose(ChainState& current, ChainState& proposed, MutationContext& context,
               double& logRatio) override;
  // All connections: the acceptance does not depend on which was picked.
  void splatProposal(const ChainState& proposed, double weight, double shared,
                     SummedFilm& film) const override;
  double density(const Technique&) const override { return 1; }
  void splatSample(const ChainState& proposed, double share, SummedFilm& film) const override;

 private:
  const SceneTarget& target_;
  int minLength_;
  BidirectionalSampler sampler_;
  struct Weighed {
    BidirectionalSampler::Connection connection;
    double target;
  };
  std::vector<Weighed> connections_;
};

}  // namespace h2mc
