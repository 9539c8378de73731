#include <array>

#include "render/integrator/bdpt_integrator.h"
#include "render/integrator/path_integrator.h"

namespace h2mc {

std::span<const IntegratorFactory> renderIntegrators() {
  static const std::array list = {pathIntegrator(), bdptIntegrator()};
  return list;
}

}  // namespace h2mc
