#include "mcmc/metropolis_integrator.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "mcmc/direct_lighting.h"
#include "mcmc/ensemble.h"
#include "render/integrator/common_options.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// Mutations of a chain in one round: a round of all chains takes some hundredths of a second.
constexpr long long kRound = 32;

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

RenderResult MetropolisIntegrator::render(const Scene& scene, const RenderRequest& request) {
  RenderClock clock;
  const int maxLength = maxLength_;
  int minLength = options_.integer("minDepth");
  const double pixels = static_cast<double>(scene.film.width) * scene.film.height;
  long long mutationsPerPixel = request.budget.mutationsPerPixel + request.budget.samplesPerPixel;
  if (mutationsPerPixel == 0 && request.budget.seconds <= 0)
    mutationsPerPixel = options_.integer("mutationsPerPixel");

  RenderRequest directRequest = request;
  directRequest.progress = nullptr;
  if (request.progress && request.budget.seconds > 0)
    directRequest.progress = [&](const RenderProgress& own) {
      const double now = clock.wallSeconds();
      request.progress({std::min(now / request.budget.seconds, 1.0), now, own.rate, own.rateUnit});
    };
  DirectLighting direct(scene, options_, directRequest);
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
    toFileUnits(scene, result);
    if (split) direct.addTo(result);
    if (result.image.pixels.empty()) result.image = Image(scene.film.width, scene.film.height);
    result.statistics["mean luminance"] = result.meanLuminance;
    result.statistics["mean luminance standard error"] = result.meanLuminanceError;
    result.wallSeconds = clock.wallSeconds();
    result.cpuSeconds = clock.cpuSeconds();
    return result;
  };
  const auto callMark = [&](std::size_t mark, const std::function<RenderResult()>& result) {
    clock.exclude([&] { request.atMark(mark, finished(result())); });
    extendDirect(mark + 1);
  };
  const auto stopped = [&] { return request.stop && *request.stop; };
  // Where there is nothing for the chains to do.
  const auto directAlone = [&] {
    for (std::size_t mark = 0; mark < request.marks.size() && !direct.interrupted(); ++mark)
      callMark(mark, [] { return RenderResult(); });
    RenderResult none;
    none.interrupted = stopped();
    return finished(none);
  };

  extendDirect(0);
  if (minLength > maxLength) return directAlone();

  const long long bootstrapSamples = std::max(1, options_.integer("bootstrapSamples"));
  const Bootstrap bootstrap(scene, minLength, maxLength, bootstrapSamples, request.seed,
                            request.threads, request.stop);
  const bool stoppedEarly = stopped();
  if (!(bootstrap.luminance().mean() > 0)) {
    spdlog::warn("no light arrives through paths of {} to {} edges: nothing to sample there",
                 minLength, maxLength);
    return directAlone();
  }

  ChainEnsemble chains(scene, method_, options_, bootstrap, minLength, maxLength, request);
  RoundsPlan plan;
  plan.unit = "mutations";
  plan.unitsPerRound = static_cast<double>(chains.chains()) * kRound;
  long long stepsPerChain = 0;  // 0: by time
  if (request.budget.seconds > 0) {
    plan.seconds = request.budget.seconds;
    plan.marks = request.marks;
  } else {
    stepsPerChain = static_cast<long long>(
        std::ceil(static_cast<double>(mutationsPerPixel) * pixels / chains.chains()));
    plan.rounds = (stepsPerChain + kRound - 1) / kRound;
    for (const double mark : request.marks)
      plan.marks.push_back(mark * pixels / chains.chains() / kRound);
  }
  RenderRequest chainRequest = request;
  const double chainsBegan = clock.wallSeconds(), directBefore = direct.seconds();
  std::size_t nextMark = 0;
  const auto balanceDirect = [&] {
    const bool last = nextMark >= request.marks.size();
    const bool timed = request.budget.seconds > 0;
    DirectLighting::Standing now;
    now.mutations = chains.mutationsPerPixel();
    now.seconds = clock.wallSeconds();
    now.chainSeconds = now.seconds - chainsBegan - (direct.seconds() - directBefore);
    if (!last)
      (timed ? now.endSeconds : now.endMutations) = request.marks[nextMark];
    else if (timed)
      now.endSeconds = request.budget.seconds;
    else
      now.endMutations = static_cast<double>(mutationsPerPixel);
    now.growth = ChainEnsemble::kGrowth;
    direct.balance(now);
  };
  plan.atMark = [&](std::size_t mark, const RoundsResult&) {
    callMark(mark, [&] { return chains.result(); });
    nextMark = mark + 1;
    if (split) balanceDirect();
  };
  plan.betweenRounds = [&] {
    if (!chains.epochIsOver()) return;
    if (!split) return chains.nextEpoch(nullptr);
    direct.measure(chains.halves(), chains.cell());
    balanceDirect();
    Image image = direct.image();
    for (Rgbf& pixel : image.pixels) pixel *= static_cast<float>(1 / scene.radianceUnit);
    chains.nextEpoch(&image);
  };
  // Stopped before the chains began: one round, so that the image is whole.
  const std::atomic<bool> goOn{false};
  if (stoppedEarly) {
    chainRequest.stop = &goOn;
    plan.rounds = 1;
    plan.marks.clear();
  }
  const RoundsResult rounds =
      runRounds(chainRequest, clock, chains.groups(), plan, [&](int group, long long round) {
        chains.run(group,
                   stepsPerChain > 0 ? std::min(kRound, stepsPerChain - round * kRound) : kRound);
      });

  RenderResult result = chains.result();
  result.interrupted = rounds.interrupted || stoppedEarly;
  return finished(std::move(result));
}

}  // namespace

KernelMixture makeKernels(const MetropolisMethod& method, const SceneTarget& target,
                          const TechniqueDistribution& techniques, const OptionSet& options,
                          int minLength) {
  KernelMixture kernels;
  if (options.string("largeStep") == "bidirectional")
    kernels.large = std::make_unique<BidirectionalLargeStep>(target, minLength);
  else
    kernels.large = std::make_unique<MultiplexedLargeStep>(target, techniques);
  kernels.largeProbability = options.number("largeStepProbability");
  kernels.small = method.smallSteps(target, options);
  return kernels;
}

std::unique_ptr<Integrator> makeMetropolisIntegrator(const MetropolisMethod& method,
                                                     const OptionSet& options) {
  return std::make_unique<MetropolisIntegrator>(method, options);
}

}  // namespace h2mc
