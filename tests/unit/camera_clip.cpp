// SPDX-License-Identifier: MIT
// The camera sees the same from both ends of its rays: what lies before the near plane hides nothing.
#include <gtest/gtest.h>

#include "clip_scenes.h"
#include "render/core/index.h"
#include "render/core/random.h"
#include "render/path/path.h"
#include "scene_files.h"

namespace h2mc {
namespace {

// Every point that a camera ray finds is seen by the camera, where the ray came from.
void expectSeenFromBothEnds(const Scene& scene) {
  Random random(1, 2, 3);
  int hits = 0, beforeCard = 0, hidden = 0, elsewhere = 0;
  for (int i = 0; i < 4000; ++i) {
    const float u = random.uniform(), v = random.uniform(), time = random.uniform();
    const PathRay<float> ray = startCamera<float>(scene, u, v, &time);
    const PrimitiveId id = nextPrimitive(scene, ray, true, time);
    if (!id.valid()) continue;
    const PathVertex<float> vertex = arriveAt<float>(scene, ray, id, &time);
    // At a grazing angle rounding moves the point along the surface.
    if (vertex.cosIn < 0.05f) continue;
    ++hits;
    beforeCard += nextPrimitive(scene, ray, false, time).shape == 0;
    float filmX = -1, filmY = -1;
    hidden += !cameraVisible(scene, vertex.point, time, {0.5f, 0.5f}, filmX, filmY);
    elsewhere += !(std::abs(filmX - u) < 1e-4f && std::abs(filmY - v) < 1e-4f);
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GT(beforeCard, 500) << "the card is to be in the way";
  EXPECT_LT(beforeCard, hits - 500);
  EXPECT_EQ(hidden, 0);
  EXPECT_EQ(elsewhere, 0);
}

TEST(CameraClip, CardBeforeTheNearPlaneHidesNothing) {
  const testing::SceneFolder folder;
  expectSeenFromBothEnds(folder.read(test::cardScene(false)));
  expectSeenFromBothEnds(folder.read(test::cardScene(true)));
}

// The plane itself, at a corner of the film, where a ray is longer to it than at the middle.
TEST(CameraClip, EndsAtTheNearPlane) {
  const testing::SceneFolder folder;
  for (const double distance : {0.9, 1.1}) {
    const Scene scene = folder.read(test::cardScene(false, distance, 3));
    float filmX, filmY;
    SurfacePoint<float> point;
    for (const float x : {0.f, -1.5f}) {
      // Straight ahead at the middle's height, beyond the card.
      point.p = Vec3f(x, 1, 0);
      point.ng = Vec3f(0, 0, 1);
      EXPECT_EQ(cameraVisible(scene, point, 0, {0.5f, 0.5f}, filmX, filmY), distance < 1) << x;
    }
  }
}

}  // namespace
}  // namespace h2mc
