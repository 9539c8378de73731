// SPDX-License-Identifier: MIT
#include "render/light/area_light.h"

#include <cmath>
#include <stdexcept>

#include "render/core/index.h"
namespace h2mc {

void AreaLight::prepare(std::span<const Shape> shapes) {
  const Shape& s = shapes[at(shape)];
  area_ = static_cast<float>(totalArea(s));
  if (!(area_ >= std::numeric_limits<float>::min())) area_ = std::numeric_limits<float>::min();
  wraps_ = wrapsAround(s);
  moving_ = s.moves();
  const std::size_t count = s.isParallelogram() ? 0 : s.triangles().size();
  if (count == 0) return;
  std::vector<double> areas(count);
  for (std::size_t i = 0; i < areas.size(); ++i)
    areas[i] = primitiveArea(s, static_cast<std::uint32_t>(i));
  triangles_ = DiscreteDistribution(areas);
}

float AreaLight::power(const SceneBounds&) const {
  if (!(area_ > 0)) throw std::logic_error("AreaLight::prepare has not been called");
  return kPi * area_ * luminance(average(*radiance));
}

PrimitiveId AreaLight::choosePrimitive(const LightContext&, float choice) const {
  const int triangle = triangles_.size() > 0 ? triangles_.sample(choice).index : 0;
  return {static_cast<std::uint32_t>(shape), static_cast<std::uint32_t>(triangle)};
}

bool AreaLight::invertDirect(const LightContext& context, PrimitiveId primitive,
                             const Vec3f& reference, const Vec3f& direction, float distance,
                             Vec2f& u, float& choice, const float* time) const {
  if (primitive.shape != static_cast<std::uint32_t>(shape)) return false;
  if (triangles_.size() > 0)
    choice = triangles_.invert(static_cast<int>(primitive.primitive), choice);
  return choice >= 0 &&
         invertPrimitive(context.shapes, primitive, reference + direction * distance, u, time);
}

bool AreaLight::invertEmission(const LightContext& context, PrimitiveId primitive,
                               const Vec3f& origin, const Vec3f& direction, Vec2f& u, Vec2f& v,
                               float& choice, const float* time) const {
  if (!invertDirect(context, primitive, origin, Vec3f(0), 0, u, choice, time)) return false;
  const Vec3f normal = samplePrimitive<float>(context.shapes, primitive, u.x, u.y, time).ng;
  const Vec3f local = Frame<float>::fromNormal(normal).toLocal(direction);
  return invertCosine(local, v);
}

}  // namespace h2mc
