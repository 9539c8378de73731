// SPDX-License-Identifier: MIT
// Where a camera is and how it is turned, at rest or at a moment of its motion.
#pragma once

#include <vector>

#include "render/core/motion.h"
#include "render/core/types.h"

namespace h2mc {

// P is a plain number for a camera at rest, and the scalar type of time for one that moves.
template <class P>
struct CameraPose {
  Vec3<P> position;
  Vec3<P> left, up, forward;  // unit, orthogonal
  // Where the film's middle is at unit distance: off the axis where the film is cropped, and for a point of the
  // aperture that is.
  P shiftX = P(0), shiftY = P(0);
};

// The camera's way through its keyframes: in straight lines, turning by quaternions. No rays hit a
// camera, so nothing needs to be cut into steps and the motion is exact.
class CameraMotion {
 public:
  CameraMotion() = default;
  // Precondition: motion.moves(). Scale and shear are those of the first keyframe, and only their
  // directions count.
  explicit CameraMotion(const Motion& motion);

  bool moves() const { return !pieces_.empty(); }

  // Precondition: moves(), time in [0, 1]. The piece is chosen by value.
  template <class T>
  CameraPose<T> at(const T& time) const;

 private:
  struct Quaternion {
    float w, x, y, z;
  };
  struct Piece {
    float begin, inverseLength;  // in moments
    Vec3f from, to;
    Quaternion first, second;
    float angle;  // between the quaternions
  };
  std::vector<Piece> pieces_;
  Vec3f axes_[3];  // left, up and forward before the rotation
};

template <class T>
CameraPose<T> CameraMotion::at(const T& time) const {
  using S = Scalar<T>;
  std::size_t i = 0;
  while (i + 1 < pieces_.size() && value(time) >= S(pieces_[i + 1].begin)) ++i;
  const Piece& piece = pieces_[i];
  const T share = (time - S(piece.begin)) * S(piece.inverseLength);
  const T rest = share * S(-1) + S(1);
  CameraPose<T> pose;
  const Vec3<S> from = plain<T>(piece.from), way = plain<T>(piece.to) - from;
  pose.position = {share * way.x + from.x, share * way.y + from.y, share * way.z + from.z};

  // [Shoemake 1985, "Animating Rotation with Quaternion Curves"]
  T a = rest, b = share;
  if (piece.angle > 1e-3f) {
    const S angle = S(piece.angle), scale = S(1) / std::sin(angle);
    a = ad::sin(T(rest * angle)) * scale;
    b = ad::sin(T(share * angle)) * scale;
  }
  const Quaternion &p = piece.first, &q = piece.second;
  const T w = a * S(p.w) + b * S(q.w);
  const Vec3<T> v{a * S(p.x) + b * S(q.x), a * S(p.y) + b * S(q.y), a * S(p.z) + b * S(q.z)};
  // Not quite 1 where the straight line stands for the arc, and for rounding.
  const T scale = T(S(2)) / (w * w + ad::length2(v));
  const auto turned = [&](const Vec3f& axis) -> Vec3<T> {
    const Vec3<S> x = plain<T>(axis);
    const Vec3<T> t = cross(v, x);
    return (t * w + cross(v, t)) * scale + x;
  };
  pose.left = turned(axes_[0]);
  pose.up = turned(axes_[1]);
  pose.forward = turned(axes_[2]);
  return pose;
}

}  // namespace h2mc
