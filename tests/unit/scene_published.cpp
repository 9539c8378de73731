// SPDX-License-Identifier: MIT
// The published scenes load as they are.
#include <gtest/gtest.h>

#include <filesystem>

#include "render/geometry/ray_tracer.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

std::string published(const std::string& name) {
  return (std::filesystem::path(H2MC_DATA_DIR) / name).string();
}

#define SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "not there: " << (path)

TEST(ScenePublished, Torus) {
  const std::string path = published("torus/torus.xml");
  SKIP_WITHOUT(path);
  ReadOptions options;
  options.integrators = testIntegrators();
  const Scene scene = readScene(path, options);
  EXPECT_EQ(scene.shapes.size(), 5u);
  EXPECT_EQ(scene.materials.size(), 4u);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.environment, 0);
  EXPECT_EQ(scene.film.width, 1024);
  EXPECT_EQ(scene.film.height, 768);
  EXPECT_EQ(scene.film.filter.kind, Filter::Kind::kBox);
  EXPECT_EQ(scene.integrator.integrator(), "h2mc");
  EXPECT_EQ(scene.integrator.integer("maxDepth"), 8);
  EXPECT_EQ(scene.samplesPerPixel, 64);
  // The camera sees something straight ahead.
  const PrimitiveId hit =
      scene.tracer->intersect({scene.camera.position()}, scene.camera.forward());
  EXPECT_TRUE(hit.valid());
  for (const Shape& shape : scene.shapes) {
    const auto& mesh = std::get<TriangleMesh>(shape.geometry);
    EXPECT_GT(mesh.triangles.size(), 0u);
    EXPECT_EQ(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size(), true);
  }
}

TEST(ScenePublished, SlowBathroom) {
  const std::string path = published("bathroom/bathroom.xml");
  SKIP_WITHOUT(path);
  ReadOptions options;
  options.integrators = testIntegrators();
  options.defines = {{"width", "256"}, {"height", "128"}};
  const Scene scene = readScene(path, options);
  EXPECT_EQ(scene.shapes.size(), 851u);
  EXPECT_EQ(scene.lights.size(), 5u);
  EXPECT_EQ(scene.film.width, 256);
  EXPECT_EQ(scene.film.height, 128);
  EXPECT_TRUE(scene.integrator.integrator().empty());
}

TEST(ScenePublished, Crosscheck) {
  const std::string path = published("crosscheck");
  SKIP_WITHOUT(path);
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.path().extension() != ".xml") continue;
    ReadOptions options;
    options.integrators = testIntegrators();
    const Scene scene = readScene(entry.path().string(), options);
    EXPECT_EQ(scene.moving, entry.path().stem() == "motion_translate");
    EXPECT_EQ(scene.integrator.integrator(), "path");
    EXPECT_EQ(scene.film.width, 96);
    EXPECT_GE(scene.integrator.integer("maxDepth"), 6);
  }
}

}  // namespace
}  // namespace h2mc::testing
