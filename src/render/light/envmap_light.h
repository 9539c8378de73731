// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <memory>

#include "render/core/distribution.h"
#include "render/image/image.h"
#include "render/light/light_kinds.h"

namespace h2mc {

// Radiance from infinitely far, from a picture in latitude and longitude. It is bilinear between
// pixel centres, and so is the density of sampled directions but for the sine of the elevation:
// radiance over density hardly varies but in hue.
class EnvmapLight : public LightWithoutArea {
 public:
  // toWorld: a rotation, or one with a reflection. Precondition: the picture is not empty, finite and
  // not negative.
  EnvmapLight(const Image& image, float scale, const glm::mat3& toWorld);

  bool isDelta() const { return false; }
  bool isInfinite() const { return true; }
  bool isEnvironment() const { return true; }
  float power(const SceneBounds& bounds) const {
    return fluxPerArea_ / detail::diskPdf<float>(bounds);
  }

  template <class T>
  DirectLight<T> sampleDirect(const LightContext& context, PrimitiveId, const Vec3<T>&, const T& u0,
                              const T& u1) const {
    Vec3<T> toLight;
    T sine;
    const BilinearDistribution::Point<T> point = sampleDirection<T>(u0, u1, toLight, sine);
    return detail::directFromInfinity<T>(context.bounds, toLight, solidAnglePdf(point, sine),
                                         perSolidAngle(point, sine));
  }

  template <class T>
  EmittedRay<T> sampleEmission(const LightContext& context, PrimitiveId, const T& u0, const T& u1,
                               const T& v0, const T& v1) const {
    Vec3<T> toLight;
    T sine;
    const BilinearDistribution::Point<T> point = sampleDirection<T>(v0, v1, toLight, sine);
    return detail::emittedFromInfinity<T>(context.bounds, toLight, solidAnglePdf(point, sine),
                                          perSolidAngle(point, sine), u0, u1);
  }

  template <class T>
  LightHit<T> hit(const LightContext& context, const SurfacePoint<T>&,
                  const Vec3<T>& direction) const;

  bool invertDirect(const LightContext&, PrimitiveId, const Vec3f& reference,
                    const Vec3f& direction, float distance, Vec2f& u, float& choice) const;
  bool invertEmission(const LightContext& context, PrimitiveId, const Vec3f& origin,
                      const Vec3f& direction, Vec2f& u, Vec2f& v, float& choice) const;
  unsigned wrapsDirect(const LightContext&) const { return 1; }
  unsigned wrapsEmission(const LightContext&) const { return 2 | 4; }

  const Image& image() const { return data_->image; }  // times the scale
  const glm::mat3& toWorld() const { return toWorld_; }
  // Of a pixel's centre: unit, in the world.
  Vec3f directionOf(int x, int y) const;
  int width() const { return data_->distribution.width(); }
  int height() const { return data_->distribution.height(); }

 private:
  struct Data {
    Image image;
    BilinearDistribution distribution;
  };

  // The picture's four pixels around a point, in double: between which it is bilinear.
  struct Corners {
    Vec3<double> c00, c10, c01, c11;
  };
  Corners corners(const BilinearDistribution::Cell& cell) const;
  template <class T>
  static Rgb<T> between(const Corners& c, const BilinearDistribution::Point<T>& point);

  // `sine`: of the angle to the pole, towards which densities in directions and in (u, v) differ.
  template <class T>
  BilinearDistribution::Point<T> sampleDirection(const T& u0, const T& u1, Vec3<T>& direction,
                                                 T& sine) const;
  template <class T>
  static T solidAnglePdf(const BilinearDistribution::Point<T>& point, const T& sine) {
    using S = Scalar<T>;
    return point.pdf * S(0.5 / (std::numbers::pi * std::numbers::pi)) / sine;
  }
  template <class T>
  Rgb<T> lookUp(const BilinearDistribution::Point<T>& point) const {
    return between<T>(corners(point.cell), point);
  }
  // Radiance over solidAnglePdf(point, sine), and over point.pdf.
  template <class T>
  Rgb<T> perSolidAngle(const BilinearDistribution::Point<T>& point, const T& sine) const {
    return perDensity<T>(point) * T(sine * Scalar<T>(2 * std::numbers::pi * std::numbers::pi));
  }
  template <class T>
  Rgb<T> perDensity(const BilinearDistribution::Point<T>& point) const;
  Vec2f invertDirection(const Vec3f& direction) const;

