// SPDX-License-Identifier: MIT
// What a comparison's plan says, read and checked, and what its runs are known by.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "mcmc/render/integrator_choice.h"
#include "render/scene/scene.h"

namespace h2mc {

// The scenes and integrators of a plan, read and checked: nothing is rendered before all of it holds.
struct ComparisonSetup {
  struct OneScene {
    Scene scene;
    std::string hash;  // of the scene file
    std::vector<IntegratorChoice> methods;
  };
  std::vector<OneScene> scenes;
};

// Reads each scene at the plan's size, or where it has none at that of the scene's reference
// (sizeForReference).
// Throws SceneError, OptionError, ComparisonError, ImageError.
ComparisonSetup setUp(const ComparisonPlan& plan);

// The key of a run, or (marks left out) of a reference: what has to be the same for an earlier run to
// be used again. Program version, scene file, defines, size, integrator, options and threads.
nlohmann::json runKey(const ComparisonPlan& plan, const ComparisonSetup::OneScene& scene,
                      const OptionSet& integrator);

// FNV-1a over the text, 16 hexadecimal digits.
std::string hashOf(const std::string& text);

// The folder of all runs of one scene, DIR/runs/SCENE.
std::filesystem::path runsFolder(const ComparisonPlan& plan, const ComparedScene& scene);

}  // namespace h2mc
