// Options that the Metropolis methods share.
#pragma once

#include <array>

#include "render/integrator/common_options.h"

namespace h2mc {

inline constexpr Parameter kMetropolisParameters[] = {
    kMaxDepthParameter,
    kMinDepthParameter,
    {"mutationsPerPixel", ParameterType::kInteger, "128",
     "mutations for each pixel, if no budget is given"},
    {"directSamples", ParameterType::kInteger, "-1",
     "samples a pixel of path tracing for paths of up to two edges, which the chains then leave "
     "out; 0: the chains do all, -1: what makes the whole picture least noisy"},
    {"chains", ParameterType::kInteger, "512", "independent Markov chains"},
    {"bootstrapSamples", ParameterType::kInteger, "0",
     "bidirectional samples that place the chains and give the first estimate of the brightness; "
     "0: 100000, and more in a long render"},
    {"largeStepProbability", ParameterType::kNumber, "0.2", "share of large steps"},
    {"largeStep", ParameterType::kString, "bidirectional",
     "what a large step proposes: a connection of a whole bidirectional sample, or one technique",
     "bidirectional|multiplexed"},
    {"importanceMap", ParameterType::kBoolean, "true",
     "let chains spend as many mutations on dark parts of the picture as on bright ones, as far as "
     "the picture is known by then"},
    {"lensProbability", ParameterType::kNumber, "0.3",
     "share of lens perturbations among the other steps"},
    {"lensSigma", ParameterType::kNumber, "0.01",
     "standard deviation of the lens perturbation, in film widths"},
    {"lensStep", ParameterType::kString, "isotropic",
     "what the lens perturbation draws from: a round Gaussian, or one shaped by the Hessian with "
     "respect to the film position",
     "isotropic|hessian"},
    {"roughnessThreshold", ParameterType::kNumber, "0.1",
     "scattering lobes narrower than this (radians) are followed, not reconnected to, by the lens "
     "perturbation"},
    {"sigma", ParameterType::kNumber, "0.01",
     "standard deviation of isotropic steps, and of the prior"},
};

// The shared parameters, then a method's own.
template <std::size_t N>
constexpr auto withShared(const std::array<Parameter, N>& own) {
  constexpr std::size_t kShared = std::size(kMetropolisParameters);
  std::array<Parameter, kShared + N> all{};
  for (std::size_t i = 0; i < kShared; ++i) all[i] = kMetropolisParameters[i];
  for (std::size_t i = 0; i < N; ++i) all[kShared + i] = own[i];
  return all;
}

}  // namespace h2mc
