// SPDX-License-Identifier: MIT
// Scenes at the edge of what numbers can hold, looked at as `h2mc stress` looks at a user's.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "check/stress/stress.h"
#include "image_check.h"
#include "render/scene/document_edit.h"
#include "scene_files.h"

namespace h2mc::test {

// What is demanded of a scene besides that every contribution and every pixel is finite and that
// h2mc's pictures are bdpt's. The latter has a chance of 1 in 1700 to fail without a reason
// (PictureComparison); seeds are fixed, so it either always does or never.
struct Demands {
  // The largest share of paths, and of derivatives in chains, that may fall back to the prior: none of
  // so few paths, one of a thousand in chains, which meet rarer ones.
  double fallbackShare = 1e-3;
  bool resolved = true;  // the pictures have to be good enough to be compared
};

inline StressSettings quickStress() {
  StressSettings settings;
  settings.paths = 60;
  settings.samples = 16000;
  settings.maxLength = 5;
  settings.seed = 7;
  return settings;
}

inline StressFindings expectSound(const Scene& scene, const std::string& what,
                                  const Demands& demands = {},
                                  const StressSettings& settings = quickStress()) {
  const StressFindings f = stressScene(scene, settings);
  EXPECT_EQ(f.notFinite, 0) << what << ": " << f.firstNotFinite;
  EXPECT_LE(f.fallbackShare(), demands.fallbackShare) << what << ": " << f.firstFallback;
  EXPECT_LE(f.chainFallbackShare(), demands.fallbackShare) << what;
  EXPECT_GT(f.paths, settings.paths / 4) << what;
  const PictureComparison& p = f.pictures;
  EXPECT_EQ(p.brokenPixels, 0) << what;
  EXPECT_FALSE(p.disagrees()) << what << ": " << p.h2mc.mean << " and " << p.bdpt.mean << ", z "
                              << p.z;
  if (demands.resolved && p.made) {
    EXPECT_TRUE(p.resolved) << what << ": " << p.h2mc.error / p.h2mc.mean << " and "
                            << p.bdpt.error / p.bdpt.mean;
  }
  std::printf(
      "%-36s %4lld paths, fallback %.2f %% %.2f %%, worst of float: value %.1e gradient %.1e "
      "Hessian %.1e, mean %.4g %.4g z %.1f\n",
      what.c_str(), f.paths, 100 * f.fallbackShare(), 100 * f.chainFallbackShare(), f.value.worst,
      f.gradient.worst, f.hessian.worst, p.h2mc.mean, p.bdpt.mean, p.z);
  return f;
}

// A scene of the text, read after `change` has been at it.
template <class Change>
Scene changedScene(const testing::SceneFolder& folder, const std::string& text, Change&& change) {
  const auto document = loadSceneDocument(folder.write("scene.xml", text), {});
  change(*document);
  ReadOptions options;
  options.integrators = testing::testIntegrators();
  return makeScene(*document, options);
}
inline Scene sceneOf(const testing::SceneFolder& folder, const std::string& text) {
  return changedScene(folder, text, [](SceneDocument&) {});
}

// The pieces of small scenes.

inline std::string camera(const std::string& origin, const std::string& target, double fov = 40) {
  return "<sensor type=\"perspective\"><float name=\"fov\" value=\"" + std::to_string(fov) +
         "\"/><transform name=\"toWorld\"><lookat origin=\"" + origin + "\" target=\"" + target +
         "\" up=\"0, 1, 0\"/></transform><film type=\"hdrfilm\"><integer name=\"width\" "
         "value=\"16\"/><integer name=\"height\" value=\"12\"/><rfilter type=\"box\"/></film>"
         "</sensor>\n";
}

inline std::string shape(const std::string& type, const std::string& transform,
                         const std::string& inside) {
  return "<shape type=\"" + type + "\"><transform name=\"toWorld\">" + transform + "</transform>" +
         inside + "</shape>\n";
}

inline std::string diffuse(double reflectance) {
  return "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"" + std::to_string(reflectance) +
         "\"/></bsdf>";
}

inline std::string emitter(const std::string& radiance) {
  return "<emitter type=\"area\"><rgb name=\"radiance\" value=\"" + radiance + "\"/></emitter>";
}

// A floor of 8 x 8 at y = 0.
inline std::string floorOf(const std::string& bsdf) {
  return shape("rectangle", "<scale value=\"4\"/><rotate x=\"1\" angle=\"-90\"/>", bsdf);
}

// A lamp of 2 x 2 at y = 3 that shines down.
inline std::string lamp() {
  return shape("rectangle", "<rotate x=\"1\" angle=\"90\"/><translate y=\"3\"/>",
               diffuse(0.3) + emitter("5, 4, 3"));
}

inline std::string sceneText(const std::string& parts) {
  return "<scene version=\"0.6.0\">\n" + parts + "</scene>\n";
}

// A ball of some material on a grey floor under the lamp.
inline std::string ballScene(const std::string& bsdf) {
  return sceneText(camera("0, 1.5, 5", "0, 0.8, 0") + floorOf(diffuse(0.5)) + lamp() +
                   shape("sphere", "<scale value=\"0.7\"/><translate y=\"0.75\"/>", bsdf));
}

}  // namespace h2mc::test
