// SPDX-License-Identifier: MIT
// Path tracing with next-event estimation, weighted by the power heuristic [Veach 1997, ch. 9].
#include "render/integrator/path_integrator.h"

#include <spdlog/spdlog.h>

#include "render/core/random.h"
#include "render/integrator/sampling_integrator.h"
#include "render/path/path.h"

namespace h2mc {
namespace {

class PathSampler final : public PixelSampler {
 public:
  explicit PathSampler(const PathOptions& options) : options_(options) {}

  double sample(const Scene& scene, Random& random, float filmX, float filmY, SplatList& film,
                SampleTally& tally) override {
    PrimarySample shared;
    drawShared(scene.shared(), random, shared);
    const Rgbf radiance =
        trace(scene, random, shared.time,
              startCamera<float>(scene, filmX, filmY, &shared.time, shared.aperture.data()), tally);
    film.splat(filmX, filmY, radiance);
    return luminance(radiance);
  }

 private:
  static constexpr auto kUnidirectional = Techniques::kUnidirectional;

  static Rgbf finiteOrCounted(const Contribution<float>& c, SampleTally& tally) {
    const Rgbf value = c.value * c.weight;
    const float sum = value.x + value.y + value.z;
    if (sum >= 0 && sum <= std::numeric_limits<float>::max()) return value;
    ++tally.notFinite;
    return Rgbf(0);
  }

  Rgbf trace(const Scene& scene, Random& random, const float time, PathRay<float> ray,
             SampleTally& tally) const {
    Rgbf radiance(0);
    for (int length = 1;; ++length) {
      // s = 0, t = length + 1
      const PrimitiveId id = nextPrimitive(scene, ray, length == 1, time);
      const bool counts = length >= options_.minDepth;
      if (!id.valid()) {
        if (counts && scene.hasEnvironment())
          radiance += finiteOrCounted(
              hitEnvironment<float>(scene, ray, length + 1, kUnidirectional), tally);
        return radiance;
      }
      const PathVertex<float> vertex = arriveAt<float>(scene, ray, id, &time);
      const int light = scene.shapes[id.shape].light;
      if (counts && light >= 0)
        radiance += finiteOrCounted(hitAreaLight<float>(scene, vertex, ray.direction, light,
                                                        length + 1, kUnidirectional, id, &time),
                                    tally);
      if (length == options_.maxDepth) return radiance;
      // s = 1, a path one edge longer
      if (length + 1 >= options_.minDepth)
        radiance += direct(scene, random, time, vertex, id, tally);
      const float u0 = random.uniform(), u1 = random.uniform();
      const LobeId lobe = chooseLobe(scene.bsdfs, materialAt(scene, id), vertex.point.uv, vertex.wi,
                                     u0, u1, random.uniform());
      ray = scatterFrom<float>(scene, vertex, id, lobe, u0, u1, Side::kCamera);
      const float largest = std::max({ray.throughput.x, ray.throughput.y, ray.throughput.z});
      if (!(largest > 0)) return radiance;
      if (length >= options_.rrDepth) {
        const float survival = std::min(0.95f, largest);
        if (random.uniform() >= survival) return radiance;
        ray.throughput *= 1 / survival;
      }
    }
  }

  static Rgbf direct(const Scene& scene, Random& random, const float time,
                     const PathVertex<float>& vertex, PrimitiveId id, SampleTally& tally) {
    int light;
    PrimitiveId primitive;
    const float choice = random.uniform(), u0 = random.uniform(), u1 = random.uniform();
    if (!hasNonDelta(scene.bsdfs, materialAt(scene, id)) ||
        !pickLight(scene, scene.directPicker, choice, light, primitive))
      return Rgbf(0);
    DirectLight<float> sample;
    const Rgbf value =
        finiteOrCounted(connectToLight<float>(scene, vertex, id, light, primitive, u0, u1,
                                              kUnidirectional, sample, &time),
                        tally);
    const bool contributes = value.x > 0 || value.y > 0 || value.z > 0;
    return contributes && lightVisible(scene, vertex.point, light, sample, time) ? value : Rgbf(0);
  }

  PathOptions options_;
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
          "path tracing can't find the light of collimated emitters: it is missing; bdpt and all "
          "integrators with chains have it");
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
