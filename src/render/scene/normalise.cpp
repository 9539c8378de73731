// SPDX-License-Identifier: MIT
#include "render/scene/normalise.h"

#include <cmath>

#include "render/scene/document_edit.h"
#include "render/scene/properties.h"

namespace h2mc {
namespace {

constexpr double kFarAway = 64;
constexpr double kBrightest = 0x1p20;

}  // namespace

SceneUnits normalise(SceneDocument& document) {
  SceneUnits units;
  try {
    const ScenePlaces places = placesOf(document);
    double reach = 0;
    for (const glm::dvec3& p : places.things)
      reach = std::max(reach, glm::length(p - places.camera));
    if (!places.things.empty() && reach * kFarAway < glm::length(places.camera)) {
      units.origin = places.camera;
      moveScene(document, 1, -units.origin);
    }
    const double brightest = brightestLight(document);
    if (brightest > kBrightest || (brightest > 0 && brightest < 1 / kBrightest)) {
      units.radiance = std::exp2(std::round(std::log2(brightest)));
      scaleRadiance(document, 1 / units.radiance);
    }
  } catch (const SceneError&) {
    // The reader finds the same, and says it where it belongs.
  }
  return units;
}

}  // namespace h2mc
