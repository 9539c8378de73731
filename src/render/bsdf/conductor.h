// SPDX-License-Identifier: MIT
// A smooth metal.
#pragma once

#include "render/bsdf/conductor_index.h"
#include "render/bsdf/lobe_kinds.h"
#include "render/core/hemisphere.h"
#include "render/texture/texture.h"

namespace h2mc {

struct Conductor : DeltaLobes {
  static constexpr int kLobes = 1;
  ConductorIndex index;
  TexturePtr specular;
  float scale = 1;  // of the specular reflectance, to conserve energy

  bool transmits() const { return false; }

  float lobeSplit(const Vec2f&, const Vec3f&, float, float) const { return 1; }
  int chooseLobe(const Vec2f&, const Vec3f&, float, float, float) const { return 0; }
  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>& uv, const Vec3<T>& wi, int) const {
    if (!(value(wi.z) > 0)) return DeltaSample<T>::none();
    const Rgb<T> f = index.reflect(modulate<T>(*specular, uv, T(Scalar<T>(scale))), wi.z);
    return {mirrored(wi), f, f, 1};
  }
  Rgbf albedo() const { return index.reflect<float>(average(*specular) * scale, 0.8f); }
};

}  // namespace h2mc
