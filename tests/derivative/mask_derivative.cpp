// SPDX-License-Identifier: MIT
// Paths that go straight on through surfaces that are not opaque: these vertices change nothing, so they cost no
// digits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "check/gradcheck/gradcheck.h"
#include "render/core/index.h"
#include "render/image/image_io.h"
#include "render/path/path_text.h"
#include "render/path/replay.h"
#include "render/path/replay_double.h"
#include "sampled_paths.h"
#include "scene_files.h"

namespace h2mc {
namespace {

enum class What { kCheckers, kColours, kMoving };
void PrintTo(What what, std::ostream* out) { *out << static_cast<int>(what); }

constexpr const char* kCheckers =
    "<texture name=\"opacity\" type=\"checkerboard\"><rgb name=\"color0\" value=\"0.9\"/>"
    "<rgb name=\"color1\" value=\"0.1\"/><float name=\"uscale\" value=\"8\"/>"
    "<float name=\"vscale\" value=\"8\"/></texture>";
// Opacity that varies from point to point, and with colour.
constexpr const char* kColours =
    "<texture name=\"opacity\" type=\"bitmap\"><string name=\"filename\" "
    "value=\"opacity.exr\"/></texture>";

std::string masked(const std::string& opacity) {
  return "<bsdf type=\"mask\">" + opacity +
         "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.7, "
         "0.4, "
         "0.3\"/></bsdf></bsdf></bsdf>";
}

// A sphere that can be seen through above a floor with a lamp; for the others a screen before it and an
// environment too; or all that with the sphere and the screen moving.
std::string sceneText(What what) {
  const bool moves = what == What::kMoving;
  const std::string opacity = what == What::kCheckers ? kCheckers : kColours;
  const auto placed = [&](const std::string& place, const std::string& by) {
    if (!moves) return "<transform name=\"toWorld\">" + place + "</transform>";
    return "<animation name=\"toWorld\"><transform time=\"0\">" + place +
           "</transform><transform time=\"1\">" + place + by + "</transform></animation>";
  };
  std::string text =
      "<scene version=\"0.6.0\"><sensor type=\"perspective\"><transform name=\"toWorld\">"
      "<lookat origin=\"0, 2, 5\" target=\"0, 0.8, 0\" up=\"0, 1, 0\"/></transform>"
      "<float name=\"fov\" value=\"40\"/>";
  if (moves)
    text += "<float name=\"shutterOpen\" value=\"0\"/><float name=\"shutterClose\" value=\"1\"/>";
  text +=
      "<film type=\"hdrfilm\"><integer name=\"width\" value=\"64\"/><integer name=\"height\" "
      "value=\"48\"/><rfilter type=\"box\"/></film></sensor>"
      "<shape type=\"rectangle\"><transform name=\"toWorld\"><rotate x=\"1\" angle=\"-90\"/>"
      "<scale value=\"4\"/></transform><bsdf type=\"diffuse\"/></shape>"
      "<shape type=\"rectangle\"><transform name=\"toWorld\"><rotate x=\"1\" angle=\"90\"/>"
      "<scale value=\"0.7\"/><translate x=\"0.5\" y=\"3\" z=\"0.5\"/></transform>"
      "<emitter type=\"area\"><rgb name=\"radiance\" value=\"8\"/></emitter></shape>"
      "<shape type=\"sphere\">" +
      placed("<scale value=\"0.8\"/><translate y=\"0.9\"/>", "<translate x=\"0.3\" y=\"0.1\"/>") +
      masked(opacity) + "</shape>";
  if (what == What::kCheckers) return text + "</scene>";
  return text + "<shape type=\"rectangle\">" +
         placed("<rotate y=\"1\" angle=\"20\"/><translate y=\"1\" z=\"1.5\"/>",
                "<rotate z=\"1\" angle=\"15\"/>") +
         masked(opacity) +
         "</shape><emitter type=\"constant\"><rgb name=\"radiance\" "
         "value=\"0.3\"/></emitter></scene>";
}

class Masks : public ::testing::TestWithParam<What> {
 protected:
  static constexpr int kMaxLength = 6;

