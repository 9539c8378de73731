#include "mcmc/metropolis_integrator.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "mcmc/bootstrap.h"
#include "render/integrator/common_options.h"
#include "render/integrator/parallel_rounds.h"
#include "render/integrator/path_integrator.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kStartStream = 0x73746172, kChainStream = 0x636861696e;
// Mutations of a chain in one round: a round of all chains takes a fraction of a second.
constexpr long long kRound = 256;
// Paths that direct lighting is made of, where it is split off.
constexpr int kDirectLength = 2;

// One group's chains, with what must not be shared.
struct ChainGroup {
  Film film;
  KernelMixture kernels;
  ChainStatistics statistics;
  MutationContext context;
  std::vector<std::unique_ptr<Chain>> chains;
};

class MetropolisIntegrator final : public Integrator {
 public:
  MetropolisIntegrator(const MetropolisMethod& method, const OptionSet& options)
      : method_(method), options_(options), maxLength_(maxPathLength(options)) {
    for (const char* name : {"minDepth", "mutationsPerPixel", "chains", "bootstrapSamples"})
      requireRange(options, name, 1, kNoLimit);
    requireRange(options, "directSamples", -1, kNoLimit);
    for (const char* name : {"largeStepProbability", "lensProbability"})
      requireRange(options, name, 0, 1);
    for (const char* name : {"sigma", "lensSigma"}) requireRange(options, name, 1e-9, 1);
    if (method.check) method.check(options);
  }

  RenderResult render(const Scene& scene, const RenderRequest& request) override;

 private:
  RenderResult renderDirect(const Scene& scene, const RenderRequest& request,
                            long long mutationsPerPixel) const;

  MetropolisMethod method_;
  OptionSet options_;
  int maxLength_;
};

// Path tracing of the shortest paths: a Metropolis chain is wasted on them.
RenderResult MetropolisIntegrator::renderDirect(const Scene& scene, const RenderRequest& request,
                                                long long mutationsPerPixel) const {
  constexpr double kTimeShare = 0.1;
  const int wanted = options_.integer("directSamples");
  const IntegratorFactory factory = pathIntegrator();
  OptionSet options(factory.plugin);
  options.set("maxDepth", std::to_string(kDirectLength));
  options.set("minDepth", std::to_string(options_.integer("minDepth")));
  RenderRequest own = request;
  own.progress = nullptr;
  own.budget = {};
  // A time budget holds for the whole render: the scene's number of samples is then an upper limit.
  if (request.budget.seconds > 0) own.budget.seconds = kTimeShare * request.budget.seconds;
  if (wanted > 0) {
    own.budget.samplesPerPixel = wanted;
  } else if (request.budget.seconds <= 0) {
    own.budget.samplesPerPixel = std::clamp(mutationsPerPixel / 4, 1LL, 256LL);
  }
  return factory.create(options)->render(scene, own);
}

