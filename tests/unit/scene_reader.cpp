// SPDX-License-Identifier: MIT
// What a scene file says arrives in the scene.
#include "render/scene/scene_reader.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/core/index.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

bool hasNote(const Scene& scene, const std::string& part) {
  return std::any_of(scene.notes.begin(), scene.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

std::string withSensor(const std::string& sensor) {
  return "<scene version=\"0.6.0\">" + sensor + kLight + kSphere + "</scene>";
}

// The reflectance of the first shape's diffuse BSDF.
Rgbf reflectance(const Scene& scene, std::size_t shape = 0) {
  const Material& m = scene.materials.at(static_cast<std::size_t>(scene.shapes.at(shape).material));
  return std::visit([](const auto& b) { return b.albedo(); },
                    scene.bsdfs.at(static_cast<std::size_t>(m.front)));
}

void expectColor(const Rgbf& c, float r, float g, float b, float tolerance = 1e-5f) {
  EXPECT_NEAR(c.x, r, tolerance);
  EXPECT_NEAR(c.y, g, tolerance);
  EXPECT_NEAR(c.z, b, tolerance);
}

TEST(SceneReader, SmallestScene) {
  const SceneFolder folder;
  const Scene scene = folder.read(sceneWith(""));
  EXPECT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.film.width, 8);
  EXPECT_EQ(scene.film.height, 6);
  EXPECT_EQ(scene.environment, -1);
  EXPECT_TRUE(scene.integrator.integrator().empty());
  EXPECT_EQ(scene.samplesPerPixel, 0);
  EXPECT_FALSE(scene.seed.has_value());
  EXPECT_NE(scene.tracer, nullptr);
  EXPECT_NEAR(scene.bounds.radius, std::sqrt(3.f), 1e-3f);
}

TEST(SceneReader, FilmSamplerAndDefaults) {
  const SceneFolder folder;
  const Scene plain = folder.read(withSensor("<sensor type=\"perspective\"/>"));
  EXPECT_EQ(plain.film.width, 768);
  EXPECT_EQ(plain.film.height, 576);
  EXPECT_EQ(plain.film.filter.kind, Filter::Kind::kGaussian);
  EXPECT_FLOAT_EQ(plain.film.filter.radius, 2);

  const Scene scene = folder.read(withSensor(
      "<sensor type=\"perspective\"><sampler type=\"ldsampler\"><integer name=\"sampleCount\" "
      "value=\"17\"/><integer name=\"dimension\" value=\"4\"/></sampler><film type=\"ldrfilm\">"
      "<boolean name=\"banner\" value=\"false\"/><rfilter type=\"mitchell\"><float name=\"B\" "
      "value=\"0.2\"/></rfilter></film></sensor>"));
  EXPECT_EQ(scene.samplesPerPixel, 17);
  EXPECT_EQ(scene.film.filter.kind, Filter::Kind::kMitchell);
  EXPECT_FLOAT_EQ(scene.film.filter.b, 0.2f);
  EXPECT_NEAR(scene.film.filter.c, 1 / 3.f, 1e-6f);
  EXPECT_TRUE(hasNote(scene, "\"banner\" of film"));
  EXPECT_TRUE(hasNote(scene, "ldsampler"));
  EXPECT_TRUE(hasNote(scene, "dimension"));
}

TEST(SceneReader, Filters) {
  const SceneFolder folder;
  const auto filter = [&](const std::string& text) {
    return folder
        .read(withSensor("<sensor type=\"perspective\"><film type=\"hdrfilm\">" + text +
                         "</film></sensor>"))
        .film.filter;
  };
  EXPECT_EQ(filter("<rfilter type=\"box\"/>").kind, Filter::Kind::kBox);
  EXPECT_FLOAT_EQ(filter("<rfilter type=\"box\"/>").radius, 0.5f);
  EXPECT_EQ(filter("<rfilter type=\"tent\"/>").kind, Filter::Kind::kTent);
  EXPECT_FLOAT_EQ(filter("<rfilter type=\"tent\"/>").radius, 1);
  EXPECT_FLOAT_EQ(filter("<rfilter type=\"catmullrom\"/>").c, 0.5f);
  const Filter gaussian =
      filter("<rfilter type=\"gaussian\"><float name=\"stddev\" value=\"0.7\"/></rfilter>");
  EXPECT_FLOAT_EQ(gaussian.stddev, 0.7f);
  EXPECT_FLOAT_EQ(gaussian.radius, 2.8f);
}

TEST(SceneReader, SizeFromTheCommandLine) {
  const SceneFolder folder;
  const auto size = [&](int width, int height, double scale) {
    ReadOptions options;
    options.width = width;
    options.height = height;
    options.scale = scale;
    const Scene scene = folder.read(sceneWith(""), options);  // 8 x 6
    return std::pair(scene.film.width, scene.film.height);
  };
  EXPECT_EQ(size(16, 0, 0), std::pair(16, 12));
  EXPECT_EQ(size(0, 12, 0), std::pair(16, 12));
  EXPECT_EQ(size(5, 7, 0), std::pair(5, 7));
  EXPECT_EQ(size(0, 0, 0.5), std::pair(4, 3));
  EXPECT_EQ(size(0, 0, 0.01), std::pair(1, 1));
}

TEST(SceneReader, ACropIsAWindowOfTheWholeView) {
  const SceneFolder folder;
  const auto film = [](const std::string& crop) {
    return "<scene version=\"0.6.0\"><sensor type=\"perspective\"><float name=\"fov\" "
           "value=\"50\"/>"
           "<film type=\"hdrfilm\"><integer name=\"width\" value=\"120\"/><integer name=\"height\" "
           "value=\"90\"/>" +
           crop + "</film></sensor>" + kLight + kSphere + "</scene>";
  };
  const std::string crop =
      "<integer name=\"cropOffsetX\" value=\"10\"/><integer name=\"cropOffsetY\" value=\"22\"/>"
      "<integer name=\"cropWidth\" value=\"80\"/><integer name=\"cropHeight\" value=\"60\"/>";
  const Scene whole = folder.read(film("")), part = folder.read(film(crop));
  EXPECT_EQ(part.film.width, 80);
  EXPECT_EQ(part.film.height, 60);
  EXPECT_NEAR(part.camera.filmArea() / whole.camera.filmArea(), 80.0 * 60 / (120 * 90), 1e-6);
  for (const Vec2f& p : {Vec2f(0, 0), Vec2f(0.3f, 0.8f), Vec2f(1, 1)}) {
    const Vec3f here = part.camera.direction<float>(p.x, p.y);
    const Vec3f there = whole.camera.direction<float>((10 + 80 * p.x) / 120, (22 + 60 * p.y) / 90);
    EXPECT_LT(glm::length(here - there), 1e-6f);
  }
  float x = 0, y = 0;
  const Vec3f inside = part.camera.direction<float>(0.3f, 0.8f);
  EXPECT_TRUE(part.camera.project(part.camera.pose<float>(), inside, x, y));
  EXPECT_NEAR(x, 0.3f, 1e-5f);
  EXPECT_NEAR(y, 0.8f, 1e-5f);
  // Seen by the whole film, left of the window.
  EXPECT_FALSE(part.camera.project(part.camera.pose<float>(),
                                   whole.camera.direction<float>(0.05f, 0.5f), x, y));
  ReadOptions half;
  half.scale = 0.5;
  const Scene small = folder.read(film(crop), half);
  EXPECT_EQ(small.film.width, 40);
  EXPECT_LT(glm::length(small.camera.direction<float>(0.3f, 0.8f) - inside), 1e-6f);
}

TEST(SceneReader, FieldOfView) {
  const SceneFolder folder;
  // Half the width of the film at unit distance, from the direction to its edge.
  const auto tangents = [&](const std::string& parameters) {
    const Scene scene = folder.read(withSensor(
        "<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"40\"/>"
        "<integer name=\"height\" value=\"20\"/></film>" +
        parameters + "</sensor>"));
    const Vec3f x = scene.camera.direction<float>(0, 0.5f),
                y = scene.camera.direction<float>(0.5f, 0);
    const Vec3f f = scene.camera.forward();
    const auto tangent = [&](const Vec3f& d) {
      return std::tan(std::acos(std::min(1.f, dot(d, f))));
    };
    return std::pair(tangent(x), tangent(y));
  };
  const auto near = [](std::pair<float, float> t, float x) {
    EXPECT_NEAR(t.first, x, 2e-4f);
    EXPECT_NEAR(t.second, x / 2, 2e-4f);
  };
  const std::string fov = "<float name=\"fov\" value=\"90\"/>";
  near(tangents(fov), 1);
  near(tangents(fov + "<string name=\"fovAxis\" value=\"x\"/>"), 1);
  near(tangents(fov + "<string name=\"fovAxis\" value=\"larger\"/>"), 1);
  near(tangents(fov + "<string name=\"fov_axis\" value=\"y\"/>"), 2);
  near(tangents(fov + "<string name=\"fovAxis\" value=\"Smaller\"/>"), 2);
  near(tangents(fov + "<string name=\"fovAxis\" value=\"diagonal\"/>"), 2 / std::sqrt(5.f));
  // 35 mm film: the diagonal of 36 x 24 mm over twice the focal length.
  const float focal = std::hypot(36.f, 24.f) / 100 * 2 / std::sqrt(5.f);
  near(tangents(""), focal);
  near(tangents("<string name=\"focalLength\" value=\"50mm\"/>"), focal);
  near(tangents("<string name=\"focalLength\" value=\"25\"/>"), 2 * focal);
}

TEST(SceneReader, CameraStandsWhereLookAtSays) {
  const SceneFolder folder;
  const Scene scene = folder.read(withSensor(
      "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/><float name=\"nearClip\" "
      "value=\"0.5\"/><float name=\"shutterClose\" value=\"1\"/><transform name=\"toWorld\">"
      "<lookat origin=\"1, 2, 3\" target=\"1 2 8\" up=\"0, 1, 0\"/></transform></sensor>"));
  expectColor(scene.camera.position(), 1, 2, 3);
  expectColor(scene.camera.forward(), 0, 0, 1);
  EXPECT_FLOAT_EQ(scene.camera.nearClip, 0.5f);
  EXPECT_FLOAT_EQ(scene.camera.shutterClose, 1);
  // The left edge of the film looks along +x: Mitsuba's x axis points to the left.
  EXPECT_GT(scene.camera.direction<float>(0, 0.5f).x, 0.1f);
  EXPECT_GT(scene.camera.direction<float>(0.5f, 0).y, 0.1f);
}

TEST(SceneReader, SnakeCaseNames) {
  const SceneFolder folder;
  const Scene scene = folder.read(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>"
      "<string name=\"fov_axis\" value=\"y\"/><float name=\"near_clip\" value=\"0.25\"/>"
      "<transform name=\"to_world\"><translate value=\"1, 2, 3\"/></transform>"
      "<sampler type=\"independent\"><integer name=\"sample_count\" "
      "value=\"9\"/></sampler></sensor>"
      "<emitter type=\"point\"/><shape type=\"sphere\"><boolean name=\"flip_normals\" "
      "value=\"true\"/>"
      "<bsdf type=\"dielectric\"><float name=\"int_ior\" value=\"1.3\"/></bsdf></shape>"
      "<integrator type=\"path\"><integer name=\"max_depth\" value=\"4\"/></integrator></scene>");
  EXPECT_FLOAT_EQ(scene.camera.nearClip, 0.25f);
  EXPECT_EQ(scene.samplesPerPixel, 9);
  EXPECT_TRUE(std::get<Sphere>(scene.shapes[0].geometry).flipNormals);
  EXPECT_EQ(scene.integrator.integer("maxDepth"), 4);
}

TEST(SceneReader, MaterialsAreSharedByReferences) {
  const SceneFolder folder;
  const Scene scene = folder.read(sceneWith(
      "<shape type=\"sphere\"><ref id=\"later\"/></shape>"
      "<bsdf type=\"diffuse\" id=\"later\"><rgb name=\"reflectance\" value=\"0.1, 0.2, "
      "0.3\"/></bsdf>"
      "<shape type=\"disk\"><ref name=\"bsdf\" id=\"later\"/></shape>"
      "<alias id=\"later\" as=\"other\"/><shape type=\"disk\"><ref id=\"other\"/></shape>"));
  ASSERT_EQ(scene.shapes.size(), 4u);
  EXPECT_EQ(scene.materials.size(), 2u);  // and the default of the helper's sphere
  EXPECT_EQ(scene.shapes[0].material, scene.shapes[1].material);
  EXPECT_EQ(scene.shapes[0].material, scene.shapes[2].material);
  EXPECT_EQ(scene.materials[at(scene.shapes[0].material)].name, "later");
  expectColor(reflectance(scene), 0.1f, 0.2f, 0.3f);
  expectColor(reflectance(scene, 3), 0.5f, 0.5f, 0.5f);
}

TEST(SceneReader, TwosidedAndMask) {
  const SceneFolder folder;
  const Scene scene = folder.read(sceneWith(
      "<shape type=\"disk\"><bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf></shape>"
      "<shape type=\"disk\"><bsdf type=\"twosided\"><bsdf type=\"diffuse\"/><bsdf "
      "type=\"conductor\"/></bsdf></shape>"
      "<shape type=\"disk\"><bsdf type=\"mask\"><float name=\"opacity\" value=\"0.25\"/>"
      "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf></bsdf></shape>"
      "<shape type=\"disk\"><bsdf type=\"mask\"><float name=\"opacity\" value=\"1\"/><bsdf "
      "type=\"diffuse\"/></bsdf></shape>"
      "<shape type=\"disk\"><bsdf type=\"dielectric\"/></shape>"));
  const auto material = [&](std::size_t shape) -> const Material& {
    return scene.materials.at(static_cast<std::size_t>(scene.shapes.at(shape).material));
  };
  EXPECT_EQ(scene.materials.size(), 6u);  // nested ones are not kept
  EXPECT_TRUE(material(0).twosided);
  EXPECT_EQ(material(0).front, material(0).back);
  EXPECT_TRUE(material(1).twosided);
  EXPECT_NE(material(1).front, material(1).back);
  EXPECT_TRUE(material(2).twosided);
  EXPECT_EQ(material(2).plugin, "mask");
  ASSERT_NE(material(2).opacity, nullptr);
  EXPECT_FLOAT_EQ(average(*material(2).opacity).x, 0.25f);
  EXPECT_EQ(material(3).opacity, nullptr);  // opaque after all
  EXPECT_FALSE(material(4).twosided);
  EXPECT_EQ(material(4).back, -1);
}

TEST(SceneReader, LightsKnowTheirShapes) {
  const SceneFolder folder;
  const Scene scene = folder.read(
      sceneWith("<shape type=\"rectangle\"/><shape type=\"rectangle\"><emitter type=\"area\">"
                "<rgb name=\"radiance\" value=\"1\"/></emitter></shape>"
                "<shape type=\"disk\"><luminaire type=\"area\"><spectrum name=\"radiance\" "
                "value=\"0\"/></luminaire></shape>"
                "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>"));
  EXPECT_EQ(scene.lights.size(), 3u);
  const int light = scene.shapes[1].light;
  ASSERT_GE(light, 0);
  EXPECT_EQ(std::get<AreaLight>(scene.lights[at(light)]).shape, 1);
  EXPECT_EQ(scene.shapes[0].light, -1);
  EXPECT_EQ(scene.shapes[2].light, -1);
  EXPECT_TRUE(hasNote(scene, "emits nothing"));
  ASSERT_GE(scene.environment, 0);
  EXPECT_TRUE(std::holds_alternative<ConstantLight>(scene.lights[at(scene.environment)]));
  // As Mitsuba 0.6: a light that names no BSDF reflects nothing.
  expectColor(reflectance(scene, 1), 0, 0, 0);
  expectColor(reflectance(scene, 0), 0.5f, 0.5f, 0.5f);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(scene.directPicker.probability(i), 0);
    EXPECT_GT(scene.emissionPicker.probability(i), 0);
  }
}

