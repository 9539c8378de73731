#include "mcmc/large_step.h"

#include <cmath>

namespace h2mc {

bool LargeStep::propose(ChainState& current, ChainState& proposed, MutationContext& context,
                        double& logRatio) {
  Random& random = *context.random;
  const int index = techniques_.choose(random.uniform());
  Path& path = proposed.path;
  path.technique = techniques_.technique(index);
  for (int i = 0; i < path.technique.dimension(); ++i)
    path.sample.u[static_cast<std::size_t>(i)] = random.uniform();
  for (int i = 0; i < path.technique.choices(); ++i)
    path.sample.choice[static_cast<std::size_t>(i)] = random.uniform();
  lastEstimate_ = 0;
  if (!target_.evaluate(path)) return false;
  lastEstimate_ = path.target / techniques_.probability(index);
  logRatio = std::log(techniques_.probability(current.path.technique) / techniques_.probability(index));
  return true;
}

}  // namespace h2mc
