#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "render/core/types.h"
#include "render/image/image.h"
#include "render/texture/checkerboard.h"

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
  Rgbf average() const;
  Rgbf maximum() const;

  // The picture in `path` (gamma as for readImage), read once while anyone holds it. Throws
  // ImageError.
  static std::shared_ptr<const Image> load(const std::string& path, float gamma);

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
