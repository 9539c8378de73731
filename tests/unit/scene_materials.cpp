// SPDX-License-Identifier: MIT
// What scene files make of materials inside materials, textures inside textures, and a mesh's own names.
#include <gtest/gtest.h>

#include "render/bsdf/material.h"
#include "render/core/index.h"
#include "scene_files.h"

namespace h2mc {
namespace {

using testing::SceneFolder;

class SceneMaterials : public ::testing::Test {
 protected:
  // The material of a rectangle with this BSDF.
  Material material(const std::string& bsdf, Scene& scene) {
    scene = folder_.read(testing::sceneWith("<shape type=\"rectangle\">" + bsdf + "</shape>"));
    return scene.materials[at(scene.shapes[0].material)];
  }
  std::string error(const std::string& bsdf) {
    return folder_.error(testing::sceneWith("<shape type=\"rectangle\">" + bsdf + "</shape>"));
  }
  SceneFolder folder_;
};

constexpr const char* kRed =
    R"(<bsdf type="diffuse"><rgb name="reflectance" value="1, 0, 0"/></bsdf>)";
constexpr const char* kMetal = R"(<bsdf type="roughconductor"/>)";

TEST_F(SceneMaterials, NullLetsEverythingThrough) {
  Scene scene;
  const Material m = material(R"(<bsdf type="null"/>)", scene);
  for (const Vec3f& wi : {Vec3f(0, 0, 1), Vec3f(0.6f, 0, -0.8f)}) {
    EXPECT_EQ(evaluateMaterial<float>(scene.bsdfs, m, Vec2f(0.5f), wi, Vec3f(0, 0.6f, 0.8f)).pdf,
              0);
    for (const float choice : {0.f, 0.5f, 0.999f}) {
      const LobeId lobe = chooseLobe(scene.bsdfs, m, Vec2f(0.5f), wi, 0.3f, 0.6f, choice);
      ASSERT_TRUE(lobe.null);
      const auto sample = sampleDelta<float>(scene.bsdfs, m, Vec2f(0.5f), wi, lobe);
      EXPECT_EQ(sample.wo, -wi);
      EXPECT_EQ(sample.radiance, Rgbf(1));
    }
  }
}

TEST_F(SceneMaterials, RoughPlasticIsThatOfTheFilesVersion) {
  const std::string text =
      R"(<shape type="rectangle"><bsdf type="roughplastic"><float name="alpha" value="0.4"/></bsdf></shape>)";
  const auto diffuse = [&](const std::string& scene) {
    const Scene read = folder_.read(scene);
    const Material& m = read.materials[at(read.shapes[0].material)];
    return average(*std::get<RoughPlastic>(read.bsdfs[at(m.front)]).base.reflectance).x;
  };
  EXPECT_NEAR(
      diffuse(testing::sceneWith(text)) / diffuse(testing::modern(testing::sceneWith(text))), 1.247,
      4e-3);
}

TEST_F(SceneMaterials, BlendsHaveTheirWeight) {
  Scene scene;
  const Material m = material(R"(<bsdf type="blendbsdf"><float name="weight" value="0.25"/>)" +
                                  std::string(kRed) + kMetal + "</bsdf>",
                              scene);
  ASSERT_TRUE(m.blend);
  EXPECT_FLOAT_EQ(m.blend->weightAt<float>(Vec2f(0.5f)), 0.25f);
  EXPECT_FLOAT_EQ(m.blend->scale, 1);
  const Vec3f wi(0, 0, 1), wo(0.6f, 0, 0.8f);
  const auto whole = evaluateMaterial<float>(scene.bsdfs, m, Vec2f(0.5f), wi, wo);
  const auto first = evaluateMaterial<float>(scene.bsdfs, *m.blend->first, Vec2f(0.5f), wi, wo);
  const auto second = evaluateMaterial<float>(scene.bsdfs, *m.blend->second, Vec2f(0.5f), wi, wo);
  EXPECT_FLOAT_EQ(whole.value.x, 0.75f * first.value.x + 0.25f * second.value.x);
  EXPECT_FLOAT_EQ(whole.pdf, 0.75f * first.pdf + 0.25f * second.pdf);
}

TEST_F(SceneMaterials, MixturesKeepTheirSumUpToOne) {
  Scene scene;
  const auto mixture = [&](const std::string& weights) {
    return material("<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"" + weights +
                        "\"/>" + kRed + kRed + kRed + "</bsdf>",
                    scene);
  };
  const Vec3f wi(0, 0, 1), wo(0.6f, 0, 0.8f);
  for (const auto& [weights, sum] : {std::pair<const char*, float>{"0.1, 0.2, 0.3", 0.6f},
                                     {"0.5 0 0.25", 0.75f},
                                     {"1, 2, 1", 1.f}}) {
    const Material m = mixture(weights);
    const auto e = evaluateMaterial<float>(scene.bsdfs, m, Vec2f(0.5f), wi, wo);
    EXPECT_NEAR(e.value.x, sum * wo.z / kPi, 1e-6) << weights;
    EXPECT_NEAR(e.pdf, wo.z / kPi, 1e-6) << weights;
  }
}

TEST_F(SceneMaterials, MistakesInBlendsAreSaid) {
  const std::string two = std::string(kRed) + kMetal;
  EXPECT_NE(
      error("<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"1\"/>" + two + "</bsdf>")
          .find("1 weights for 2 bsdfs"),
      std::string::npos);
  EXPECT_NE(error("<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"1, -1\"/>" + two +
                  "</bsdf>")
                .find("a weight is -1, expected numbers from 0 to 1000"),
            std::string::npos);
  EXPECT_NE(error("<bsdf type=\"blendbsdf\">" + std::string(kRed) + "</bsdf>").find("expected two"),
            std::string::npos);
  EXPECT_NE(error("<bsdf type=\"blendbsdf\"><bsdf type=\"mask\">" + std::string(kRed) + "</bsdf>" +
                  kMetal + "</bsdf>")
                .find("not a mask"),
            std::string::npos);
  EXPECT_NE(
      error(
          R"(<bsdf type="blendbsdf"><bsdf type="roughdielectric"/><bsdf type="difftrans"/></bsdf>)")
          .find("refract differently"),
      std::string::npos);
}

TEST_F(SceneMaterials, CoatsGoOverWhatReflects) {
  Scene scene;
  const auto coat = [&](const Material& m, bool back = false) {
    return std::get<FurtherBsdf>(scene.bsdfs[at(back ? m.back : m.front)]).bsdf;
  };
  const std::string plain = R"(<bsdf type="coating">)" + std::string(kRed) + "</bsdf>";
  const Material smooth = material(plain, scene);
  EXPECT_FALSE(smooth.twosided);
  const auto defaults = std::get<SmoothCoat>(coat(smooth));
  EXPECT_FLOAT_EQ(defaults.interface.eta, 1.5046f / 1.000277f);
  EXPECT_EQ(defaults.thickness, 1);
  EXPECT_FALSE(defaults.absorption);
  EXPECT_EQ(average(*defaults.specular), Rgbf(1));
  EXPECT_TRUE(std::holds_alternative<Diffuse>(defaults.below->bsdf));
  EXPECT_EQ(defaults.lobes(), 2);

  const Material given = material(
      R"(<bsdf type="roughcoating"><string name="distribution" value="ggx"/><float name="alpha" value="0.2"/>
      <float name="intIOR" value="1.6"/><float name="extIOR" value="1"/><float name="thickness" value="2"/>
      <rgb name="sigmaA" value="0.1, 0.2, 0.3"/><float name="specularReflectance" value="0.5"/>)" +
          std::string(kMetal) + "</bsdf>",
      scene);
  const auto rough = std::get<RoughCoat>(coat(given));
  EXPECT_FLOAT_EQ(rough.interface.eta, 1.6f);
  EXPECT_EQ(rough.interface.facets.distribution, FacetDistribution::kGgx);
  EXPECT_EQ(rough.interface.facets.alpha, 0.2f);
  EXPECT_EQ(rough.thickness, 2);
  EXPECT_EQ(average(*rough.absorption), Rgbf(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(average(*rough.specular), Rgbf(0.5f));
  const auto beckmann = std::get<RoughCoat>(
      coat(material(R"(<bsdf type="roughcoating">)" + std::string(kRed) + "</bsdf>", scene)));
  EXPECT_EQ(beckmann.interface.facets.distribution, FacetDistribution::kBeckmann);
  EXPECT_EQ(beckmann.interface.facets.alpha, 0.1f);

  const Material inside = material(R"(<bsdf type="coating"><bsdf type="twosided">)" +
                                       std::string(kRed) + kMetal + "</bsdf></bsdf>",
                                   scene);
  EXPECT_TRUE(inside.twosided);
  EXPECT_TRUE(std::holds_alternative<Diffuse>(std::get<SmoothCoat>(coat(inside)).below->bsdf));
  EXPECT_TRUE(
      std::holds_alternative<RoughConductor>(std::get<SmoothCoat>(coat(inside, true)).below->bsdf));
  EXPECT_TRUE(material("<bsdf type=\"twosided\">" + plain + "</bsdf>", scene).twosided);
  // Along dp/du, as what is below has it.
  EXPECT_TRUE(material(R"(<bsdf type="coating"><bsdf type="ward"><float name="alphaV" value="0.3"/>
      </bsdf></bsdf>)",
                       scene)
                  .frame);

  const auto refuses = [&](const std::string& below, const char* says) {
    EXPECT_NE(error("<bsdf type=\"coating\">" + below + "</bsdf>").find(says), std::string::npos)
        << below << error("<bsdf type=\"coating\">" + below + "</bsdf>");
  };
  refuses("", "without a bsdf inside");
  refuses(plain, "no coat yet");
  refuses(R"(<bsdf type="dielectric"/>)", "does not let light through");
  refuses("<bsdf type=\"mask\">" + std::string(kRed) + "</bsdf>", "the mask goes around");
  refuses("<bsdf type=\"blendbsdf\">" + std::string(kRed) + kMetal + "</bsdf>", "no blend");
  refuses(R"(<bsdf type="bumpmap"><texture type="checkerboard"/>)" + std::string(kRed) + "</bsdf>",
          "without a bump or normal map");
  refuses(
      R"(<float name="intIOR" value="1.3"/><float name="extIOR" value="1.3"/>)" + std::string(kRed),
      "must differ");
}

TEST_F(SceneMaterials, MapsGoAroundAndIntoTwosided) {
  Scene scene;
  const std::string bump =
      R"(<bsdf type="bumpmap"><texture type="scale"><float name="scale" value="3"/>
    <texture type="checkerboard"/></texture>)";
  const Material one = material(bump + kRed + "</bsdf>", scene);
  ASSERT_TRUE(one.frame);
  EXPECT_EQ(one.frame->kind, FrameMap::Kind::kBump);
  EXPECT_FALSE(one.frame->perSide);
  EXPECT_FLOAT_EQ(average(*one.frame->texture).x, 0.9f);
  const Material inside =
      material("<bsdf type=\"twosided\">" + bump + kRed + "</bsdf></bsdf>", scene);
  EXPECT_TRUE(inside.twosided);
  EXPECT_TRUE(inside.frame && inside.frame->perSide);
  const Material around =
      material(bump + "<bsdf type=\"twosided\">" + kRed + "</bsdf></bsdf>", scene);
  EXPECT_TRUE(around.twosided);
  EXPECT_TRUE(around.frame && !around.frame->perSide);
  EXPECT_NE(error(bump + bump + kRed + "</bsdf></bsdf>").find("without a bump or normal map"),
            std::string::npos);
  EXPECT_NE(error("<bsdf type=\"bumpmap\">" + std::string(kRed) + "</bsdf>").find("texture"),
            std::string::npos);
}

TEST_F(SceneMaterials, AnisotropicOnesFollowTheTexture) {
  Scene scene;
  EXPECT_FALSE(material(R"(<bsdf type="ward"/>)", scene).frame);
  const Material m =
      material(R"(<bsdf type="ward"><float name="alphaV" value="0.3"/></bsdf>)", scene);
  ASSERT_TRUE(m.frame);
  EXPECT_EQ(m.frame->kind, FrameMap::Kind::kTangent);
}

TEST_F(SceneMaterials, TexturesAreTransformed) {
  Scene scene;
  material(R"(<bsdf type="diffuse"><texture name="reflectance" type="checkerboard">
    <transform name="to_uv"><scale x="4" y="2"/><rotate z="1" angle="90"/><translate x="0.5" y="1"/></transform>
    </texture></bsdf>)",
           scene);
  const auto& t = std::get<CheckerboardTexture>(*std::get<Diffuse>(scene.bsdfs[0]).reflectance);
  const Vec2f uv = t.mapping(Vec2f(0.25f, 0.75f));
  EXPECT_NEAR(uv.x, -0.75f * 2 + 0.5f, 1e-6);
  EXPECT_NEAR(uv.y, 0.25f * 4 + 1, 1e-6);
}

