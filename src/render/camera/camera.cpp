#include "render/camera/camera.h"

#include <cmath>

namespace h2mc {

Camera::Camera(const Mat4& toWorld, float fov, FovAxis axis, float aspect) {
  position_ = Vec3f(toWorld[3]);
  forward_ = glm::normalize(Vec3f(toWorld[2]));
  left_ = glm::normalize(Vec3f(toWorld[0]));
  up_ = glm::normalize(Vec3f(toWorld[1]));
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

bool Camera::project(const Vec3f& direction, float& filmX, float& filmY) const {
  if (!(dot(forward_, direction) > 0)) return false;
  const Vec2f film = filmPosition(direction);
  filmX = film.x;
  filmY = film.y;
  return film.x >= 0 && film.x < 1 && film.y >= 0 && film.y < 1;
}

}  // namespace h2mc
