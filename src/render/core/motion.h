// SPDX-License-Identifier: MIT
// Keyframed transforms.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

#include "render/core/types.h"

namespace h2mc {

// M = T R S: translation, rotation, and a symmetric matrix that scales and shears [Shoemake and Duff
// 1992, "Matrix Animation and Polar Decomposition"]. Exact: nothing of M is lost.
struct Decomposition {
  glm::dvec3 translation{0};
  glm::dquat rotation{1, 0, 0, 0};
  glm::dmat3 stretch{1};  // symmetric; negative definite if M mirrors, so that R is a rotation

  // Precondition: the matrix is affine and can be inverted.
  static Decomposition of(const glm::dmat4& matrix);
  glm::dmat4 matrix() const;
};

// A transform as a function of the moment during the shutter's opening. Between two keyframes the
// translation and the stretch go in a straight line and the rotation the short way round; before the
// first and after the last nothing moves.
class Motion {
 public:
  struct Keyframe {
    double time = 0;
    glm::dmat4 matrix{1};
  };

  // At rest.
  Motion() = default;
  explicit Motion(const glm::dmat4& matrix) : still_(matrix) {}
  // What is seen of the keyframes while the shutter is open, shutterOpen <= shutterClose, in the
  // keyframes' unit of time. Preconditions: at least one, times strictly ascending, matrices as
  // above, all mirroring or none.
  Motion(std::span<const Keyframe> keyframes, double shutterOpen, double shutterClose);

  bool moves() const { return !keys_.empty(); }
  // `moment` in [0, 1]: share of the opening. The matrix itself, not composed again, where it is at
  // rest.
  glm::dmat4 at(double moment) const;

  struct Key {
    double moment;
    Decomposition pose;
  };
  // Ascending from moment 0 to moment 1, at least 2; empty if it does not move. The quaternions of
  // neighbours lie in the same half of their sphere.
  const std::vector<Key>& keys() const { return keys_; }

 private:
  glm::dmat4 still_{1};
  std::vector<Key> keys_;
};

// Into how many equal pieces, 1 .. kMaxMotionSegments, to cut the shutter's opening so that points of
// the box [low, high] that go in straight lines between the pieces' ends stay within kChordError times
// the box's (transformed) diagonal of where the motion has them. `error` is what that share is with
// the result: larger than kChordError only if kMaxMotionSegments are not enough.
int motionSegments(const Motion& motion, const glm::dvec3& low, const glm::dvec3& high,
                   double& error);

inline constexpr int kMaxMotionSegments = 128;  // Embree's limit
inline constexpr double kChordError = 5e-4;

}  // namespace h2mc
