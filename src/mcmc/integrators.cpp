#include "mcmc/integrators.h"

#include "mcmc/h2mc.h"
#include "mcmc/mmlt.h"

namespace h2mc {
namespace {

template <MetropolisMethod (*method)()>
IntegratorFactory factory() {
  return {method().plugin,
          [](const OptionSet& options) { return makeMetropolisIntegrator(method(), options); }};
}

template <MetropolisMethod (*... methods)()>
struct Methods {
  static std::vector<MetropolisMethod> list() { return {methods()...}; }
  static std::vector<IntegratorFactory> factories() { return {factory<methods>()...}; }
};

using All = Methods<mmltMethod, h2mcMethod>;

}  // namespace

std::span<const MetropolisMethod> metropolisMethods() {
  static const std::vector<MetropolisMethod> list = All::list();
  return list;
}

std::span<const IntegratorFactory> allIntegrators() {
  static const std::vector<IntegratorFactory> list = [] {
    std::vector<IntegratorFactory> all(renderIntegrators().begin(), renderIntegrators().end());
    for (const IntegratorFactory& factory : All::factories()) all.push_back(factory);
    return all;
  }();
  return list;
}

}  // namespace h2mc
