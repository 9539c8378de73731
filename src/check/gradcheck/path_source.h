// SPDX-License-Identifier: MIT
// Where the paths come from whose derivatives are checked.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "mcmc/chain/statistics.h"
#include "render/path/primary_sample.h"
#include "render/scene/scene.h"

namespace h2mc {

enum class PathOrigin : std::uint8_t { kBidirectional, kChain, kGiven };
const char* nameOf(PathOrigin origin);

// A path with a positive target, as tracePath traces it again.
struct SampledPath {
  PathOrigin origin = PathOrigin::kGiven;
  // Bidirectional: the sample it is a connection of. Chain: chain * 2^32 + number of the state.
  std::uint64_t index = 0;
  Technique technique;
  PrimarySample sample;
};

// "bdpt sample 12", "chain 3, state 4" or "given".
std::string nameOf(const SampledPath& path);

// Contributions that were not finite where paths were looked for.
struct NotFiniteCount {
  long long count = 0;
  std::string first;  // replays the first of them
};

// Up to `count` connections of bidirectional samples, whatever they contribute: as evenly spread over
// the techniques of 1 .. maxLength edges as these are found. The same paths for the same seed.
// `notFinite`, if not null, gets what was not finite in the samples looked at.
std::vector<SampledPath> sampleBidirectional(const Scene& scene, int maxLength, int count,
                                             std::uint64_t seed,
                                             NotFiniteCount* notFinite = nullptr);

// Up to `count` states of h2mc's chains, with the method's defaults: in proportion to the target, in
// the narrow places where chains dwell. None where no light arrives. The same paths for the same seed,
// whatever the number of threads. Ends early when `stop` is set. `statistics`, if not null, gets what
// the chains have counted on their way.
std::vector<SampledPath> sampleChains(const Scene& scene, int maxLength, int count,
                                      std::uint64_t seed, int threads,
                                      const std::atomic<bool>* stop,
                                      ChainStatistics* statistics = nullptr);

}  // namespace h2mc
