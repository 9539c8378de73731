// SPDX-License-Identifier: MIT
#include "mcmc/render/metropolis_integrator.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "mcmc/populations/ensemble.h"
#include "mcmc/render/direct_lighting.h"
#include "render/integrator/common_options.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// Mutations of a chain in one round: a round of all chains takes some hundredths of a second.
constexpr long long kRound = 32;

// Bootstrap samples, unless the options say: a share of the time, or of the mutations, between these. A
// sample much brighter than the mean holds its share of the chains for longer than most renders take; the
// more samples there are, the smaller that share is.
constexpr long long kLeastBootstrap = 100000, kMostBootstrap = 4000000;
constexpr double kBootstrapOfTime = 0.04, kBootstrapOfMutations = 0.02;

// One render: direct lighting and the chains take turns.
class MetropolisRender {
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
        minLength_(split() ? DirectLighting::kLongest + 1 : options.integer("minDepth")),
        maxLength_(maxLength) {}
  MetropolisRender(const MetropolisRender&) = delete;
  MetropolisRender& operator=(const MetropolisRender&) = delete;

  RenderResult run();

 private:
  bool timed() const { return request_.budget.seconds > 0; }
  bool stopped() const { return request_.stop && *request_.stop; }
  // Whether direct lighting is left out of the chains.
  bool split() const { return direct_.wanted(); }
  double pixels() const { return static_cast<double>(scene_.film.width) * scene_.film.height; }

  // 0 where seconds are the only limit.
  long long mutationBudget() const {
    const RenderBudget& budget = request_.budget;
    const long long asked = budget.mutationsPerPixel + budget.samplesPerPixel;
    return asked == 0 && !timed() ? options_.integer("mutationsPerPixel") : asked;
  }
  RenderRequest directRequest() const;
  // `seconds`: what kLeastBootstrap of them took.
  long long bootstrapSamples(double seconds) const;
  void extendDirect(std::size_t mark);
  void balanceDirect(const ChainEnsemble& chains);
  void endEpoch(ChainEnsemble& chains);
  void atMark(std::size_t mark, const std::function<RenderResult()>& result);
  RoundsPlan plan(ChainEnsemble& chains);
  RenderResult directAlone();
  RenderResult withChains();
  RenderResult finished(RenderResult result);
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
  const int minLength_, maxLength_;  // of the chains' paths
  long long stepsPerChain_ = 0;      // 0: by time
  std::size_t nextMark_ = 0;
  double chainsBegan_ = 0, directBefore_ = 0;  // seconds of the clock, seconds of direct_ by then
};

RenderRequest MetropolisRender::directRequest() const {
  RenderRequest r = request_;
  r.progress = nullptr;
  if (request_.progress && timed())
    r.progress = [this](const RenderProgress& own) {
      const double now = clock_.wallSeconds();
      request_.progress(
          {std::min(now / request_.budget.seconds, 1.0), now, own.rate, own.rateUnit});
    };
  return r;
}

long long MetropolisRender::bootstrapSamples(double seconds) const {
  const double samples =
      timed() ? kBootstrapOfTime * request_.budget.seconds / seconds * kLeastBootstrap
              : kBootstrapOfMutations * static_cast<double>(mutationsPerPixel_) * pixels();
  return std::llround(
      std::clamp<double>(samples, kLeastBootstrap, static_cast<double>(kMostBootstrap)));
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
  if (split()) direct_.measure(chains.halves(), chains.cell());
  chains.endEpoch();
  if (split()) balanceDirect(chains);
  chains.nextEpoch(split() ? &direct_.image() : nullptr);
}

void MetropolisRender::atMark(std::size_t mark, const std::function<RenderResult()>& result) {
  clock_.exclude([&] { request_.atMark(mark, finished(result())); });
  nextMark_ = mark + 1;
  extendDirect(nextMark_);
}

RenderResult MetropolisRender::finished(RenderResult result) {
  result.sampleUnit = "mutations";
  if (split()) direct_.addTo(result);
  if (result.image.pixels.empty()) result.image = Image(scene_.film.width, scene_.film.height);
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
  RenderResult none;
  none.interrupted = stopped();
  return finished(none);
}

RoundsPlan MetropolisRender::plan(ChainEnsemble& chains) {
  RoundsPlan plan;
  plan.unit = "mutations";
  plan.unitsPerRound = static_cast<double>(chains.chains()) * kRound;
  if (timed()) {
    plan.seconds = request_.budget.seconds;
    plan.marks = request_.marks;
  } else {
    const auto steps = [&](double perPixel) { return perPixel * pixels() / chains.chains(); };
    stepsPerChain_ =
        static_cast<long long>(std::ceil(steps(static_cast<double>(mutationsPerPixel_))));
    plan.rounds = (stepsPerChain_ + kRound - 1) / kRound;
    for (const double mark : request_.marks) plan.marks.push_back(steps(mark) / kRound);
  }
  plan.atMark = [&](std::size_t mark, const RoundsResult&) {
    atMark(mark, [&] { return chains.result(); });
    if (split()) balanceDirect(chains);
  };
  plan.endOfRound = [&] { chains.endRound(); };
  plan.betweenRounds = [&] {
    if (chains.epochIsOver()) endEpoch(chains);
  };
  return plan;
}

RenderResult MetropolisRender::withChains() {
  const bool stoppedEarly = stopped();  // while direct light or the bootstrap was made
  ChainEnsemble chains(scene_, method_, options_, *bootstrap_, minLength_, maxLength_, request_);
  const RoundsPlan rounds = plan(chains);
  chainsBegan_ = clock_.wallSeconds();
  directBefore_ = direct_.seconds();
  const RoundsResult done =
      runRounds(request_, clock_, chains.groups(), rounds, [&](int group, long long round) {
        chains.run(group,
                   stepsPerChain_ > 0 ? std::min(kRound, stepsPerChain_ - round * kRound) : kRound);
      });
  chains.endEpoch();
  RenderResult result = chains.result();
  result.interrupted = done.interrupted || stoppedEarly;
  return finished(std::move(result));
}

RenderResult MetropolisRender::run() {
  extendDirect(0);
  if (minLength_ > maxLength_) return directAlone();
  const int wanted = options_.integer("bootstrapSamples");
  const double before = clock_.wallSeconds();
  bootstrap_.emplace(scene_, minLength_, maxLength_, wanted > 0 ? wanted : kLeastBootstrap,
                     request_.seed, request_.threads, request_.stop);
  if (wanted == 0) bootstrap_->extendTo(bootstrapSamples(clock_.wallSeconds() - before));
  if (bootstrap_->luminance().mean() > 0) return withChains();
  if (!stopped())
    spdlog::warn("no light arrives through paths of {} to {} edges: nothing to sample there",
                 minLength_, maxLength_);
  return directAlone();
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
