// SPDX-License-Identifier: MIT
#include "mcmc/methods/mlt.h"

#include <array>

namespace h2mc {
namespace {

struct MutationShare {
  std::string_view mutation, option;
};
constexpr std::array<MutationShare, 5> kMutationShares = {
    {{"veachBidirectional", "bidirectionalShare"},
     {"veachLens", "lensShare"},
     {"caustic", "causticShare"},
     {"multiChain", "multiChainShare"},
     {"lensSubpath", "lensSubpathShare"}}};

std::vector<MetropolisMethod::Step> steps(const OptionSet& options) {
  double sum = 0;
  for (const MutationShare& share : kMutationShares) sum += options.number(share.option);
  std::vector<MetropolisMethod::Step> steps;
  steps.reserve(kMutationShares.size());
  for (const MutationShare& share : kMutationShares)
    steps.push_back({share.mutation, options.number(share.option) / sum, {}});
  return steps;
}

void check(const OptionSet& options) {
  bool any = false;
  for (const MutationShare& share : kMutationShares) {
    requireRange(options, share.option, 0, 1);
    any |= options.number(share.option) > 0;
  }
  if (!any) throw OptionError("mlt: one of the mutations' shares must be more than 0");
}

}  // namespace

MetropolisMethod mltMethod() {
  return {
      "mlt",
      "Metropolis light transport in path space [Veach and Guibas 1997]: mutations of vertices, "
      "whatever the technique",
      steps,
      {{"bidirectionalShare", ParameterType::kNumber, "0.25",
        "share of bidirectional mutations among the steps that are not large; the five shares "
        "count in proportion to their sum"},
       {"lensShare", ParameterType::kNumber, "0.3", "the same of lens perturbations"},
       {"causticShare", ParameterType::kNumber, "0.2", "the same of caustic perturbations"},
       {"multiChainShare", ParameterType::kNumber, "0.15", "the same of multi-chain perturbations"},
       {"lensSubpathShare", ParameterType::kNumber, "0.1", "the same of lens subpath mutations"}},
      check};
}

}  // namespace h2mc
