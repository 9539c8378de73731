// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "render/image/image.h"
#include "render/texture/mapping.h"
#include "render/texture/slope.h"

namespace h2mc {

// What lies outside the unit square.
enum class WrapMode { kRepeat, kMirror, kClamp, kZero, kOne };

// A picture: (0, 0) is the corner of the first pixel of its top row, v runs down.
struct BitmapTexture {
  std::shared_ptr<const Image> image;  // linear, not empty
  TextureMapping mapping;
  WrapMode wrapU = WrapMode::kRepeat, wrapV = WrapMode::kRepeat;
  bool nearest = false;  // or else bilinear

  // Within a texel (nearest) or between four texels' centres (bilinear), chosen by value.
  template <class T>
  Rgb<T> evaluate(const Vec2<T>& uv) const {
    using S = Scalar<T>;
    const Vec2<T> p = mapping(uv);
    const S shift = nearest ? S(0) : S(-0.5);
    const T x = p.x * S(image->width) + shift, y = p.y * S(image->height) + shift;
    // Beyond this the coordinates no longer tell texels apart.
    if (!(std::abs(value(x)) < S(1e9) && std::abs(value(y)) < S(1e9))) return Rgb<T>(T(0));
    const S left = std::floor(value(x)), top = std::floor(value(y));
    const int i = static_cast<int>(left), j = static_cast<int>(top);
    const Vec3<S> c00 = plain<T>(texel(i, j));
    if (nearest) return {T(c00.x), T(c00.y), T(c00.z)};
    const Vec3<S> c10 = plain<T>(texel(i + 1, j)), c01 = plain<T>(texel(i, j + 1));
    const Vec3<S> dx = c10 - c00, dy = c01 - c00, dxy = plain<T>(texel(i + 1, j + 1)) - c10 - dy;
    const T a = x - left, b = y - top, ab = a * b;
    using ad::linear3;
    return {linear3(a, dx.x, b, dy.x, ab, dxy.x) + c00.x,
            linear3(a, dx.y, b, dy.y, ab, dxy.y) + c00.y,
            linear3(a, dx.z, b, dy.z, ab, dxy.z) + c00.z};
  }
  // With the first derivatives by the surface's u and v, which `nearest` has none of.
  template <class T>
  TextureSlope<T> slope(const Vec2<T>& uv) const {
    using S = Scalar<T>;
    TextureSlope<T> r{evaluate<T>(uv), Rgb<T>(T(S(0))), Rgb<T>(T(S(0)))};
    if (nearest) return r;
    const Vec2<T> p = mapping(uv);
    const T x = p.x * S(image->width) - S(0.5), y = p.y * S(image->height) - S(0.5);
    if (!(std::abs(value(x)) < S(1e9) && std::abs(value(y)) < S(1e9))) return r;
    const S left = std::floor(value(x)), top = std::floor(value(y));
    const int i = static_cast<int>(left), j = static_cast<int>(top);
    const Vec3<S> c00 = plain<T>(texel(i, j));
    const Vec3<S> dx = plain<T>(texel(i + 1, j)) - c00, dy = plain<T>(texel(i, j + 1)) - c00;
    const Vec3<S> dxy = plain<T>(texel(i + 1, j + 1)) - c00 - dx - dy;
    const T a = x - left, b = y - top;
    for (int c = 0; c < 3; ++c) {
      const T byX = (b * dxy[c] + dx[c]) * S(image->width);
      const T byY = (a * dxy[c] + dy[c]) * S(image->height);
      r.du[c] = byX * S(mapping.scale.x) + byY * S(mapping.across.y);
      r.dv[c] = byX * S(mapping.across.x) + byY * S(mapping.scale.y);
    }
    return r;
  }
  Rgbf average() const;
  Rgbf maximum() const;

  // The picture in `path` (gamma and channel as for readImage), read once while anyone holds it.
  // Throws ImageError.
  static std::shared_ptr<const Image> load(const std::string& path, float gamma,
                                           const std::string& channel = "");

 private:
  Rgbf texel(int i, int j) const {
    float outside = -1;
    i = wrap(i, image->width, wrapU, outside);
    j = wrap(j, image->height, wrapV, outside);
    return outside >= 0 ? Rgbf(outside) : image->at(i, j);
  }
  static int wrap(int i, int n, WrapMode mode, float& outside) {
    if (i >= 0 && i < n) return i;
    switch (mode) {
      case WrapMode::kRepeat:
        return (i % n + n) % n;
      case WrapMode::kMirror:
        i = (i % (2 * n) + 2 * n) % (2 * n);
        return i < n ? i : 2 * n - 1 - i;
      case WrapMode::kClamp:
        return i < 0 ? 0 : n - 1;
      case WrapMode::kZero:
        if (outside < 0) outside = 0;
        return 0;
      case WrapMode::kOne:
        if (outside < 0) outside = 1;
        return 0;
    }
    return 0;
  }
};

}  // namespace h2mc
