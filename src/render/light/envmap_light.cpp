// SPDX-License-Identifier: MIT
#include "render/light/envmap_light.h"

#include <cmath>

namespace h2mc {

// Directions are chosen with at least this share of the average density, so that it never vanishes
// and the map to directions has derivatives everywhere.
constexpr double kUniformShare = 1e-3;

EnvmapLight::EnvmapLight(const Image& image, float scale, const glm::mat3& toWorld)
    : toWorld_(toWorld) {
  auto data = std::make_shared<Data>();
  data->image = image;
  for (Rgbf& pixel : data->image.pixels) pixel *= scale;

  const int width = image.width, height = image.height;
  double sum = 0, sineSum = 0;
  const auto sineAt = [&](int row) { return std::sin(std::numbers::pi * (row + 0.5) / height); };
  for (int y = 0; y < height; ++y) {
    double row = 0;
    for (int x = 0; x < width; ++x) row += static_cast<double>(luminance(data->image.at(x, y)));
    sum += row * sineAt(y);
    sineSum += sineAt(y) * width;
  }
  const double average = sum / sineSum;
  fluxPerArea_ = static_cast<float>(average * 4 * std::numbers::pi);

  // Relative to the average, so that any scale of radiance fits.
  std::vector<float> weights;
  weights.reserve(data->image.pixels.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double relative =
          average > 0 ? static_cast<double>(luminance(data->image.at(x, y))) / average : 1;
      weights.push_back(static_cast<float>((relative + kUniformShare) * sineAt(y)));
    }
  data->distribution = BilinearDistribution(width, height, std::move(weights));
  data_ = std::move(data);
}

Vec3f EnvmapLight::directionOf(int x, int y) const {
  const double phi = 2 * std::numbers::pi * (x + 0.5) / width();
  const double theta = std::numbers::pi * (y + 0.5) / height();
  return glm::normalize(toWorld_ * Vec3f(std::sin(phi) * std::sin(theta), std::cos(theta),
                                         -std::cos(phi) * std::sin(theta)));
}

Vec2f EnvmapLight::invertDirection(const Vec3f& direction) const {
  const glm::dvec3 d = glm::normalize(glm::dvec3(glm::transpose(toWorld_) * direction));
  const double v = std::atan2(std::hypot(d.x, d.z), d.y) / std::numbers::pi;
  return data_->distribution.invert(turns(d.x, -d.z), v);
}

bool EnvmapLight::invertDirect(const LightContext&, PrimitiveId, const Vec3f&,
                               const Vec3f& direction, float, Vec2f& u, float& choice) const {
  u = invertDirection(direction);
  choice = 0.5f;
  return true;
}

bool EnvmapLight::invertEmission(const LightContext& context, PrimitiveId, const Vec3f& origin,
                                 const Vec3f& direction, Vec2f& u, Vec2f& v, float& choice) const {
  v = invertDirection(-direction);
  choice = 0.5f;
  return detail::invertDiskTowards(context.bounds, -direction, origin, u);
}

}  // namespace h2mc
