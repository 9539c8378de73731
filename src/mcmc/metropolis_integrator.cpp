#include "mcmc/metropolis_integrator.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "mcmc/bootstrap.h"
#include "mcmc/direct_lighting.h"
#include "render/integrator/common_options.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kStartStream = 0x73746172, kChainStream = 0x636861696e;
// Mutations of a chain in one round: a round of all chains takes a fraction of a second.
constexpr long long kRound = 256;

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
  MetropolisMethod method_;
  OptionSet options_;
  int maxLength_;
};

// Brightness: bootstrap samples and large steps both estimate it without bias. A multiplexed large
// step sees one technique where a bootstrap sample sees all; the bootstrap knows both variances.
// The large steps' weight against bootstrap samples.
double largeStepWeight(const Bootstrap& bootstrap, const TechniqueDistribution& techniques) {
  double multiplexed = 0;
  for (int k = 0; k < techniques.size(); ++k)
    if (techniques.probability(k) > 0)
      multiplexed +=
          bootstrap.techniqueSquares()[static_cast<std::size_t>(k)] / techniques.probability(k);
  const Moments& first = bootstrap.luminance();
  const double spread = std::max(multiplexed - squared(first.mean()), 1e-30);
  return std::min(1.0, first.variance() / spread);
}

// What the chains have so far, but for the time; leaves them as they are.
RenderResult chainResult(const Scene& scene, const std::vector<ChainGroup>& work, int maxLength,
                         const Bootstrap& bootstrap, double weight) {
  ChainStatistics total(work[0].kernels.kinds(), maxLength);
  long long chains = 0, neverMoved = 0;
  Film film(scene.film);
  for (const ChainGroup& group : work) {
    ChainStatistics statistics = group.statistics;
    statistics.derivatives = group.context.derivatives;
    total.add(statistics);
    film.merge(group.film);
    for (const auto& chain : group.chains) {
      chain->splatPending(film);
      neverMoved += !chain->moved();
      ++chains;
    }
  }
  const Moments& first = bootstrap.luminance();
  const double n0 = static_cast<double>(first.count);
  const double n1 = weight * static_cast<double>(total.largeSteps.count);
  const double brightness = (n0 * first.mean() + n1 * total.largeSteps.mean()) / (n0 + n1);
  const double mutations = static_cast<double>(total.mutations);

  RenderResult result;
  result.sampleUnit = "mutations";
  result.image = film.develop(mutations > 0 ? brightness / mutations : 0);
  result.samples = total.mutations;
  result.meanLuminance = brightness;
  result.meanLuminanceError =
      std::hypot(n0 * first.standardError(), n1 * total.largeSteps.standardError()) / (n0 + n1);
  result.statistics = total.json(work[0].kernels.kindNames());
  result.statistics["chains"] = chains;
  result.statistics["chains that never moved"] = neverMoved;
  result.statistics["bootstrap"] = {{"samples", first.count},
                                    {"mean luminance", first.mean()},
                                    {"standard error", first.standardError()},
                                    {"not finite", bootstrap.notFinite()}};
  result.statistics["large steps"] = {{"mean luminance", total.largeSteps.mean()},
                                      {"standard error", total.largeSteps.standardError()},
                                      {"weight", weight}};
  return result;
}

RenderResult MetropolisIntegrator::render(const Scene& scene, const RenderRequest& request) {
  RenderClock clock;
  const int maxLength = maxLength_;
  int minLength = options_.integer("minDepth");
  const double pixels = static_cast<double>(scene.film.width) * scene.film.height;
  long long mutationsPerPixel = request.budget.mutationsPerPixel + request.budget.samplesPerPixel;
  if (mutationsPerPixel == 0 && request.budget.seconds <= 0)
    mutationsPerPixel = options_.integer("mutationsPerPixel");

  DirectLighting direct(scene, options_, request);
  const bool split = direct.wanted();
  if (split) minLength = DirectLighting::kLongest + 1;
  // Direct lighting keeps pace with the chains: up to mark i it gets what a render that ends there
  // would give it.
  const auto extendDirect = [&](std::size_t mark) {
    if (!split) return;
    const double end = mark < request.marks.size() ? request.marks[mark] : 0;
    if (request.budget.seconds > 0)
      direct.extendTo(end > 0 ? end : request.budget.seconds, 0);
    else
      direct.extendTo(0, end > 0 ? std::llround(end) : mutationsPerPixel);
  };
  const auto finished = [&](RenderResult result) {
    result.sampleUnit = "mutations";
    if (split) direct.addTo(result);
    if (result.image.pixels.empty()) result.image = Image(scene.film.width, scene.film.height);
    result.statistics["mean luminance"] = result.meanLuminance;
    result.statistics["mean luminance standard error"] = result.meanLuminanceError;
    result.wallSeconds = clock.wallSeconds();
    result.cpuSeconds = clock.cpuSeconds();
    return result;
  };
  const auto callMark = [&](std::size_t mark, const RenderResult& result) {
    clock.exclude([&] { request.atMark(mark, finished(result)); });
    extendDirect(mark + 1);
  };
  // Where there is nothing for the chains to do.
  const auto directAlone = [&] {
    for (std::size_t mark = 0; mark < request.marks.size() && !direct.interrupted(); ++mark)
      callMark(mark, {});
    return finished({});
  };

  extendDirect(0);
  if (minLength > maxLength) return directAlone();

  const long long bootstrapSamples = std::max(1, options_.integer("bootstrapSamples"));
  const Bootstrap bootstrap(scene, minLength, maxLength, bootstrapSamples, request.seed,
                            request.threads);
  if (!(bootstrap.luminance().mean() > 0)) {
    spdlog::warn("no light arrives through paths of {} to {} edges: nothing to sample there",
                 minLength, maxLength);
    return directAlone();
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
    plan.seconds = request.budget.seconds;
    plan.marks = request.marks;
  } else {
    stepsPerChain = static_cast<long long>(
        std::ceil(static_cast<double>(mutationsPerPixel) * pixels / chainCount));
    plan.rounds = (stepsPerChain + kRound - 1) / kRound;
    for (const double mark : request.marks)
      plan.marks.push_back(mark * pixels / chainCount / kRound);
  }
  RenderRequest chainRequest = request;
  const double weight = bidirectional ? 1 : largeStepWeight(bootstrap, techniques);
  plan.atMark = [&](std::size_t mark, const RoundsResult&) {
    callMark(mark, chainResult(scene, work, maxLength, bootstrap, weight));
  };
  // Stopped before the chains began: one round, so that the image is whole.
  const std::atomic<bool> goOn{false};
  if (direct.interrupted()) {
    chainRequest.stop = &goOn;
    plan.rounds = 1;
    plan.marks.clear();
  }
  const RoundsResult rounds =
      runRounds(chainRequest, clock, groups, plan, [&](int index, long long round) {
        ChainGroup& group = work[static_cast<std::size_t>(index)];
        const long long steps =
            stepsPerChain > 0 ? std::min(kRound, stepsPerChain - round * kRound) : kRound;
        for (const auto& chain : group.chains)
          for (long long i = 0; i < steps; ++i)
            chain->step(group.kernels, group.film, group.statistics, group.context);
      });

  RenderResult result = chainResult(scene, work, maxLength, bootstrap, weight);
  result.interrupted = rounds.interrupted;
  return finished(std::move(result));
}

}  // namespace

std::unique_ptr<Integrator> makeMetropolisIntegrator(const MetropolisMethod& method,
                                                     const OptionSet& options) {
  return std::make_unique<MetropolisIntegrator>(method, options);
}

}  // namespace h2mc
