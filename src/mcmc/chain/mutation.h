// SPDX-License-Identifier: MIT
// States and the kernels that move between them: the contract that every mutation fulfils.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mcmc/chain/chain_films.h"
#include "mcmc/chain/derivative_counts.h"
#include "mcmc/chain/slots.h"
#include "mcmc/targets/target.h"

namespace h2mc {

class Archive;
class OptionSet;
class TechniqueDistribution;
struct ChainStatistics;

// A chain's state: a path, and what kernels have derived from it so far. What is derived is a function of the path (and
// of random numbers that nothing else depends on), made on first use and kept until the path changes.
struct ChainState {
  explicit ChainState(int maxLength) : path(maxLength) {}

  Path path;
  Slots derived;

  // The path is about to change.
  void forget() { derived.forget(); }
};

// Seconds that sampled mutations spent in each part; see Profile.
struct PhaseSeconds {
  double derivatives = 0, gaussian = 0;
};

// Contributions that are no numbers: left out, and counted.
struct NotFiniteCounts {
  long long count = 0;
  std::string first;  // replays the first of them

  void add(const Technique& technique, const PrimarySample& sample, long long times = 1);
  // So many of the connections of its last sample.
  void add(const BidirectionalSampler& sampler, int times) {
    if (times > 0)
      add(sampler.lastNotFinite(), sampler.primarySample(sampler.lastNotFinite()), times);
  }
  void add(const NotFiniteCounts& other);
  void archive(Archive& archive);
};

// What a mutation works with; one a group of chains.
struct MutationContext {
  Random* random = nullptr;
  // Of the chain, whatever its state, for up to Chain::kDerivedAnew steps; null where no chain runs.
  Slots* memory = nullptr;
  // What the mutation adds up for its learn(), which gets the sums of all groups; null where nobody learns.
  std::vector<double>* sums = nullptr;
  DerivativeCounts derivatives;
  NotFiniteCounts notFinite;
  PhaseSeconds seconds;
  bool timed = false;  // this mutation's phases are measured
};

// Why a mutation has proposed nothing.
enum class Refusal : unsigned char {
  kUntold,
  kStructure,  // the path would be of another kind, for which the way back does not exist
  kRange,      // too far, as seen from there
  kBlocked,    // something is in the way, or it is beside the film
  kDark,       // it carries nothing
  kTechnique,  // no technique makes it, or rounding keeps the one drawn from it
};
inline constexpr std::size_t kRefusals = 6;

// What came of Mutation::propose.
class Proposal {
 public:
  // Nothing was proposed, or the target is zero there: the chain stays.
  static Proposal none(Refusal why = Refusal::kUntold) {
    Proposal none(Kind::kNone, 0);
    none.refusal_ = why;
    return none;
  }
  // To be accepted by Metropolis-Hastings, with log q(proposed -> current) - log q(current -> proposed) in the primary
  // measure of all techniques' spaces together.
  static Proposal withLogRatio(double logRatio) { return Proposal(Kind::kRatio, logRatio); }
  // Accepted already, by a random number of the mutation's own. For kernels that every state chooses with the same
  // probability.
  static Proposal accepted() { return Proposal(Kind::kAccepted, 0); }

  bool made() const { return kind_ != Kind::kNone; }
  Refusal refusal() const { return refusal_; }
  bool isDecided() const { return kind_ == Kind::kAccepted; }
  // Precondition: made, and not decided.
  double logRatio() const { return logRatio_; }
  // The probability, in [0, 1], with which the chain goes from one path to the other. `logSelection`: log of the
  // probability with which `to` chooses the kernel, over that of `from`. Precondition: from.target > 0.
  double acceptance(const Path& from, const Path& to, double logSelection = 0) const;

 private:
  enum class Kind { kNone, kRatio, kAccepted };
  Proposal(Kind kind, double logRatio) : kind_(kind), logRatio_(logRatio) {}

  Kind kind_;
  Refusal refusal_ = Refusal::kUntold;
  double logRatio_;
};

// A proposal kernel. It makes proposals and says their densities; selection, acceptance, splatting and statistics are
// the chain's. The rules that keep it exact: CONTRIBUTING.md, "A mutation".
class Mutation {
 public:
  virtual ~Mutation() = default;
  // As in the list of mutations.
  virtual std::string_view name() const = 0;

  // Whether it can do anything for such a path. Where it can't it is not chosen, and a proposal for which it could not
  // be chosen is rejected. A function of the path, the same for equal paths.
  virtual bool applies(const Path&) const { return true; }

  // Makes `proposed` from `current` and evaluates it. `current` changes only in what is derived from it. Preconditions:
  // applies(current.path), current.path.target > 0; `proposed` is forgotten, its path of any content.
  virtual Proposal propose(ChainState& current, ChainState& proposed, MutationContext& context) = 0;

  // Whether the chain, where it has not accepted what propose() made, is to ask for another proposal.
  virtual bool triesAgain() const { return false; }
  // That proposal, by delayed rejection [Green and Mira 2001]: makes `proposed` from `current` as propose() does,
  // whatever `refused` was, and returns the ratio of the two ways' densities. `back` becomes what a first try at
  // `proposed` would have to be for a second one to lead back to `current`, evaluated, its target zero where it carries
  // nothing. First tries must be symmetric and have q(current -> refused) = q(proposed -> back).
  virtual Proposal proposeAgain(ChainState& current, const ChainState& refused,
                                ChainState& proposed, ChainState& back, MutationContext& context) {
    (void)current, (void)refused, (void)proposed, (void)back, (void)context;
    return Proposal::none();
  }

  // log q(from -> to) with respect to the primary measure, for kernels that have such a density, for composites that
  // need it by itself; up to the same constant for the way back.
  virtual std::optional<double> logDensity(ChainState& from, ChainState& to,
                                           MutationContext&) const {
    (void)from, (void)to;
    return std::nullopt;
  }

  // Between epochs, when no chain is in the middle of a step: what was counted so far, where this mutation is the kind
  // `kind`. What it changes by that may depend on nothing else.
  virtual void learn(const ChainStatistics& statistics, std::size_t kind) {
    (void)statistics, (void)kind;
  }

  // What learn() has set, so that a render can be gone on with.
  virtual void archive(Archive&) {}

  // Adds the last proposal to a film, with the probability of its acceptance as weight. A mutation that knows what else
  // it might as well have proposed adds the average of that.
  virtual void splatProposal(const ChainState& proposed, double weight, const Division& division,
                             StateFilm& film) const {
    splatPath(proposed.path, weight, division, film);
  }

  static void splatPath(const Path& path, double weight, const Division& division,
                        StateFilm& film) {
    film.splat(path.filmX, path.filmY, path.contribution, weight, path.target, division);
  }
};

// What a mutation is made from. Everything outlives it.
struct MutationSetup {
  const PathTarget& target;
  const TechniqueDistribution& techniques;  // of multiplexed large steps
  int minLength;                            // in edges, of the chains' paths
  const OptionSet& options;                 // with the mutation's parameters among them
  SlotNumbers& slots;
  // All kernels of the mixture move whole bidirectional samples, of which the path is only what was picked: acceptance
  // does not depend on the pick, and states are splatted with all their connections.
  bool wholeSamples = false;
};

}  // namespace h2mc
