// SPDX-License-Identifier: MIT
// What a path costs: its value, derivatives, Gaussian and mutations, by scene and by length.
//
// Every figure is the mean over the same mixture of techniques, so that "value" is the unit for the
// others of its row. scripts/bench-table.py makes the table of docs/measurements.md of them.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "mcmc/mutations/hamiltonian_step.h"
#include "mcmc/mutations/isotropic_step.h"
#include "mcmc/mutations/langevin_step.h"
#include "mcmc/mutations/lens_step.h"
#include "mcmc/render/integrators.h"
#include "render/core/index.h"
#include "render/path/assemble.h"
#include "render/path/path_densities.h"
#include "render/path/replay.h"
#include "render/scene/scene_reader.h"
#include "sampled_paths.h"

namespace h2mc {
namespace {

// So many samples find enough of the long paths even in the open ring scene: among few, one that is done
// again in double would count too much.
constexpr int kMaxLength = 8, kPerTechnique = 12, kSamples = 300000;

struct SampledScene {
  Scene scene;
  std::vector<std::vector<Path>> byLength{kMaxLength + 1};
};

// Read and sampled once; null where the scene's file is absent.
const SampledScene* sampledScene(const std::string& file) {
  static std::map<std::string, std::unique_ptr<SampledScene>> scenes;
  auto [it, added] = scenes.try_emplace(file);
  if (added && std::filesystem::exists(file)) {
    ReadOptions options;
    std::vector<IntegratorPlugin> plugins;
    for (const IntegratorFactory& f : allIntegrators()) plugins.push_back(f.plugin);
    options.integrators = plugins;
    it->second = std::make_unique<SampledScene>(SampledScene{readScene(file, options)});
    test::forSampledPaths(it->second->scene, kMaxLength, kPerTechnique, kSamples,
                          [&](const Path& path, float) {
                            it->second->byLength[at(path.technique.length())].push_back(path);
                          });
  }
  return it->second.get();
}

// Runs `work(scene, path)` on the scene's paths of one length, one after the other.
template <class Work>
void overPaths(benchmark::State& state, const std::string& file, int length, Work&& work,
               bool (*wanted)(const Scene&, const Path&) = nullptr) {
  const SampledScene* sampled = sampledScene(file);
  if (!sampled) return state.SkipWithError("no such scene");
  std::vector<const Path*> paths;
  for (const Path& path : sampled->byLength[at(length)])
    if (!wanted || wanted(sampled->scene, path)) paths.push_back(&path);
  if (paths.empty()) return state.SkipWithError("no path of this length");
  std::size_t i = 0;
  for (auto _ : state) {
    work(sampled->scene, *paths[i]);
    if (++i == paths.size()) i = 0;
  }
}

void value(benchmark::State& state, const std::string& file, int length) {
  overPaths(state, file, length, [](const Scene& scene, const Path& path) {
    benchmark::DoNotOptimize(replayLogTarget<float>(scene, path, path.sample.u.data()));
  });
}

void derivative(benchmark::State& state, const std::string& file, int length) {
  Derivative result;
  overPaths(state, file, length, [&](const Scene& scene, const Path& path) {
    differentiateLocally(scene, path, result);
    benchmark::DoNotOptimize(result);
  });
}

void plainDerivative(benchmark::State& state, const std::string& file, int length) {
  if (2 * length > kMaxPlainDimension) return state.SkipWithError("not compiled");
  Derivative result;
  overPaths(
      state, file, length,
      [&](const Scene& scene, const Path& path) {
        differentiatePlainly(scene, path, result);
        benchmark::DoNotOptimize(result);
      },
      [](const Scene& scene, const Path& path) {
        Derivative unused;
        return differentiatePlainly(scene, path, unused);
      });
}

// The derivatives in the form that is chosen, and with the Gaussian made of them: the difference is the
// Gaussian's cost.
void chosenDerivative(benchmark::State& state, const std::string& file, int length) {
  Derivative result;
  overPaths(state, file, length, [&](const Scene& scene, const Path& path) {
    differentiate(scene, path, result);
    benchmark::DoNotOptimize(result);
  });
}

void gradientAlone(benchmark::State& state, const std::string& file, int length) {
  Gradient result;
  overPaths(state, file, length, [&](const Scene& scene, const Path& path) {
    differentiateOnce(scene, path, result);
    benchmark::DoNotOptimize(result);
  });
}

void gaussian(benchmark::State& state, const std::string& file, int length) {
  Derivative result;
  Gaussian made;
  overPaths(state, file, length, [&](const Scene& scene, const Path& path) {
    differentiate(scene, path, result);
    hamiltonianGaussian(result, {}, made);
    benchmark::DoNotOptimize(made);
  });
}

void sampleAndDensity(benchmark::State& state, const std::string& file, int length) {
  std::map<const Path*, Gaussian> gaussians;
  Random random(1, 2, 3);
  float offset[kMaxCoordinates];
  overPaths(state, file, length, [&](const Scene& scene, const Path& path) {
    auto [it, added] = gaussians.try_emplace(&path);
    if (added) {
      Derivative result;
      differentiate(scene, path, result);
      hamiltonianGaussian(result, {}, it->second);
    }
    it->second.sample(random, offset);
    benchmark::DoNotOptimize(it->second.logDensity(offset));
  });
}

// One proposal from each path in turn, evaluated and with its densities: derivatives of the state
// itself are kept, as in a chain that has rejected; those of proposals with a positive target are
// computed.
void mutation(benchmark::State& state, const std::string& file, int length,
              const std::function<std::unique_ptr<Mutation>(const SceneTarget&)>& make) {
  const SampledScene* sampled = sampledScene(file);
  if (!sampled) return state.SkipWithError("no such scene");
  const ImportanceMap everywhere;
  const SceneTarget target(sampled->scene, kMaxLength, everywhere);
  const std::unique_ptr<Mutation> kernel = make(target);
  std::map<const Path*, ChainState> states;
  ChainState proposed(kMaxLength);
  Random random(1, 2, 3);
  MutationContext context;
  context.random = &random;
  overPaths(state, file, length, [&](const Scene&, const Path& path) {
    auto [it, added] = states.try_emplace(&path, kMaxLength);
    if (added) it->second.path = path;
    proposed.forget();
    benchmark::DoNotOptimize(kernel->propose(it->second, proposed, context));
  });
}

// The path in path space, with the densities of all techniques; and assembled in the technique that has most
// of its weight.
void pathDensities(benchmark::State& state, const std::string& file, int length) {
  auto full = std::make_unique<FullPath>();
  overPaths(state, file, length, [&](const Scene& scene, const Path& path) {
    toFull(scene, path, *full);
    benchmark::DoNotOptimize(densities(scene, *full));
  });
}
void densitiesAndAssemble(benchmark::State& state, const std::string& file, int length) {
  auto full = std::make_unique<FullPath>();
  Path assembled(kMaxLength);
  Random random(1, 0, 0);
  overPaths(state, file, length, [&](const Scene& scene, const Path& path) {
    toFull(scene, path, *full);
    const TechniqueDensities d = densities(scene, *full);
    const auto end = d.weight.begin() + d.edges + 1;
    const auto s = static_cast<int>(std::max_element(d.weight.begin(), end) - d.weight.begin());
    benchmark::DoNotOptimize(
        assemble(scene, *full, {s, d.edges + 1 - s}, kNoEdge, random, assembled));
  });
}

void registerScene(const std::string& name, const std::string& file) {
  const auto add = [&](const std::string& what, auto&& function, auto&&... more) {
    for (int length = 1; length <= kMaxLength; ++length)
      benchmark::RegisterBenchmark(
          (name + "/" + what + "/length:" + std::to_string(length)).c_str(),
          [=](benchmark::State& state) { function(state, file, length, more...); });
  };
  add("value", value);
  add("derivative", derivative);
  add("plain derivative", plainDerivative);
  add("chosen derivative", chosenDerivative);
  add("gradient", gradientAlone);
  add("derivative+gaussian", gaussian);
  add("sample+density", sampleAndDensity);
  add("path densities", pathDensities);
  add("path densities+assemble", densitiesAndAssemble);
  using Make = std::function<std::unique_ptr<Mutation>(const SceneTarget&)>;
  add("mutation:isotropic", mutation, Make([](const SceneTarget& target) {
        return std::make_unique<IsotropicStep>(target, StepShape::kGaussian, 0.01f);
      }));
  add("mutation:hamiltonian", mutation, Make([](const SceneTarget& target) {
        SlotNumbers slots;
        return std::make_unique<HamiltonianStep>(target, HamiltonianSettings{}, slots);
      }));
  add("mutation:langevin", mutation, Make([](const SceneTarget& target) {
        SlotNumbers slots;
        return std::make_unique<LangevinStep>(target, LangevinStep::Settings{}, slots);
      }));
}

const bool registered = [] {
  const std::string data = H2MC_DATA_DIR, own = H2MC_SOURCE_DIR;
  registerScene("torus", data + "/torus/torus.xml");
  registerScene("ring", own + "/scenes/ring/ring.xml");
  registerScene("bathroom", data + "/bathroom/bathroom.xml");
  return true;
}();

}  // namespace
}  // namespace h2mc
