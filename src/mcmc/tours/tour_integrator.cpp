// SPDX-License-Identifier: MIT
#include "mcmc/tours/tour_integrator.h"

#include <spdlog/spdlog.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "mcmc/populations/bootstrap.h"
#include "mcmc/render/direct_lighting.h"
#include "mcmc/tours/tour_ensemble.h"
#include "render/core/archive.h"
#include "render/integrator/common_options.h"
#include "render/integrator/memory_need.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// Where so many samples have found no light, there is taken to be none.
constexpr long long kMostBootstrap = 200000;

// One render: direct lighting, then tours, and more direct lighting between their epochs.
class TourRender final : public RenderInProgress {
 public:
  TourRender(const TourMethod& method, const OptionSet& options, int maxLength, const Scene& scene,
             const RenderRequest& request)
      : method_(method),
        options_(options),
        scene_(scene),
        request_(request),
        mutationsPerPixel_(mutationBudget()),
        directRequest_(directRequest()),
        direct_(scene, options, directRequest_),
        minLength_(split() ? DirectLighting::longest(scene) + 1 : options.integer("minDepth")),
        maxLength_(maxLength) {
    if (request_.watch) direct_.setWatch([this] { look(); });
  }
  TourRender(const TourRender&) = delete;
  TourRender& operator=(const TourRender&) = delete;

  RenderResult run();

  RenderResult result() const override {
    return finished(tours_ ? tours_->result() : RenderResult());
  }
  // Direct light that was cut short has another number of samples than it would have had.
  bool isExact() const override { return !inexact_ && !direct_.interrupted(); }
  bool isOver() const override { return over_; }
  void save(Archive& archive) override;
  void pause(const std::function<void()>& work) override {
    clock_.exclude([&] { direct_.pause(work); });
  }

 private:
  enum class Stage : int { kDirect, kTours };

  bool timed() const { return request_.budget.seconds > 0; }
  bool stopped() const { return request_.stop && *request_.stop; }
  // Whether direct lighting is left out of the tours.
  bool split() const { return direct_.wanted(); }
  double pixels() const { return static_cast<double>(scene_.film.width) * scene_.film.height; }
  // 0 where seconds are the only limit.
  long long mutationBudget() const {
    const RenderBudget& budget = request_.budget;
    const long long asked = budget.mutationsPerPixel + budget.samplesPerPixel;
    return asked == 0 && !timed() ? options_.integer("mutationsPerPixel") : asked;
  }
  RenderRequest directRequest() const;
  double meanLuminance();
  void extendDirect(std::size_t mark);
  void balanceDirect();
  void endEpoch();
  void atMark(std::size_t mark);
  RoundsPlan plan();
  RenderResult withTours();
  RenderResult directAlone();
  RenderResult finished(RenderResult result) const;
  void look() { request_.watch(*this); }
  void lookLast() {
    over_ = true;
    if (request_.watch) look();
  }
  void archiveRender(Archive& archive);

  RenderClock clock_;
  const TourMethod& method_;
  const OptionSet& options_;
  const Scene& scene_;
  const RenderRequest& request_;
  const long long mutationsPerPixel_;
  const RenderRequest directRequest_;
  DirectLighting direct_;
  const int minLength_, maxLength_;  // of the tours' paths
  double meanLuminance_ = 0;         // about
  long long bootstrapNotFinite_ = 0;
  std::optional<TourEnsemble> tours_;
  Stage stage_ = Stage::kDirect;
  long long rounds_ = 0;  // made
  bool inexact_ = false;  // the stop flag was set before the tours began
  bool over_ = false;
  std::size_t nextMark_ = 0;
  double toursBegan_ = 0, directBefore_ = 0;  // seconds of the clock, seconds of direct_ by then
};

