// SPDX-License-Identifier: MIT
#include "mcmc/render/metropolis_integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "mcmc/populations/ensemble.h"
#include "mcmc/render/metropolis_memory.h"
#include "mcmc/render/split_render.h"
#include "render/core/archive.h"
#include "render/integrator/common_options.h"
#include "render/integrator/parallel_rounds.h"
#include "render/integrator/ranks.h"

namespace h2mc {
namespace {

// Mutations of a chain in one round, so that one of all chains takes some hundredths of a second: a power of two, at
// most this many, and of all chains at most that many.
constexpr long long kMostARound = 32, kMostOfAll = 1 << 20;
static_assert(Chain::kDerivedAnew % kMostARound == 0);

long long roundOf(long long chains) {
  long long round = kMostARound;
  while (round > 1 && round * chains > kMostOfAll) round /= 2;
  return round;
}

// Bootstrap samples, unless the options say: a share of the time, or of the mutations, between these. A
// sample much brighter than the mean holds its share of the chains for longer than most renders take; the
// more samples there are, the smaller that share is.
constexpr long long kLeastBootstrap = 100000, kMostBootstrap = 4000000;
constexpr double kBootstrapOfTime = 0.04, kBootstrapOfMutations = 0.02;
// Where the time is too short for the least number, what it may take of it, after so many that tell how long they take.
constexpr double kShortBootstrapOfTime = 0.15;
constexpr long long kTrialBootstrap = 4096;

// One render: direct lighting and the chains take turns.
class MetropolisRender final : public SplitRender {
 public:
  MetropolisRender(const MetropolisMethod& method, const OptionSet& options, int maxLength,
                   const Scene& scene, const RenderRequest& request)
      : SplitRender(options, maxLength, scene, request),
        method_(method),
        round_(roundOf(options.integer("chains"))) {}

  RenderResult run();

  RenderResult result() const override;
  bool isExact() const override;
  void save(Archive& archive) override;
  void gather() override {
    if (chains_) chains_->gather();
  }

 private:
  // What it is at: the first direct light, the chains, or direct light between two of their epochs.
  enum class Stage : int { kDirect, kChains, kBetweenEpochs };

  // Of a chain in the present round.
  long long roundNow() const {
    const long long left = round_ - stepsDone_ % round_;
    return stepsPerChain_ > 0 ? std::min(left, stepsPerChain_ - stepsDone_) : left;
  }
  // `seconds`: what one of them takes.
  long long bootstrapSamples(double seconds) const;
  void makeBootstrap();
  void balance(const ChainEnsemble& chains) {
    balanceDirect(chains.mutationsPerPixel(), chains.mutationCost());
  }
  void endEpoch(ChainEnsemble& chains);
  void beginEpoch(ChainEnsemble& chains);
  RoundsPlan plan(ChainEnsemble& chains);
  RenderResult withChains();
  using SplitRender::finished;
  RenderResult finished(RenderResult result) const override;
  // What save() writes but for the chains.
  void archiveRender(Archive& archive);

