// SPDX-License-Identifier: MIT
// A scene as the integrators see it: read, checked, in world space, ready to trace.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/bsdf/bsdf.h"
#include "render/camera/camera.h"
#include "render/camera/film_settings.h"
#include "render/core/shared_coordinates.h"
#include "render/geometry/shape.h"
#include "render/light/light.h"
#include "render/light/light_picker.h"
#include "render/scene/option_set.h"

namespace h2mc {

class RayTracer;

struct Scene {
  Scene();
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  std::string file;                // the scene file's path as given
  std::vector<std::string> files;  // all that were read, this one among them
  Camera camera;
  FilmSettings film;
  std::vector<Shape> shapes;
  std::vector<Material> materials;
  std::vector<Bsdf> bsdfs;
  std::vector<Light> lights;
  int environment = -1;  // index of the constant or envmap light, or -1; suns stand before it
  OptionSet integrator;  // what the scene asks for; integrator() is empty when it does not say
  // What the scene says of rendering in any integrator's words, by our options' names (maxDepth,
  // sigma, ...): for an integrator that is not the scene's own; what it does not have is not for it.
  std::map<std::string, std::string, std::less<>> options;
  int samplesPerPixel = 0;            // the sampler's sampleCount; 0 when it does not say
  std::optional<std::uint64_t> seed;  // where the scene gives one
  // Coordinates are relative to this point of the scene file's world, radiances in multiples of this
  // number of its units (normalise.h); (0, 0, 0) and 1 for all but extreme scenes. Pictures that
  // integrators return are in the file's units.
  glm::dvec3 origin{0};
  double radianceUnit = 1;
  std::vector<std::string> notes;  // accepted and not used, left out because nothing needs it
  // What is likely a mistake, or not rendered as the scene asks for: whole messages with place and caret.
  std::vector<std::string> warnings;

  // Made by finish():
  bool moving = false;  // the camera or any shape moves while the shutter is open
  SceneBounds bounds;   // of all that is in it at any moment
  // How probable each light is: for next-event estimation, and for a light subpath to start from.
  LightPicker directPicker, emissionPicker;
  std::unique_ptr<RayTracer> tracer;
  // The lights that are a SunLight, and their discs.
  std::vector<int> sunLights;
  std::vector<SkyDisc> suns;

  // The coordinates that all paths have besides their technique's.
  SharedCoordinates shared() const { return {camera.hasAperture(), moving}; }
  LightContext lightContext() const { return {shapes, bounds, suns}; }
  // Whether there is light where a ray leaves the scene, and which, in a direction; -1 for none.
  bool hasEnvironment() const { return environment >= 0 || !suns.empty(); }
  int environmentAt(const Vec3f& direction) const {
    for (std::size_t i = 0; i < suns.size(); ++i)
      if (suns[i].covers(direction)) return sunLights[i];
    return environment;
  }

  // Whether a light is a beam, whose light no path has that starts from the camera alone.
  bool hasBeam() const;

  // Computes what follows from the parts: bounds, light probabilities, the tracer. Call once, when
  // shapes, materials and lights are in place. Throws std::runtime_error if Embree fails.
  void finish();
};

// A sphere around all shapes.
SceneBounds boundsOf(std::span<const Shape> shapes);

}  // namespace h2mc
