// SPDX-License-Identifier: MIT
#include "check/gradcheck/path_source.h"

#include <algorithm>

#include "mcmc/chain/chain.h"
#include "mcmc/methods/methods.h"
#include "mcmc/populations/bootstrap.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"
#include "render/path/bidirectional.h"
#include "render/path/path_text.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kSampleStream = 0x677263, kStartStream = 0x677265, kChainStream = 0x677266;
// Samples to look for rare techniques in, for each path wanted.
constexpr int kSamplesPerPath = 40;
constexpr long long kBootstrapSamples = 20000;
constexpr int kChains = 32;
// Mutations of a chain between the states that are kept.
constexpr int kStride = 48;

bool stopped(const std::atomic<bool>* stop) { return stop && stop->load(); }

}  // namespace

const char* nameOf(PathOrigin origin) {
  switch (origin) {
    case PathOrigin::kBidirectional:
      return "bdpt";
    case PathOrigin::kChain:
      return "chain";
    case PathOrigin::kGiven:
      return "given";
  }
  return "?";
}

std::vector<SampledPath> sampleBidirectional(const Scene& scene, int maxLength, int count,
                                             std::uint64_t seed, NotFiniteCount* notFinite) {
  const TechniqueDistribution techniques(1, maxLength);
  const auto kinds = at(techniques.size());
  const std::size_t share = (static_cast<std::size_t>(count) + kinds - 1) / kinds;
  std::vector<std::vector<SampledPath>> found(kinds), spare(kinds);
  BidirectionalSampler sampler(maxLength);
  std::vector<Technique> connections;
  std::size_t total = 0;
  for (long long i = 0; i < static_cast<long long>(kSamplesPerPath) * count; ++i) {
    if (total == share * kinds) break;
    Random random(seed, kSampleStream, static_cast<std::uint64_t>(i));
    connections.clear();
    const int broken = sampler.sample(
        scene, random, -1, -1, 1,
        [&](const BidirectionalSampler::Connection& c) { connections.push_back(c.technique); });
    if (notFinite && broken > 0) {
      if (notFinite->first.empty())
        notFinite->first =
            pathText(sampler.lastNotFinite(), sampler.primarySample(sampler.lastNotFinite()));
      notFinite->count += broken;
    }
    // One wanted path and one to fill up with from a sample: its connections resemble one another.
    std::size_t fewest = share;
    const Technique* wanted = nullptr;
    for (const Technique& t : connections) {
      const std::size_t have = found[at(techniques.index(t))].size();
      if (have < fewest) fewest = have, wanted = &t;
    }
    const auto keep = [&](const Technique& t) {
      return SampledPath{PathOrigin::kBidirectional, static_cast<std::uint64_t>(i), t,
                         sampler.primarySample(t)};
    };
    if (wanted) {
      found[at(techniques.index(*wanted))].push_back(keep(*wanted));
      ++total;
    }
    if (connections.empty()) continue;
    const auto pick =
        static_cast<std::size_t>(random.uniform() * static_cast<float>(connections.size()));
    const Technique& other = connections[pick];
    std::vector<SampledPath>& more = spare[at(techniques.index(other))];
    if (!(wanted && *wanted == other) && more.size() < static_cast<std::size_t>(count))
      more.push_back(keep(other));
  }
  std::vector<SampledPath> paths;
  for (const auto& of : found) paths.insert(paths.end(), of.begin(), of.end());
  const auto wanted = at(count);
  for (std::size_t k = 0; paths.size() < wanted; ++k) {
    bool any = false;
    for (const auto& of : spare) {
      if (k >= of.size() || paths.size() >= wanted) continue;
      paths.push_back(of[k]);
      any = true;
    }
    if (!any) break;
  }
  if (paths.size() > wanted) {
    // Every technique is the same number too many.
    std::vector<SampledPath> fewer;
    for (std::size_t k = 0; fewer.size() < wanted; ++k)
      for (const auto& of : found)
        if (k < of.size() && fewer.size() < wanted) fewer.push_back(of[k]);
    paths = std::move(fewer);
  }
  return paths;
}

std::vector<SampledPath> sampleChains(const Scene& scene, int maxLength, int count,
                                      std::uint64_t seed, int threads,
                                      const std::atomic<bool>* stop, ChainStatistics* statistics) {
  if (count <= 0) return {};
  const Bootstrap bootstrap(scene, 1, maxLength, kBootstrapSamples, seed, threads);
  if (!(bootstrap.luminance().mean() > 0)) return {};
  const ImportanceMap everywhere;
  const SceneTarget target(scene, maxLength, everywhere);
  const MetropolisMethod& method = methodNamed("h2mc");
  const OptionSet options(method.plugin());
  const TechniqueDistribution techniques(1, maxLength);
  const int chains = std::min(kChains, count);
  std::vector<std::vector<SampledPath>> found(static_cast<std::size_t>(chains));
  std::vector<ChainStatistics> counts(
      static_cast<std::size_t>(chains),
      ChainStatistics(makeKernels(method, target, techniques, options, 1).kinds(), maxLength));
  parallelFor(threads, chains, [&](int c) {
    KernelMixture kernels = makeKernels(method, target, techniques, options, 1);
    ChainStatistics& own = counts[at(c)];
    MutationContext context;
    ChainFilms films;
    Path start(maxLength);
    Random random(seed, kStartStream, static_cast<std::uint64_t>(c));
    bootstrap.drawStart(random.uniformDouble(), random, start);
    Chain chain(target, start, Random(seed, kChainStream, static_cast<std::uint64_t>(c)));
    const int share = count / chains + (c < count % chains);
    for (int k = 1; k <= share && !stopped(stop); ++k) {
      // A little longer where it has not moved: the same path twice says nothing new.
      const PrimarySample before = chain.path().sample;
      films.clear();  // nobody looks at the picture
      for (int tries = 0; tries < 4 && (tries == 0 || chain.path().sample.u == before.u); ++tries)
        for (int i = 0; i < kStride; ++i) chain.step(kernels, films, own, context);
      found[at(c)].push_back({PathOrigin::kChain,
                              (static_cast<std::uint64_t>(c) << 32) + static_cast<std::uint64_t>(k),
                              chain.path().technique, chain.path().sample});
    }
    own.derivatives = context.derivatives;
    own.notFinite = context.notFinite;
  });
  if (statistics) {
    *statistics = counts[0];
    for (std::size_t c = 1; c < counts.size(); ++c) statistics->add(counts[c]);
  }
  std::vector<SampledPath> paths;
  for (const auto& of : found) paths.insert(paths.end(), of.begin(), of.end());
  return paths;
}

}  // namespace h2mc
