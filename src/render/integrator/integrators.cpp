// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <limits>
#include <stdexcept>

#include "ad/traits.h"
#include "render/core/parallel.h"
#include "render/core/user_error.h"
#include "render/integrator/bdpt_integrator.h"
#include "render/integrator/path_integrator.h"
#include "render/integrator/photon_integrator.h"
#include "render/scene/scene.h"

namespace h2mc {

std::span<const IntegratorFactory> renderIntegrators() {
  static const std::array list = {pathIntegrator(), bdptIntegrator(), photonIntegrator()};
  return list;
}

void finish(const Scene& scene, RenderResult& result) {
  const double unit = scene.radianceUnit;
  Image& image = result.image;
  parallelFor(0, image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      Rgbf& pixel = image.at(x, y);
      const auto place = [&] { return fmt::format("pixel ({}, {}) of the picture", x, y); };
      if (!ad::isFinite(pixel))
        throw FilmError(place() + " is not finite: sums on the film are beyond float");
      pixel = glm::max(Rgbf(glm::dvec3(pixel) * unit), Rgbf(0));
      if (!ad::isFinite(pixel))
        throw UserError(place() +
                        " is too bright for an image file, which holds values up to 3.4e38: "
                        "give all lights smaller values");
    }
  });
  for (Rgbf& pixel : result.variance.pixels)
    pixel = Rgbf(
        glm::min(glm::dvec3(pixel) * unit * unit, glm::dvec3(std::numeric_limits<float>::max())));
  result.meanLuminance *= unit;
  result.meanLuminanceError *= unit;
}

}  // namespace h2mc
