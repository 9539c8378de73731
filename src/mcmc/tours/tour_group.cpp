// SPDX-License-Identifier: MIT
#include "mcmc/tours/tour_group.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "render/core/archive.h"
#include "render/core/low_discrepancy.h"
#include "render/core/unit_interval.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kBatchStream = 0x62617463, kSampleStream = 0x66726573,
                        kTourStream = 0x746f7572;

}  // namespace

void TourCounts::add(const TourCounts& other) {
  samples += other.samples;
  bright += other.bright;
  tours += other.tours;
  moved += other.moved;
  mutations += other.mutations;
  longest = std::max(longest, other.longest);
}

nlohmann::json TourCounts::json() const {
  const auto ratio = [](long long a, long long b) {
    return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : 0.0;
  };
  return {{"samples", samples},
          {"samples that contribute", ratio(bright, samples)},
          {"tours", tours},
          {"tours a sample", ratio(tours, samples)},
          {"tours of at least one mutation", ratio(moved, tours)},
          {"mutations a sample", ratio(mutations, samples)},
          {"mean length", ratio(mutations, tours)},
          {"longest", longest}};
}

TourGroup::TourGroup(const PathTarget& target, const TourRule& rule, KernelMixture kernels,
                     int minLength, std::uint64_t seed, bool counting)
    : target_(target),
      rule_(rule),
      kernels_(std::move(kernels)),
      minLength_(minLength),
      seed_(seed),
      sampler_(target.maxLength()),
      start_(target.maxLength()),
      statistics_(kernels_.kinds(), target.maxLength()) {
  if (rule.level() > 0) kernels_.level = rule.level();
  films_.states.counting = counting;
}

void TourGroup::run(long long batch) {
  batch_ = static_cast<std::uint64_t>(batch);
  random_ = Random(seed_, kBatchStream, batch_);
  toursBegun_ = 0;
  const float shiftX = random_.uniform(), shiftY = random_.uniform();
  for (int i = 0; i < kBatch; ++i) {
    const UnitSquarePoint point = sobolPoint(static_cast<std::uint64_t>(i));
    sample(i, wrap(point.x + shiftX), wrap(point.y + shiftY));
  }
  blocks_.add(films_.states.splats, rule_.weight() / kBatch);
}

void TourGroup::sample(int index, float filmX, float filmY) {
  connections_.clear();
  Random random(seed_, kSampleStream, batch_ * kBatch + static_cast<std::uint64_t>(index));
  context_.notFinite.add(sampler_, sampler_.sample(target_.scene(), random, filmX, filmY,
                                                   minLength_, [&](const auto& connection) {
                                                     connections_.push_back(connection);
                                                   }));
  const Division births{rule_.level()};
  bool bright = false;
  for (const auto& c : connections_) {
    const double target = target_.of(c);
    if (!(target > 0)) continue;
    bright = true;
    if (rule_.level() > 0) films_.states.splat(c.filmX, c.filmY, c.contribution, 1, target, births);
    tours(c, target);
  }
  ++counts_.samples;
  counts_.bright += bright;
}

void TourGroup::tours(const BidirectionalSampler::Connection& c, double target) {
  const long long count = rule_.toursAt(target, random_);
  counts_.tours += count;
  bool traced = false;
  for (long long k = 0; k < count; ++k) {
    if (!rule_.goesOn(0, target, random_)) continue;
    if (!traced && !(sampler_.path(target_.scene(), c.technique, start_) && target_.weigh(start_)))
      return;  // by rounding
    traced = true;
    if (!chain_) chain_.emplace(target_, start_, random_);
    chain_->begin(start_, Random(mixBits(seed_ ^ kTourStream), batch_, toursBegun_++));
    long long made = 0;
    do chain_->step(kernels_, films_, statistics_, context_);
    while (rule_.goesOn(++made, chain_->path().target, random_));
    chain_->flush(kernels_, films_.states);
    ++counts_.moved;
    counts_.mutations += made;
    counts_.longest = std::max(counts_.longest, made);
  }
}

void TourGroup::archive(Archive& archive) {
  archive(kernels_, statistics_, context_.derivatives, context_.notFinite, counts_, blocks_);
}

ChainStatistics TourGroup::statistics() const {
  ChainStatistics own = statistics_;
  own.derivatives = context_.derivatives;
  own.notFinite = context_.notFinite;
  return own;
}

}  // namespace h2mc
