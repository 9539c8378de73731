// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <variant>

#include "render/core/hemisphere.h"
#include "render/light/constant_light.h"
#include "render/light/envmap_light.h"

namespace h2mc {

// A disc infinitely far, with the same radiance from all of it: the sun. It stands before the environment: of the
// directions in it all light is its own, what the environment would send from there included (`behind`). So every
// direction has one light.
class SunLight : public LightWithoutArea {
 public:
  using Behind = std::variant<std::monostate, ConstantLight, EnvmapLight>;

  // direction: unit, towards it. radius: half its apparent angle, in (0, pi / 2], in radians.
  SunLight(const glm::dvec3& direction, double radius, const Rgbf& radiance)
      : frame_(Frame<float>::fromNormal(Vec3f(direction))),
        radiance_(radiance),
        height_(2 * squared(std::sin(radius / 2))) {}

  SkyDisc disc() const { return {frame_.n, static_cast<float>(height_)}; }
  void setBehind(Behind behind) { behind_ = std::move(behind); }

  bool isDelta() const { return false; }
  bool isInfinite() const { return true; }
  bool isEnvironment() const { return true; }
  float power(const SceneBounds& bounds) const {
    return static_cast<float>(solidAngle<double>()) * luminance(radiance_) /
           detail::diskPdf<float>(bounds);
  }

  template <class T>
  DirectLight<T> sampleDirect(const LightContext& context, PrimitiveId, const Vec3<T>&, const T& u0,
                              const T& u1) const {
    const Vec3<T> toLight = sampleDirection(u0, u1);
    return detail::directFromInfinity<T>(context.bounds, toLight, T(1 / solidAngle<Scalar<T>>()),
                                         arriving<T>(context, toLight));
  }

  template <class T>
  EmittedRay<T> sampleEmission(const LightContext& context, PrimitiveId, const T& u0, const T& u1,
                               const T& v0, const T& v1) const {
    const Vec3<T> toLight = sampleDirection(v0, v1);
    return detail::emittedFromInfinity<T>(context.bounds, toLight, T(1 / solidAngle<Scalar<T>>()),
                                          arriving<T>(context, toLight), u0, u1);
  }

  template <class T>
  LightHit<T> hit(const LightContext& context, const SurfacePoint<T>&,
                  const Vec3<T>& direction) const {
    using S = Scalar<T>;
    if (!disc().covers(Vec3f(value3(direction)))) return detail::noHit<T>();
    const T pdf = T(1 / solidAngle<S>());
    return {radianceFrom<T>(context, direction), pdf, pdf * detail::diskPdf<S>(context.bounds)};
  }

  bool invertDirect(const LightContext&, PrimitiveId, const Vec3f&, const Vec3f& direction, float,
                    Vec2f& u, float& choice) const {
    choice = 0.5f;
    return invertDirection(direction, u);
  }
  bool invertEmission(const LightContext& context, PrimitiveId, const Vec3f& origin,
                      const Vec3f& direction, Vec2f& u, Vec2f& v, float& choice) const {
    choice = 0.5f;
    return invertDirection(-direction, v) &&
           detail::invertDiskTowards(context.bounds, -direction, origin, u);
  }
  unsigned wrapsDirect(const LightContext&) const { return 1; }
  unsigned wrapsEmission(const LightContext&) const { return 2 | 4; }

 private:
  template <class S>
  S solidAngle() const {
    return S(2 * std::numbers::pi * height_);
  }
  // Uniform by solid angle, u0 the azimuth.
  template <class T>
  Vec3<T> sampleDirection(const T& u0, const T& u1) const {
    using S = Scalar<T>;
    const T height = awayFromPole(u1) * S(height_);
    const T sine = ad::sqrt(T(height * (S(2) - height)));
    const Vec2<T> c = detail::circle(u0);
    return ad::combine(T(sine * c.x), plain<T>(frame_.s), T(sine * c.y), plain<T>(frame_.t),
                       T(S(1) - height), plain<T>(frame_.n));
  }
  bool invertDirection(const Vec3f& direction, Vec2f& u) const {
    const float height = disc().heightOf(direction);
    u = {toUnitInterval(turns(dot(direction, frame_.t), dot(direction, frame_.s))),
         toUnitInterval(height / height_)};
    return height <= static_cast<float>(height_);
  }
  template <class T>
  Rgb<T> arriving(const LightContext& context, const Vec3<T>& toLight) const {
    return radianceFrom<T>(context, toLight) * solidAngle<Scalar<T>>();
  }
  template <class T>
  Rgb<T> radianceFrom(const LightContext& context, const Vec3<T>& direction) const {
    const Rgb<T> own = detail::passiveColor<T>(radiance_);
    return std::visit(
        [&](const auto& b) -> Rgb<T> {
          if constexpr (std::is_same_v<std::remove_cvref_t<decltype(b)>, std::monostate>)
            return own;
          else
            return own + b.template hit<T>(context, SurfacePoint<T>{}, direction).radiance;
        },
        behind_);
  }

  Frame<float> frame_;
  Rgbf radiance_;
  double height_;  // 1 - cos(radius)
  Behind behind_;
};

}  // namespace h2mc