RenderRequest TourRender::directRequest() const {
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

// From samples that the tours do not have: what they make of it is then right whatever it is.
double TourRender::meanLuminance() {
  long long samples = options_.integer("luminanceSamples");
  Bootstrap bootstrap(scene_, minLength_, maxLength_, samples, request_.seed, request_.threads,
                      request_.stop);
  while (!(bootstrap.luminance().mean() > 0) && samples < kMostBootstrap && !stopped())
    bootstrap.extendTo(samples *= 2);
  bootstrapNotFinite_ = bootstrap.notFinite();
  return bootstrap.luminance().mean();
}

// Up to mark i it gets what a render that ends there would give it.
void TourRender::extendDirect(std::size_t mark) {
  if (!split()) return;
  const double end = mark < request_.marks.size() ? request_.marks[mark] : 0;
  if (timed())
    direct_.extendTo(end > 0 ? end : request_.budget.seconds, 0);
  else
    direct_.extendTo(0, end > 0 ? std::llround(end) : mutationsPerPixel_);
}

void TourRender::balanceDirect() {
  const TwoEstimates picture = tours_->halves();
  direct_.measure(picture, direct_.weights(picture.mean(), tours_->cell()));
  DirectLighting::Standing now;
  now.mutations = tours_->mutationsPerPixel();
  now.seconds = clock_.wallSeconds();
  now.chainSeconds = now.seconds - toursBegan_ - (direct_.seconds() - directBefore_);
  if (nextMark_ < request_.marks.size())
    (timed() ? now.endSeconds : now.endMutations) = request_.marks[nextMark_];
  else if (timed())
    now.endSeconds = request_.budget.seconds;
  else
    now.endMutations = static_cast<double>(mutationsPerPixel_);
  now.growth = TourEnsemble::kGrowth;
  direct_.balance(now);
}

// A state that is saved while direct light is made has the next epoch's kernels already.
void TourRender::endEpoch() {
  tours_->nextEpoch();
  if (split()) balanceDirect();
}

void TourRender::atMark(std::size_t mark) {
  clock_.exclude([&] { request_.atMark(mark, result()); });
  nextMark_ = mark + 1;
  extendDirect(nextMark_);
}

RenderResult TourRender::finished(RenderResult result) const {
  result.sampleUnit = "mutations";
  if (split()) direct_.addTo(result);
  const Image empty(scene_.film.width, scene_.film.height);
  if (result.image.pixels.empty()) result.image = empty;
  const PixelStatistics& asked = request_.pixelStatistics;
  if (asked.variance && result.variance.pixels.empty()) result.variance = empty;
  if (asked.counts) result.counts.resize(empty.pixels.size());
  finish(scene_, result);
  const long long inTours =
      result.statistics.is_object() ? result.statistics.value("not finite", 0LL) : 0;
  result.statistics["not finite"] = inTours + bootstrapNotFinite_ + direct_.notFinite();
  result.statistics["not finite by source"] = {{"tours", inTours},
                                               {"bootstrap", bootstrapNotFinite_},
                                               {"direct lighting", direct_.notFinite()}};
  result.statistics["mean luminance"] = result.meanLuminance;
  result.statistics["mean luminance standard error"] = result.meanLuminanceError;
  result.wallSeconds = clock_.wallSeconds();
  result.cpuSeconds = clock_.cpuSeconds();
  return result;
}

RenderResult TourRender::directAlone() {
  for (std::size_t mark = 0; mark < request_.marks.size() && !direct_.interrupted(); ++mark)
    atMark(mark);
  lookLast();
  RenderResult none;
  none.interrupted = stopped();
  return finished(none);
}

RoundsPlan TourRender::plan() {
  RoundsPlan plan;
  plan.unit = "mutations";
  const double aRound =
      method_.mutationsASample(options_) * TourGroup::kBatch * TourEnsemble::kGroups;
  plan.unitsPerRound = aRound;
  plan.begin = rounds_;
  if (request_.watch) plan.watch = [this](long long) { look(); };
  if (timed()) {
    plan.seconds = request_.budget.seconds;
    plan.marks = request_.marks;
  } else {
    const auto rounds = [&](double perPixel) { return perPixel * pixels() / aRound; };
    plan.rounds = std::llround(std::ceil(rounds(static_cast<double>(mutationsPerPixel_))));
    for (const double mark : request_.marks) plan.marks.push_back(rounds(mark));
  }
  plan.atMark = [this](std::size_t mark, const RoundsResult&) { atMark(mark); };
  plan.endOfRound = [this] {
    tours_->endRound();
    ++rounds_;
  };
  plan.betweenRounds = [this] {
    if (tours_->epochIsOver()) endEpoch();
  };
  return plan;
}

RenderResult TourRender::withTours() {
  const bool stoppedEarly = stopped();
  inexact_ = stoppedEarly;
  const bool restored = stage_ == Stage::kTours;
  tours_.emplace(scene_, method_, options_, meanLuminance_, minLength_, maxLength_, request_);
  if (restored) {
    (*request_.resume)(*tours_);
    direct_.finishPart();
    extendDirect(0);
  } else {
    stage_ = Stage::kTours;
    toursBegan_ = clock_.wallSeconds();
    directBefore_ = direct_.seconds();
  }
  const RoundsPlan rounds = plan();
  RoundsResult done;
  if (timed() || rounds_ < rounds.rounds)
    done = runRounds(
        request_, clock_, TourEnsemble::kGroups, rounds,
        [&](int group, long long round) { tours_->run(round * TourEnsemble::kGroups + group); });
  lookLast();
  RenderResult result = tours_->result();
  result.interrupted = done.interrupted || stoppedEarly;
  return finished(std::move(result));
}

RenderResult TourRender::run() {
  // The picture's film, its halves and image; direct light's picture or film.
  const PixelStatistics& asked = request_.pixelStatistics;
  requireMemory({filmMemory(scene_.film, 24 + 2 * sizeof(Rgbf) + 24 +
                                             (asked.variance ? 24 + 4 * sizeof(Rgbf) : 0) +
                                             (asked.counts ? 24 + sizeof(float) : 0))});
  if (request_.resume) archiveRender(*request_.resume);
  if (stage_ == Stage::kDirect) {
    direct_.finishPart();
    extendDirect(0);
  }
  if (minLength_ > maxLength_) return directAlone();
  if (stage_ == Stage::kDirect) meanLuminance_ = meanLuminance();
  if (meanLuminance_ > 0) return withTours();
  if (!stopped())
    spdlog::warn("no light arrives through paths of {} to {} edges: nothing to sample there",
                 minLength_, maxLength_);
  return directAlone();
}

void TourRender::archiveRender(Archive& archive) {
  double wall = clock_.wallSeconds(), cpu = clock_.cpuSeconds();
  archive(wall, cpu, stage_, meanLuminance_, bootstrapNotFinite_, rounds_, toursBegan_,
          directBefore_, direct_);
  if (archive.reading()) clock_.advance(wall, cpu);
}

void TourRender::save(Archive& archive) {
  archiveRender(archive);
  if (stage_ == Stage::kTours) archive(*tours_);
}

class TourIntegrator final : public Integrator {
 public:
  TourIntegrator(const TourMethod& method, const OptionSet& options)
      : method_(method), options_(options), maxLength_(maxPathLength(options)) {
    checkOptions(method, options);
  }
  RenderResult render(const Scene& scene, const RenderRequest& request) override {
    return TourRender(method_, options_, maxLength_, scene, request).run();
  }

 private:
  const TourMethod& method_;
  OptionSet options_;
  int maxLength_;
};

}  // namespace

std::unique_ptr<Integrator> makeTourIntegrator(const TourMethod& method, const OptionSet& options) {
  return std::make_unique<TourIntegrator>(method, options);
}

}  // namespace h2mc
