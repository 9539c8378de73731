// Which integrator renders, with which options.
#pragma once

#include <memory>
#include <string>

#include "render/integrator/integrator.h"

namespace h2mc {

struct IntegratorChoice {
  OptionSet options;
  std::unique_ptr<Integrator> integrator;
};

// `wish` is the command line's "NAME", "NAME:option=value,...", ":option=value,..." or "".
// Without a name it is the scene's integrator, or h2mc. What the scene says about options of the
// same names holds for whatever integrator is chosen; the wish goes before it.
// Throws InputError or OptionError, saying what there is.
IntegratorChoice chooseIntegrator(const std::string& wish, const OptionSet& sceneOptions);

// "a=1,b=2" of the values in force, as chooseIntegrator reads them.
std::string optionText(const OptionSet& options);

// Fails as chooseIntegrator would for the wish alone: before a scene is read.
void checkIntegratorWish(const std::string& wish);

}  // namespace h2mc
