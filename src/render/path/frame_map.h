// SPDX-License-Identifier: MIT
// Shading frames along the texture coordinates, or bent by height and normal maps [Blinn 1978, "Simulation
// of Wrinkled Surfaces"].
//
// The frame is a function of the point like any other: derivative types see the height's second derivatives
// (a bitmap's within the cell between four texel centres) and how the tangents turn. The term of Blinn's
// with the derivative of the normal is left out, as it is there.
#pragma once

#include "render/bsdf/bsdf.h"
#include "render/geometry/tangents.h"

namespace h2mc {

namespace detail {

// Scaled to a length of about 1 first: squares of lengths in world units may leave float's range.
template <class T>
bool normalizeAny(Vec3<T>& a) {
  using S = Scalar<T>;
  const Vec3<S> v = value3(a);
  const S largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > std::numeric_limits<S>::min()) || !std::isfinite(largest)) return false;
  a = ad::normalize(Vec3<T>(a * (S(1) / largest)));
  return true;
}

template <class T>
Vec3<T> without(const Vec3<T>& a, const Vec3<T>& unit) {
  return a - unit * dot(a, unit);
}

// The bent normal, or the same where the map says nothing. `side`: -1 where heights point the other way.
template <class T>
Vec3<T> bentNormal(const FrameMap& map, const Tangents<T>& tangents, const Vec3<T>& n,
                   const SurfacePoint<T>& point, Scalar<T> side) {
  using S = Scalar<T>;
  Vec3<T> bent;
  if (map.kind == FrameMap::Kind::kBump) {
    const TextureSlope<T> height = slopeOf<T>(*map.texture, point.uv);
    const Vec3<T> u = without(tangents.u, n) + n * T(luminance(height.du) * side);
    const Vec3<T> v = without(tangents.v, n) + n * T(luminance(height.dv) * side);
    bent = cross(u, v);
    if (!normalizeAny(bent)) return n;
    return dot(value3(bent), value3(n)) < 0 ? -bent : bent;
  }
  Vec3<T> s = without(tangents.u, n);
  if (!normalizeAny(s)) return n;
  const Rgb<T> c = evaluate<T>(*map.texture, point.uv);
  const T x = (c.x * S(2) - S(1)) * side, y = (c.y * S(2) - S(1)) * side, z = c.z * S(2) - S(1);
  bent = s * x + cross(n, s) * y + n * z;
  return normalizeAny(bent) ? bent : n;
}

}  // namespace detail

// Turns the point's shading frame as the map says. `toPrevious`: where the path came from, in world space.
template <class T>
[[gnu::noinline]] void mapFrame(const FrameMap& map, std::span<const Shape> shapes, PrimitiveId id,
                                const Vec3<T>& toPrevious, SurfacePoint<T>& point,
                                const std::type_identity_t<T>* time) {
  using S = Scalar<T>;
  const Tangents<T> tangents = tangentsOnPrimitive<T>(shapes, id, point, time);
  Vec3<T> n = point.shading.n;
  if constexpr (ad::isDual<T>)
    if (point.shading.constant) n = lift<T>(value3(n));
  if (map.kind != FrameMap::Kind::kTangent) {
    point.unbent = value3(n);
    point.bend = map.perSide ? Bend::kBoth : Bend::kLight;
    point.flat = false;
    const S side = map.perSide && dot(value3(toPrevious), point.unbent) < 0 ? S(-1) : S(1);
    n = detail::bentNormal(map, tangents, n, point, side);
  }
  Vec3<T> s = detail::without(tangents.u, n);
  point.shading = detail::normalizeAny(s) ? Frame<T>{s, cross(n, s), n} : Frame<T>::fromNormal(n);
}

}  // namespace h2mc
