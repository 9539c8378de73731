// SPDX-License-Identifier: MIT
#include "mcmc/tours/tour_ensemble.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "mcmc/populations/epochs.h"
#include "render/core/archive.h"
#include "render/integrator/parallel_rounds.h"
#include "render/integrator/ranks.h"

namespace h2mc {
namespace {

double limitOf(const OptionSet& options, double meanLuminance) {
  const double times = options.number("targetLimit");
  return times > 0 ? times * meanLuminance : std::numeric_limits<double>::infinity();
}

}  // namespace

TourEnsemble::TourEnsemble(const Scene& scene, const TourMethod& method, const OptionSet& options,
                           double meanLuminance, int minLength, int maxLength,
                           const RenderRequest& request)
    : scene_(scene),
      asked_(request.pixelStatistics),
      threads_(request.threads),
      ranks_(request.ranks),
      target_(scene, maxLength, limitOf(options, meanLuminance)),
      rule_(method.rule(options, meanLuminance)),
      picture_(scene.film, request.threads, rule_->weight(), asked_) {
  groups_.reserve(kGroups);
  for (int g = 0; g < kGroups; ++g)
    groups_.emplace_back(target_, *rule_,
                         makeTourKernels(target_, options, minLength, meanLuminance), minLength,
                         request.seed, asked_.counts);
}

void TourEnsemble::run(long long batch) {
  TourGroup& group = groups_[at(static_cast<int>(batch % kGroups))];
  group.run(batch);
  picture_.sort(group.films());
}

void TourEnsemble::endRound() {
  exchange(ranks_, kGroups, [&](Archive& archive, int g) {
    archive(groups_[at(g)].films(), groups_[at(g)].counts());
  });
  if (ranks_)
    parallelFor(threads_, kGroups, [&, own = shareOf(ranks_, kGroups)](int g) {
      if (!own.has(g)) picture_.sort(groups_[at(g)].films());
    });
  std::vector<TourPicture::Part> parts;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const long long samples = groups_[g].counts().samples;
    if (samples == samplesBefore_[g]) continue;
    parts.push_back({&groups_[g].films(), static_cast<int>(g % 2), samples - samplesBefore_[g]});
    samplesBefore_[g] = samples;
  }
  picture_.add(parts);
}

void TourEnsemble::gather() {
  exchange(ranks_, kGroups, [&](Archive& archive, int g) { archive(groups_[at(g)]); });
}

TourCounts TourEnsemble::counts() const {
  TourCounts all;
  for (const TourGroup& group : groups_) all.add(group.counts());
  return all;
}

ChainStatistics TourEnsemble::statistics() const {
  ChainStatistics all = groups_[0].statistics();
  for (std::size_t g = 1; g < groups_.size(); ++g) all.add(groups_[g].statistics());
  return all;
}

double TourEnsemble::mutationsPerPixel() const {
  return static_cast<double>(counts().mutations) /
         (static_cast<double>(scene_.film.width) * scene_.film.height);
}

bool TourEnsemble::epochIsOver() const { return mutationsPerPixel() >= epochEnd(epoch_); }

void TourEnsemble::nextEpoch() {
  ++epoch_;
  const ChainStatistics all = statistics();
  for (TourGroup& group : groups_) group.learn(all);
}

TwoEstimates TourEnsemble::halves() const {
  const TourCounts all = counts();
  return picture_.halves(
      all.samples > 0 ? static_cast<double>(all.mutations) / static_cast<double>(all.samples) : 0);
}

void TourEnsemble::archive(Archive& archive) {
  archive(picture_, samplesBefore_, epoch_);
  for (TourGroup& group : groups_) archive(group);
}

RenderResult TourEnsemble::result() const {
  const ChainStatistics statistics = this->statistics();
  const TourCounts all = counts();
  BlockMoments blocks;
  for (const TourGroup& group : groups_) blocks.add(group.blocks());

  RenderResult result;
  result.sampleUnit = "mutations";
  result.image = picture_.image();
  if (asked_.variance) result.variance = picture_.variance();
  if (asked_.counts) result.counts = picture_.counts();
  result.samples = all.mutations;
  result.meanLuminance = blocks.whole().mean();
  result.meanLuminanceError = blocks.whole().standardError();
  result.statistics = statistics.json(groups_[0].kernels().kindNames());
  result.statistics["mutation kinds"].erase("large");
  result.statistics["tours"] = all.json();
  result.statistics["blocks"] = blocks.json(scene_.radianceUnit);
  result.statistics["epochs"] = epoch_ + 1;
  return result;
}

}  // namespace h2mc
