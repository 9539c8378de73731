// SPDX-License-Identifier: MIT
#include "render/core/motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/core/index.h"
namespace h2mc {
namespace {

// `share` of the way from a to b.
Decomposition between(const Decomposition& a, const Decomposition& b, double share) {
  return {a.translation + (b.translation - a.translation) * share,
          glm::normalize(glm::slerp(a.rotation, b.rotation, share)),
          a.stretch + (b.stretch - a.stretch) * share};
}

bool same(const glm::dmat4& a, const glm::dmat4& b) {
  double difference = 0, size = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      difference = std::max(difference, std::abs(a[i][j] - b[i][j]));
      size = std::max(size, std::abs(a[i][j]));
    }
  return difference <= 1e-12 * size;
}

}  // namespace

Decomposition Decomposition::of(const glm::dmat4& matrix) {
  const glm::dmat3 linear(matrix);
  // The orthogonal factor by Newton's iteration Q <- (Q + Q^-T) / 2, sped up at first by scaling with
  // the determinant [Higham 1986, "Computing the Polar Decomposition"].
  glm::dmat3 q = linear;
  for (int i = 0; i < 100; ++i) {
    const double scale = std::cbrt(1 / std::abs(glm::determinant(q)));
    if (std::abs(scale - 1) > 1e-3) q *= scale;
    const glm::dmat3 next = (q + glm::transpose(glm::inverse(q))) * 0.5;
    double change = 0;
    for (int k = 0; k < 3; ++k) change = std::max(change, glm::length(next[k] - q[k]));
    q = next;
    if (change < 1e-15) break;
  }
  if (glm::determinant(q) < 0) q = -q;
  Decomposition d;
  d.translation = glm::dvec3(matrix[3]);
  d.rotation = glm::normalize(glm::quat_cast(q));
  d.stretch = glm::transpose(q) * linear;
  d.stretch = (d.stretch + glm::transpose(d.stretch)) * 0.5;
  return d;
}

glm::dmat4 Decomposition::matrix() const {
  glm::dmat4 m(glm::mat3_cast(rotation) * stretch);
  m[3] = glm::dvec4(translation, 1);
  return m;
}

Motion::Motion(std::span<const Keyframe> keyframes, double shutterOpen, double shutterClose) {
  std::vector<Key> all;
  for (const Keyframe& frame : keyframes)
    all.push_back({frame.time, Decomposition::of(frame.matrix)});
  for (std::size_t i = 1; i < all.size(); ++i)
    if (glm::dot(all[i].pose.rotation, all[i - 1].pose.rotation) < 0)
      all[i].pose.rotation = -all[i].pose.rotation;
  const auto poseAt = [&](double time) {
    if (time <= all.front().moment) return all.front().pose;
    for (std::size_t i = 1; i < all.size(); ++i) {
      const Key &a = all[i - 1], &b = all[i];
      if (time <= b.moment)
        return between(a.pose, b.pose, (time - a.moment) / (b.moment - a.moment));
    }
    return all.back().pose;
  };

  // The keyframes within the opening, and its ends.
  const double length = shutterClose - shutterOpen;
  keys_.push_back({0, poseAt(shutterOpen)});
  if (length > 0) {
    for (const Key& key : all)
      if (key.moment > shutterOpen && key.moment < shutterClose)
        keys_.push_back({(key.moment - shutterOpen) / length, key.pose});
    keys_.push_back({1, poseAt(shutterClose)});
  }
  for (std::size_t i = 1; i < keys_.size(); ++i)
    if (glm::dot(keys_[i].pose.rotation, keys_[i - 1].pose.rotation) < 0)
      keys_[i].pose.rotation = -keys_[i].pose.rotation;

  const glm::dmat4 first = keys_[0].pose.matrix();
  if (std::all_of(keys_.begin(), keys_.end(),
                  [&](const Key& key) { return same(first, key.pose.matrix()); })) {
    // As it was written, not composed again, where that is what is seen.
    still_ = first;
    for (const Keyframe& frame : keyframes)
      if (same(first, frame.matrix)) still_ = frame.matrix;
    keys_.clear();
  }
}

glm::dmat4 Motion::at(double moment) const {
  if (!moves()) return still_;
  std::size_t i = 1;
  while (i + 1 < keys_.size() && moment > keys_[i].moment) ++i;
  const Key &a = keys_[i - 1], &b = keys_[i];
  const double share = std::clamp((moment - a.moment) / (b.moment - a.moment), 0.0, 1.0);
  return between(a.pose, b.pose, share).matrix();
}

int motionSegments(const Motion& motion, const glm::dvec3& low, const glm::dvec3& high,
                   double& error) {
  error = 0;
  if (!motion.moves()) return 1;
  std::array<glm::dvec4, 8> corners;
  for (int i = 0; i < 8; ++i)
    corners[at(i)] =
        glm::dvec4(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z, 1);
  double size = 0;
  for (const Motion::Key& key : motion.keys())
    size = std::max(size, glm::length(glm::dmat3(key.pose.matrix()) * (high - low)));

  // The distance between the motion and a chord is, at any moment, convex in the point: over the box
  // it is largest at a corner. Moments looked at: some within each piece, and the keyframes, where
  // the motion may have corners.
  const auto errorOf = [&](int segments) {
    double largest = 0;
    const auto look = [&](double moment) {
      const double scaled = moment * segments;
      const double index = std::min(std::floor(scaled), segments - 1.0);
      const glm::dmat4 a = motion.at(index / segments), b = motion.at((index + 1) / segments);
      const glm::dmat4 off = a + (b - a) * (scaled - index) - motion.at(moment);
      for (const glm::dvec4& corner : corners)
        largest = std::max(largest, glm::length(glm::dvec3(off * corner)));
    };
    for (int i = 0; i < segments; ++i)
      for (const double share : {0.25, 0.5, 0.75}) look((i + share) / segments);
    for (const Motion::Key& key : motion.keys()) look(key.moment);
    return size > 0 ? largest / size : 0;
  };
  for (int segments = 1;; segments += 1 + segments / 8) {
    segments = std::min(segments, kMaxMotionSegments);
    error = errorOf(segments);
    if (error <= kChordError || segments == kMaxMotionSegments) return segments;
  }
}

}  // namespace h2mc
