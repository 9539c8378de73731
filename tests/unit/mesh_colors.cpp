// SPDX-License-Identifier: MIT
// Colours of a mesh's vertices: which texture coordinates stand for them, and what scene files make of them.
#include <gtest/gtest.h>

#include "ad/dual.h"
#include "render/bsdf/material.h"
#include "render/core/index.h"
#include "render/geometry/tangents.h"
#include "render/image/color_encoding.h"
#include "scene_files.h"

namespace h2mc {
namespace {

using testing::SceneFolder;

TEST(MeshPlace, RemembersTriangleAndPoint) {
  for (const std::size_t count : {1u, 2u, 3u, 1000u, 1000000u, 30000000u}) {
    const std::uint32_t columns = MeshPlace::columnsFor(count);
    const float tolerance = static_cast<float>(columns) * 0x1p-22f;
    for (const std::size_t part : {0u, 1u, 2u, 3u}) {
      const auto triangle = static_cast<std::uint32_t>((count - 1) * part / 3);
      for (const float b1 : {0.f, -1e-6f, 0.3f, 1.000001f})
        for (const float b2 : {0.f, -1e-6f, 0.7f, 1.f}) {
          const Vec2f place = MeshPlace::of(triangle, columns, b1, b2);
          const MeshPlace at(place, columns, count);
          ASSERT_EQ(at.triangle, triangle) << count;
          ASSERT_NEAR(at.b1(place), b1, tolerance);
          ASSERT_NEAR(at.b2(place), b2, tolerance);
        }
    }
  }
  for (const Vec2f& nowhere : {Vec2f(-1, 0), Vec2f(0, 1e9f), Vec2f(NAN, 0), Vec2f(3, 3)})
    EXPECT_EQ(MeshPlace(nowhere, 2, 3).triangle, 0u);
}

// Two triangles; `properties` of colours behind the corners' places and texture coordinates.
std::string ply(const std::string& properties, const std::vector<std::string>& colors) {
  const char* const corners[] = {"0 0 0 0 0", "2 0 0 1 0", "2 1 0 1 1", "0 1 0 0 1"};
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nproperty float u\nproperty float v\n" +
      properties + "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < 4; ++i) text += std::string(corners[i]) + " " + colors[i] + "\n";
  return text + "3 0 1 2\n3 2 3 0\n";
}
std::string named(const std::string& type, const char* r, const char* g, const char* b) {
  std::string text;
  for (const char* name : {r, g, b}) text += "property " + type + " " + name + "\n";
  return text;
}
const std::vector<std::string> kFloats = {"0.5 0 0.25", "0 1 0.25", "0 0 0.25", "0.25 0.5 0.25"};
std::string floats() { return ply(named("float", "r", "g", "b"), kFloats); }

std::string mesh(const std::string& inside) {
  return R"(<shape type="ply"><string name="filename" value="m.ply"/>)" + inside + "</shape>";
}
constexpr const char* kColored =
    R"(<bsdf type="diffuse"><texture type="vertexcolors" name="reflectance"/></bsdf>)";

class MeshColors : public ::testing::Test {
 protected:
  Scene read(const std::string& text, const std::string& file = floats()) {
    folder_.write("m.ply", file);
    return folder_.read(text);
  }
  // The reflectance of shape 0 at coordinates of its first triangle, of its own.
  template <class T>
  Rgb<T> reflectance(const Scene& scene, const T& u0, const T& u1, const T* time = nullptr) {
    const SurfacePoint<T> point = samplePrimitive<T>(scene.shapes, {0, 0}, u0, u1, time);
    const Material& material = scene.materials[at(scene.shapes[0].material)];
    const auto& bsdf = std::get<Diffuse>(scene.bsdfs[at(material.front)]);
    return evaluate<T>(*bsdf.reflectance, point.uv);
  }
  // Of corner i of the first triangle.
  Rgbf corner(const Scene& scene, int i) {
    const float one = std::nextafter(1.f, 0.f);
    return i == 0   ? reflectance(scene, 0.f, 0.f)
           : i == 1 ? reflectance(scene, one, 0.f)
                    : reflectance(scene, 0.f, one);
  }
  void expectCorners(const Scene& scene, const std::vector<Rgbf>& colors) {
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(corner(scene, i)[k], colors[at(i)][k], 1e-3) << i;
  }
  SceneFolder folder_;
};

TEST_F(MeshColors, AreLinearOverTriangles) {
  const Scene scene = read(testing::modern(testing::sceneWith(mesh(kColored))));
  expectCorners(scene, {{0.5f, 0, 0.25f}, {0, 1, 0.25f}, {0, 0, 0.25f}});
  // b1 = 1 - sqrt(1 - u0), b2 = u1 sqrt(1 - u0), and derivatives by u1.
  using D = ad::Dual2<double, 2>;
  const D u0 = D::variable(0.36, 0), u1 = D::variable(0.5, 1);
  const Rgb<D> c = reflectance<D>(scene, u0, u1);
  EXPECT_NEAR(c.x.v, 0.5 * 0.4, 1e-6);
  EXPECT_NEAR(c.y.v, 0.2, 1e-6);
  EXPECT_NEAR(c.z.v, 0.25, 1e-6);
  EXPECT_NEAR(c.x.gradient(1), -0.5 * 0.8, 1e-6);
  EXPECT_NEAR(c.y.gradient(0), 0.5 / 0.8, 1e-6);
  const Material& material = scene.materials[at(scene.shapes[0].material)];
  const auto& bsdf = std::get<Diffuse>(scene.bsdfs[at(material.front)]);
  EXPECT_EQ(maximum(*bsdf.reflectance), Rgbf(0.5f, 1, 0.25f));
  EXPECT_NEAR(average(*bsdf.reflectance).x, (0.5 + 0.5 + 0.25) / 6, 1e-6);
}

TEST_F(MeshColors, AreSrgbByVersionTypeAndParameter) {
  const auto first = [&](const std::string& text, const std::string& file) {
    return corner(read(text, file), 0).x;
  };
  const std::string old = testing::sceneWith(mesh(kColored)), recent = testing::modern(old);
  const std::string linear =
      testing::sceneWith(mesh(std::string(R"(<boolean name="srgb" value="false"/>)") + kColored));
  const std::vector<std::string> integers(4, "128 128 128");
  for (const auto& file :
       {ply(named("uchar", "red", "green", "blue"), integers),
        ply(named("uint8", "diffuse_red", "diffuse_green", "diffuse_blue"), integers)}) {
    EXPECT_NEAR(first(old, file), srgbToLinear(128 / 255.f), 1e-4);
    EXPECT_NEAR(first(recent, file), srgbToLinear(128 / 255.f), 1e-4);
    EXPECT_NEAR(first(linear, file), 128 / 255.f, 1e-4);
  }
  EXPECT_NEAR(first(old, floats()), srgbToLinear(0.5f), 1e-4);
  EXPECT_NEAR(first(recent, floats()), 0.5f, 1e-4);
  EXPECT_NEAR(first(linear, ply(named("double", "color_r", "color_g", "color_b"), kFloats)), 0.5f,
              1e-4);
}

TEST_F(MeshColors, OtherTexturesAndTangentsKeepTheMeshsCoordinates) {
  // A checkerboard of white and black times the colours: black where u > 1/2.
  const std::string board =
      R"(<texture type="checkerboard" name="scale"><rgb name="color0" value="1"/>
         <rgb name="color1" value="0"/></texture>)";
  const Scene scene = read(testing::modern(testing::sceneWith(mesh(
      R"(<bsdf type="diffuse"><texture type="scale" name="reflectance">
         <texture type="mesh_attribute" name="texture"><string name="name" value="vertex_color"/>
         <float name="scale" value="0.5"/></texture>)" +
      board + "</texture></bsdf>"))));
  const float one = std::nextafter(1.f, 0.f);
  EXPECT_NEAR(reflectance(scene, 0.f, 0.f).x, 0.25f, 1e-4);
  EXPECT_NEAR(reflectance(scene, 0.5f, 0.f).y, 0.5f * (1 - std::sqrt(0.5f)), 1e-4);
  EXPECT_NEAR(reflectance(scene, 0.9f, 0.f).y, 0, 1e-6);
  EXPECT_NEAR(reflectance(scene, one, 0.f).y, 0, 1e-6);
  const SurfacePoint<float> point = samplePrimitive<float>(scene.shapes, {0, 0}, 0.3f, 0.4f);
  const Tangents<float> tangents = tangentsOnPrimitive<float>(scene.shapes, {0, 0}, point);
  EXPECT_NEAR(tangents.u.x, 2, 1e-6);
  EXPECT_NEAR(tangents.v.y, 1, 1e-6);
}

