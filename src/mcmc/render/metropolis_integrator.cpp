// SPDX-License-Identifier: MIT
#include "mcmc/render/metropolis_integrator.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "mcmc/populations/ensemble.h"
#include "mcmc/render/direct_lighting.h"
#include "mcmc/render/metropolis_memory.h"
#include "render/core/archive.h"
#include "render/integrator/common_options.h"
#include "render/integrator/parallel_rounds.h"

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
class MetropolisRender final : public RenderInProgress {
 public:
  MetropolisRender(const MetropolisMethod& method, const OptionSet& options, int maxLength,
                   const Scene& scene, const RenderRequest& request)
      : method_(method),
        options_(options),
        scene_(scene),
        request_(request),
        mutationsPerPixel_(mutationBudget()),
        directRequest_(directRequest()),
        direct_(scene, options, directRequest_),
        minLength_(split() ? DirectLighting::longest(scene) + 1 : options.integer("minDepth")),
        maxLength_(maxLength),
        round_(roundOf(options.integer("chains"))) {
    if (request_.watch) direct_.setWatch([this] { look(); });
  }
  MetropolisRender(const MetropolisRender&) = delete;
  MetropolisRender& operator=(const MetropolisRender&) = delete;

  RenderResult run();

  RenderResult result() const override;
  bool isExact() const override;
  bool isOver() const override { return over_; }
  void save(Archive& archive) override;
  void pause(const std::function<void()>& work) override;

 private:
  // What it is at: the first direct light, the chains, or direct light between two of their epochs.
  enum class Stage : int { kDirect, kChains, kBetweenEpochs };

  bool timed() const { return request_.budget.seconds > 0; }
  bool stopped() const { return request_.stop && *request_.stop; }
  // Whether direct lighting is left out of the chains.
  bool split() const { return direct_.wanted(); }
  double pixels() const { return static_cast<double>(scene_.film.width) * scene_.film.height; }

  // Of a chain in the present round.
  long long roundNow() const {
    const long long left = round_ - stepsDone_ % round_;
    return stepsPerChain_ > 0 ? std::min(left, stepsPerChain_ - stepsDone_) : left;
  }
  // 0 where seconds are the only limit.
  long long mutationBudget() const {
    const RenderBudget& budget = request_.budget;
    const long long asked = budget.mutationsPerPixel + budget.samplesPerPixel;
    return asked == 0 && !timed() ? options_.integer("mutationsPerPixel") : asked;
  }
  RenderRequest directRequest() const;
  // `seconds`: what one of them takes.
  long long bootstrapSamples(double seconds) const;
  void makeBootstrap();
  void extendDirect(std::size_t mark);
  void balanceDirect(const ChainEnsemble& chains);
  void endEpoch(ChainEnsemble& chains);
  void beginEpoch(ChainEnsemble& chains);
  void atMark(std::size_t mark, const std::function<RenderResult()>& result);
  RoundsPlan plan(ChainEnsemble& chains);
  RenderResult directAlone();
  RenderResult withChains();
  RenderResult finished(RenderResult result) const;
  void look() { request_.watch(*this); }
  void lookLast();
  // What save() writes but for the chains.
  void archiveRender(Archive& archive);
  void countNotFinite(nlohmann::json& statistics) const;

  RenderClock clock_;
  const MetropolisMethod& method_;
  const OptionSet& options_;
  const Scene& scene_;
  const RenderRequest& request_;
  const long long mutationsPerPixel_;
  const RenderRequest directRequest_;
  DirectLighting direct_;
  std::optional<Bootstrap> bootstrap_;
  std::optional<ChainEnsemble> chains_;
  const int minLength_, maxLength_;  // of the chains' paths
  const long long round_;            // mutations of a chain
  long long stepsPerChain_ = 0;      // 0: by time
  long long stepsDone_ = 0;          // of each chain
  Stage stage_ = Stage::kDirect;
  long long bootstrapCount_ = 0;  // samples that were to be made
  bool inexact_ = false;          // the stop flag was set before the chains began
  bool restored_ = false;         // chains go on from an archive
  bool over_ = false;
  std::size_t nextMark_ = 0;
  double chainsBegan_ = 0, directBefore_ = 0;  // seconds of the clock, seconds of direct_ by then
};

RenderRequest MetropolisRender::directRequest() const {
  RenderRequest r = request_;
  r.progress = nullptr;
  r.watch = nullptr;
  r.resume = nullptr;
  if (request_.progress && timed())
    r.progress = [this](const RenderProgress& own) {
      const double now = clock_.wallSeconds();
      request_.progress(
          {std::min(now / request_.budget.seconds, 1.0), now, own.rate, own.rateUnit});
    };
  return r;
}

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
                     request_.stop);
  if (restored_) return;
  const double each = (clock_.wallSeconds() - before) / static_cast<double>(first);
  bootstrapCount_ = wanted > 0 ? wanted : std::max(first, bootstrapSamples(each));
  bootstrap_->extendTo(bootstrapCount_);
  // Light that is seldom found must be found first.
  while (wanted <= 0 && !stopped() && !(bootstrap_->luminance().mean() > 0) &&
         bootstrapCount_ < kLeastBootstrap) {
    bootstrapCount_ = std::min(2 * bootstrapCount_, kLeastBootstrap);
    bootstrap_->extendTo(bootstrapCount_);
  }
}

