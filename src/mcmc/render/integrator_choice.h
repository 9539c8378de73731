// SPDX-License-Identifier: MIT
// Which integrator renders, with which options.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "render/integrator/integrator.h"
#include "render/scene/scene.h"

namespace h2mc {

// "NAME" or "NAME:option=value,..." in parts.
struct NamedOptions {
  std::string name;
  std::vector<std::pair<std::string, std::string>> options;
};
// Throws OptionError.
NamedOptions namedOptions(const std::string& text);

struct IntegratorChoice {
  OptionSet options;
  std::unique_ptr<Integrator> integrator;
};

// `wish` is the command line's "NAME", "NAME:option=value,...", ":option=value,..." or "", where NAME is an integrator
// or a preset.
// Without a name it is the scene's integrator, or h2mc. What the scene says in the words of another
// integrator holds where the chosen one has an option of that name; the wish goes before it.
// Throws OptionError, saying what there is.
IntegratorChoice chooseIntegrator(const std::string& wish, const Scene& scene);

// "a=1,b=2" of the values in force, as chooseIntegrator reads them.
std::string optionText(const OptionSet& options);

// Fails as chooseIntegrator would for the wish alone: before a scene is read.
void checkIntegratorWish(const std::string& wish);

}  // namespace h2mc
