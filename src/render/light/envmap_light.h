#pragma once

#include <memory>

#include "render/core/distribution.h"
#include "render/image/image.h"
#include "render/light/light_sampling.h"

namespace h2mc {

// Radiance from infinitely far, from a picture in latitude and longitude. It is bilinear between
// pixel centres, and so is the density of sampled directions but for the sine of the elevation:
// radiance over density hardly varies but in hue.
class EnvmapLight {
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
    using S = Scalar<T>;
    DirectLight<T> r;
    sampleDirection<T>(u0, u1, r.direction, r.radiance, r.directPdf);
    r.distance = T(S(detail::beyond(context.bounds)));
    r.emissionPdf = r.directPdf * detail::diskPdf<S>(context.bounds);
    r.cosLight = T(S(1));
    return r;
  }

  template <class T>
  EmittedRay<T> sampleEmission(const LightContext& context, PrimitiveId, const T& u0, const T& u1,
                               const T& v0, const T& v1) const {
    using S = Scalar<T>;
    EmittedRay<T> r;
    Vec3<T> toLight;
    sampleDirection<T>(v0, v1, toLight, r.power, r.directPdf);
    r.origin = detail::diskTowards(context.bounds, toLight, u0, u1);
    r.direction = -toLight;
    r.normal = lift<T>(Vec3<S>(0));
    r.emissionPdf = r.directPdf * detail::diskPdf<S>(context.bounds);
    r.cosLight = T(S(1));
    return r;
  }

  template <class T>
  LightHit<T> hit(const LightContext& context, const SurfacePoint<T>&,
                  const Vec3<T>& direction) const;

  PrimitiveId choosePrimitive(const LightContext&, float) const { return {}; }
  bool invertDirect(const LightContext&, PrimitiveId, const Vec3f& reference,
                    const Vec3f& direction, float distance, Vec2f& u, float& choice) const;
  bool invertEmission(const LightContext& context, PrimitiveId, const Vec3f& origin,
                      const Vec3f& direction, Vec2f& u, Vec2f& v, float& choice) const;
  unsigned wrapsDirect(const LightContext&) const { return 1; }
  unsigned wrapsEmission(const LightContext&) const { return 2 | 4; }

  int width() const { return data_->distribution.width(); }
  int height() const { return data_->distribution.height(); }

 private:
  struct Data {
    Image image;
    BilinearDistribution distribution;
  };

  template <class T>
  void sampleDirection(const T& u0, const T& u1, Vec3<T>& direction, Rgb<T>& radiance,
                       T& pdf) const;
  template <class T>
  Rgb<T> lookUp(const BilinearDistribution::Point<T>& point) const;
  Vec2f invertDirection(const Vec3f& direction) const;

  std::shared_ptr<const Data> data_;  // lights are copied
  glm::mat3 toWorld_;                 // its inverse is its transpose
  float fluxPerArea_ = 0;             // luminance of the radiance, integrated over all directions
};

// Bilinear between the corners of the point's cell.
template <class T>
Rgb<T> EnvmapLight::lookUp(const BilinearDistribution::Point<T>& point) const {
  const Image& image = data_->image;
  const int x0 = point.cell.column, x1 = x0 + 1 == image.width ? 0 : x0 + 1;
  const int y0 = point.cell.row == 0 ? 0 : point.cell.row - 1;
  const int y1 = point.cell.row == image.height ? image.height - 1 : point.cell.row;
  const Rgb<Scalar<T>> c00 = plain<T>(image.at(x0, y0)), c10 = plain<T>(image.at(x1, y0));
  if (y0 == y1) {
    const Rgb<Scalar<T>> d = c10 - c00;
    return {point.x * d.x + c00.x, point.x * d.y + c00.y, point.x * d.z + c00.z};
  }
  const Rgb<Scalar<T>> c01 = plain<T>(image.at(x0, y1)), c11 = plain<T>(image.at(x1, y1));
  const Rgb<Scalar<T>> dx = c10 - c00, dy = c01 - c00, dxy = (c11 - c01) - dx;
  const T xy = point.x * point.y;
  return {linear3(point.x, dx.x, point.y, dy.x, xy, dxy.x) + c00.x,
          linear3(point.x, dx.y, point.y, dy.y, xy, dxy.y) + c00.y,
          linear3(point.x, dx.z, point.y, dy.z, xy, dxy.z) + c00.z};
}

template <class T>
void EnvmapLight::sampleDirection(const T& u0, const T& u1, Vec3<T>& direction, Rgb<T>& radiance,
                                  T& pdf) const {
  using S = Scalar<T>;
  const BilinearDistribution::Point<T> point = data_->distribution.template sample<T>(u0, u1);
  radiance = lookUp<T>(point);
  T sinTheta, cosTheta;
  ad::sincos(T(point.v * S(std::numbers::pi)), sinTheta, cosTheta);
  // A pole itself, by rounding.
  if (value(sinTheta) < S(1e-7)) sinTheta = T(S(1e-7));
  const Vec2<T> phi = detail::circle(point.u);
  // u turns from -z towards x; y is up.
  direction = ad::combine(T(sinTheta * phi.y), plain<T>(toWorld_[0]), cosTheta,
                          plain<T>(toWorld_[1]), T(-(sinTheta * phi.x)), plain<T>(toWorld_[2]));
  pdf = point.pdf * S(0.5 / (std::numbers::pi * std::numbers::pi)) / sinTheta;
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
  r.directPdf = point.pdf * S(0.5 / (std::numbers::pi * std::numbers::pi)) / sinTheta;
  r.emissionPdf = r.directPdf * detail::diskPdf<S>(context.bounds);
  return r;
}

}  // namespace h2mc
