// SPDX-License-Identifier: MIT
// Changes to a scene's document, and what is done to extreme ones before they are read.
#include <gtest/gtest.h>

#include "render/scene/document_edit.h"
#include "render/scene/normalise.h"
#include "scene_files.h"

namespace h2mc {
namespace {

using testing::SceneFolder;

constexpr const char* kCamera =
    "<sensor type=\"perspective\"><transform name=\"toWorld\"><translate x=\"1\" y=\"2\" "
    "z=\"3\"/></transform><film type=\"hdrfilm\"/></sensor>\n";

class DocumentEdit : public ::testing::Test {
 protected:
  void load(const std::string& body) {
    document = loadSceneDocument(
        folder.write("scene.xml", "<scene version=\"0.6.0\">\n" + body + "</scene>\n"), {});
  }
  Scene make() { return makeScene(*document, {}); }
  template <class B>
  const B& bsdf(const Scene& scene) {
    for (const Bsdf& b : scene.bsdfs)
      if (const B* const found = std::get_if<B>(&b)) return *found;
    throw std::runtime_error("no such bsdf");
  }

  SceneFolder folder;
  std::unique_ptr<SceneDocument> document;
};

std::string lit(const std::string& bsdf) {
  return kCamera + std::string("<emitter type=\"point\"/>\n<shape type=\"sphere\">") + bsdf +
         "</shape>\n";
}

TEST_F(DocumentEdit, Roughness) {
  load(
      lit("<bsdf type=\"twosided\"><bsdf type=\"roughconductor\"><float name=\"alphaU\" "
          "value=\"0.3\"/><float name=\"alpha_v\" value=\"0.3\"/></bsdf></bsdf>"));
  EXPECT_EQ(setRoughness(*document, 0.02), 1);
  EXPECT_EQ(setRoughness(*document, 0.02), 0);
  EXPECT_FLOAT_EQ(bsdf<RoughConductor>(make()).facets.alpha, 0.02f);
  EXPECT_EQ(setPhongExponent(*document, 5), 0);
  EXPECT_EQ(setRefractiveIndex(*document, 1.2), 0);
}

TEST_F(DocumentEdit, PhongExponent) {
  load(lit("<bsdf type=\"phong\"/>"));
  EXPECT_EQ(setPhongExponent(*document, 1e6), 1);
  EXPECT_FLOAT_EQ(bsdf<Phong>(make()).exponent, 1e6f);
}

TEST_F(DocumentEdit, RefractiveIndex) {
  load(lit("<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"bk7\"/></bsdf>"));
  EXPECT_EQ(setRefractiveIndex(*document, 1), 1);
  EXPECT_EQ(bsdf<Dielectric>(make()).eta, 1);
  load(lit("<bsdf type=\"roughdielectric\"/>"));
  EXPECT_EQ(setRefractiveIndex(*document, 1), 0);
  EXPECT_EQ(setRefractiveIndex(*document, 1.0001), 1);
  EXPECT_FLOAT_EQ(bsdf<RoughDielectric>(make()).eta, 1.0001f);
  load(lit("<bsdf type=\"roughcoating\"><bsdf type=\"diffuse\"/></bsdf>"));
  EXPECT_EQ(setRefractiveIndex(*document, 1), 0);
  EXPECT_EQ(setRefractiveIndex(*document, 1.2), 1);
  EXPECT_EQ(setRoughness(*document, 0.02), 1);
  const auto coat = std::get<RoughCoat>(bsdf<FurtherBsdf>(make()).bsdf).interface;
  EXPECT_FLOAT_EQ(coat.eta, 1.2f);
  EXPECT_FLOAT_EQ(coat.facets.alpha, 0.02f);
}

TEST_F(DocumentEdit, IdsStayValid) {
  load(kCamera + std::string("<bsdf type=\"phong\" id=\"a\"/><emitter type=\"point\"/>\n<shape "
                             "type=\"sphere\" id=\"b\"><ref id=\"a\"/></shape>\n"));
  setPhongExponent(*document, 7);
  moveScene(*document, 2, {1, 1, 1});
  EXPECT_EQ(document->find("b")->name, "shape");
  EXPECT_FLOAT_EQ(bsdf<Phong>(make()).exponent, 7);
}

TEST_F(DocumentEdit, Radiance) {
  load(kCamera + std::string("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1, 2, "
                             "3\"/></emitter><shape type=\"sphere\"><emitter type=\"area\"/>"
                             "</shape>\n"));
  EXPECT_EQ(brightestLight(*document), 3);
  EXPECT_EQ(scaleRadiance(*document, 1e5), 2);
  EXPECT_EQ(brightestLight(*document), 3e5);
  EXPECT_EQ(std::get<ConstantLight>(make().lights[0]).radiance, Rgbf(1e5f, 2e5f, 3e5f));
}

TEST_F(DocumentEdit, ShrunkLights) {
  load(kCamera + std::string("<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/><emitter "
                             "type=\"area\"/></shape>\n<shape type=\"rectangle\"><transform "
                             "name=\"toWorld\"><translate x=\"5\"/></transform><emitter "
                             "type=\"area\"/></shape>\n"));
  EXPECT_EQ(shrinkLights(*document, 0.25), 2);
  const Scene scene = make();
  EXPECT_FLOAT_EQ(std::get<Sphere>(scene.shapes[0].geometry).radius, 1);
  const auto& mesh = std::get<TriangleMesh>(scene.shapes[1].geometry);
  for (const Vec3f& p : mesh.positions) {
    EXPECT_FLOAT_EQ(std::abs(p.x - 5), 0.5f);
    EXPECT_FLOAT_EQ(std::abs(p.y), 0.5f);
  }
  EXPECT_EQ(brightestLight(*document), 4);
}

TEST_F(DocumentEdit, MovedScene) {
  load(kCamera + std::string("<emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"0\" "
                             "z=\"0\"/></emitter>\n<shape type=\"sphere\"><point name=\"center\" "
                             "x=\"0\" y=\"1\" z=\"0\"/></shape>\n"));
  EXPECT_EQ(moveScene(*document, 1, {0, 0, 0}), 0);
  EXPECT_EQ(moveScene(*document, 10, {0, 0, 7}), 3);
  const Scene scene = make();
  const auto& sphere = std::get<Sphere>(scene.shapes[0].geometry);
  EXPECT_EQ(sphere.center, Vec3f(0, 10, 7));
  EXPECT_FLOAT_EQ(sphere.radius, 10);
  const auto& light = std::get<PointLight>(scene.lights[0]);
  EXPECT_EQ(light.position, Vec3f(10, 0, 7));
  EXPECT_EQ(light.intensity, Rgbf(100));
  EXPECT_EQ(scene.camera.position(), Vec3f(10, 20, 37));
  EXPECT_FLOAT_EQ(scene.camera.nearClip, 0.1f);
  EXPECT_FLOAT_EQ(scene.camera.farClip, 1e5f);
}

TEST_F(DocumentEdit, FarScenesComeToTheOrigin) {
  load(lit(""));
  moveScene(*document, 1, {1e7, 0, 0});
  const Scene scene = make();
  EXPECT_EQ(scene.origin, glm::dvec3(1e7 + 1, 2, 3));
  EXPECT_EQ(scene.camera.position(), Vec3f(0));
  EXPECT_EQ(std::get<Sphere>(scene.shapes[0].geometry).center, Vec3f(-1, -2, -3));
  EXPECT_EQ(std::get<PointLight>(scene.lights[0]).position, Vec3f(-1, -2, -3));
  ASSERT_FALSE(scene.notes.empty());
  EXPECT_NE(scene.notes[0].find("relative to"), std::string::npos);
}

TEST_F(DocumentEdit, OthersStayWhereTheyAre) {
  load(lit(""));
  EXPECT_EQ(make().origin, glm::dvec3(0));
  // A camera far away from what it looks at.
  load(
      "<sensor type=\"perspective\"><transform name=\"toWorld\"><translate z=\"1e6\"/></transform>"
      "<film type=\"hdrfilm\"/></sensor><emitter type=\"point\"/><shape type=\"sphere\"/>");
  EXPECT_EQ(make().origin, glm::dvec3(0));
}

// A factor that is not given is not one of 1.
TEST_F(DocumentEdit, ScalesOfEnvironmentsAreBrightness) {
  const auto brightest = [&](const std::string& emitter) {
    load(kCamera + emitter + "<shape type=\"sphere\"/>\n");
    const double before = brightestLight(*document);
    scaleRadiance(*document, 8);
    EXPECT_DOUBLE_EQ(brightestLight(*document), 8 * before) << emitter;
    return before;
  };
  const auto light = [](const std::string& type, const std::string& numbers) {
    return "<emitter type=\"" + type + "\">" + numbers + "</emitter>";
  };
  const auto number = [](const std::string& name, const std::string& value) {
    return "<float name=\"" + name + "\" value=\"" + value + "\"/>";
  };
  EXPECT_FLOAT_EQ(static_cast<float>(
                      brightest(light("collimated", "<rgb name=\"power\" value=\"1e-9, 0, 0\"/>"))),
                  1e-9f);
  for (const char* type : {"envmap", "sky", "sun", "sunsky"}) {
    EXPECT_DOUBLE_EQ(brightest(light(type, number("scale", "1e-9"))), 1e-9) << type;
    EXPECT_DOUBLE_EQ(brightest(light(type, "")), 1) << type;
  }
  EXPECT_DOUBLE_EQ(
      brightest(light("sunsky", number("sunScale", "1e-9") + number("skyScale", "1e-8"))), 1e-8);
  EXPECT_DOUBLE_EQ(brightest(light("sunsky", number("sunScale", "1e-9") + number("scale", "1e-8"))),
                   1e-8);
}

TEST_F(DocumentEdit, UnitsOfRadiance) {
  for (const double factor : {1e-30, 1e-3, 1.0, 1e3, 1e30}) {
    load(kCamera + std::string("<emitter type=\"constant\"/><shape type=\"sphere\"/>\n"));
    scaleRadiance(*document, factor);
    const Scene scene = make();
    const double radiance = std::get<ConstantLight>(scene.lights[0]).radiance.x;
    EXPECT_NEAR(radiance * scene.radianceUnit / factor, 1, 1e-6);
    if (factor == 1e30 || factor == 1e-30) {
      EXPECT_GT(radiance, 0.5);
      EXPECT_LT(radiance, 2);
      EXPECT_EQ(std::exp2(std::round(std::log2(scene.radianceUnit))), scene.radianceUnit);
    } else {
      EXPECT_EQ(scene.radianceUnit, 1);
    }
  }
}

}  // namespace
}  // namespace h2mc
