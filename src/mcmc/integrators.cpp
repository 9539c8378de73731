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

}  // namespace

std::span<const IntegratorFactory> allIntegrators() {
  static const std::vector<IntegratorFactory> list = [] {
    std::vector<IntegratorFactory> all(renderIntegrators().begin(), renderIntegrators().end());
    all.push_back(factory<mmltMethod>());
    all.push_back(factory<h2mcMethod>());
    return all;
  }();
  return list;
}

}  // namespace h2mc
