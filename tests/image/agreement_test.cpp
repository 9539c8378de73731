// The integrators against each other on the project's own scenes.
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

class OwnScenes : public testing::TestWithParam<std::string> {};

TEST_P(OwnScenes, SlowIntegratorsAgree) {
  constexpr int kEdge = 16, kRuns = 8;
  const std::string& name = GetParam();
  const Scene scene =
      readTestScene(std::string(H2MC_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".xml", 96, 72);
  const auto depth = std::pair<std::string, std::string>{"maxDepth", "5"};
  // Bidirectional path tracing sees every path that the chains see, with independent samples.
  const Runs trusted = renderRuns(scene, "bdpt", {depth}, 16, 96, kEdge);
  std::vector<double> mean, variance;
  for (std::size_t k = 0; k < trusted.size(); ++k) {
    mean.push_back(trusted.mean(k));
    variance.push_back(trusted.variance(k));
  }
  for (const char* integrator : {"path", "mmlt", "h2mc"}) {
    std::vector<std::pair<std::string, std::string>> options{depth};
    const bool chain = std::string(integrator) != "path";
    if (chain) {
      options.emplace_back("bootstrapSamples", "400000");
      options.emplace_back("chains", "256");
    }
    expectAgreement(renderRuns(scene, integrator, options, kRuns, chain ? 48 : 192, kEdge), mean,
                    variance, chain ? 3e-2 : 1e-2, name + " " + integrator);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, OwnScenes, testing::ValuesIn(ownScenes()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace h2mc::test
