// SPDX-License-Identifier: MIT
#include "mcmc/methods/beside_isotropic.h"

#include "mcmc/methods/shared_steps.h"

namespace h2mc {
namespace {

void check(const OptionSet& options) {
  requireRange(options, "lensProbability", 0, 1);
  requireRange(options, "isotropicProbability", -1, 1);
  if (options.boolean("delayedRejection") && options.number("isotropicProbability") >= 0)
    throw OptionError(
        "expected isotropicProbability=-1 with delayedRejection=true: the isotropic step is then "
        "the first try of all");
}

}  // namespace

MetropolisMethod methodBesideIsotropic(
    std::string_view name, std::string_view description,
    std::vector<MetropolisMethod::Step> (*steps)(const OptionSet& options)) {
  return {name,
          description,
          steps,
          {kLensProbabilityParameter,
           kDelayedRejectionParameter,
           {"isotropicProbability", ParameterType::kNumber, "-1",
            "share of isotropic steps among those that are neither large nor of the lens; -1: by "
            "what is accepted at each brightness of a path, which the chains learn"}},
          check};
}

std::vector<MetropolisMethod::Step> besideIsotropic(const OptionSet& options,
                                                    std::string_view mutation, double cost,
                                                    std::string_view delayed) {
  const double lens = options.number("lensProbability");
  if (options.boolean("delayedRejection"))
    return {{"lens", lens, {}}, {"isotropic", 0, {}}, {mutation, 0, {}}, {delayed, 1 - lens, {}}};
  const double wanted = options.number("isotropicProbability");
  if (wanted < 0)
    return {{"lens", lens, {}},
            {"isotropic", (1 - lens) / 2, 1},
            {mutation, (1 - lens) / 2, cost},
            {delayed, 0, {}}};
  return {{"lens", lens, {}},
          {"isotropic", (1 - lens) * wanted, {}},
          {mutation, (1 - lens) * (1 - wanted), {}},
          {delayed, 0, {}}};
}

}  // namespace h2mc
