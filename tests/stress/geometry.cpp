// SPDX-License-Identifier: MIT
// Shapes and views that degenerate.
#include <gtest/gtest.h>

#include "stress_check.h"

namespace h2mc::test {
namespace {

std::string gloss() {
  return "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.1\"/></bsdf>";
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

// A camera just above a floor that it sees edge-on, and one beside a wall.
TEST(Grazing, Camera) {
  const testing::SceneFolder folder;
  for (const double height : {1e-2, 1e-4, 1e-6})
    for (const std::string& bsdf : {diffuse(0.5), gloss()}) {
      const std::string text = sceneText(
          camera("0, " + number(height) + ", 3.5", "0, " + number(height) + ", 0") + floorOf(bsdf) +
          lamp() + shape("rectangle", "<scale value=\"3\"/><translate z=\"-3\"/>", diffuse(0.6)));
      expectSound(sceneOf(folder, text), "camera at height " + number(height), {.resolved = false});
    }
}

// All that is seen is lit at a grazing angle, by a lamp whose middle is in the floor's plane.
TEST(Grazing, Light) {
  const testing::SceneFolder folder;
  for (const double tilt : {1e-2, 1e-4, 1e-6})
    for (const std::string& bsdf : {diffuse(0.5), gloss()}) {
      // Tilted out of the floor's plane by this angle, so that it shines along the floor.
      const std::string text =
          sceneText(camera("-5, 1, 0", "0, 0, 0") + floorOf(bsdf) +
                    shape("rectangle",
                          "<rotate x=\"1\" angle=\"90\"/><rotate z=\"1\" angle=\"" +
                              number(-tilt * 180 / 3.14159265358979) +
                              "\"/><translate x=\"6\" y=\"" + number(2 * tilt) + "\"/>",
                          diffuse(0) + emitter("5")));
      expectSound(sceneOf(folder, text), "lamp at angle " + number(tilt), {.resolved = false});
    }
}

TEST(SmallLights, OfArea1e6th) {
  const testing::SceneFolder folder;
  const std::string rest =
      camera("0, 1.5, 5", "0, 0.8, 0") + floorOf(diffuse(0.5)) +
      shape("sphere", "<scale value=\"0.7\"/><translate y=\"0.75\"/>", gloss());
  expectSound(sceneOf(folder, sceneText(rest + shape("rectangle",
                                                     "<scale value=\"5e-4\"/><rotate x=\"1\" "
                                                     "angle=\"90\"/><translate y=\"3\"/>",
                                                     diffuse(0) + emitter("2e7")))),
              "rectangle of area 1e-6", {.resolved = false});
  expectSound(sceneOf(folder, sceneText(rest + shape("sphere",
                                                     "<scale value=\"2.82e-4\"/><translate "
                                                     "y=\"3\"/>",
                                                     diffuse(0) + emitter("2e7")))),
              "sphere of area 1e-6", {.resolved = false});
  expectSound(sceneOf(folder, sceneText(rest + shape("disk",
                                                     "<scale value=\"5.64e-4\"/><rotate x=\"1\" "
                                                     "angle=\"90\"/><translate y=\"3\"/>",
                                                     diffuse(0) + emitter("2e7")))),
              "disk of area 1e-6", {.resolved = false});
}

std::string obj(const std::string& file, const std::string& bsdf, const std::string& more = "") {
  return "<shape type=\"obj\"><string name=\"filename\" value=\"" + file + "\"/>" + more + bsdf +
         "</shape>\n";
}

// A wall of needles 4 high and 4e-6 wide (two or three of a pixel), beside whole ones.
TEST(Meshes, NeedleTriangles) {
  const testing::SceneFolder folder;
  std::string mesh;
  constexpr int kNeedles = 40;
  for (int i = 0; i < kNeedles; ++i) {
    const double x = -2 + 4.0 * i / kNeedles, next = -2 + 4.0 * (i + 1) / kNeedles;
    // A needle, and a trapezium up to the next one.
    for (const auto& [px, py] :
         {std::pair(x, 0.0), {x + 4e-6, 0.0}, {x + 2e-6, 4.0}, {next, 0.0}, {next, 4.0}})
      mesh += "v " + number(px) + " " + number(py) + " -1\n";
    mesh += "f -5 -4 -3\nf -4 -2 -3\nf -2 -1 -3\n";
  }
  folder.write("needles.obj", mesh);
  for (const std::string& bsdf : {diffuse(0.6), gloss()})
    expectSound(sceneOf(folder, sceneText(camera("0, 1.5, 5", "0, 1, 0") + floorOf(diffuse(0.5)) +
                                          lamp() + obj("needles.obj", bsdf))),
                "needles", {.resolved = false});
  // As a lamp: as bright as the sum of its triangles.
  expectSound(sceneOf(folder, sceneText(camera("0, 1.5, 5", "0, 1, 0") + floorOf(diffuse(0.5)) +
                                        obj("needles.obj", diffuse(0.1) + emitter("2")))),
              "needles that shine");
}

// Triangles without area, vertices given twice, a face of one vertex thrice; coordinates and normals
// of the texture that coincide.
TEST(Meshes, CoincidentVertices) {
  const testing::SceneFolder folder;
  folder.write("coincident.obj",
               "v -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\nv -1 0 0\nv 1 2 0\nv 0 1 0\n"
               "vt 0.5 0.5\nvt 0.5 0.5\nvt 0.5 0.5\n"
               "f 1/1 2/2 3/3\nf 5/1 6/2 4/3\nf 1 1 1\nf 1 5 1\nf 1 3 6\nf 1 7 3\n");
  for (const std::string& bsdf : {diffuse(0.6), gloss()})
    expectSound(sceneOf(folder, sceneText(camera("0, 1.5, 5", "0, 1, 0") + floorOf(diffuse(0.5)) +
                                          lamp() + obj("coincident.obj", bsdf))),
                "coincident vertices", {.resolved = false});
  expectSound(sceneOf(folder, sceneText(camera("0, 1.5, 5", "0, 1, 0") + floorOf(diffuse(0.5)) +
                                        obj("coincident.obj", diffuse(0.1) + emitter("2")))),
              "coincident vertices that shine");
}

// Normals of no length, against the geometric one, along the surface, and ones that cancel half way.
TEST(Meshes, ShadingNormals) {
  const testing::SceneFolder folder;
  const std::pair<const char*, const char*> kNormals[] = {
      {"zero normals", "vn 0 0 0\nvn 0 0 0\nvn 0 0 0\nvn 0 0 0\n"},
      {"opposite normals", "vn 0 0 -1\nvn 0 0 -1\nvn 0 0 -1\nvn 0 0 -1\n"},
      {"normals along the surface", "vn 1 0 0\nvn 1 0 0\nvn 1 0 0\nvn 1 0 0\n"},
      {"normals that cancel", "vn 0 0 1\nvn 0 0 -1\nvn 0 0 1\nvn 0 0 -1\n"},
      {"normals of length 1e-30", "vn 0 0 1e-30\nvn 1e-31 0 1e-30\nvn 0 0 1e-30\nvn 0 0 1e-30\n"},
      {"normals of length 1e30", "vn 0 0 1e30\nvn 1e29 0 1e30\nvn 0 0 1e30\nvn 0 0 1e30\n"},
  };
  for (const auto& [what, normals] : kNormals) {
    folder.write("normals.obj", std::string("v -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 0\n") + normals +
                                    "f 1//1 2//2 3//3\nf 1//1 3//3 4//4\n");
    for (const std::string& bsdf : {"<bsdf type=\"twosided\">" + diffuse(0.6) + "</bsdf>",
                                    "<bsdf type=\"twosided\">" + gloss() + "</bsdf>",
                                    std::string("<bsdf type=\"dielectric\"/>")})
      expectSound(sceneOf(folder, sceneText(camera("0, 1.5, 5", "0, 1, 0") + floorOf(diffuse(0.5)) +
                                            lamp() + obj("normals.obj", bsdf))),
                  what, {.resolved = false});
  }
}

}  // namespace
}  // namespace h2mc::test
