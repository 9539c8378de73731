// SPDX-License-Identifier: MIT
#include "mcmc/methods/presets.h"

#include <algorithm>

namespace h2mc {

std::span<const Preset> presets() {
  using Option = std::pair<std::string_view, std::string_view>;
  static constexpr Option kMmlt[] = {{"largeStep", "multiplexed"}, {"largeStepProbability", "0.3"},
                                     {"lensProbability", "0"},     {"smallStep", "kelemen"},
                                     {"importanceMap", "false"},   {"directSamples", "0"}};
  static constexpr Option kH2mc[] = {{"largeStep", "multiplexed"},
                                     {"largeStepProbability", "0.3"},
                                     {"lensProbability", "0.3"},
                                     {"isotropicProbability", "0.2"},
                                     {"sigma", "0.01"},
                                     {"lensSigma", "0.01"},
                                     {"importanceMap", "false"},
                                     {"directSamples", "16"}};
  static constexpr Option kLmc[] = {
      {"largeStep", "multiplexed"},    {"largeStepProbability", "0.05"}, {"lensProbability", "0"},
      {"isotropicProbability", "0.1"}, {"preconditioner", "published"},  {"sigma", "0.005"},
      {"stepSize", "0.005"},           {"importanceMap", "false"},       {"directSamples", "16"}};
  static constexpr Option kMlt[] = {{"largeStepProbability", "0"},
                                    {"baseSamples", "0"},
                                    {"roughnessThreshold", "0"},
                                    {"importanceMap", "false"},
                                    {"directSamples", "0"}};
  static constexpr Option kPssmlt[] = {{"largeStepProbability", "0.3"},
                                       {"baseSamples", "0"},
                                       {"smallStep", "kelemen"},
                                       {"importanceMap", "false"},
                                       {"directSamples", "0"}};
  static constexpr Option kErpt[] = {{"numChains", "1"},       {"chainLength", "100"},
                                     {"targetLimit", "0"},     {"lensShare", "0"},
                                     {"isotropicShare", "0"},  {"hamiltonianShare", "0"},
                                     {"veachLensShare", "1"},  {"causticShare", "1"},
                                     {"multiChainShare", "1"}, {"roughnessThreshold", "0"}};
  static constexpr Preset kPresets[] = {
      {"mmlt-2014",
       "Hachisuka, Kaplanyan, Dachsbacher 2014: one technique at a time, Kelemen's steps, "
       "luminance "
       "as the target, all light by the chains",
       "mmlt", kMmlt},
      {"h2mc-2015",
       "Li et al. 2015, with the defaults of the authors' program: one technique at a time, a "
       "fifth "
       "of isotropic steps, luminance as the target, direct light by 16 samples a pixel",
       "h2mc", kH2mc},
      {"lmc-2020",
       "Luan et al. 2020, online, with the constants of the authors' program, as far as it is "
       "exact: the preconditioner is fixed for an epoch, the drift has no momentum, no chain is "
       "reset",
       "lmc", kLmc},
      {"mlt-1997",
       "Veach and Guibas 1997: path-space mutations alone, no large steps beside them, only what "
       "is "
       "perfectly smooth counts as specular, luminance as the target, all light by the chains",
       "mlt", kMlt},
      {"pssmlt-2002",
       "Kelemen et al. 2002: one primary space for a whole bidirectional sample, exponential "
       "steps, "
       "a share of 0.3 of large ones, which count as samples too, luminance as the target, all "
       "light by "
       "the chains",
       "pssmlt", kPssmlt},
      {"erpt-2005",
       "Cline, Talbot, Egbert 2005, with the constants of Mitsuba's: chains of 100 perturbations "
       "in "
       "path space, one a sample on average, only what is perfectly smooth counts as specular; "
       "without the filters, which are biased",
       "erpt", kErpt},
  };
  return kPresets;
}

const Preset* presetNamed(std::string_view name) {
  const auto all = presets();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Preset& p) { return p.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace h2mc
