// SPDX-License-Identifier: MIT
// Members that lights of one kind have in common (light.h says what each is).
#pragma once

#include "render/light/light_sampling.h"

namespace h2mc {

// On no shape: there is nothing to choose.
struct LightWithoutArea {
  PrimitiveId choosePrimitive(const LightContext&, float) const { return {}; }
};

// No path can hit it.
struct DeltaLight : LightWithoutArea {
  bool isDelta() const { return true; }
  bool isEnvironment() const { return false; }
  template <class T>
  LightHit<T> hit(const LightContext&, const SurfacePoint<T>&, const Vec3<T>&) const {
    return detail::noHit<T>();
  }
  unsigned wrapsDirect(const LightContext&) const { return 0; }
};

// All light comes from one point.
struct LightAtPoint : DeltaLight {
  Vec3f position{0};

  bool isInfinite() const { return false; }
  bool invertDirect(const LightContext&, PrimitiveId, const Vec3f& reference,
                    const Vec3f& direction, float distance, Vec2f& u, float& choice) const {
    u = Vec2f(0.5f);
    choice = 0.5f;
    return detail::isNear(reference + direction * distance, position, distance);
  }
};

}  // namespace h2mc
