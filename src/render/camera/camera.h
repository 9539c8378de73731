// SPDX-License-Identifier: MIT
// The camera: a pinhole, a thin lens, or one that sees along parallel rays.
#pragma once

#include <array>
#include <string>

#include "render/camera/camera_motion.h"
#include "render/core/concentric_disk.h"
#include "render/core/safe_math.h"
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

  // Orthographic: all rays go along the axis, from a film of this half width and height in world space.
  // Preconditions: both > 0, toWorld invertible.
  static Camera parallel(const Mat4& toWorld, float halfWidth, float halfHeight);
  bool isParallel() const { return parallel_; }

  // Leaves a window of the film, or of the plane that it is in, given by two corners in the coordinates of the whole
  // film: from here on film coordinates are the window's. Precondition: left < right, top < bottom. Call once.
  void crop(double left, double top, double right, double bottom);

  // Gives it a thin lens: rays start anywhere on a disk of this radius across the axis, and those through one point of
  // the film meet at a point of the plane that is `focusDistance` away along the axis. A point of the aperture being
  // given, it is a pinhole there, with a film that is shifted. Preconditions: both > 0.
  void focus(float apertureRadius, float focusDistance);
  bool hasAperture() const { return apertureRadius_ > 0; }
  float apertureRadius() const { return apertureRadius_; }
  float focusDistance() const { return focusDistance_; }

  // Lets the camera move as `motion` says, if it moves; the rest stays as constructed.
  void follow(const Motion& motion);
  bool moves() const { return motion_.moves(); }

  // Where it is: at rest, or at its motion's beginning, at the aperture's centre.
  template <class S>
  CameraPose<S> pose() const {
    return {Vec3<S>(pose_.position), Vec3<S>(pose_.left), Vec3<S>(pose_.up),
            Vec3<S>(pose_.forward),  S(pose_.shiftX),     S(pose_.shiftY)};
  }
  // At a moment `time` in [0, 1] of its motion, and at the point of the aperture that two numbers in [0, 1) stand for,
  // uniform by area. Neither is looked at where it makes no difference.
  template <class T>
  CameraPose<T> poseAt(const T* time, const T* aperture) const;
  CameraPose<float> poseOf(float time, const std::array<float, 2>& aperture) const {
    return poseAt(&time, aperture.data());
  }

  // Where it looks, wherever in its aperture.
  Vec3f forwardOf(float time) const { return moves() ? motion_.at(time).forward : pose_.forward; }

  // The unit direction through a point of the film, (0,0) its upper left and (1,1) its lower right
  // corner. Precondition: not parallel.
  template <class P, class T>
  Vec3<T> direction(const CameraPose<P>& pose, const T& filmX, const T& filmY) const {
    const Vec2<T> at = onFilm(pose, filmX, filmY);
    return normalize(pose.left * at.x + pose.up * at.y + pose.forward);
  }
  // Where the ray from there starts. Precondition: parallel.
  template <class P, class T>
  Vec3<T> origin(const CameraPose<P>& pose, const T& filmX, const T& filmY) const {
    const Vec2<T> at = onFilm(pose, filmX, filmY);
    return pose.left * at.x + pose.up * at.y + pose.position;
  }
  // Of a camera at rest.
  template <class T>
  Vec3<T> direction(const T& filmX, const T& filmY) const {
    return direction(pose<Scalar<T>>(), filmX, filmY);
  }

  // Density per solid angle of direction(u, v) for (u, v) uniform on the film, 1 / (A cos^3) with A
  // the film's area at unit distance; `cosine` > 0. It is the camera's importance as well, for a
  // film of which every point counts the same. Of a parallel camera, whose cosines are 1: density of
  // origin(u, v) per area.
  template <class T>
  T pdf(const T& cosine) const {
    return T(Scalar<T>(1 / filmArea_)) / (cosine * cosine * cosine);
  }

  // The film position that sees what lies `offset` away from the pose's position; false when it is behind or
  // beside. Its length matters for parallel cameras alone.
  bool project(const CameraPose<float>& pose, const Vec3f& offset, float& filmX,
               float& filmY) const;

  // At rest, or at its motion's beginning.
  const Vec3f& position() const { return pose_.position; }
  const Vec3f& forward() const { return pose_.forward; }
  float filmArea() const { return filmArea_; }

  float nearClip = 1e-2f, farClip = 1e4f;   // distances along the optical axis
  float shutterOpen = 0, shutterClose = 0;  // in the unit of keyframes' times

 private:
  explicit Camera(const Mat4& toWorld);
  // Left and up from the axis: at unit distance, or of a parallel camera anywhere.
  template <class P, class T>
  Vec2<T> onFilm(const CameraPose<P>& pose, const T& filmX, const T& filmY) const {
    return {(filmX * Scalar<T>(-2) + Scalar<T>(1)) * Scalar<T>(tanX_) + pose.shiftX,
            (filmY * Scalar<T>(-2) + Scalar<T>(1)) * Scalar<T>(tanY_) + pose.shiftY};
  }

  CameraPose<float> pose_{Vec3f(0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  CameraMotion motion_;
  bool parallel_ = false;
  // At unit distance the film is the rectangle [-tan, tan] + the pose's shift; of a parallel camera anywhere.
  float tanX_ = 1, tanY_ = 1, filmArea_ = 4;
  float apertureRadius_ = 0, focusDistance_ = 1;
};

template <class T>
CameraPose<T> Camera::poseAt(const T* time, const T* aperture) const {
  using S = Scalar<T>;
  CameraPose<T> pose;
  if (moves()) {
    pose = motion_.at(*time);
    pose.shiftX = T(S(pose_.shiftX));
    pose.shiftY = T(S(pose_.shiftY));
  } else {
    pose = {lift<T>(plain<T>(pose_.position)),
            lift<T>(plain<T>(pose_.left)),
            lift<T>(plain<T>(pose_.up)),
            lift<T>(plain<T>(pose_.forward)),
            T(S(pose_.shiftX)),
            T(S(pose_.shiftY))};
  }
  if (!hasAperture()) return pose;
  const Vec2<T> at = concentricDisk(aperture[0], aperture[1]);
  const T x = at.x * S(apertureRadius_), y = at.y * S(apertureRadius_);
  pose.position = pose.position + pose.left * x + pose.up * y;
  pose.shiftX = pose.shiftX - x * (S(1) / S(focusDistance_));
  pose.shiftY = pose.shiftY - y * (S(1) / S(focusDistance_));
  return pose;
}

}  // namespace h2mc