TEST_F(MeshColors, OfOneBsdfOnSeveralMeshes) {
  folder_.write("n.ply", ply(named("float", "r", "g", "b"), std::vector<std::string>(4, "0 0 1")));
  const Scene scene = read(testing::modern(
      testing::sceneWith(R"(<bsdf id="b" type="twosided">)" + std::string(kColored) + "</bsdf>" +
                         mesh(R"(<ref id="b"/>)") +
                         R"(<shape type="ply"><string name="filename" value="n.ply"/>
                                                 <ref id="b"/></shape>)")));
  expectCorners(scene, {{0.5f, 0, 0.25f}, {0, 1, 0.25f}, {0, 0, 0.25f}});
  const Material& second = scene.materials[at(scene.shapes[1].material)];
  const auto& bsdf = std::get<Diffuse>(scene.bsdfs[at(second.front)]);
  EXPECT_EQ(maximum(*bsdf.reflectance), Rgbf(0, 0, 1));
}

TEST_F(MeshColors, OfInstancesAndMovingMeshes) {
  const std::vector<Rgbf> colors = {{0.5f, 0, 0.25f}, {0, 1, 0.25f}, {0, 0, 0.25f}};
  const std::string group = "<shape type=\"shapegroup\" id=\"g\">" + mesh(kColored) + "</shape>";
  const auto instance = [&](const std::string& where) {
    return testing::modern(
        testing::sceneWith(group + R"(<shape type="instance"><ref id="g"/>)" + where + "</shape>"));
  };
  expectCorners(read(instance("")), colors);
  // Corners 1 and 2 change places, with their colours.
  expectCorners(read(instance(R"(<transform name="toWorld"><scale x="-1"/></transform>)")),
                {colors[0], colors[2], colors[1]});
  const std::string moves =
      R"(<animation name="toWorld"><transform time="0"/><transform time="1"><translate y="1"/></transform>
         </animation>)";
  const auto open = [](std::string text) {
    const std::string camera = R"(<sensor type="perspective">)";
    return text.insert(text.find(camera) + camera.size(),
                       R"(<float name="shutterClose" value="1"/>)");
  };
  for (const std::string& text :
       {instance(moves), testing::modern(testing::sceneWith(mesh(moves + kColored))),
        testing::modern(
            testing::sceneWith(R"(<shape type="deforming">)" + mesh("") +
                               mesh(R"(<transform name="toWorld"><translate y="1"/></transform>)") +
                               kColored + "</shape>"))}) {
    const Scene scene = read(open(text));
    ASSERT_TRUE(scene.shapes[0].moves()) << text;
    const float time = 0.5f;
    EXPECT_NEAR(reflectance(scene, 0.36f, 0.5f, &time).y, 0.2f, 1e-4);
  }
}

TEST_F(MeshColors, LampsHaveThemToo) {
  const Scene scene = read(testing::modern(testing::sceneWith(
      mesh(R"(<emitter type="area"><texture type="vertexcolors" name="radiance"/></emitter>)"))));
  const auto& light = std::get<AreaLight>(scene.lights[at(scene.shapes[0].light)]);
  EXPECT_EQ(maximum(*light.radiance), Rgbf(0.5f, 1, 0.25f));
}

TEST_F(MeshColors, Mistakes) {
  folder_.write("m.ply", floats());
  const auto error = [&](const std::string& shape) {
    return folder_.error(testing::modern(testing::sceneWith(shape)));
  };
  const auto expect = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect(error("<shape type=\"sphere\">" + std::string(kColored) + "</shape>"),
         "scene.xml:2:44: error: texture \"vertexcolors\": what it is on has no vertex colours");
  expect(error(mesh(R"(<bsdf type="diffuse"><texture type="mesh_attribute" name="reflectance">
                       <string name="name" value="face_color"/></texture></bsdf>)")),
         "the attribute \"face_color\" is not supported");
  folder_.write("m.ply",
                ply(named("float", "r", "g", "b"), std::vector<std::string>(4, "-1 0 0.5")));
  expect(error(mesh(kColored)), "4 vertex colours of the mesh are negative");
  folder_.write("m.ply",
                ply(named("float", "r", "g", "b"), std::vector<std::string>(4, "nan 0 0.5")));
  expect(error(mesh(kColored)), "\"nan\" is not a finite number");
}

}  // namespace
}  // namespace h2mc