TEST(SceneReader, WhatNothingRefersToIsLeftOut) {
  const SceneFolder folder;
  const Scene scene = folder.read(sceneWith(
      "<texture type=\"bitmap\" id=\"photo\"><string name=\"filename\" "
      "value=\"lost.png\"/></texture>"
      "<bsdf type=\"diffuse\" id=\"unused\"><ref name=\"reflectance\" id=\"photo\"/></bsdf>"));
  EXPECT_TRUE(hasNote(scene, "left out: nothing refers to texture \"photo\""));
  EXPECT_TRUE(hasNote(scene, "left out: nothing refers to bsdf \"unused\""));
  EXPECT_EQ(scene.bsdfs.size(), 1u);
}

TEST(SceneReader, IncludesDefaultsAndDefines) {
  const SceneFolder folder;
  folder.write("parts/ball.xml",
               "<shape type=\"sphere\"><float name=\"radius\" value=\"$radius\"/></shape>");
  folder.write("parts/mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("parts/more.xml",
               "<scene version=\"0.6.0\"><shape type=\"obj\"><string name=\"filename\" "
               "value=\"mesh.obj\"/></shape><default name=\"late\" value=\"7\"/></scene>");
  const std::string text = sceneWith(
      "<default name=\"radius\" value=\"2\"/><default name=\"radius\" value=\"3\"/>"
      "<default name=\"twice\" value=\"$radius$radius\"/>"
      "<include filename=\"parts/ball.xml\"/><include filename=\"parts/more.xml\"/>"
      "<shape type=\"sphere\"><float name=\"radius\" value=\"$late.5\"/></shape>"
      "<shape type=\"sphere\"><float name=\"radius\" value=\"$twice\"/></shape>");
  const auto radius = [](const Scene& scene, std::size_t shape) {
    return std::get<Sphere>(scene.shapes.at(shape).geometry).radius;
  };
  const Scene scene = folder.read(text);
  ASSERT_EQ(scene.shapes.size(), 5u);
  EXPECT_FLOAT_EQ(radius(scene, 0), 2);
  EXPECT_FLOAT_EQ(radius(scene, 2), 7.5f);
  EXPECT_FLOAT_EQ(radius(scene, 3), 22);

  ReadOptions options;
  options.defines = {{"radius", "5"}};
  EXPECT_FLOAT_EQ(radius(folder.read(text, options), 0), 5);
}

