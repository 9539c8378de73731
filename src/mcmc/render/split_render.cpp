// SPDX-License-Identifier: MIT
#include "mcmc/render/split_render.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "mcmc/populations/epochs.h"
#include "render/integrator/ranks.h"

namespace h2mc {

SplitRender::SplitRender(const OptionSet& options, int maxLength, const Scene& scene,
                         const RenderRequest& request)
    : options_(options),
      scene_(scene),
      request_(request),
      mutationsPerPixel_(mutationBudget()),
      directRequest_(directRequest()),
      direct_(scene, options, directRequest_),
      minLength_(split() ? DirectLighting::longest(scene) + 1 : options.integer("minDepth")),
      maxLength_(maxLength) {
  if (request_.watch) direct_.setWatch([this] { look(); });
}

long long SplitRender::mutationBudget() const {
  const RenderBudget& budget = request_.budget;
  const long long asked = budget.mutationsPerPixel + budget.samplesPerPixel;
  return asked == 0 && !timed() ? options_.integer("mutationsPerPixel") : asked;
}

RenderRequest SplitRender::directRequest() const {
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

void SplitRender::extendDirect(std::size_t mark) {
  if (!split()) return;
  const double end = mark < request_.marks.size() ? request_.marks[mark] : 0;
  if (timed())
    direct_.extendTo(end > 0 ? end : request_.budget.seconds, 0);
  else
    direct_.extendTo(0, end > 0 ? std::llround(end) : mutationsPerPixel_);
}

void SplitRender::startMutations() {
  began_ = clock_.wallSeconds();
  directBefore_ = direct_.seconds();
}

void SplitRender::balanceDirect(double mutations, double mutationCost) {
  DirectLighting::Standing now;
  now.mutations = mutations;
  now.mutationCost = mutationCost;
  now.seconds = clock_.wallSeconds();
  now.chainSeconds = now.seconds - began_ - (direct_.seconds() - directBefore_);
  if (timed()) now = agreed(request_.ranks, now);
  if (nextMark_ < request_.marks.size())
    (timed() ? now.endSeconds : now.endMutations) = request_.marks[nextMark_];
  else if (timed())
    now.endSeconds = request_.budget.seconds;
  else
    now.endMutations = static_cast<double>(mutationsPerPixel_);
  now.growth = kEpochGrowth;
  direct_.balance(now);
}

void SplitRender::atMark(std::size_t mark, const std::function<RenderResult()>& result) {
  clock_.exclude([&] { request_.atMark(mark, finished(result())); });
  nextMark_ = mark + 1;
  extendDirect(nextMark_);
}

void SplitRender::gatherLast() {
  try {
    gather();
  } catch (const RankLost&) {
    // The picture is whole: what there is of it is brought together after each round.
  }
}

void SplitRender::lookLast() {
  over_ = true;
  if (request_.watch) look();
}

RenderResult SplitRender::directAlone() {
  for (std::size_t mark = 0; mark < request_.marks.size() && !direct_.interrupted(); ++mark)
    atMark(mark, [] { return RenderResult(); });
  lookLast();
  RenderResult none;
  none.interrupted = stopped();
  return finished(none);
}

RenderResult SplitRender::withoutLight() {
  if (!stopped())
    spdlog::warn("no light arrives through paths of {} to {} edges: nothing to sample there",
                 minLength_, maxLength_);
  return directAlone();
}

RenderResult SplitRender::finished(RenderResult result, const char* source,
                                   const NotFinite& bootstrap) const {
  result.sampleUnit = "mutations";
  if (split()) direct_.addTo(result);
  const Image empty(scene_.film.width, scene_.film.height);
  if (result.image.pixels.empty()) result.image = empty;
  const PixelStatistics& asked = request_.pixelStatistics;
  if (asked.variance && result.variance.pixels.empty()) result.variance = empty;
  if (asked.counts) result.counts.resize(empty.pixels.size());
  finish(scene_, result);

  nlohmann::json& statistics = result.statistics;
  // Where there were no mutations there are no statistics yet.
  const long long own = statistics.is_object() ? statistics.value("not finite", 0LL) : 0;
  statistics["not finite"] = own + bootstrap.count + direct_.notFinite();
  statistics["not finite by source"] = {
      {source, own}, {"bootstrap", bootstrap.count}, {"direct lighting", direct_.notFinite()}};
  if (!statistics.contains("first not finite") && bootstrap.count > 0)
    statistics["first not finite"] = bootstrap.first;
  statistics["mean luminance"] = result.meanLuminance;
  statistics["mean luminance standard error"] = result.meanLuminanceError;
  result.wallSeconds = clock_.wallSeconds();
  result.cpuSeconds = clock_.cpuSeconds();
  return result;
}

void SplitRender::archiveDirect(Archive& archive) {
  double wall = clock_.wallSeconds(), cpu = clock_.cpuSeconds();
  archive(wall, cpu, began_, directBefore_, direct_);
  if (archive.reading()) clock_.advance(wall, cpu);
}

}  // namespace h2mc