TEST_F(SceneMaterials, MeshesTakeBsdfsByName) {
  folder_.write("m.obj", R"(v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 0
usemtl red
f 1 2 3
usemtl blue
f 2 4 3
usemtl red
f 1 3 2
)");
  const auto shapes = [&](const std::string& bsdfs) {
    return folder_.read(testing::sceneWith(
        R"(<shape type="obj"><string name="filename" value="m.obj"/>)" + bsdfs + "</shape>"));
  };
  const Scene scene =
      shapes(R"(<bsdf type="phong" name="blue"/><bsdf type="diffuse" name="red"/>)");
  const auto kind = [](const Scene& s, std::size_t i) {
    return s.materials[at(s.shapes[i].material)].plugin;
  };
  ASSERT_EQ(scene.shapes.size(), 3u);  // and the sphere
  EXPECT_EQ(std::get<TriangleMesh>(scene.shapes[0].geometry).triangles.size(), 2u);
  EXPECT_EQ(kind(scene, 0), "diffuse");
  EXPECT_EQ(std::get<TriangleMesh>(scene.shapes[1].geometry).triangles.size(), 1u);
  EXPECT_EQ(kind(scene, 1), "phong");
  // A nameless one is for the others, and a single one for all.
  const Scene rest = shapes(R"(<bsdf type="phong" name="blue"/><bsdf type="plastic"/>)");
  EXPECT_EQ(kind(rest, 0), "plastic");
  EXPECT_EQ(kind(rest, 1), "phong");
  EXPECT_EQ(kind(shapes(R"(<bsdf type="plastic" name="steel"/>)"), 1), "plastic");
  EXPECT_EQ(shapes(R"(<bsdf type="plastic"/>)").shapes.size(), 2u);
}

}  // namespace
}  // namespace h2mc
