// SPDX-License-Identifier: MIT
#include "mcmc/mutations/multiplexed_large_step.h"

#include <cmath>

#include "render/core/index.h"

namespace h2mc {

Proposal MultiplexedLargeStep::propose(ChainState& current, ChainState& proposed,
                                       MutationContext& context) {
  Random& random = *context.random;
  const int index = techniques_.choose(random.uniform());
  Path& path = proposed.path;
  path.technique = techniques_.technique(index);
  drawShared(target_.shared(), random, path.sample);
  for (int i = 0; i < path.technique.dimension(); ++i) path.sample.u[at(i)] = random.uniform();
  for (int i = 0; i < path.technique.choices(); ++i) path.sample.choice[at(i)] = random.uniform();
  lastEstimate_ = 0;
  if (!target_.evaluate(path)) return Proposal::none();
  lastEstimate_ = luminance(path.contribution) / techniques_.probability(index);
  return Proposal::withLogRatio(
      std::log(techniques_.probability(current.path.technique) / techniques_.probability(index)));
}

void MultiplexedLargeStep::splatSample(const ChainState& proposed, const Division& division,
                                       SampleFilm& film) const {
  const Path& path = proposed.path;
  const double density = techniques_.probability(path.technique);
  film.splat(path.filmX, path.filmY, path.contribution, path.target, {division.level * density},
             density);
}

LargeStepPlugin multiplexedLargeStep() {
  return {"multiplexed",
          "one technique at a uniform point of its primary space",
          {},
          [](const MutationSetup& setup) -> std::unique_ptr<LargeStep> {
            return std::make_unique<MultiplexedLargeStep>(setup.target, setup.techniques);
          }};
}

}  // namespace h2mc
