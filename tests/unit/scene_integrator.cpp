// What a scene says of rendering: <integrator>, dpt's <dpt>, and the options they set.
#include <gtest/gtest.h>

#include <algorithm>

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

TEST(SceneIntegrator, OtherMethodsOfMitsubaLeaveTheChoice) {
  const Scene scene = readBody(
      "<integrator type=\"mlt\"><integer name=\"maxDepth\" value=\"8\"/><boolean "
      "name=\"lensPerturbation\" value=\"false\"/></integrator>");
  EXPECT_TRUE(scene.integrator.integrator().empty());
  EXPECT_EQ(scene.options.at("maxDepth"), "8");
  EXPECT_TRUE(hasNote(scene, "integrator \"mlt\""));
  EXPECT_TRUE(readBody("<integrator type=\"photonmapper\"/>").integrator.integrator().empty());
}

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
  EXPECT_EQ(scene.integrator.integer("chains"), 64);
  EXPECT_DOUBLE_EQ(scene.integrator.number("sigma"), 0.03);
  EXPECT_EQ(scene.options.at("lensProbability"), "0.5");
  EXPECT_EQ(scene.options.count("rrDepth"), 0u);
  EXPECT_EQ(scene.options.count("minDepth"), 0u);
  ASSERT_TRUE(scene.seed.has_value());
  EXPECT_EQ(*scene.seed, 3u);
  EXPECT_TRUE(hasNote(scene, "roughnessthreshold"));
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
