// SPDX-License-Identifier: MIT
// Derivatives of paths through smooth glass.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "check/gradcheck/form_check.h"
#include "render/path/derivative.h"
#include "render/path/replay_double.h"
#include "sampled_paths.h"
#include "scene_files.h"

namespace h2mc {
namespace {

// Through a smooth sphere twice and more: near the rim the cosines' second derivatives are large at each
// vertex, and cancel. In float alone every hundredth Hessian is off by 1e-3 and more, some by a factor of
// hundreds.
TEST(RefractionDerivative, ThatCancelsAlongThePath) {
  const testing::SceneFolder folder;
  const Scene scene = folder.read(R"(<scene version="0.6.0">
    <sensor type="perspective"><float name="fov" value="35"/>
      <transform name="toWorld"><lookat origin="0, 1.5, 5" target="0, 0.4, 0" up="0, 1, 0"/></transform>
      <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film></sensor>
    <shape type="sphere"><bsdf type="dielectric"/></shape>
    <shape type="rectangle"><transform name="toWorld"><scale value="20"/><rotate x="1" angle="-90"/>
      <translate y="-1"/></transform><bsdf type="diffuse"/></shape>
    <emitter type="constant"/></scene>)");
  constexpr int kLength = 8;
  int refracted = 0, off = 0;
  double worst = 0;
  test::forSampledPaths(scene, kLength, 1500, 20000, [&](const Path& path, float) {
    if (path.technique.length() < 4) return;
    double u[kMaxCoordinates];
    pathCoordinates(path, u);
    const auto exact = differentiateLocallyInDouble(scene, path, u);
    Derivative derivative;
    if (differentiatePlainly(scene, path, derivative)) return;
    ++refracted;
    differentiateLocally(scene, path, derivative);
    ad::DerivativeValues found;
    copyDerivative(derivative, found);
    const FormCheck check = formErrors(found, exact);
    worst = std::max(worst, double(check.hessian));
    off += !(check.hessian <= 1e-3);
  });
  std::printf("%d paths, Hessians of %d off by 1e-3, of one by %.1e\n", refracted, off, worst);
  EXPECT_GT(refracted, 2000);
  EXPECT_LE(off, refracted / 500);
  EXPECT_LE(worst, 0.1);
}

}  // namespace
}  // namespace h2mc
