// SPDX-License-Identifier: MIT
// What a scene says of rendering: <integrator>, dpt's <dpt>, and the options they set.
#include <gtest/gtest.h>

#include <algorithm>

#include "mcmc/render/integrators.h"
#include "scene_files.h"

namespace h2mc::testing {
namespace {

bool hasNote(const Scene& scene, const std::string& part) {
  return std::any_of(scene.notes.begin(), scene.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

Scene readBody(const std::string& body) { return SceneFolder().read(sceneWith(body)); }

TEST(SceneIntegrator, OwnIntegratorsByTheirTables) {
  const Scene scene = readBody(
      "<integrator type=\"h2mc\"><integer name=\"maxDepth\" value=\"7\"/><float name=\"sigma\" "
      "value=\"0.02\"/><boolean name=\"adapt\" value=\"false\"/><string name=\"proposal\" "
      "value=\"Isotropic\"/></integrator>");
  EXPECT_EQ(scene.integrator.integrator(), "h2mc");
  EXPECT_EQ(scene.integrator.integer("maxDepth"), 7);
  EXPECT_DOUBLE_EQ(scene.integrator.number("sigma"), 0.02);
  EXPECT_FALSE(scene.integrator.boolean("adapt"));
  EXPECT_EQ(scene.integrator.string("proposal"), "isotropic");
  EXPECT_EQ(scene.integrator.integer("chains"), 128);
  EXPECT_TRUE(scene.integrator.given("sigma"));
  EXPECT_FALSE(scene.integrator.given("chains"));
  EXPECT_EQ(scene.options.at("maxDepth"), "7");
}

TEST(SceneIntegrator, MitsubasPathIsOurs) {
  const Scene scene = readBody(
      "<integrator type=\"path\"><integer name=\"maxDepth\" value=\"-1\"/><integer "
      "name=\"rrDepth\" "
      "value=\"100\"/><boolean name=\"strictNormals\" value=\"true\"/></integrator>");
  EXPECT_EQ(scene.integrator.integrator(), "path");
  EXPECT_EQ(scene.integrator.integer("maxDepth"), -1);
  EXPECT_EQ(scene.integrator.integer("rrDepth"), 100);
  EXPECT_TRUE(hasNote(scene, "strictNormals"));
}

TEST(SceneIntegrator, OtherMethodsOfMitsubaAreRenderedByTheNearest) {
  const Scene scene = readBody(
      "<integrator type=\"mlt\"><integer name=\"maxDepth\" value=\"8\"/><boolean "
      "name=\"lensPerturbation\" value=\"false\"/></integrator>");
  EXPECT_EQ(scene.integrator.integrator(), "mmlt");
  EXPECT_EQ(scene.integrator.integer("maxDepth"), 8);
  EXPECT_EQ(scene.options.at("maxDepth"), "8");
  EXPECT_TRUE(hasNote(scene, "lensPerturbation of integrator \"mlt\""));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("scene.xml:2:19: warning: integrator \"mlt\" is rendered by "
                                   "\"mmlt\"\n"),
            std::string::npos)
      << scene.warnings[0];
  for (const auto& [theirs, ours] :
       {std::pair("volpath", "path"), std::pair("volpath_simple", "path"),
        std::pair("guided_path", "path"), std::pair("vcm", "bdpt")}) {
    const Scene read = readBody("<integrator type=\"" + std::string(theirs) + "\"/>");
    EXPECT_EQ(read.integrator.integrator(), ours);
    EXPECT_EQ(read.warnings.size(), 1u) << theirs;
  }
}

// Mitsuba's own words: those that mean the same here are taken, the others are known.
TEST(SceneIntegrator, ErptOfMitsubaIsOurs) {
  const std::vector<IntegratorPlugin> plugins = integratorPlugins();
  ReadOptions options;
  options.integrators = plugins;
  const SceneFolder folder;
  const Scene scene = readScene(
      folder.write(
          "scene.xml",
          sceneWith("<integrator type=\"erpt\"><integer name=\"maxDepth\" value=\"8\"/>"
                    "<float name=\"numChains\" value=\"2\"/><integer name=\"chainLength\" "
                    "value=\"50\"/><integer name=\"maxChains\" value=\"3\"/>"
                    "<boolean name=\"manifoldPerturbation\" value=\"true\"/></integrator>")),
      options);
  EXPECT_EQ(scene.integrator.integrator(), "erpt");
  EXPECT_EQ(scene.integrator.integer("maxDepth"), 8);
  EXPECT_EQ(scene.integrator.number("numChains"), 2);
  EXPECT_EQ(scene.integrator.integer("chainLength"), 50);
  EXPECT_TRUE(hasNote(scene, "maxChains"));
  EXPECT_TRUE(hasNote(scene, "manifoldPerturbation"));
  EXPECT_TRUE(scene.warnings.empty());
}

// A table entry is for as long as there is no method of that name.
TEST(SceneIntegrator, OwnMethodsGoBeforeTheTable) {
  static constexpr Parameter kParameters[] = {
      {"maxDepth", ParameterType::kInteger, "-1", "longest path"}};
  static const IntegratorPlugin kPlugins[] = {{"mmlt", "", kParameters}, {"mlt", "", kParameters}};
  const SceneFolder folder;
  ReadOptions options;
  options.integrators = kPlugins;
  const Scene scene =
      readScene(folder.write("scene.xml", sceneWith("<integrator type=\"mlt\"/>")), options);
  EXPECT_EQ(scene.integrator.integrator(), "mlt");
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(SceneIntegrator, UnknownOnesAreWarnedOf) {
  const Scene scene = readBody(
      "<integrator type=\"h2nc\"><integer name=\"maxDepth\" value=\"6\"/><float name=\"x\" "
      "value=\"1\"/></integrator>");
  EXPECT_TRUE(scene.integrator.integrator().empty());
  EXPECT_EQ(scene.options.at("maxDepth"), "6");
  ASSERT_EQ(scene.warnings.size(), 1u);
  for (const char* part : {"scene.xml:2:19: warning: unknown integrator \"h2nc\"\n", "-i NAME",
                           "did you mean \"h2mc\"", "path"})
    EXPECT_NE(scene.warnings[0].find(part), std::string::npos) << scene.warnings[0];
}

TEST(SceneIntegrator, DirectIsDirectLight) {
  const Scene scene = readBody("<integrator type=\"direct\"/>");
  EXPECT_EQ(scene.integrator.integrator(), "path");
  EXPECT_EQ(scene.integrator.integer("maxDepth"), 2);
  EXPECT_EQ(scene.options.at("maxDepth"), "2");  // by whatever it is rendered
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(SceneIntegrator, WrappersStandForTheOneInside) {
  const Scene scene = readBody(
      "<integrator type=\"aov\"><string name=\"aovs\" value=\"dd:depth\"/>"
      "<integrator type=\"moment\"><integrator type=\"path\"><integer name=\"maxDepth\" "
      "value=\"5\"/></integrator></integrator></integrator>");
  EXPECT_EQ(scene.integrator.integrator(), "path");
  EXPECT_EQ(scene.integrator.integer("maxDepth"), 5);
  EXPECT_TRUE(hasNote(scene, "\"aov\""));
  EXPECT_TRUE(hasNote(scene, "\"moment\""));
  const Scene referred = readBody(
      "<integrator type=\"bdpt\" id=\"inner\"/>"
      "<integrator type=\"adaptive\"><ref id=\"inner\"/></integrator>");
  EXPECT_EQ(referred.integrator.integrator(), "bdpt");
  // Nothing inside: as any other that there is not.
  EXPECT_EQ(readBody("<integrator type=\"adaptive\"/>").warnings.size(), 1u);
  // One that contains itself ends.
  readBody("<integrator type=\"moment\" id=\"a\"><ref id=\"a\"/></integrator>");
}

TEST(SceneIntegrator, HiddenEmittersLeaveOutPathsOfOneEdge) {
  const std::string hide = "<boolean name=\"hideEmitters\" value=\"true\"/>";
  EXPECT_EQ(readBody("<integrator type=\"path\">" + hide + "</integrator>").options.at("minDepth"),
            "2");
  EXPECT_EQ(
      readBody("<integrator type=\"direct\">" + hide + "</integrator>").options.at("minDepth"),
      "2");
  EXPECT_EQ(readBody("<integrator type=\"unknown\"><boolean name=\"hide_emitters\" value=\"true\"/>"
                     "</integrator>")
                .options.at("minDepth"),
            "2");
  EXPECT_EQ(readBody("<integrator type=\"path\"><boolean name=\"hideEmitters\" value=\"false\"/>"
                     "</integrator>")
                .options.count("minDepth"),
            0u);
  // A lamp behind a hole of a mask would still be seen.
  const std::string mask =
      "<shape type=\"disk\"><bsdf type=\"mask\"><float name=\"opacity\" value=\"0.5\"/>"
      "<bsdf type=\"diffuse\"/></bsdf></shape>";
  const std::string scene = sceneWith("<integrator type=\"path\">" + hide + "</integrator>" + mask);
  const std::string message = SceneFolder().error(scene);
  EXPECT_NE(message.find("hideEmitters in a scene with masks"), std::string::npos) << message;
  ReadOptions permissive;
  permissive.strictness = Strictness::kPermissive;
  EXPECT_EQ(SceneFolder().read(scene, permissive).warnings.size(), 1u);
}

// It goes before an <integrator>; what it says of how to sample is not for us.
TEST(SceneIntegrator, DptBlockWins) {
  const Scene scene = readBody(
      "<dpt><string name=\"integrator\" value=\"mcmc\"/><boolean name=\"h2mc\" value=\"true\"/>"
      "<integer name=\"spp\" value=\"256\"/><integer name=\"maxdepth\" value=\"8\"/>"
      "<integer name=\"mindepth\" value=\"-1\"/><float name=\"perturbstddev\" value=\"0.03\"/>"
      "<integer name=\"numchains\" value=\"64\"/><float name=\"lensperturbprob\" value=\"0.5\"/>"
      "<integer name=\"seedoffset\" value=\"3\"/><float name=\"roughnessthreshold\" "
      "value=\"0.01\"/>"
      "</dpt><integrator type=\"path\"><integer name=\"rrDepth\" value=\"3\"/></integrator>");
  EXPECT_EQ(scene.integrator.integrator(), "h2mc");
  EXPECT_EQ(scene.integrator.integer("mutationsPerPixel"), 256);
  EXPECT_EQ(scene.integrator.integer("maxDepth"), 8);
  EXPECT_FALSE(scene.integrator.given("chains"));
  EXPECT_FALSE(scene.integrator.given("sigma"));
  EXPECT_EQ(scene.options.count("lensProbability"), 0u);
  EXPECT_EQ(scene.options.count("rrDepth"), 0u);
  EXPECT_EQ(scene.options.count("minDepth"), 0u);
  ASSERT_TRUE(scene.seed.has_value());
  EXPECT_EQ(*scene.seed, 3u);
  EXPECT_TRUE(
      hasNote(scene, "perturbstddev, lensperturbprob, numchains, roughnessthreshold of <dpt>"));
}

TEST(SceneIntegrator, DptMethods) {
  const auto method = [](const std::string& inside) {
    return readBody("<dpt>" + inside + "</dpt>").integrator.integrator();
  };
  const std::string mc = "<string name=\"integrator\" value=\"mc\"/>";
  EXPECT_EQ(method(""), "h2mc");
  EXPECT_EQ(method("<boolean name=\"h2mc\" value=\"false\"/>"), "mmlt");
  EXPECT_EQ(method(mc), "bdpt");
  EXPECT_EQ(method(mc + "<boolean name=\"bidirectional\" value=\"false\"/>"), "path");
  const Scene scene = readBody("<dpt>" + mc + "<integer name=\"spp\" value=\"9\"/></dpt>");
  EXPECT_EQ(scene.integrator.integer("samplesPerPixel"), 9);
}

TEST(OptionSet, KnowsItsTable) {
  OptionSet options(testIntegrators()[3]);
  EXPECT_TRUE(options.has("sigma"));
  EXPECT_FALSE(options.has("sigmas"));
  EXPECT_EQ(options.values().size(), 6u);
  options.set("adapt", " False ");
  EXPECT_EQ(options.string("adapt"), "false");
  options.set("sigma", "1e-3");
  EXPECT_DOUBLE_EQ(options.number("sigma"), 1e-3);
  EXPECT_THROW(options.integer("unknown"), std::logic_error);
}

TEST(OptionSet, RefusesWithAList) {
  OptionSet options(testIntegrators()[3]);
  const auto message = [&](const char* name, const char* value) -> std::string {
    try {
      options.set(name, value);
    } catch (const OptionError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(message("sigmma", "1").find("did you mean \"sigma\"?"), std::string::npos);
  EXPECT_NE(message("sigma", "big").find("\"big\" is not a number"), std::string::npos);
  EXPECT_NE(message("chains", "1.5").find("is not an integer"), std::string::npos);
  EXPECT_NE(message("adapt", "yes").find("neither true nor false"), std::string::npos);
  EXPECT_NE(message("proposal", "hesian").find("did you mean \"hessian\"?"), std::string::npos);
  EXPECT_FALSE(options.given("sigma"));
}

TEST(OptionSet, WithoutATableIsEmpty) {
  OptionSet options;
  EXPECT_TRUE(options.integrator().empty());
  EXPECT_FALSE(options.has("maxDepth"));
  EXPECT_THROW(options.set("maxDepth", "3"), OptionError);
}

}  // namespace
}  // namespace h2mc::testing
