// SPDX-License-Identifier: MIT
// Photon mapping: a caustic that nothing else sees against its formula, with the bias that theory says; against
// bidirectional path tracing on scenes that have everything.
#include <algorithm>
#include <cmath>

#include "exactness_scenes.h"
#include "image_check.h"
#include "scene_files.h"

namespace h2mc::test {
namespace {

using Options = std::vector<std::pair<std::string, std::string>>;

RenderResult render(const Scene& scene, const std::string& integrator, const Options& options,
                    long long passes, std::uint64_t seed = 1) {
  for (const IntegratorFactory& factory : allIntegrators()) {
    if (factory.plugin.name != integrator) continue;
    OptionSet set(factory.plugin);
    for (const auto& [name, text] : options) set.set(name, text);
    RenderRequest request;
    request.budget.samplesPerPixel = passes;
    request.seed = seed;
    return factory.create(set)->render(scene, request);
  }
  throw std::runtime_error("no such integrator");
}

// A floor of reflectance 0.5 at y = 0, a mirror above it at y = 4, a point light of intensity 10 at y = 3, seen by a
// camera that looks straight up into the mirror: light, mirror, floor, mirror, camera. The mirror makes a second light
// at y = 5, so the floor has the irradiance 10 * 5 / (x^2 + z^2 + 5^2)^1.5 by way of the mirror; within a disk of
// radius r around (0, 0) that is in the mean 10 / 25 * 2 / R^2 * (1 - 1 / sqrt(1 + R^2)), R = r / 5.
constexpr double kHeight = 5, kDistance = 7;  // of the camera to the floor by way of the mirror
std::string mirrorScene() {
  return R"(<scene version="0.6.0"><sensor type="perspective"><float name="fov" value="3"/>
  <transform name="toWorld"><lookat origin="0, 1, 0" target="0, 2, 0" up="0, 0, 1"/></transform>
  <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/>
    <rfilter type="box"/></film></sensor>
<shape type="rectangle"><transform name="toWorld"><scale value="30"/><rotate x="1" angle="-90"/></transform>
  <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></shape>
<shape type="rectangle"><transform name="toWorld"><scale value="12"/><rotate x="1" angle="90"/>
    <translate y="4"/></transform>
  <bsdf type="conductor"><string name="material" value="none"/></bsdf></shape>
<emitter type="point"><point name="position" x="0" y="3" z="0"/><rgb name="intensity" value="10"/></emitter>
</scene>)";
}
double meanOfDisk(double radius) {
  const double r2 = (radius / kHeight) * (radius / kHeight);
  const double irradiance = 10 / (kHeight * kHeight) * 2 / r2 * (1 - 1 / std::sqrt(1 + r2));
  return 0.5 / std::numbers::pi * irradiance;
}
Options mirrorOptions(const Scene& scene, double radius, double alpha) {
  const double pixel = kDistance * std::sqrt(double(scene.camera.filmArea())) / 8;
  return {{"minDepth", "4"},
          {"maxDepth", "4"},
          {"photons", "30000"},
          {"radius", std::to_string(radius / pixel)},
          {"alpha", std::to_string(alpha)}};
}

TEST(PhotonMapping, SeesTheCausticOfAPointLightInAMirrorWithTheBiasOfItsRadius) {
  const testing::SceneFolder folder;
  const Scene scene = readTestScene(folder.write("scene.xml", mirrorScene()));
  EXPECT_EQ(render(scene, "bdpt", {{"minDepth", "4"}, {"maxDepth", "4"}}, 16).meanLuminance, 0);
  const double exact = 0.5 / std::numbers::pi * 10 / (kHeight * kHeight);
  for (const double radius : {4., 2., 1.}) {
    const RenderResult result = render(scene, "photon", mirrorOptions(scene, radius, 1), 60);
    const double error = result.meanLuminanceError;
    std::printf("radius %g: %.6f +- %.6f, by theory %.6f, without bias %.6f\n", radius,
                result.meanLuminance, error, meanOfDisk(radius), exact);
    EXPECT_LT(error, 0.01 * exact);
    // The picture shows no more than 0.19 around the middle: what it sees is within 3e-3 of that there.
    EXPECT_NEAR(result.meanLuminance, meanOfDisk(radius), 4 * error + 3e-3 * exact) << radius;
  }
}

// Radii shrink as alpha says: the mean of all passes has the mean of their biases.
TEST(PhotonMapping, RadiiShrinkFromPassToPass) {
  const testing::SceneFolder folder;
  const Scene scene = readTestScene(folder.write("scene.xml", mirrorScene()));
  constexpr double kAlpha = 0.3, kRadius = 10;
  constexpr int kPasses = 80;
  double expected = 0, squared = kRadius * kRadius;
  for (int n = 1; n <= kPasses; ++n) {
    expected += meanOfDisk(std::sqrt(squared)) / kPasses;
    squared *= (n + kAlpha) / (n + 1);
  }
  const RenderResult result =
      render(scene, "photon", mirrorOptions(scene, kRadius, kAlpha), kPasses);
  std::printf("%.6f +- %.6f, by theory %.6f, with the first radius %.6f\n", result.meanLuminance,
              result.meanLuminanceError, expected, meanOfDisk(kRadius));
  EXPECT_NEAR(result.meanLuminance, expected, 4 * result.meanLuminanceError + 3e-3 * expected);
}

// Many bounces: the radiance is 0.5 everywhere, whatever the path's length; only edges are darker.
TEST(PhotonMapping, FurnaceIsEven) {
  const Scene scene =
      readTestScene(std::string(H2MC_SOURCE_DIR) + "/scenes/furnace/furnace.xml", 24, 18);
  const RenderResult result = render(scene, "photon", {{"radius", "0.3"}}, 150);
  std::printf("furnace: %.5f +- %.5f\n", result.meanLuminance, result.meanLuminanceError);
  EXPECT_NEAR(result.meanLuminance, 0.5, 0.006 + 3 * result.meanLuminanceError);
  EXPECT_LT(result.meanLuminanceError, 0.004);
}

class PhotonMappingIn : public ::testing::TestWithParam<ExactnessScene> {};

// Beams, masks, motion, lenses, environments, every kind of surface. Two percent are left to the bias.
TEST_P(PhotonMappingIn, AgreesWithBidirectionalPathTracing) {
  constexpr int kEdge = 4, kRuns = 16;
  const testing::SceneFolder folder;
  const Scene scene = readTestScene(folder.write("scene.xml", GetParam().xml));
  const std::string depth = std::to_string(GetParam().maxLength);
  const Runs trusted = renderRuns(scene, "bdpt", {{"maxDepth", depth}}, kRuns, 150, kEdge);
  const Runs photon = renderRuns(scene, "photon",
                                 {{"maxDepth", depth},
                                  {"photons", "4000"},
                                  {"radius", "0.35"},
                                  {"narrowLobe", "0.6"},
                                  {"alpha", "1"}},
                                 kRuns, 60, kEdge);
  const std::size_t whole = trusted.size() - 1;
  for (std::size_t k = 0; k <= whole; ++k) {
    const double reference = trusted.mean(k), mean = trusted.mean(whole);
    const double sigma = std::sqrt(trusted.variance(k) + photon.variance(k));
    const double allowed = k == whole ? 0.02 * reference : 0.05 * reference + 0.01 * mean;
    EXPECT_NEAR(photon.mean(k), reference, allowed + 5 * sigma) << GetParam().name << " " << k;
    if (k < whole) continue;
    EXPECT_LT(sigma, 0.01 * reference);
    std::printf("%s: %.5f of %.5f (%+.2f %%), standard error %.2f %%\n", GetParam().name,
                photon.mean(k), reference, 100 * (photon.mean(k) / reference - 1),
                100 * sigma / reference);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, PhotonMappingIn, ::testing::ValuesIn(exactnessScenes()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace h2mc::test
