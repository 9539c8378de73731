// Renders what a comparison needs, and finds again what has been rendered.
#pragma once

#include "compare/comparison.h"
#include "compare/observer.h"
#include "mcmc/integrator_choice.h"
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

// Throws SceneError, OptionError, ComparisonError.
ComparisonSetup setUp(const ComparisonPlan& plan);

// Renders with marks, writes the images and, last, the record DIR/runs/SCENE/METHOD/.../record.json.
// A run whose record is there, with the same key (program version, scene file, size, defines,
// integrator, options, seed, threads, marks), is read instead. Repeats are the outer loop and the
// methods' order rotates, so that a machine that slows down hurts all alike.
// Returns false when it was stopped; the records of finished runs stay.
bool renderRuns(const ComparisonPlan& plan, const ComparisonSetup& setup,
                const ComparisonObserver& observer, std::vector<SceneRuns>& results);

// The key of a run, or (marks left out) of a reference.
nlohmann::json runKey(const ComparisonPlan& plan, const ComparisonSetup::OneScene& scene,
                      const OptionSet& integrator);

// FNV-1a over the text, 16 hexadecimal digits.
std::string hashOf(const std::string& text);

// A method's folder for one scene.
std::filesystem::path runsFolder(const ComparisonPlan& plan, const ComparedScene& scene);

}  // namespace h2mc
