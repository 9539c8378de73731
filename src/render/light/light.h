// SPDX-License-Identifier: MIT
// Lights: where light comes from. Densities do not include the probability of choosing the light.
#pragma once

#include <span>
#include <string>
#include <variant>

#include "render/light/area_light.h"
#include "render/light/collimated_light.h"
#include "render/light/constant_light.h"
#include "render/light/directional_light.h"
#include "render/light/envmap_light.h"
#include "render/light/light_types.h"
#include "render/light/point_light.h"
#include "render/light/projector_light.h"
#include "render/light/spot_light.h"
#include "render/light/sun_light.h"
#include "render/scene/plugin.h"

namespace h2mc {

// What each alternative provides (all const), some of it by way of light_kinds.h:
//
//   bool isDelta();      // no path can hit it: point, spot, directional, projector, collimated
//   bool isInfinite();   // no position: directional, constant, envmap, sun
//   bool isEnvironment();  // seen by rays that leave the scene: constant, envmap, sun
//   float power(const SceneBounds&);  // luminance of the flux (an estimate is enough), > 0 if it emits
//
//   // Light arriving at the point `reference`, sampled with u in [0,1)^2 (technique s = 1).
//   // `primitive` is the discrete choice made by choosePrimitive().
//   template <class T> DirectLight<T> sampleDirect(const LightContext&, PrimitiveId primitive,
//                                                 const Vec3<T>& reference, const T& u0, const T& u1);
//
//   // A ray leaving the light: u0, u1 place its origin, v0, v1 its direction (s >= 2). Point lights
//   // use v only, directional ones u only.
//   template <class T> EmittedRay<T> sampleEmission(const LightContext&, PrimitiveId primitive,
//                                                   const T& u0, const T& u1, const T& v0, const T& v1);
//
//   // Radiance and densities of a path that hits the light (s = 0): for area lights at the surface
//   // point, seen along unit `direction` (from the previous vertex to the light); for environments
//   // along `direction`, the point is not used. Zero radiance on the dark side.
//   template <class T> LightHit<T> hit(const LightContext&, const SurfacePoint<T>&,
//                                      const Vec3<T>& direction);
//
//   // The discrete choice within the light from a coordinate in [0,1): an area light's triangle.
//   PrimitiveId choosePrimitive(const LightContext&, float choice);
//
//   // The inverses, for mutations that move vertices: coordinates that give back the sampled point
//   // or ray; false where the light cannot have made it. Area lights turn `choice`, a remainder, into the primitive's.
//   bool invertDirect(const LightContext&, PrimitiveId, const Vec3f& reference,
//                     const Vec3f& direction, float distance, Vec2f& u, float& choice);
//   bool invertEmission(const LightContext&, PrimitiveId, const Vec3f& origin,
//                       const Vec3f& direction, Vec2f& u, Vec2f& v, float& choice);
//
//   // Which of (u0, u1) of sampleDirect and (u0, u1, v0, v1) of sampleEmission are angles, so that 0
//   // and 1 are the same point: bit i for the i-th.
//   unsigned wrapsDirect(const LightContext&);
//   unsigned wrapsEmission(const LightContext&);
using Light = std::variant<AreaLight, PointLight, SpotLight, DirectionalLight, ConstantLight,
                           EnvmapLight, SunLight, ProjectorLight, CollimatedLight>;

// Whether its rays are all the same one: what it lights first can't be moved.
inline bool isBeam(const Light& light) { return std::holds_alternative<CollimatedLight>(light); }

// Whether suns stand before it.
template <class L>
inline constexpr bool kBehindSuns =
    std::is_same_v<L, ConstantLight> || std::is_same_v<L, EnvmapLight>;
inline bool isBehindSun(const LightContext& context, const Vec3f& toLight) {
  for (const SkyDisc& sun : context.suns)
    if (sun.covers(toLight)) return true;
  return false;
}

// sampleDirect and sampleEmission in a scene: at a moment of the shutter's opening, which only area lights know of, and
// nothing from where a sun stands before the light. `time` may be null where the light's shape does not move.
template <class T, class L>
DirectLight<T> sampleDirectAt(const L& light, const LightContext& context, PrimitiveId primitive,
                              const Vec3<T>& reference, const T& u0, const T& u1, const T* time) {
  if constexpr (std::is_same_v<L, AreaLight>) {
    return light.template sampleDirect<T>(context, primitive, reference, u0, u1, time);
  } else {
    DirectLight<T> r = light.template sampleDirect<T>(context, primitive, reference, u0, u1);
    if constexpr (kBehindSuns<L>)
      if (!context.suns.empty() && isBehindSun(context, Vec3f(value3(r.direction)))) [[unlikely]]
        r.arriving = lift<T>(Vec3<Scalar<T>>(0));
    return r;
  }
}
template <class T, class L>
EmittedRay<T> sampleEmissionAt(const L& light, const LightContext& context, PrimitiveId primitive,
                               const T& u0, const T& u1, const T& v0, const T& v1, const T* time) {
  if constexpr (std::is_same_v<L, AreaLight>) {
    return light.template sampleEmission<T>(context, primitive, u0, u1, v0, v1, time);
  } else {
    EmittedRay<T> r = light.template sampleEmission<T>(context, primitive, u0, u1, v0, v1);
    if constexpr (kBehindSuns<L>)
      if (!context.suns.empty() && isBehindSun(context, -Vec3f(value3(r.direction)))) [[unlikely]]
        r.flux = lift<T>(Vec3<Scalar<T>>(0));
    return r;
  }
}

// Tells area lights about the shapes they stand on. Call once, when the scene's shapes are in place
// and AreaLight::shape is set, before any other use.
void prepareLights(std::span<Light> lights, std::span<const Shape> shapes);

// Every light a scene file can name.
std::span<const Plugin<Light>> lightPlugins();

}  // namespace h2mc
