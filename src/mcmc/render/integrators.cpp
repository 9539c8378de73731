// SPDX-License-Identifier: MIT
#include "mcmc/render/integrators.h"

#include "mcmc/methods/methods.h"
#include "mcmc/render/metropolis_integrator.h"
#include "mcmc/tours/tour_integrator.h"

namespace h2mc {

std::span<const IntegratorFactory> allIntegrators() {
  static const std::vector<IntegratorFactory> list = [] {
    std::vector<IntegratorFactory> all(renderIntegrators().begin(), renderIntegrators().end());
    for (const MetropolisMethod& method : metropolisMethods())
      all.push_back({method.plugin(), [&method](const OptionSet& options) {
                       return makeMetropolisIntegrator(method, options);
                     }});
    for (const TourMethod& method : tourMethods())
      all.push_back({method.plugin(), [&method](const OptionSet& options) {
                       return makeTourIntegrator(method, options);
                     }});
    return all;
  }();
  return list;
}

std::vector<IntegratorPlugin> integratorPlugins() {
  std::vector<IntegratorPlugin> plugins;
  for (const IntegratorFactory& factory : allIntegrators()) plugins.push_back(factory.plugin);
  return plugins;
}

}  // namespace h2mc