  std::shared_ptr<const Data> data_;  // lights are copied
  glm::mat3 toWorld_;                 // its inverse is its transpose
  float fluxPerArea_ = 0;             // luminance of the radiance, integrated over all directions
};

inline EnvmapLight::Corners EnvmapLight::corners(const BilinearDistribution::Cell& cell) const {
  const Image& image = data_->image;
  const int x0 = cell.column, x1 = x0 + 1 == image.width ? 0 : x0 + 1;
  const int y0 = cell.row == 0 ? 0 : cell.row - 1;
  const int y1 = cell.row == image.height ? image.height - 1 : cell.row;
  const auto pixel = [&](int x, int y) { return Vec3<double>(image.at(x, y)); };
  return {pixel(x0, y0), pixel(x1, y0), pixel(x0, y1), pixel(x1, y1)};
}

template <class T>
Rgb<T> EnvmapLight::between(const Corners& c, const BilinearDistribution::Point<T>& point) {
  using S = Scalar<T>;
  const Vec3<S> c00(c.c00), dx(c.c10 - c.c00), dy(c.c01 - c.c00),
      dxy((c.c11 - c.c01) - (c.c10 - c.c00));
  const T xy = point.x * point.y;
  return {linear3(point.x, dx.x, point.y, dy.x, xy, dxy.x) + c00.x,
          linear3(point.x, dx.y, point.y, dy.y, xy, dxy.y) + c00.y,
          linear3(point.x, dx.z, point.y, dy.z, xy, dxy.z) + c00.z};
}

// A hue that all corners share, times the density's own factor, and what is left of the corners then.
template <class T>
Rgb<T> EnvmapLight::perDensity(const BilinearDistribution::Point<T>& point) const {
  using S = Scalar<T>;
  Corners c = corners(point.cell);
  if (point.cell.row == 0 || point.cell.row == height())
    return between<T>(c, point) * T(S(1) / point.pdf);
  const BilinearDistribution::Densities d = data_->distribution.densities(point.cell);
  const double largest = std::max({d.d00, d.d10, d.d01, d.d11});
  const Vec3<double> hue = (largest == d.d00   ? c.c00
                            : largest == d.d10 ? c.c10
                            : largest == d.d01 ? c.c01
                                               : c.c11) /
                           largest;
  c = {c.c00 - hue * d.d00, c.c10 - hue * d.d10, c.c01 - hue * d.d01, c.c11 - hue * d.d11};
  const Rgb<T> r = between<T>(c, point) * T(S(1) / point.pdf) + Vec3<S>(hue);
  // Beside black pixels rounding may leave less than nothing.
  return {ad::max(r.x, S(0)), ad::max(r.y, S(0)), ad::max(r.z, S(0))};
}

template <class T>
BilinearDistribution::Point<T> EnvmapLight::sampleDirection(const T& u0, const T& u1,
                                                            Vec3<T>& direction, T& sine) const {
  using S = Scalar<T>;
  const BilinearDistribution::Point<T> point = data_->distribution.template sample<T>(u0, u1);
  T cosine;
  ad::sincos(T(point.v * S(std::numbers::pi)), sine, cosine);
  // A pole itself, by rounding.
  if (value(sine) < S(1e-7)) sine = T(S(1e-7));
  const Vec2<T> phi = detail::circle(point.u);
  // u turns from -z towards x; y is up.
  direction = ad::combine(T(sine * phi.y), plain<T>(toWorld_[0]), cosine, plain<T>(toWorld_[1]),
                          T(-(sine * phi.x)), plain<T>(toWorld_[2]));
  return point;
}

template <class T>
LightHit<T> EnvmapLight::hit(const LightContext& context, const SurfacePoint<T>&,
                             const Vec3<T>& direction) const {
  using S = Scalar<T>;
  const T x = dot(direction, plain<T>(toWorld_[0])), y = dot(direction, plain<T>(toWorld_[1])),
          z = dot(direction, plain<T>(toWorld_[2]));
  T sinTheta = safeSqrt(T(dot2(x, x, z, z)));
  if (value(sinTheta) < S(1e-7)) sinTheta = T(S(1e-7));
  const T u = turns(x, T(-z)), v = ad::atan2(sinTheta, y) * S(std::numbers::inv_pi);
  const BilinearDistribution::Point<T> point = data_->distribution.template at<T>(u, v);
  LightHit<T> r;
  r.radiance = lookUp<T>(point);
  r.directPdf = solidAnglePdf(point, sinTheta);
  r.emissionPdf = r.directPdf * detail::diskPdf<S>(context.bounds);
  return r;
}

}  // namespace h2mc