// Direct lighting keeps pace with the chains: up to mark i it gets what a render that ends there would
// give it.
void MetropolisRender::extendDirect(std::size_t mark) {
  if (!split()) return;
  const double end = mark < request_.marks.size() ? request_.marks[mark] : 0;
  if (timed())
    direct_.extendTo(end > 0 ? end : request_.budget.seconds, 0);
  else
    direct_.extendTo(0, end > 0 ? std::llround(end) : mutationsPerPixel_);
}

void MetropolisRender::balanceDirect(const ChainEnsemble& chains) {
  DirectLighting::Standing now;
  now.mutations = chains.mutationsPerPixel();
  now.mutationCost = chains.mutationCost();
  now.seconds = clock_.wallSeconds();
  now.chainSeconds = now.seconds - chainsBegan_ - (direct_.seconds() - directBefore_);
  if (nextMark_ < request_.marks.size())
    (timed() ? now.endSeconds : now.endMutations) = request_.marks[nextMark_];
  else if (timed())
    now.endSeconds = request_.budget.seconds;
  else
    now.endMutations = static_cast<double>(mutationsPerPixel_);
  now.growth = ChainEnsemble::kGrowth;
  direct_.balance(now);
}

// Direct lighting has its film while the chains have none.
void MetropolisRender::endEpoch(ChainEnsemble& chains) {
  const TwoEstimates picture = chains.halves();
  const std::vector<double> weights = direct_.weights(picture.mean(), chains.cell());
  if (split()) direct_.measure(picture, weights);
  chains.measure(weights);
  chains.endEpoch();
  stage_ = Stage::kBetweenEpochs;
  if (split()) balanceDirect(chains);
  beginEpoch(chains);
}

void MetropolisRender::beginEpoch(ChainEnsemble& chains) {
  chains.nextEpoch(split() ? &direct_.image() : nullptr);
  stage_ = Stage::kChains;
}

void MetropolisRender::atMark(std::size_t mark, const std::function<RenderResult()>& result) {
  clock_.exclude([&] { request_.atMark(mark, finished(result())); });
  nextMark_ = mark + 1;
  extendDirect(nextMark_);
}

RenderResult MetropolisRender::finished(RenderResult result) const {
  result.sampleUnit = "mutations";
  if (split()) direct_.addTo(result);
  const Image empty(scene_.film.width, scene_.film.height);
  if (result.image.pixels.empty()) result.image = empty;
  const PixelStatistics& asked = request_.pixelStatistics;
  if (asked.variance && result.variance.pixels.empty()) result.variance = empty;
  if (asked.counts) result.counts.resize(empty.pixels.size());
  finish(scene_, result);
  countNotFinite(result.statistics);
  result.statistics["mean luminance"] = result.meanLuminance;
  result.statistics["mean luminance standard error"] = result.meanLuminanceError;
  result.wallSeconds = clock_.wallSeconds();
  result.cpuSeconds = clock_.cpuSeconds();
  return result;
}

// What was left out because it was not finite: all of it, and where.
void MetropolisRender::countNotFinite(nlohmann::json& statistics) const {
  // Where no chain has run there are no statistics yet.
  const long long inChains = statistics.is_object() ? statistics.value("not finite", 0LL) : 0;
  const long long inBootstrap = bootstrap_ ? bootstrap_->notFinite() : 0;
  const long long inDirect = direct_.notFinite();
  statistics["not finite"] = inChains + inBootstrap + inDirect;
  statistics["not finite by source"] = {
      {"chains", inChains}, {"bootstrap", inBootstrap}, {"direct lighting", inDirect}};
  if (!statistics.contains("first not finite") && inBootstrap > 0)
    statistics["first not finite"] = bootstrap_->firstNotFinite();
}

// Where there is nothing for the chains to do.
RenderResult MetropolisRender::directAlone() {
  for (std::size_t mark = 0; mark < request_.marks.size() && !direct_.interrupted(); ++mark)
    atMark(mark, [] { return RenderResult(); });
  lookLast();
  RenderResult none;
  none.interrupted = stopped();
  return finished(none);
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
    atMark(mark, [&] { return chains.result(); });
    if (split()) balanceDirect(chains);
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
  ChainEnsemble& chains =
      chains_.emplace(scene_, method_, options_, *bootstrap_, minLength_, maxLength_, request_);
  if (restored_) {
    (*request_.resume)(chains);
    direct_.finishPart();
    if (stage_ == Stage::kBetweenEpochs) beginEpoch(chains);
    extendDirect(0);
  }
  stage_ = Stage::kChains;
  const RoundsPlan rounds = plan(chains);
  if (!restored_) {
    chainsBegan_ = clock_.wallSeconds();
    directBefore_ = direct_.seconds();
  }
  RoundsResult done;
  if (stepsPerChain_ == 0 || stepsDone_ < stepsPerChain_)
    done = runRounds(request_, clock_, chains.groups(), rounds,
                     [&](int group, long long) { chains.run(group, roundNow()); });
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
  makeBootstrap();
  if (bootstrap_->luminance().mean() > 0) return withChains();
  if (!stopped())
    spdlog::warn("no light arrives through paths of {} to {} edges: nothing to sample there",
                 minLength_, maxLength_);
  return directAlone();
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

void MetropolisRender::pause(const std::function<void()>& work) {
  clock_.exclude([&] { direct_.pause(work); });
}

void MetropolisRender::lookLast() {
  over_ = true;
  if (request_.watch) look();
}

void MetropolisRender::archiveRender(Archive& archive) {
  double wall = clock_.wallSeconds(), cpu = clock_.cpuSeconds();
  archive(wall, cpu, stage_, bootstrapCount_, stepsDone_, chainsBegan_, directBefore_, direct_);
  if (archive.reading()) clock_.advance(wall, cpu);
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
