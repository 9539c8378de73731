// SPDX-License-Identifier: MIT
#include "render/camera/camera_motion.h"

#include <algorithm>
#include <cmath>

namespace h2mc {

CameraMotion::CameraMotion(const Motion& motion) {
  const std::vector<Motion::Key>& keys = motion.keys();
  const auto quaternion = [](const glm::dquat& q) {
    return Quaternion{static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                      static_cast<float>(q.z)};
  };
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const Motion::Key &a = keys[i - 1], &b = keys[i];
    const double cosine = glm::dot(a.pose.rotation, b.pose.rotation);
    pieces_.push_back({static_cast<float>(a.moment), static_cast<float>(1 / (b.moment - a.moment)),
                       Vec3f(a.pose.translation), Vec3f(b.pose.translation),
                       quaternion(a.pose.rotation), quaternion(b.pose.rotation),
                       static_cast<float>(std::acos(std::clamp(cosine, -1.0, 1.0)))});
  }
  for (int i = 0; i < 3; ++i) axes_[i] = Vec3f(glm::normalize(keys[0].pose.stretch[i]));
}

}  // namespace h2mc
