// SPDX-License-Identifier: MIT
// A card between eye and near plane: no technique may see it.
#include "clip_scenes.h"
#include "image_check.h"
#include "scene_files.h"

namespace h2mc::test {
namespace {

TEST(CameraClip, IntegratorsAgreeAboutACardBeforeTheNearPlane) {
  constexpr int kEdge = 8, kRuns = 16;
  const testing::SceneFolder folder;
  for (const bool moving : {false, true}) {
    const Scene scene = readTestScene(folder.write("card.xml", cardScene(moving)));
    const Runs trusted = renderRuns(scene, "path", {}, kRuns, 48, kEdge);
    std::vector<double> mean, variance;
    for (std::size_t k = 0; k < trusted.size(); ++k) {
      mean.push_back(trusted.mean(k));
      variance.push_back(trusted.variance(k));
    }
    const std::string what = moving ? "moving camera: " : "camera at rest: ";
    expectAgreement(renderRuns(scene, "bdpt", {}, kRuns, 24, kEdge), mean, variance, 1.5e-2,
                    what + "bdpt");
    const std::vector<std::pair<std::string, std::string>> chains{
        {"bootstrapSamples", "20000"}, {"directSamples", "24"}, {"chains", "64"}};
    for (const char* integrator : {"mmlt", "h2mc"})
      expectAgreement(renderRuns(scene, integrator, chains, kRuns, 12, kEdge), mean, variance, 3e-2,
                      what + integrator);
  }
}

}  // namespace
}  // namespace h2mc::test
