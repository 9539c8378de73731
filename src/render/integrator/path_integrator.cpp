// SPDX-License-Identifier: MIT
// Path tracing with next-event estimation, weighted by the power heuristic [Veach 1997, ch. 9].
#include "render/integrator/path_integrator.h"

#include <spdlog/spdlog.h>

#include "render/integrator/camera_walk.h"

namespace h2mc {
namespace {

class PathSampler final : public PixelSampler {
 public:
  explicit PathSampler(const PathOptions& options) : walk_(options) {}

  double sample(const Scene& scene, Random& random, float filmX, float filmY, SplatList& film,
                SampleTally& tally) override {
    PrimarySample shared;
    drawShared(scene.shared(), random, shared);
    const Rgbf radiance = walk_.radiance(
        scene, random, shared.time,
        startCamera<float>(scene, filmX, filmY, &shared.time, shared.aperture.data()), tally,
        [](const auto&...) { return CameraWalk::Visited{}; });
    film.splat(filmX, filmY, radiance);
    return luminance(radiance);
  }

 private:
  CameraWalk walk_;
};

class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const OptionSet& options)
      : options_(options),
        path_{options.integer("minDepth"), maxPathLength(options), options.integer("rrDepth")} {
    for (const char* name : {"minDepth", "rrDepth", "samplesPerPixel"})
      requireRange(options, name, 1, kNoLimit);
  }

  RenderResult render(const Scene& scene, const RenderRequest& request) override {
    if (scene.hasBeam())
      spdlog::warn(
          "path tracing can't find the light of collimated emitters: it is missing; bdpt, photon "
          "and "
          "all integrators with chains have it");
    return renderSamples(scene, request, options_.integer("samplesPerPixel"),
                         [&] { return std::make_unique<PathSampler>(path_); });
  }

 private:
  OptionSet options_;
  PathOptions path_;
};

constexpr Parameter kPathParameters[] = {
    kMaxDepthParameter,
    kMinDepthParameter,
    {"rrDepth", ParameterType::kInteger, "5", "length from which Russian roulette may end a path"},
    {"samplesPerPixel", ParameterType::kInteger, "64",
     "samples for each pixel, if no budget is given"},
};

}  // namespace

std::unique_ptr<PixelSampler> makePathSampler(const PathOptions& options) {
  return std::make_unique<PathSampler>(options);
}

IntegratorFactory pathIntegrator() {
  return {{"path", "path tracing with next-event estimation and multiple importance sampling",
           kPathParameters},
          [](const OptionSet& options) -> std::unique_ptr<Integrator> {
            return std::make_unique<PathIntegrator>(options);
          }};
}

}  // namespace h2mc
