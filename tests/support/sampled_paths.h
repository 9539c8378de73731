// SPDX-License-Identifier: MIT
// Paths of a scene's every technique, for tests and benchmarks.
#pragma once

#include <map>

#include "render/path/bidirectional.h"

namespace h2mc::test {

// Traces up to `perTechnique` paths of each technique out of `samples` bidirectional samples and
// calls visit(path, sampled luminance) for each. The path is reused. Returns the number of techniques
// seen.
template <class Visit>
std::size_t forSampledPaths(const Scene& scene, int maxLength, int perTechnique, int samples,
                            Visit&& visit) {
  BidirectionalSampler sampler(maxLength);
  Path path(maxLength);
  std::map<std::pair<int, int>, int> seen;
  for (int i = 0; i < samples; ++i) {
    Random random(5, 0, static_cast<std::uint64_t>(i));
    sampler.sample(scene, random, -1, -1, 1, [&](const BidirectionalSampler::Connection& c) {
      int& count = seen[{c.technique.s, c.technique.t}];
      if (count >= perTechnique) return;
      ++count;
      path.technique = c.technique;
      path.sample = sampler.primarySample(c.technique);
      if (tracePath(scene, path)) visit(path, luminance(c.contribution));
    });
  }
  return seen.size();
}

}  // namespace h2mc::test