  Masks() {
    Image image(3, 2);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const auto x = static_cast<float>(i) / 5;
      image.pixels[i] = Rgbf(0.2f + 0.5f * x, 0.6f - 0.4f * x, 0.3f + 0.8f * x * (1 - x));
    }
    writeImage(folder_.path() + "opacity.exr", image);
    scene_ = std::make_unique<Scene>(folder_.read(sceneText(GetParam())));
  }

  // How often the path goes straight on.
  static int passed(const Path& path) {
    int count = 0;
    const auto [s, t] = path.technique;
    for (int i = 1; i < t - 1; ++i) count += path.camera[at(i)].lobe.null;
    for (int i = 1; i < s - 1; ++i) count += path.light[at(i)].lobe.null;
    return count;
  }

  testing::SceneFolder folder_;
  std::unique_ptr<Scene> scene_;
};

TEST_P(Masks, SlowCostNoDigits) {
  GradcheckSettings settings;
  settings.paths = GetParam() == What::kCheckers ? 1500 : 600;
  settings.maxLength = kMaxLength;
  settings.threads = 2;
  int through = 0, twice = 0;
  Path path(kMaxLength);
  for (const PathCheck& check : gradcheck(*scene_, settings).paths) {
    path.technique = check.path.technique;
    path.sample = check.path.sample;
    ASSERT_TRUE(check.traced && tracePath(*scene_, path));
    through += passed(path) > 0;
    twice += passed(path) > 1;
    for (std::size_t k = 0; k < settings.forms.size(); ++k)
      EXPECT_NE(check.forms[k].verdict, FormVerdict::kWrong)
          << settings.forms[k].name << ", passes " << passed(path) << " times, Hessian "
          << check.forms[k].hessian << ": " << pathText(path.technique, path.sample);
    EXPECT_EQ(check.wrong, 0) << pathText(path.technique, path.sample);
  }
  std::printf("%d paths go straight on, %d more than once\n", through, twice);
  EXPECT_GT(through, settings.paths / 10);
  EXPECT_GT(twice, settings.paths / 30);
}

// The same ray arrives beyond, and all forms of the path say the same.
TEST_P(Masks, TheRayStaysWhatItIs) {
  int through = 0;
  test::forSampledPaths(*scene_, kMaxLength, 60, 6000, [&](const Path& path, float sampled) {
    EXPECT_EQ(path.target, sampled) << "replayed";
    if (passed(path) == 0) return;
    ++through;
    const auto [s, t] = path.technique;
    const auto expectStraight = [](const TracedVertex& v, const TracedVertex& next) {
      if (!v.lobe.null) return;
      EXPECT_EQ(v.vertex.line.origin, next.vertex.line.origin);
      EXPECT_EQ(v.vertex.line.direction, next.vertex.line.direction);
      EXPECT_EQ(next.vertex.vcm, 0);
    };
    for (int i = 1; i < t - (path.escaped ? 2 : 1); ++i)
      expectStraight(path.camera[at(i)], path.camera[at(i) + 1]);
    for (int i = 1; i < s - 1; ++i) expectStraight(path.light[at(i)], path.light[at(i) + 1]);

    const double traced = std::log(double(path.target));
    const float* time = path.moving ? &path.sample.time : nullptr;
    EXPECT_NEAR(replayLogTarget<float>(*scene_, path, path.sample.u.data(), time), traced, 1e-4);
    double u[kMaxCoordinates];
    pathCoordinates(path, u);
    const auto plain = differentiateInDouble(*scene_, path, u);
    const auto local = differentiateLocallyInDouble(*scene_, path, u);
    if (!plain.finite()) return;
    EXPECT_NEAR(local.value, plain.value, 1e-8);
    double largest = 1, error = 0;
    for (std::size_t k = 0; k < plain.hessian.size(); ++k) {
      largest = std::max(largest, std::abs(plain.hessian[k]));
      error = std::max(error, std::abs(plain.hessian[k] - local.hessian[k]));
    }
    EXPECT_LE(error, 1e-6 * largest) << pathText(path.technique, path.sample);
  });
  EXPECT_GT(through, 100);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Masks,
                         ::testing::Values(What::kCheckers, What::kColours, What::kMoving));

}  // namespace
}  // namespace h2mc
