// SPDX-License-Identifier: MIT
// What a chain samples: a non-negative function on the union of all techniques' primary spaces.
#pragma once

#include "mcmc/targets/importance_map.h"
#include "render/path/bidirectional.h"
#include "render/path/derivative.h"
#include "render/path/gradient.h"
#include "render/path/path.h"

namespace h2mc {

class Target {
 public:
  virtual ~Target() = default;
  // Fills in everything of `path` that follows from its technique and primary sample. Returns path.target > 0.
  virtual bool evaluate(Path& path) const = 0;
  // Derivatives of log(path.target).
  virtual void differentiate(const Path& path, Derivative& result) const = 0;
  // The first alone.
  virtual void differentiateOnce(const Path& path, Gradient& result) const = 0;
  virtual int maxLength() const = 0;
  // The coordinates that every state has besides its technique's. Derivatives have those that the path depends on.
  virtual SharedCoordinates shared() const { return {}; }
};

// A target on the paths of a scene: a function of what a path contributes, and where. A target that changes another one
// (tempers it, restricts it) derives from this too and asks the other for its value.
class PathTarget : public Target {
 public:
  // Keeps a reference.
  PathTarget(const Scene& scene, int maxLength) : scene_(scene), maxLength_(maxLength) {}

  // >= 0; positive only where the contribution's luminance is.
  virtual double value(const Technique& technique, const Rgbf& contribution, float filmX,
                       float filmY) const = 0;

  // For mutations that trace paths in parts, after joinSubpaths: sets path.target. Returns whether it is positive.
  bool weigh(Path& path) const {
    path.target =
        static_cast<float>(value(path.technique, path.contribution, path.filmX, path.filmY));
    return path.target > 0;
  }
  // Of what a connection contributes.
  double of(const BidirectionalSampler::Connection& c) const {
    return value(c.technique, c.contribution, c.filmX, c.filmY);
  }
  bool evaluate(Path& path) const final { return tracePath(scene_, path) && weigh(path); }
  // Of the luminance alone.
  void differentiate(const Path& path, Derivative& result) const override {
    h2mc::differentiate(scene_, path, result);
  }
  void differentiateOnce(const Path& path, Gradient& result) const override {
    h2mc::differentiateOnce(scene_, path, result);
  }
  int maxLength() const final { return maxLength_; }
  SharedCoordinates shared() const final { return scene_.shared(); }
  const Scene& scene() const { return scene_; }

 private:
  const Scene& scene_;
  int maxLength_;
};

// The luminance of a scene's MIS-weighted contribution, times the film's importance there. Its derivatives leave the
// importance out, which varies little within a proposal's reach.
class SceneTarget final : public PathTarget {
 public:
  // Keeps references; the map may change between a chain's steps, whose state must then be evaluated again.
  SceneTarget(const Scene& scene, int maxLength, const ImportanceMap& importance)
      : PathTarget(scene, maxLength), importance_(importance) {}
  double value(const Technique&, const Rgbf& contribution, float filmX,
               float filmY) const override {
    return double(luminance(contribution)) * importance_(filmX, filmY);
  }

 private:
  const ImportanceMap& importance_;
};

}  // namespace h2mc
