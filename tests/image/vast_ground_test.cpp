// SPDX-License-Identifier: MIT
// Small things on a tilted ground of 10 km look as they do on one of half a metre in the same plane.
#include "vast_ground.h"

#include "image_check.h"
#include "scene_files.h"

namespace h2mc::test {
namespace {

std::string text(const Vec3f& p) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, "%.9g, %.9g, %.9g", double(p.x), double(p.y), double(p.z));
  return buffer;
}

std::string objOf(const Shape& shape) {
  const auto& mesh = std::get<TriangleMesh>(shape.geometry);
  std::string lines;
  for (const Vec3f& p : mesh.positions) {
    std::string line = text(p);
    std::erase(line, ',');
    lines += "v " + line + "\n";
  }
  for (const glm::uvec3& t : mesh.triangles)
    lines += "f " + std::to_string(t.x + 1) + " " + std::to_string(t.y + 1) + " " +
             std::to_string(t.z + 1) + "\n";
  return lines;
}

// The same random numbers make the same paths, but for rounding.
std::vector<double> picture(const testing::SceneFolder& folder, const VastGround& world,
                            const Shape& ground) {
  std::string shapes;
  const auto add = [&](const char* name, const Shape& shape, const std::string& inside) {
    folder.write(std::string(name) + ".obj", objOf(shape));
    shapes += std::string("<shape type=\"obj\"><string name=\"filename\" value=\"") + name +
              ".obj\"/>" + inside + "</shape>\n";
  };
  const auto diffuse = [](const char* color) {
    return std::string(
               "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
               "value=\"") +
           color + "\"/></bsdf></bsdf>";
  };
  add("ground", ground, diffuse("0.6"));
  add("card", world.card(-0.005, 0, 1e-4, 0.004), diffuse("0.8, 0.2, 0.2"));
  add("high card", world.card(-0.005, -0.01, 1e-3, 0.002), diffuse("0.2, 0.3, 0.8"));
  add("box", world.box(0.002, -0.003, 1e-3), diffuse("0.3, 0.7, 0.3"));
  Shape lamp = world.card(0.01, 0.01, 0.03, 0.004);
  for (glm::uvec3& t : std::get<TriangleMesh>(lamp.geometry).triangles) std::swap(t.y, t.z);
  add("lamp", lamp,
      diffuse("0") + "<emitter type=\"area\"><rgb name=\"radiance\" value=\"20\"/></emitter>");
  const std::string scene =
      "<scene version=\"0.6.0\"><integrator type=\"path\"><integer name=\"maxDepth\" value=\"3\"/>"
      "</integrator><sensor type=\"perspective\"><transform name=\"toWorld\"><lookat origin=\"" +
      text(world.at(0.002, -0.03, 0.008)) + "\" target=\"" + text(world.at(-0.002, 0, 0)) +
      "\" up=\"" + text(world.along(0, 0, 1)) +
      "\"/></transform><float name=\"fov\" value=\"35\"/><float name=\"nearClip\" value=\"1e-3\"/>"
      "<film type=\"hdrfilm\"><integer name=\"width\" value=\"64\"/>"
      "<integer name=\"height\" value=\"48\"/><rfilter type=\"box\"/></film></sensor>" +
      shapes + "</scene>";
  return renderRuns(readTestScene(folder.write("scene.xml", scene)), "path", {}, 1, 256, 4)
      .blocks[0];
}

TEST(VastGround, LooksLikeASmallOne) {
  const testing::SceneFolder folder;
  const VastGround world;
  const std::vector<double> vast = picture(folder, world, world.ground());
  const std::vector<double> small = picture(folder, world, world.card(0, 0, 0, 0.25));
  ASSERT_EQ(vast.size(), small.size());
  double worst = 0;
  for (std::size_t k = 0; k < vast.size(); ++k) {
    // The lamp's dark side may fill a block.
    if (small[k] > 0)
      worst = std::max(worst, std::abs(vast[k] / small[k] - 1));
    else
      EXPECT_EQ(vast[k], 0);
  }
  std::printf("blocks of 4 x 4 pixels differ by %.2g or less\n", worst);
  EXPECT_LT(worst, 0.02);
  EXPECT_NEAR(vast.back(), small.back(), 1e-3 * small.back());
}

}  // namespace
}  // namespace h2mc::test
