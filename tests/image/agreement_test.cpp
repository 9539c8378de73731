// SPDX-License-Identifier: MIT
// The integrators against each other on the project's own scenes.
#include <algorithm>

#include "image_check.h"

namespace h2mc::test {
namespace {

std::vector<std::string> ownScenes() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(H2MC_SOURCE_DIR) + "/scenes")) {
    const std::string name = entry.path().filename().string();
    if (std::filesystem::exists(entry.path() / (name + ".xml"))) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

// The others take a minute or more each, and are compared when H2MC_TEST_EFFORT is given.
bool everyTime(const std::string& name) { return name == "ring"; }

// Path tracing finds small lights by chance: what it takes to be as certain as the others.
long long pathSamples(const std::string& name) {
  return name == "swords" || name == "cars" ? 512 : 64;
}

class OwnScenes : public testing::TestWithParam<std::string> {};

TEST_P(OwnScenes, SlowIntegratorsAgree) {
  constexpr int kEdge = 16, kRuns = 16;
  const std::string& name = GetParam();
  if (!everyTime(name) && std::getenv("H2MC_TEST_EFFORT") == nullptr)
    GTEST_SKIP() << "compared with H2MC_TEST_EFFORT only";
  const Scene scene =
      readTestScene(std::string(H2MC_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".xml", 96, 72);
  const std::vector<std::pair<std::string, std::string>> options{{"maxDepth", "5"}};
  // Bidirectional path tracing sees every path that the chains see, with independent samples.
  const Runs trusted = renderRuns(scene, "bdpt", options, kRuns, 48, kEdge);
  std::vector<double> mean, variance;
  for (std::size_t k = 0; k < trusted.size(); ++k) {
    mean.push_back(trusted.mean(k));
    variance.push_back(trusted.variance(k));
  }
  // What limits the chains' mean is their brightness, which the bootstrap gives, and direct light.
  auto chains = options;
  chains.insert(chains.end(),
                {{"bootstrapSamples", "150000"}, {"directSamples", "48"}, {"chains", "256"}});
  for (const char* integrator :
       {"path", "mmlt", "h2mc", "lmc", "rjmlt", "mlt", "pssmlt", "remlt"}) {
    const bool path = std::string(integrator) == "path";
    expectAgreement(renderRuns(scene, integrator, path ? options : chains, kRuns,
                               path ? pathSamples(name) : 8, kEdge),
                    mean, variance, 1.7e-2, name + " " + integrator);
  }
  auto tours = options;
  tours.insert(tours.end(), {{"directSamples", "48"}});
  for (const char* integrator : {"erpt:chainLength", "restore:tourLength"}) {
    const std::string text(integrator);
    const std::size_t colon = text.find(':');
    auto own = tours;
    own.insert(own.end(), {{text.substr(colon + 1), "10"}});
    expectAgreement(renderRuns(scene, text.substr(0, colon), own, kRuns, 32, kEdge), mean, variance,
                    1.7e-2, name + " " + text.substr(0, colon));
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, OwnScenes, testing::ValuesIn(ownScenes()), [](const auto& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace h2mc::test
