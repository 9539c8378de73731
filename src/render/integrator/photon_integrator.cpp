// SPDX-License-Identifier: MIT
// Stochastic progressive photon mapping [Hachisuka and Jensen 2009] in the probabilistic form [Knaus and Zwicker 2011].
//
// The camera's path goes on through narrow lobes and ends at a wide one. What arrives there straight from a light is
// found as path tracing finds it, by both of its techniques; all else by photons. Every path has one vertex that is its
// first wide one as seen from the camera, or none, so nothing counts twice.
#include "render/integrator/photon_integrator.h"

#include "render/integrator/common_options.h"
#include "render/integrator/sampling_integrator.h"
#include "render/photon/photon_pass.h"

namespace h2mc {
namespace {

// Light paths by default: for each pixel, and in a pass at most, which takes some 300 MB.
constexpr long long kByDefault = 4, kMostByDefault = 1 << 19;

class PhotonSampler final : public PixelSampler {
 public:
  PhotonSampler(const PhotonPass& pass, const PathOptions& options) : pass_(pass), walk_(options) {}

  double sample(const Scene& scene, Random& random, float filmX, float filmY, SplatList& film,
                SampleTally& tally) override {
    PrimarySample shared;
    drawShared(scene.shared(), random, shared);
    shared.time = pass_.time();
    const Rgbf radiance = walk_.radiance(
        scene, random, shared.time,
        startCamera<float>(scene, filmX, filmY, &shared.time, shared.aperture.data()), tally,
        [&](const PathVertex<float>& vertex, PrimitiveId id, LobeId lobe, int length) {
          const float distance = walked_.to(vertex, length);
          return CameraWalk::Visited{pass_.gather(vertex, id, length, distance, tally),
                                     pass_.lobes().isWide(materialAt(scene, id), lobe)};
        });
    film.splat(filmX, filmY, radiance);
    return luminance(radiance);
  }

 private:
  const PhotonPass& pass_;
  CameraWalk walk_;
  WalkedDistance walked_;
};

class PhotonIntegrator final : public Integrator {
 public:
  explicit PhotonIntegrator(const OptionSet& options) : options_(options) {
    for (const char* name : {"minDepth", "rrDepth", "samplesPerPixel"})
      requireRange(options, name, 1, kNoLimit);
    requireRange(options, "photons", 0, PhotonMap::kMostPaths);
    requireRange(options, "radius", 1e-3, 1e3);
    requireRange(options, "alpha", 0.01, 1);
    requireRange(options, "narrowLobe", 1e-3, kPi / 2);
    photons_.path = {options.integer("minDepth"), maxPathLength(options),
                     options.integer("rrDepth")};
    photons_.radius = options.number("radius");
    photons_.alpha = options.number("alpha");
    photons_.narrowest = options.number("narrowLobe");
  }

  RenderResult render(const Scene& scene, const RenderRequest& request) override {
    PhotonOptions photons = photons_;
    photons.photons = options_.integer("photons");
    if (photons.photons == 0)
      photons.photons = static_cast<int>(
          std::min(kMostByDefault, kByDefault * scene.film.width * scene.film.height));
    SharedByPass shared;
    shared.memory = PhotonPass::memory(photons);
    PhotonPass pass(scene, photons, request.seed, request.threads);
    shared.begin = [&](long long number) { pass.begin(number); };
    shared.addStatistics = [&](nlohmann::json& statistics) {
      statistics["photons"] = pass.statistics();
    };
    return renderSamples(
        scene, request, options_.integer("samplesPerPixel"),
        [&] { return std::make_unique<PhotonSampler>(pass, photons.path); }, shared);
  }

 private:
  OptionSet options_;
  PhotonOptions photons_;
};

constexpr Parameter kPhotonParameters[] = {
    kMaxDepthParameter,
    kMinDepthParameter,
    {"rrDepth", ParameterType::kInteger, "5",
     "length from which Russian roulette may end a camera path"},
    {"samplesPerPixel", ParameterType::kInteger, "64", "passes, if no budget is given"},
    {"photons", ParameterType::kInteger, "0",
     "light paths a pass; 0: four for each pixel, and no more than 524288"},
    {"radius", ParameterType::kNumber, "2",
     "radius of the first pass within which photons count, in pixels at their distance"},
    {"alpha", ParameterType::kNumber, "0.6667",
     "the squared radius of pass n falls as n^(alpha - 1): the picture's variance falls as "
     "n^-alpha, its bias as "
     "n^(alpha - 1); 1: it stays, and so does the bias"},
    {"narrowLobe", ParameterType::kNumber, "0.4",
     "lobes of less than this width, in radians, are followed by camera paths as mirrors are; at "
     "others photons are "
     "gathered"},
};

}  // namespace

IntegratorFactory photonIntegrator() {
  return {{"photon",
           "stochastic progressive photon mapping [Hachisuka and Jensen 2009, Knaus and Zwicker "
           "2011]: biased, by less with each pass",
           kPhotonParameters},
          [](const OptionSet& options) -> std::unique_ptr<Integrator> {
            return std::make_unique<PhotonIntegrator>(options);
          }};
}

}  // namespace h2mc
