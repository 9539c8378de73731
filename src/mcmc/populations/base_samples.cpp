// SPDX-License-Identifier: MIT
#include "mcmc/populations/base_samples.h"

#include <cmath>

#include "render/core/archive.h"
#include "render/core/unit_interval.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kSampleStream = 0x62617365, kShiftStream = 0x73686966;

}  // namespace

BaseSamples::BaseSamples(const PathTarget& target, int minLength, std::uint64_t seed)
    : target_(target), minLength_(minLength), seed_(seed), sampler_(target.maxLength()) {}

void BaseSamples::begin(int sequence, int part, int parts) {
  sequence_ = static_cast<std::uint64_t>(sequence);
  part_ = static_cast<std::uint64_t>(part);
  parts_ = static_cast<std::uint64_t>(parts);
  made_ = 0;
  Random random(seed_, kShiftStream, sequence_);
  shift_ = {random.uniform(), random.uniform()};
}

void BaseSamples::add(const Division& division, SampleFilm& film, NotFiniteCounts& notFinite) {
  const std::uint64_t n = static_cast<std::uint64_t>(made_) * parts_ + part_;
  Random random(seed_, kSampleStream | sequence_ << 32, n);
  const UnitSquarePoint point = sobolPoint(n);
  double luminances = 0;
  const int wrong =
      sampler_.sample(target_.scene(), random, wrap(point.x + shift_.x), wrap(point.y + shift_.y),
                      minLength_, [&](const BidirectionalSampler::Connection& c) {
                        film.splat(c.filmX, c.filmY, c.contribution, target_.of(c), division);
                        luminances += h2mc::luminance(c.contribution);
                      });
  luminance_.add(luminances);
  ++made_;
  notFinite.add(sampler_, wrong);
}

void BaseSamples::extendTo(double samplesAMutation, long long mutations, const Division& division,
                           SampleFilm& film, NotFiniteCounts& notFinite) {
  const long long wanted = std::llround(samplesAMutation * static_cast<double>(mutations));
  while (made_ < wanted) add(division, film, notFinite);
}

}  // namespace h2mc
