// SPDX-License-Identifier: MIT
#include "mcmc/tours/tour_integrator.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "mcmc/populations/bootstrap.h"
#include "mcmc/populations/epochs.h"
#include "mcmc/render/split_render.h"
#include "mcmc/tours/tour_ensemble.h"
#include "render/core/archive.h"
#include "render/integrator/common_options.h"
#include "render/integrator/memory_need.h"
#include "render/integrator/parallel_rounds.h"
#include "render/integrator/ranks.h"

namespace h2mc {
namespace {

// Where so many samples have found no light, there is taken to be none.
constexpr long long kMostBootstrap = 200000;

// One render: direct lighting, then tours, and more direct lighting between their epochs.
class TourRender final : public SplitRender {
 public:
  TourRender(const TourMethod& method, const OptionSet& options, int maxLength, const Scene& scene,
             const RenderRequest& request)
      : SplitRender(options, maxLength, scene, request), method_(method) {}

  RenderResult run();

  RenderResult result() const override {
    return finished(tours_ ? tours_->result() : RenderResult());
  }
  // Direct light that was cut short has another number of samples than it would have had.
  bool isExact() const override { return !inexact_ && !direct_.interrupted(); }
  void save(Archive& archive) override;
  void gather() override {
    if (tours_) tours_->gather();
  }

 private:
  enum class Stage : int { kDirect, kTours };

  double meanLuminance();
  void endEpoch();
  RoundsPlan plan();
  RenderResult withTours();
  using SplitRender::finished;
  RenderResult finished(RenderResult result) const override {
    return finished(std::move(result), "tours", bootstrapNotFinite_);
  }
  void archiveRender(Archive& archive);

  const TourMethod& method_;
  double meanLuminance_ = 0;  // about
  NotFinite bootstrapNotFinite_;
  std::optional<TourEnsemble> tours_;
  Stage stage_ = Stage::kDirect;
  long long rounds_ = 0;  // made
  bool inexact_ = false;  // the stop flag was set before the tours began
};

// From samples that the tours do not have: what they make of it is then right whatever it is.
double TourRender::meanLuminance() {
  long long samples = options_.integer("luminanceSamples");
  Bootstrap bootstrap(scene_, minLength_, maxLength_, samples, request_.seed, request_.threads,
                      request_.stop, request_.ranks);
  while (!(bootstrap.luminance().mean() > 0) && samples < kMostBootstrap && !stopped())
    bootstrap.extendTo(samples *= 2);
  bootstrapNotFinite_ = {bootstrap.notFinite(), bootstrap.firstNotFinite()};
  return bootstrap.luminance().mean();
}

// A state that is saved while direct light is made has the next epoch's kernels already.
void TourRender::endEpoch() {
  tours_->gather();
  tours_->nextEpoch();
  if (split()) {
    const TwoEstimates picture = tours_->halves();
    direct_.measure(picture,
                    direct_.weights(picture.mean(), knownCell(tours_->mutationsPerPixel())));
    balanceDirect(tours_->mutationsPerPixel(), 1);
  }
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
  plan.atMark = [this](std::size_t mark, const RoundsResult&) {
    tours_->gather();
    atMark(mark, [this] { return tours_->result(); });
  };
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
    startMutations();
  }
  const RoundsPlan rounds = plan();
  RoundsResult done;
  if (timed() || rounds_ < rounds.rounds)
    done = runRounds(
        request_, clock_, TourEnsemble::kGroups, rounds,
        [&](int group, long long round) { tours_->run(round * TourEnsemble::kGroups + group); });
  gatherLast();
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
  try {
    if (stage_ == Stage::kDirect) meanLuminance_ = meanLuminance();
  } catch (const RankLost&) {
    return directAlone();
  }
  if (meanLuminance_ > 0) return withTours();
  return withoutLight();
}

void TourRender::archiveRender(Archive& archive) {
  archiveDirect(archive);
  archive(stage_, meanLuminance_, bootstrapNotFinite_, rounds_);
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
