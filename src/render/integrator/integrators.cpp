// SPDX-License-Identifier: MIT
#include <array>

#include "render/integrator/bdpt_integrator.h"
#include "render/integrator/path_integrator.h"
#include "render/scene/scene.h"

namespace h2mc {

std::span<const IntegratorFactory> renderIntegrators() {
  static const std::array list = {pathIntegrator(), bdptIntegrator()};
  return list;
}

void finish(const Scene& scene, RenderResult& result) {
  const auto unit = static_cast<float>(scene.radianceUnit);
  for (Rgbf& pixel : result.image.pixels) pixel = glm::max(pixel * unit, Rgbf(0));
  result.meanLuminance *= scene.radianceUnit;
  result.meanLuminanceError *= scene.radianceUnit;
}

}  // namespace h2mc
