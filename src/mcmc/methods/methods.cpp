// SPDX-License-Identifier: MIT
#include "mcmc/methods/methods.h"

#include <algorithm>
#include <cassert>

#include "mcmc/methods/h2mc.h"
#include "mcmc/methods/lmc.h"
#include "mcmc/methods/mlt.h"
#include "mcmc/methods/mmlt.h"
#include "mcmc/methods/pssmlt.h"
#include "mcmc/methods/remlt.h"
#include "mcmc/methods/rjmlt.h"
#include "mcmc/mutations/mutations.h"

namespace h2mc {
namespace {

// Those that two mutations share are named once.
void addParameters(std::span<const Parameter> more, std::vector<Parameter>& parameters) {
  for (const Parameter& p : more)
    if (std::none_of(parameters.begin(), parameters.end(),
                     [&](const Parameter& had) { return had.name == p.name; }))
      parameters.push_back(p);
}

std::vector<Parameter> allParameters(const MetropolisMethod& method) {
  std::vector<Parameter> all;
  addParameters(sharedParameters(), all);
  for (const LargeStepPlugin& large : largeSteps()) addParameters(large.parameters, all);
  addParameters(method.ownParameters, all);
  // Which mutations they are does not depend on the values.
  const OptionSet fallbacks({method.name, method.description, all});
  for (const MetropolisMethod::Step& step : method.steps(fallbacks))
    addParameters(mutationNamed(step.mutation).parameters, all);
  return all;
}

}  // namespace

std::span<const MetropolisMethod> metropolisMethods() {
  // A new method is a line here.
  static const std::vector<MetropolisMethod> list = [] {
    std::vector<MetropolisMethod> methods{mmltMethod(), h2mcMethod(),   lmcMethod(),  rjmltMethod(),
                                          mltMethod(),  pssmltMethod(), remltMethod()};
    for (MetropolisMethod& method : methods) method.parameters = allParameters(method);
    return methods;
  }();
  return list;
}

const MetropolisMethod& methodNamed(std::string_view name) {
  const auto methods = metropolisMethods();
  const auto found = std::find_if(methods.begin(), methods.end(),
                                  [&](const MetropolisMethod& m) { return m.name == name; });
  assert(found != methods.end());
  return *found;
}

}  // namespace h2mc
