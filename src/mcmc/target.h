// What a chain samples: a non-negative function on the union of all techniques' primary spaces.
#pragma once

#include "render/path/derivative.h"
#include "render/path/path.h"

namespace h2mc {

class Target {
 public:
  virtual ~Target() = default;
  // Fills in everything of `path` that follows from its technique and primary sample. Returns
  // path.target > 0.
  virtual bool evaluate(Path& path) const = 0;
  // Derivatives of log(path.target); false where they are not to be had (too many coordinates).
  virtual bool differentiate(const Path& path, Derivative& result) const = 0;
  virtual int maxLength() const = 0;
};

// The luminance of a scene's MIS-weighted contribution.
class SceneTarget final : public Target {
 public:
  SceneTarget(const Scene& scene, int maxLength) : scene_(scene), maxLength_(maxLength) {}
  bool evaluate(Path& path) const override { return tracePath(scene_, path); }
  bool differentiate(const Path& path, Derivative& result) const override {
    return h2mc::differentiate(scene_, path, result);
  }
  int maxLength() const override { return maxLength_; }
  const Scene& scene() const { return scene_; }

 private:
  const Scene& scene_;
  int maxLength_;
};

}  // namespace h2mc
