// SPDX-License-Identifier: MIT
// The renderer's words for numbers: vectors, colours, the scalar behind a derivative type.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>

#include "ad/functions.h"
#include "ad/traits.h"
#include "ad/vec3.h"

namespace h2mc {

using ad::Scalar;
using ad::value;
// Unqualified calls then mean these for plain numbers too, never the C library's double versions.
using ad::abs;
using ad::distance2;
using ad::dot;
using ad::exp;
using ad::length2;
using ad::log;
using ad::normalize;
using ad::sqrt;
using ad::Vec2;
using ad::Vec3;
using Vec2f = Vec2<float>;
using Vec3f = Vec3<float>;
using Mat4 = glm::mat4;

// Linear RGB, Rec. 709 primaries.
template <class T>
using Rgb = Vec3<T>;
using Rgbf = Rgb<float>;

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kInvPi = std::numbers::inv_pi_v<float>;

// The longest path any integrator follows, in edges (1 = an emitter seen directly).
inline constexpr int kMaxPathLength = 32;

// Plain copies of scene data in the scalar behind T: float data meets double derivatives here.
template <class T>
Vec3<Scalar<T>> plain(const Vec3f& a) {
  return Vec3<Scalar<T>>(a);
}

// Values of a vector of derivative types.
template <class T>
Vec3<Scalar<T>> value3(const Vec3<T>& a) {
  return {value(a.x), value(a.y), value(a.z)};
}
template <class T>
Vec2<Scalar<T>> value2(const Vec2<T>& a) {
  return {value(a.x), value(a.y)};
}

// Y of linear Rec. 709 RGB.
inline constexpr double kLuminance[3] = {0.212671, 0.715160, 0.072169};
template <class T>
T luminance(const Rgb<T>& c) {
  using S = Scalar<T>;
  return c.x * S(kLuminance[0]) + c.y * S(kLuminance[1]) + c.z * S(kLuminance[2]);
}

// No channel carries anything.
inline bool dark(const Rgbf& c) { return !(c.x > 0) && !(c.y > 0) && !(c.z > 0); }

template <class T>
T squared(const T& x) {
  return x * x;
}

}  // namespace h2mc
