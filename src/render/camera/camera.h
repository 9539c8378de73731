// SPDX-License-Identifier: MIT
// A perspective pinhole camera.
#pragma once

#include <string>

#include "render/camera/camera_motion.h"
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

  // Leaves a window of the film, given by two corners in the coordinates of the whole one: from here on
  // film coordinates are the window's. Precondition: left < right, top < bottom. Call once.
  void crop(double left, double top, double right, double bottom);

  // Lets the camera move as `motion` says, if it moves; the rest stays as constructed.
  void follow(const Motion& motion);
  bool moves() const { return motion_.moves(); }

  // Where it is: at rest, or at its motion's beginning; and at a moment `time` in [0, 1] of its motion
  // (precondition: moves()).
  template <class S>
  CameraPose<S> pose() const {
    return {Vec3<S>(pose_.position), Vec3<S>(pose_.left), Vec3<S>(pose_.up),
            Vec3<S>(pose_.forward)};
  }
  template <class T>
  CameraPose<T> poseAt(const T& time) const {
    return motion_.at(time);
  }
  // The same whether it moves or not.
  CameraPose<float> poseOf(float time) const { return moves() ? motion_.at(time) : pose_; }

  // The unit direction through a point of the film, (0,0) its upper left and (1,1) its lower right
  // corner.
  template <class P, class T>
  Vec3<T> direction(const CameraPose<P>& pose, const T& filmX, const T& filmY) const {
    const T x = (filmX * Scalar<T>(-2) + Scalar<T>(1)) * Scalar<T>(tanX_) + Scalar<T>(shiftX_);
    const T y = (filmY * Scalar<T>(-2) + Scalar<T>(1)) * Scalar<T>(tanY_) + Scalar<T>(shiftY_);
    return normalize(pose.left * x + pose.up * y + pose.forward);
  }
  // Of a camera at rest.
  template <class T>
  Vec3<T> direction(const T& filmX, const T& filmY) const {
    return direction(pose<Scalar<T>>(), filmX, filmY);
  }

  // Density per solid angle of direction(u, v) for (u, v) uniform on the film, 1 / (A cos^3) with A
  // the film's area at unit distance; `cosine` > 0. It is the camera's importance as well, for a
  // film of which every point counts the same.
  template <class T>
  T pdf(const T& cosine) const {
    return T(Scalar<T>(1 / filmArea_)) / (cosine * cosine * cosine);
  }

  // The film position that sees along `direction` (any length); false when it is behind or beside.
  bool project(const CameraPose<float>& pose, const Vec3f& direction, float& filmX,
               float& filmY) const;

  // At rest, or at its motion's beginning.
  const Vec3f& position() const { return pose_.position; }
  const Vec3f& forward() const { return pose_.forward; }
  float filmArea() const { return filmArea_; }

  float nearClip = 1e-2f, farClip = 1e4f;   // distances along the optical axis
  float shutterOpen = 0, shutterClose = 0;  // in the unit of keyframes' times

 private:
  CameraPose<float> pose_{Vec3f(0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  CameraMotion motion_;
  // At unit distance the film is the rectangle [-tan, tan] + shift.
  float tanX_ = 1, tanY_ = 1, filmArea_ = 4;
  float shiftX_ = 0, shiftY_ = 0;
};

}  // namespace h2mc
