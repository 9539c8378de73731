// SPDX-License-Identifier: MIT
#include "render/camera/camera.h"

#include <cmath>

namespace h2mc {

Camera::Camera(const Mat4& toWorld) {
  pose_.position = Vec3f(toWorld[3]);
  pose_.forward = glm::normalize(Vec3f(toWorld[2]));
  pose_.left = glm::normalize(Vec3f(toWorld[0]));
  pose_.up = glm::normalize(Vec3f(toWorld[1]));
}

Camera Camera::parallel(const Mat4& toWorld, float halfWidth, float halfHeight) {
  Camera camera(toWorld);
  camera.parallel_ = true;
  camera.tanX_ = halfWidth;
  camera.tanY_ = halfHeight;
  camera.filmArea_ = 4 * halfWidth * halfHeight;
  return camera;
}

Camera::Camera(const Mat4& toWorld, float fov, FovAxis axis, float aspect) : Camera(toWorld) {
  const double tangent = std::tan(0.5 * double(fov) * std::numbers::pi / 180);
  double tanX = tangent;
  switch (axis) {
    case FovAxis::kX:
      break;
    case FovAxis::kY:
      tanX = tangent * aspect;
      break;
    case FovAxis::kDiagonal:
      tanX = tangent * aspect / std::sqrt(1 + double(aspect) * aspect);
      break;
    case FovAxis::kSmaller:
      tanX = aspect < 1 ? tangent : tangent * aspect;
      break;
    case FovAxis::kLarger:
      tanX = aspect < 1 ? tangent * aspect : tangent;
      break;
  }
  tanX_ = static_cast<float>(tanX);
  tanY_ = static_cast<float>(tanX / aspect);
  filmArea_ = static_cast<float>(4 * tanX * tanX / aspect);
}

void Camera::crop(double left, double top, double right, double bottom) {
  const double tanX = tanX_, tanY = tanY_;
  pose_.shiftX = static_cast<float>(tanX * (1 - left - right));
  pose_.shiftY = static_cast<float>(tanY * (1 - top - bottom));
  tanX_ = static_cast<float>(tanX * (right - left));
  tanY_ = static_cast<float>(tanY * (bottom - top));
  filmArea_ = static_cast<float>(4 * tanX * (right - left) * tanY * (bottom - top));
}

void Camera::focus(float apertureRadius, float focusDistance) {
  apertureRadius_ = apertureRadius;
  focusDistance_ = focusDistance;
}

void Camera::follow(const Motion& motion) {
  if (motion.moves()) motion_ = CameraMotion(motion);
}

bool Camera::project(const CameraPose<float>& pose, const Vec3f& offset, float& filmX,
                     float& filmY) const {
  const float depth = dot(pose.forward, offset), z = parallel_ ? 1 : depth;
  if (!(depth > 0)) return false;
  filmX = ((dot(pose.left, offset) / z - pose.shiftX) * (1 / tanX_) - 1) * -0.5f;
  filmY = ((dot(pose.up, offset) / z - pose.shiftY) * (1 / tanY_) - 1) * -0.5f;
  return filmX >= 0 && filmX < 1 && filmY >= 0 && filmY < 1;
}

}  // namespace h2mc
