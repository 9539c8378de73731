// SPDX-License-Identifier: MIT
// Who the chains are.
#include "mcmc/populations/population.h"

#include <gtest/gtest.h>

#include <set>

#include "image_check.h"

namespace h2mc {
namespace {

using Samples = std::set<std::vector<float>>;

// The samples of either half, once each.
std::pair<Samples, Samples> halvesOf(const Members& members) {
  std::pair<Samples, Samples> result;
  for (std::size_t c = 0; c < members.states.size(); ++c) {
    const float* u = members.states[c].sample.u.data();
    (c < members.half ? result.first : result.second).insert({u, u + 4});
  }
  return result;
}

void expectDisjoint(const Members& members) {
  const auto [first, second] = halvesOf(members);
  for (const auto& sample : first) EXPECT_FALSE(second.contains(sample));
}

// Three hundred samples for a thousand chains: most start more than one. Then one state takes over: however many
// copies it has, they are all in its own half.
TEST(ResampledChains, HalvesHaveNothingInCommon) {
  const Scene scene = test::readTestScene(H2MC_SOURCE_DIR "/scenes/ring/ring.xml", 24, 18);
  const Bootstrap bootstrap(scene, 2, 4, 300, 3, 2);
  constexpr std::size_t kChains = 1000;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto population = resampledChains();
    Members members = population->start(bootstrap, kChains, 4, seed, 2);
    ASSERT_EQ(members.states.size(), kChains);
    EXPECT_NEAR(static_cast<double>(members.half), kChains * bootstrap.firstHalf(), 1);
    expectDisjoint(members);
    for (const Path& path : members.states) EXPECT_GT(path.target, 0);

    std::vector<const Path*> states;
    std::vector<double> weights;
    for (const Path& path : members.states) {
      states.push_back(&path);
      weights.push_back(states.size() == 7 ? 300 : 1);
    }
    Random random(seed, 1, 2);
    const Members next = population->renew(states, members.half, weights, random);
    ASSERT_EQ(next.states.size(), kChains);
    // The first half has what its states weigh.
    const double share = (static_cast<double>(members.half) + 299) / (kChains + 299);
    EXPECT_NEAR(static_cast<double>(next.half), kChains * share, 1);
    expectDisjoint(next);
  }
}

// The same whatever the number of threads.
TEST(ResampledChains, DoNotDependOnThreads) {
  const Scene scene = test::readTestScene(H2MC_SOURCE_DIR "/scenes/ring/ring.xml", 24, 18);
  const Bootstrap bootstrap(scene, 2, 4, 300, 3, 2);
  const Members one = resampledChains()->start(bootstrap, 100, 4, 5, 1);
  const Members two = resampledChains()->start(bootstrap, 100, 4, 5, 2);
  EXPECT_EQ(one.half, two.half);
  for (std::size_t c = 0; c < 100; ++c) {
    const Path &a = one.states[c], &b = two.states[c];
    ASSERT_EQ(a.technique, b.technique) << c;
    for (int i = 0; i < a.technique.dimension(); ++i)
      EXPECT_EQ(a.sample.u[at(i)], b.sample.u[at(i)]) << c;
  }
}

}  // namespace
}  // namespace h2mc
