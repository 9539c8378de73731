// SPDX-License-Identifier: MIT
#pragma once

#include "render/light/light_kinds.h"

namespace h2mc {

// A beam: all light leaves one point in one direction. What it falls on it finds without drawing anything, so paths are
// made by s >= 2 alone, and their first vertex can't be moved (isOnBeam() in full_path.h).
struct CollimatedLight : LightAtPoint {
  Vec3f direction{0, 0, 1};  // unit
  Rgbf flux{1};              // in all

  float power(const SceneBounds&) const { return luminance(flux); }

  // Nothing arrives: no point but those on the beam is lit, and these no reference hits.
  template <class T>
  DirectLight<T> sampleDirect(const LightContext&, PrimitiveId, const Vec3<T>& reference, const T&,
                              const T&) const {
    using S = Scalar<T>;
    DirectLight<T> r =
        detail::directFromPoint<T>(position, reference, [](DirectLight<T>& at, const T&) {
          at.arriving = lift<T>(Vec3<S>(0));
          at.emissionPdf = T(S(0));
        });
    r.directPdf = T(S(0));
    return r;
  }

  // The density of what is always the same counts as 1.
  template <class T>
  EmittedRay<T> sampleEmission(const LightContext&, PrimitiveId, const T&, const T&, const T&,
                               const T&) const {
    using S = Scalar<T>;
    EmittedRay<T> r;
    r.origin = lift<T>(plain<T>(position));
    r.normal = lift<T>(Vec3<S>(0));
    r.direction = lift<T>(plain<T>(direction));
    r.flux = detail::passiveColor<T>(flux);
    r.emissionPdf = r.cosLight = T(S(1));
    r.directPdf = T(S(0));
    return r;
  }

  // Whether p lies on the beam, up to the rounding of where a ray meets a surface.
  bool reaches(const Vec3f& p) const {
    const glm::dvec3 d = glm::dvec3(p) - glm::dvec3(position), along(direction);
    const double way = glm::dot(d, along);
    const double tolerance = 3e-6 * (glm::length(glm::dvec3(p)) + way);
    return way > 0 && glm::length(d - along * way) <= tolerance;
  }

  bool invertDirect(const LightContext&, PrimitiveId, const Vec3f&, const Vec3f&, float, Vec2f&,
                    float&) const {
    return false;
  }
  bool invertEmission(const LightContext&, PrimitiveId, const Vec3f& origin, const Vec3f& along,
                      Vec2f& u, Vec2f& v, float& choice) const {
    u = v = Vec2f(0.5f);
    choice = 0.5f;
    return detail::isNear(origin, position, 0) && dot(along, direction) > 1 - 1e-5f;
  }
  unsigned wrapsEmission(const LightContext&) const { return 0; }
};

}  // namespace h2mc
