// A perspective pinhole camera.
#pragma once

#include <string>

#include "render/core/types.h"

namespace h2mc {

class Camera {
 public:
  enum class FovAxis { kX, kY, kDiagonal, kSmaller, kLarger };

  Camera() = default;
  // toWorld: camera to world, looking along +z with x to the left as in Mitsuba 0.6. Scale in it is
  // ignored. fov in degrees along the axis; aspect = width / height.
  // Precondition: 0 < fov < 180, aspect > 0, toWorld invertible.
  Camera(const Mat4& toWorld, float fov, FovAxis axis, float aspect);

  // The unit direction through a point of the film, (0,0) its upper left and (1,1) its lower right
  // corner.
  template <class T>
  Vec3<T> direction(const T& filmX, const T& filmY) const {
    const T x = (filmX * Scalar<T>(-2) + Scalar<T>(1)) * Scalar<T>(tanX_);
    const T y = (filmY * Scalar<T>(-2) + Scalar<T>(1)) * Scalar<T>(tanY_);
    return normalize(plain<T>(left_) * x + plain<T>(up_) * y + plain<T>(forward_));
  }

  // Cosine between a unit direction and the optical axis.
  template <class T>
  T cosine(const Vec3<T>& direction) const {
    return dot(plain<T>(forward_), direction);
  }

  // Density per solid angle of direction(u, v) for (u, v) uniform on the film, 1 / (A cos^3) with A
  // the film's area at unit distance; `cosine` > 0. It is the camera's importance as well, for a
  // film of which every point counts the same.
  template <class T>
  T pdf(const T& cosine) const {
    return T(Scalar<T>(1 / filmArea_)) / (cosine * cosine * cosine);
  }

  // The film position that sees along `direction` (any length); false when it is behind or beside.
  bool project(const Vec3f& direction, float& filmX, float& filmY) const;
  // The same without the test, for derivatives. Precondition: in front of the camera.
  template <class T>
  Vec2<T> filmPosition(const Vec3<T>& direction) const {
    using S = Scalar<T>;
    const T z = dot(plain<T>(forward_), direction);
    const T x = dot(plain<T>(left_), direction) / z * S(1 / tanX_);
    const T y = dot(plain<T>(up_), direction) / z * S(1 / tanY_);
    return {(x - S(1)) * S(-0.5), (y - S(1)) * S(-0.5)};
  }

  const Vec3f& position() const { return position_; }
  const Vec3f& forward() const { return forward_; }
  float filmArea() const { return filmArea_; }

  float nearClip = 1e-2f, farClip = 1e4f;  // distances along the optical axis
  float shutterOpen = 0, shutterClose = 0;

 private:
  Vec3f position_{0}, left_{1, 0, 0}, up_{0, 1, 0}, forward_{0, 0, 1};
  float tanX_ = 1, tanY_ = 1, filmArea_ = 4;
};

}  // namespace h2mc
