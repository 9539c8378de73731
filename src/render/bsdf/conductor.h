// A smooth metal.
#pragma once

#include "render/bsdf/bsdf_types.h"
#include "render/bsdf/conductor_index.h"
#include "render/core/hemisphere.h"
#include "render/texture/texture.h"

namespace h2mc {

struct Conductor {
  static constexpr int kLobes = 1;
  ConductorIndex index;
  TexturePtr specular;
  float scale = 1;  // of the specular reflectance, to conserve energy

  bool isDelta(int) const { return true; }
  bool hasNonDelta() const { return false; }
  bool transmits() const { return false; }

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>&, const Vec3<T>&, const Vec3<T>&) const {
    return BsdfValue<T>::zero();
  }
  float lobeSplit(const Vec2f&, const Vec3f&, float, float) const { return 1; }
  int chooseLobe(const Vec2f&, const Vec3f&, float, float, float) const { return 0; }
  template <class T>
  Vec3<T> sample(const Vec2<T>&, const Vec3<T>&, int, const T&, const T&) const {
    return noDirection<T>();
  }
  template <class T>
  T lobePdf(const Vec2<T>&, const Vec3<T>&, const Vec3<T>&, int) const {
    return T(0);
  }
  bool invert(const Vec2f&, const Vec3f&, const Vec3f&, int, Vec2f&) const { return false; }
  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>& uv, const Vec3<T>& wi, int) const {
    if (!(value(wi.z) > 0)) return DeltaSample<T>::none();
    const Rgb<T> f = index.reflect(modulate<T>(*specular, uv, T(Scalar<T>(scale))), wi.z);
    return {mirrored(wi), f, f, 1};
  }
  float width(int) const { return 0; }
  Rgbf albedo() const { return index.reflect<float>(average(*specular) * scale, 0.8f); }
};

}  // namespace h2mc
