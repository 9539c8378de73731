// Lambertian reflection.
#pragma once

#include "render/bsdf/bsdf_types.h"
#include "render/core/hemisphere.h"
#include "render/texture/texture.h"

namespace h2mc {

struct Diffuse {
  static constexpr int kLobes = 1;
  TexturePtr reflectance;
  float scale = 1;  // of the reflectance, to conserve energy

  bool isDelta(int) const { return false; }
  bool hasNonDelta() const { return true; }
  bool transmits() const { return false; }

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return BsdfValue<T>::zero();
    const S invPi = kInvPiOf<T>;
    return {modulate<T>(*reflectance, uv, wo.z * (invPi * S(scale))), wo.z * invPi, wi.z * invPi};
  }
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return SampledBsdf<T>::zero();
    const S invPi = kInvPiOf<T>;
    return {modulate<T>(*reflectance, uv, T(S(scale))), wo.z * invPi, wi.z * invPi};
  }
  float lobeSplit(const Vec2f&, const Vec3f&, float, float) const { return 1; }
  int chooseLobe(const Vec2f&, const Vec3f&, float, float, float) const { return 0; }
  template <class T>
  Vec3<T> sample(const Vec2<T>&, const Vec3<T>&, int, const T& u0, const T& u1) const {
    return sampleCosine(u0, u1);
  }
  template <class T>
  T lobePdf(const Vec2<T>&, const Vec3<T>& wi, const Vec3<T>& wo, int) const {
    return value(wi.z) > 0 && value(wo.z) > 0 ? T(wo.z * kInvPiOf<T>) : T(0);
  }
  bool invert(const Vec2f&, const Vec3f& wi, const Vec3f& wo, int, Vec2f& u) const {
    return wi.z > 0 && invertCosine(wo, u);
  }
  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>&, const Vec3<T>&, int) const {
    return DeltaSample<T>::none();
  }
  float width(int) const { return kPi / 2; }
  Rgbf albedo() const { return average(*reflectance) * scale; }
};

}  // namespace h2mc
