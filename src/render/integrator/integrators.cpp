#include <array>

#include "render/integrator/bdpt_integrator.h"
#include "render/integrator/path_integrator.h"
#include "render/scene/scene.h"

namespace h2mc {

std::span<const IntegratorFactory> renderIntegrators() {
  static const std::array list = {pathIntegrator(), bdptIntegrator()};
  return list;
}

void toFileUnits(const Scene& scene, RenderResult& result) {
  if (scene.radianceUnit == 1) return;
  for (Rgbf& pixel : result.image.pixels) pixel *= static_cast<float>(scene.radianceUnit);
  result.meanLuminance *= scene.radianceUnit;
  result.meanLuminanceError *= scene.radianceUnit;
}

}  // namespace h2mc
