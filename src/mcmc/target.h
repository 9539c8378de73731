// What a chain samples: a non-negative function on the union of all techniques' primary spaces.
#pragma once

#include "mcmc/importance_map.h"
#include "render/path/bidirectional.h"
#include "render/path/derivative.h"
#include "render/path/path.h"

namespace h2mc {

class Target {
 public:
  virtual ~Target() = default;
  // Fills in everything of `path` that follows from its technique and primary sample. Returns
  // path.target > 0.
  virtual bool evaluate(Path& path) const = 0;
  // Derivatives of log(path.target).
  virtual void differentiate(const Path& path, Derivative& result) const = 0;
  virtual int maxLength() const = 0;
  // Whether time is a further coordinate of every state: PrimarySample::time in [0, 1). Derivatives
  // have it as their last coordinate where path.moving.
  virtual bool hasTime() const { return false; }
};

// The luminance of a scene's MIS-weighted contribution, times the film's importance there.
class SceneTarget final : public Target {
 public:
  // Keeps references; the map may change between a chain's steps, whose state must then be evaluated
  // again.
  SceneTarget(const Scene& scene, int maxLength, const ImportanceMap& importance)
      : scene_(scene), maxLength_(maxLength), importance_(importance) {}
  bool evaluate(Path& path) const override { return tracePath(scene_, path) && weigh(path); }
  // For mutations that trace paths in parts: after joinSubpaths. Returns path.target > 0.
  bool weigh(Path& path) const {
    path.target *= importance_(path.filmX, path.filmY);
    return path.target > 0;
  }
  // Of what a connection contributes.
  double target(const BidirectionalSampler::Connection& c) const {
    return double(luminance(c.contribution)) * importance_(c.filmX, c.filmY);
  }
  // Of the luminance alone: the importance varies little within a proposal's reach.
  void differentiate(const Path& path, Derivative& result) const override {
    h2mc::differentiate(scene_, path, result);
  }
  int maxLength() const override { return maxLength_; }
  bool hasTime() const override { return scene_.moving; }
  const Scene& scene() const { return scene_; }

 private:
  const Scene& scene_;
  int maxLength_;
  const ImportanceMap& importance_;
};

}  // namespace h2mc
