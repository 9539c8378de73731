// SPDX-License-Identifier: MIT
// Images of other programs in a comparison.
#pragma once

#include <optional>

#include "compare/comparison.h"

namespace h2mc {

// The images of a method for one scene: EXR files in FOLDER/SCENE, or in FOLDER itself where there is
// only one scene or no such folder and the file's name holds the scene's. The time of each is its
// attribute "wallSeconds", "seconds" or "time", or what stands before an "s" in its name
// ("ring-2.5s-a.exr"). Images of the same time are repeats, in the order of their names. Throws
// ComparisonError or ImageError: no images, no time, another size.
MethodRuns readExternal(const ExternalMethod& method, const SceneRuns& scene, bool onlyScene);

// The number before the last "s" that ends a word in a file's name, or "sec"; none: no such thing.
std::optional<double> secondsInName(const std::string& name);

// "name=DIR". Throws ComparisonError.
ExternalMethod parseExternal(const std::string& text);

}  // namespace h2mc