  const MetropolisMethod& method_;
  std::optional<Bootstrap> bootstrap_;
  std::optional<ChainEnsemble> chains_;
  const long long round_;        // mutations of a chain
  long long stepsPerChain_ = 0;  // 0: by time
  long long stepsDone_ = 0;      // of each chain
  Stage stage_ = Stage::kDirect;
  long long bootstrapCount_ = 0;  // samples that were to be made
  // Bidirectional samples a pixel that there would be time for.
  double affordable_ = std::numeric_limits<double>::infinity();
  bool inexact_ = false;   // the stop flag was set before the chains began
  bool restored_ = false;  // chains go on from an archive
};

long long MetropolisRender::bootstrapSamples(double seconds) const {
  constexpr auto kLeast = static_cast<double>(kLeastBootstrap),
                 kMost = static_cast<double>(kMostBootstrap);
  if (!timed())
    return std::llround(std::clamp(
        kBootstrapOfMutations * static_cast<double>(mutationsPerPixel_) * pixels(), kLeast, kMost));
  const double affordable = request_.budget.seconds / seconds;
  const double least = std::min(kLeast, kShortBootstrapOfTime * affordable);
  return std::llround(std::clamp(kBootstrapOfTime * affordable, least, kMost));
}

void MetropolisRender::makeBootstrap() {
  const int wanted = options_.integer("bootstrapSamples");
  const long long first = restored_    ? bootstrapCount_
                          : wanted > 0 ? wanted
                          : timed()    ? kTrialBootstrap
                                       : kLeastBootstrap;
  const double before = clock_.wallSeconds();
  bootstrap_.emplace(scene_, minLength_, maxLength_, first, request_.seed, request_.threads,
                     request_.stop, request_.ranks);
  if (restored_) return;
  const double each =
      agreed(request_.ranks, (clock_.wallSeconds() - before) / static_cast<double>(first));
  if (timed()) affordable_ = request_.budget.seconds / each / pixels();
  bootstrapCount_ = wanted > 0 ? wanted : std::max(first, bootstrapSamples(each));
  bootstrap_->extendTo(bootstrapCount_);
  // Light that is seldom found must be found first.
  while (wanted <= 0 && !stopped() && !(bootstrap_->luminance().mean() > 0) &&
         bootstrapCount_ < kLeastBootstrap) {
    bootstrapCount_ = std::min(2 * bootstrapCount_, kLeastBootstrap);
    bootstrap_->extendTo(bootstrapCount_);
  }
}

// Direct lighting has its film while the chains have none.
void MetropolisRender::endEpoch(ChainEnsemble& chains) {
  chains.gather();
  const TwoEstimates picture = chains.halves();
  const std::vector<double> weights = direct_.weights(picture.mean(), chains.cell());
  if (split()) direct_.measure(picture, weights);
  chains.measure(weights);
  chains.endEpoch();
  stage_ = Stage::kBetweenEpochs;
  if (split()) balance(chains);
  beginEpoch(chains);
}

void MetropolisRender::beginEpoch(ChainEnsemble& chains) {
  chains.nextEpoch(split() ? &direct_.image() : nullptr);
  stage_ = Stage::kChains;
}

RenderResult MetropolisRender::finished(RenderResult result) const {
  NotFinite ofBootstrap;
  if (bootstrap_) ofBootstrap = {bootstrap_->notFinite(), bootstrap_->firstNotFinite()};
  return finished(std::move(result), "chains", ofBootstrap);
}

RoundsPlan MetropolisRender::plan(ChainEnsemble& chains) {
  RoundsPlan plan;
  plan.unit = "mutations";
  plan.unitsPerRound = static_cast<double>(chains.chains() * round_);
  plan.begin = stepsDone_ / round_;
  if (request_.watch) {
    plan.watch = [this](long long) { look(); };
    plan.roundsAPass = Chain::kDerivedAnew / round_;
  }
  if (timed()) {
    plan.seconds = request_.budget.seconds;
    plan.marks = request_.marks;
  } else {
    const auto steps = [&](double perPixel) { return perPixel * pixels() / chains.chains(); };
    stepsPerChain_ =
        static_cast<long long>(std::ceil(steps(static_cast<double>(mutationsPerPixel_))));
    plan.rounds = (stepsPerChain_ + round_ - 1) / round_;
    for (const double mark : request_.marks)
      plan.marks.push_back(steps(mark) / static_cast<double>(round_));
  }
  plan.atMark = [&](std::size_t mark, const RoundsResult&) {
    chains.gather();
    atMark(mark, [&] { return chains.result(); });
    if (split()) balance(chains);
  };
  plan.endOfRound = [&] {
    chains.endRound();
    stepsDone_ += roundNow();
  };
  plan.betweenRounds = [&] {
    if (chains.epochIsOver()) endEpoch(chains);
  };
  return plan;
}

RenderResult MetropolisRender::withChains() {
  const bool stoppedEarly = stopped();  // while direct light or the bootstrap was made
  inexact_ = stoppedEarly;
  ChainEnsemble& chains = chains_.emplace(scene_, method_, options_, *bootstrap_, minLength_,
                                          maxLength_, request_, affordable_);
  if (restored_) {
    (*request_.resume)(chains);
    direct_.finishPart();
    if (stage_ == Stage::kBetweenEpochs) beginEpoch(chains);
    extendDirect(0);
  }
  stage_ = Stage::kChains;
  const RoundsPlan rounds = plan(chains);
  if (!restored_) startMutations();
  RoundsResult done;
  if (stepsPerChain_ == 0 || stepsDone_ < stepsPerChain_)
    done = runRounds(request_, clock_, chains.groups(), rounds,
                     [&](int group, long long) { chains.run(group, roundNow()); });
  gatherLast();
  lookLast();
  chains.endEpoch();
  RenderResult result = chains.result();
  result.interrupted = done.interrupted || stoppedEarly;
  return finished(std::move(result));
}

RenderResult MetropolisRender::run() {
  const int wanted = options_.integer("bootstrapSamples");
  // At most: where samples take no time.
  requireMetropolisMemory(scene_, options_, request_, maxLength_,
                          wanted > 0 ? wanted : bootstrapSamples(0));
  if (request_.resume) archiveRender(*request_.resume);
  restored_ = stage_ != Stage::kDirect;
  if (stage_ == Stage::kDirect) {
    direct_.finishPart();
    extendDirect(0);
  }
  if (minLength_ > maxLength_) return directAlone();
  try {
    makeBootstrap();
  } catch (const RankLost&) {
    return directAlone();
  }
  if (bootstrap_->luminance().mean() > 0) return withChains();
  return withoutLight();
}

// What there is, whatever stage it is at.
RenderResult MetropolisRender::result() const {
  return finished(chains_ ? chains_->result() : RenderResult());
}

// Direct light that was cut short has another number of samples than it would have had.
bool MetropolisRender::isExact() const {
  return !inexact_ && !direct_.interrupted() &&
         (stage_ != Stage::kChains || stepsDone_ % Chain::kDerivedAnew == 0);
}

void MetropolisRender::archiveRender(Archive& archive) {
  archiveDirect(archive);
  archive(stage_, bootstrapCount_, stepsDone_);
}

void MetropolisRender::save(Archive& archive) {
  archiveRender(archive);
  if (stage_ != Stage::kDirect) archive(*chains_);
}

class MetropolisIntegrator final : public Integrator {
 public:
  MetropolisIntegrator(const MetropolisMethod& method, const OptionSet& options)
      : method_(method), options_(options), maxLength_(maxPathLength(options)) {
    checkOptions(method, options);
  }

  RenderResult render(const Scene& scene, const RenderRequest& request) override {
    return MetropolisRender(method_, options_, maxLength_, scene, request).run();
  }

 private:
  const MetropolisMethod& method_;
  OptionSet options_;
  int maxLength_;
};

}  // namespace

std::unique_ptr<Integrator> makeMetropolisIntegrator(const MetropolisMethod& method,
                                                     const OptionSet& options) {
  return std::make_unique<MetropolisIntegrator>(method, options);
}

}  // namespace h2mc