RenderResult MetropolisIntegrator::render(const Scene& scene, const RenderRequest& request) {
  const double startWall = wallClock(), startCpu = cpuClock();
  const int maxLength = maxLength_;
  int minLength = options_.integer("minDepth");
  const double pixels = static_cast<double>(scene.film.width) * scene.film.height;
  long long mutationsPerPixel = request.budget.mutationsPerPixel + request.budget.samplesPerPixel;
  if (mutationsPerPixel == 0 && request.budget.seconds <= 0)
    mutationsPerPixel = options_.integer("mutationsPerPixel");

  RenderResult direct;
  const bool split = options_.integer("directSamples") != 0 && minLength <= kDirectLength;
  if (split) {
    direct = renderDirect(scene, request, mutationsPerPixel);
    minLength = kDirectLength + 1;
  }

  RenderResult result;
  result.sampleUnit = "mutations";
  const auto finish = [&] {
    if (split) {
      if (result.image.pixels.empty())
        result.image = direct.image;
      else
        for (std::size_t i = 0; i < result.image.pixels.size(); ++i)
          result.image.pixels[i] += direct.image.pixels[i];
      result.meanLuminance += direct.meanLuminance;
      result.meanLuminanceError = std::hypot(result.meanLuminanceError, direct.meanLuminanceError);
      result.statistics["direct lighting"] = direct.statistics;
    }
    if (result.image.pixels.empty()) result.image = Image(scene.film.width, scene.film.height);
    result.statistics["mean luminance"] = result.meanLuminance;
    result.statistics["mean luminance standard error"] = result.meanLuminanceError;
    result.wallSeconds = wallClock() - startWall;
    result.cpuSeconds = cpuClock() - startCpu;
  };
  if (minLength > maxLength) {
    finish();
    return result;
  }

  const long long bootstrapSamples = std::max(1, options_.integer("bootstrapSamples"));
  const Bootstrap bootstrap(scene, minLength, maxLength, bootstrapSamples, request.seed,
                            request.threads);
  if (!(bootstrap.luminance().mean() > 0)) {
    spdlog::warn("no light arrives through paths of {} to {} edges: nothing to sample there",
                 minLength, maxLength);
    finish();
    return result;
  }

  const SceneTarget target(scene, maxLength);
  TechniqueDistribution techniques(minLength, maxLength);
  {
    const std::vector<double>& weights = bootstrap.techniqueLuminance();
    techniques.setWeights(weights, std::vector<bool>(weights.size(), true));
  }

  const bool bidirectional = options_.string("largeStep") == "bidirectional";
  const int groups = groupCount(scene.film);
  const int chainCount = std::max(options_.integer("chains"), 1);
  std::vector<ChainGroup> work;
  work.reserve(static_cast<std::size_t>(groups));
  for (int g = 0; g < groups; ++g) {
    KernelMixture kernels;
    if (bidirectional)
      kernels.large = std::make_unique<BidirectionalLargeStep>(target, minLength);
    else
      kernels.large = std::make_unique<MultiplexedLargeStep>(target, techniques);
    kernels.largeProbability = options_.number("largeStepProbability");
    kernels.small = method_.smallSteps(target, options_);
    const int kinds = kernels.kinds();
    work.push_back(
        {Film(scene.film), std::move(kernels), ChainStatistics(kinds, maxLength), {}, {}});
  }
  parallelFor(request.threads, groups, [&](int g) {
    Path start(maxLength);
    for (int c = g; c < chainCount; c += groups) {
      Random random(request.seed, kStartStream, static_cast<std::uint64_t>(c));
      bootstrap.drawStart(random, start);
      work[static_cast<std::size_t>(g)].chains.push_back(std::make_unique<Chain>(
          target, start, Random(request.seed, kChainStream, static_cast<std::uint64_t>(c))));
    }
  });

  RoundsPlan plan;
  plan.unit = "mutations";
  plan.unitsPerRound = static_cast<double>(chainCount) * kRound;
  long long stepsPerChain = 0;  // 0: by time
  if (request.budget.seconds > 0) {
    plan.seconds = std::max(request.budget.seconds - (wallClock() - startWall), 1e-3);
  } else {
    stepsPerChain = static_cast<long long>(
        std::ceil(static_cast<double>(mutationsPerPixel) * pixels / chainCount));
    plan.rounds = (stepsPerChain + kRound - 1) / kRound;
  }
  RenderRequest chainRequest = request;
  // Stopped before the chains began: one round, so that the image is whole.
  const std::atomic<bool> goOn{false};
  if (direct.interrupted) {
    chainRequest.stop = &goOn;
    plan.rounds = 1;
  }
  const RoundsResult rounds =
      runRounds(chainRequest, groups, plan, [&](int index, long long round) {
        ChainGroup& group = work[static_cast<std::size_t>(index)];
        const long long steps =
            stepsPerChain > 0 ? std::min(kRound, stepsPerChain - round * kRound) : kRound;
        for (const auto& chain : group.chains)
          for (long long i = 0; i < steps; ++i)
            chain->step(group.kernels, group.film, group.statistics, group.context);
      });

  ChainStatistics total(work[0].kernels.kinds(), maxLength);
  long long neverMoved = 0;
  for (ChainGroup& group : work) {
    group.statistics.derivatives = group.context.derivatives;
    total.add(group.statistics);
    for (const auto& chain : group.chains) {
      chain->flush(group.film);
      neverMoved += !chain->moved();
    }
  }
  for (std::size_t i = 1; i < work.size(); ++i) work[0].film.merge(work[i].film);

  // Brightness: bootstrap samples and large steps both estimate it without bias. A multiplexed large
  // step sees one technique where a bootstrap sample sees all; the bootstrap knows both variances.
  double multiplexed = 0;
  for (int k = 0; k < techniques.size(); ++k)
    if (techniques.probability(k) > 0)
      multiplexed +=
          bootstrap.techniqueSquares()[static_cast<std::size_t>(k)] / techniques.probability(k);
  const Moments& first = bootstrap.luminance();
  const double spread = std::max(multiplexed - squared(first.mean()), 1e-30);
  const double weight = bidirectional ? 1 : std::min(1.0, first.variance() / spread);
  const double n0 = static_cast<double>(first.count);
  const double n1 = weight * static_cast<double>(total.largeSteps.count);
  const double brightness = (n0 * first.mean() + n1 * total.largeSteps.mean()) / (n0 + n1);
  const double error =
      std::hypot(n0 * first.standardError(), n1 * total.largeSteps.standardError()) / (n0 + n1);

  const double mutations = static_cast<double>(total.mutations);
  result.image = work[0].film.develop(mutations > 0 ? brightness / mutations : 0);
  result.samples = total.mutations;
  result.interrupted = rounds.interrupted || direct.interrupted;
  result.meanLuminance = brightness;
  result.meanLuminanceError = error;
  result.statistics = total.json(work[0].kernels.kindNames());
  result.statistics["chains"] = chainCount;
  result.statistics["chains that never moved"] = neverMoved;
  result.statistics["mutations per second"] = mutations / std::max(rounds.wallSeconds, 1e-9);
  result.statistics["bootstrap"] = {{"samples", first.count},
                                    {"mean luminance", first.mean()},
                                    {"standard error", first.standardError()},
                                    {"not finite", bootstrap.notFinite()}};
  result.statistics["large steps"] = {{"mean luminance", total.largeSteps.mean()},
                                      {"standard error", total.largeSteps.standardError()},
                                      {"weight", weight}};
  finish();
  return result;
}

}  // namespace

std::unique_ptr<Integrator> makeMetropolisIntegrator(const MetropolisMethod& method,
                                                     const OptionSet& options) {
  return std::make_unique<MetropolisIntegrator>(method, options);
}

}  // namespace h2mc
