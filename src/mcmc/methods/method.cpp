// SPDX-License-Identifier: MIT
#include "mcmc/methods/method.h"

#include <algorithm>

#include "mcmc/mutations/mutations.h"
#include "mcmc/render/split_parameters.h"

namespace h2mc {

std::span<const Parameter> sharedParameters() {
  static constexpr Parameter kParameters[] = {
      kMaxDepthParameter,
      kMinDepthParameter,
      kMutationsPerPixelParameter,
      kDirectSamplesParameter,
      {"chains", ParameterType::kInteger, "512", "independent Markov chains"},
      {"bootstrapSamples", ParameterType::kInteger, "0",
       "bidirectional samples that place the chains and give the first estimate of the brightness; "
       "0: 100000, more in a long render and fewer in one of some seconds"},
      {"baseSamples", ParameterType::kNumber, "-1",
       "bidirectional samples for each mutation, to which chains leave what samples are good at; "
       "0: chains do all, -1: "
       "what makes the picture least noisy, none beside multiplexed large steps"},
      {"divisionByHolding", ParameterType::kBoolean, "false",
       "of successive states within a pixel, count as many as one as there are on average at that "
       "brightness when base samples and states divide the picture: fewer spikes, more samples"},
      {"largeStepProbability", ParameterType::kNumber, "0.2", "share of large steps"},
      {"largeStep", ParameterType::kString, "bidirectional",
       "what a large step proposes: a connection of a whole bidirectional sample, or one technique",
       "bidirectional|multiplexed"},
      {"importanceMap", ParameterType::kBoolean, "true",
       "let chains spend as many mutations on dark parts of the picture as on bright ones, as far "
       "as the picture is known by then"},
  };
  return kParameters;
}

void checkOptions(const MetropolisMethod& method, const OptionSet& options) {
  checkSplitOptions(options);
  requireRange(options, "chains", 1, kNoLimit);
  requireRange(options, "bootstrapSamples", 0, kNoLimit);
  requireRange(options, "baseSamples", -1, 1000);
  if (options.string("largeStep") != "bidirectional" && options.number("baseSamples") > 0)
    throw OptionError("expected baseSamples=0 with largeStep=" + options.string("largeStep") +
                      ": base samples stand beside bidirectional large steps");
  if (options.boolean("divisionByHolding") &&
      (options.string("largeStep") != "bidirectional" || options.number("baseSamples") == 0))
    throw OptionError(
        "expected divisionByHolding=false without base samples: there is nothing to divide with");
  requireRange(options, "largeStepProbability", 0, 1);
  for (const MetropolisMethod::Step& step : method.steps(options))
    if (const auto check = mutationNamed(step.mutation).check) check(options);
  if (method.check) method.check(options);
}

KernelMixture makeKernels(const MetropolisMethod& method, const PathTarget& target,
                          const TechniqueDistribution& techniques, const OptionSet& options,
                          int minLength) {
  SlotNumbers slots;
  const std::vector<MetropolisMethod::Step> steps = method.steps(options);
  const LargeStepPlugin& large = largeStepNamed(options.string("largeStep"));
  const bool wholeSamples =
      large.wholeSamples && std::all_of(steps.begin(), steps.end(), [](const auto& step) {
        return mutationNamed(step.mutation).wholeSamples;
      });
  const MutationSetup setup{target, techniques, minLength, options, slots, wholeSamples};
  KernelMixture kernels;
  kernels.large = large.create(setup);
  kernels.largeProbability = options.number("largeStepProbability");
  for (const MetropolisMethod::Step& step : steps)
    if (step.share > 0)
      kernels.small.push_back({mutationNamed(step.mutation).create(setup), step.share, step.cost});
  return kernels;
}

}  // namespace h2mc