TEST(SceneReader, DoublingIncludesEnd) {
  const SceneFolder folder;
  for (int i = 0; i < 20; ++i) {
    const std::string next = "<include filename=\"" + std::to_string(i + 1) + ".xml\"/>";
    folder.write(std::to_string(i) + ".xml", "<scene>" + next + next + "</scene>");
  }
  folder.write("20.xml", "<scene/>");
  EXPECT_FALSE(folder.error("<scene><include filename=\"0.xml\"/></scene>").empty());
}

TEST(SceneReader, Colors) {
  const SceneFolder folder;
  const auto color = [&](const std::string& element) {
    return reflectance(folder.read(
        sceneWith("<shape type=\"disk\"><bsdf type=\"diffuse\">" + element + "</bsdf></shape>")));
  };
  expectColor(color("<rgb name=\"reflectance\" value=\"0.1, 0.2 0.3\"/>"), 0.1f, 0.2f, 0.3f);
  expectColor(color("<rgb name=\"reflectance\" value=\"0.25\"/>"), 0.25f, 0.25f, 0.25f);
  expectColor(color("<spectrum name=\"reflectance\" value=\"0.1, 0.2, 0.3\"/>"), 0.1f, 0.2f, 0.3f);
  expectColor(color("<spectrum name=\"reflectance\" value=\".5\"/>"), 0.5f, 0.5f, 0.5f);
  expectColor(color("<float name=\"reflectance\" value=\"0.5\"/>"), 0.5f, 0.5f, 0.5f);
  expectColor(color("<rgb name=\"reflectance\" value=\"#ff0080\"/>"), 1, 0, 128 / 255.f);
  expectColor(color("<srgb name=\"reflectance\" value=\"#ff0080\"/>"), 1, 0, 0.2158605f);
  expectColor(color("<srgb name=\"reflectance\" value=\"0.5\"/>"), 0.2140411f, 0.2140411f,
              0.2140411f);
}

TEST(SceneReader, SameSceneTwiceIsTheSame) {
  const SceneFolder folder;
  const std::string text = sceneWith("<shape type=\"cube\"/>");
  const Scene a = folder.read(text), b = folder.read(text);
  EXPECT_EQ(a.notes, b.notes);
  EXPECT_EQ(a.bounds.radius, b.bounds.radius);
}

TEST(SceneReader, MovedScenesStayUsable) {
  const SceneFolder folder;
  Scene a = folder.read(sceneWith(""));
  Scene b = std::move(a);
  EXPECT_EQ(b.shapes.size(), 1u);
  EXPECT_NE(b.tracer, nullptr);
}

}  // namespace
}  // namespace h2mc::testing
