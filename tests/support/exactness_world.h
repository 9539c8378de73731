// SPDX-License-Identifier: MIT
// Each mutation of the lists by itself, on a scene of the tests of exactness.
#pragma once

#include <cstdio>
#include <memory>

#include "exactness.h"
#include "exactness_scenes.h"
#include "mcmc/mutations/multiplexed_large_step.h"
#include "mcmc/mutations/mutations.h"

namespace h2mc::test {

// More verdicts than there are: all together they raise a false alarm with probability kFalseAlarmRate.
inline constexpr int kVerdicts = 1200;

// A kernel with one of the values of its options.
struct Kernel {
  std::string name, mutation;
  std::vector<std::pair<std::string, std::string>> options;
  bool large = false;
};

// One for each value of each option that is a choice.
template <class Plugin>
void addKernels(const Plugin& plugin, bool large, std::vector<Kernel>& kernels) {
  const std::string name(plugin.name);
  kernels.push_back({name, name, {}, large});
  for (const Parameter& p : plugin.parameters) {
    for (std::size_t begin = 0; begin < p.choices.size();) {
      const std::size_t end = std::min(p.choices.find('|', begin), p.choices.size());
      const std::string value(p.choices.substr(begin, end - begin));
      if (value != p.fallback)
        kernels.push_back({name + "_" + value, name, {{std::string(p.name), value}}, large});
      begin = end + 1;
    }
  }
}

inline std::vector<Kernel> allKernels() {
  std::vector<Kernel> kernels;
  for (const LargeStepPlugin& plugin : largeSteps()) addKernels(plugin, true, kernels);
  for (const MutationPlugin& plugin : mutations()) addKernels(plugin, false, kernels);
  return kernels;
}

template <class Plugin>
OptionSet optionsOf(const Plugin& plugin, const Kernel& kernel) {
  OptionSet options({plugin.name, plugin.description, plugin.parameters});
  for (const auto& [name, value] : kernel.options) options.set(name, value);
  return options;
}

// A scene, a map that makes some of its film more important, and what large steps need.
struct World {
  testing::SceneFolder folder;
  Scene scene;
  int maxLength;
  ImportanceMap importance;
  SceneTarget target;
  TechniqueDistribution techniques;

  explicit World(const ExactnessScene& of)
      : scene(folder.read(of.xml)),
        maxLength(of.maxLength),
        importance(map(scene)),
        target(scene, maxLength, importance),
        techniques(1, maxLength) {
    // Some techniques are proposed more often than others.
    std::vector<double> weights;
    for (int i = 0; i < techniques.size(); ++i) weights.push_back(1 + i % 3);
    techniques.setWeights(weights, std::vector<bool>(weights.size(), true));
  }

  static ImportanceMap map(const Scene& scene) {
    Image picture(scene.film.width, scene.film.height);
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        picture.at(x, y) = Rgbf(0.2f + static_cast<float>(x * x + 3 * y) / 40);
    return ImportanceMap(picture, picture, 2);
  }

  KernelMixture alone(const Kernel& kernel, SlotNumbers& slots) const {
    KernelMixture kernels;
    const auto setup = [&](const OptionSet& options) {
      return MutationSetup{target, techniques, 1, options, slots};
    };
    const auto make = [&](const auto& plugin) {
      return plugin.create(setup(optionsOf(plugin, kernel)));
    };
    if (!kernel.large) return alone(make(mutationNamed(kernel.mutation)));
    kernels.large = make(largeStepNamed(kernel.mutation));
    kernels.largeProbability = 1;
    return kernels;
  }
  // Chains that make this step and no other.
  KernelMixture alone(std::unique_ptr<Mutation> mutation) const {
    KernelMixture kernels;
    kernels.large = std::make_unique<MultiplexedLargeStep>(target, techniques);
    kernels.largeProbability = 0;
    kernels.small.push_back({std::move(mutation), 1, {}});
    return kernels;
  }
};

// Whether chains keep the target, as one of kVerdicts; prints in short what was found.
inline ExactnessReport reportOn(const PathTarget& target, KernelMixture& kernels,
                                ExactnessPlan plan = {}) {
  plan.verdicts = kVerdicts;
  ExactnessReport report = checkExactness(target, kernels, 1, plan);
  std::printf("%d samples: acceptance %.3f, smallest p %.2g\n", plan.samples, report.acceptance,
              report.smallestP);
  return report;
}

}  // namespace h2mc::test
