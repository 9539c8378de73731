// SPDX-License-Identifier: MIT
// Bidirectional path tracing with all techniques, light tracing included [Veach 1997, ch. 10].
#include "render/integrator/bdpt_integrator.h"

#include "render/integrator/sampling_integrator.h"
#include "render/path/bidirectional.h"

namespace h2mc {
namespace {

class BdptSampler final : public PixelSampler {
 public:
  BdptSampler(int minLength, int maxLength) : minLength_(minLength), sampler_(maxLength) {}

  double sample(const Scene& scene, Random& random, float filmX, float filmY, SplatList& film,
                SampleTally& tally) override {
    double added = 0;
    tally.notFinite += sampler_.sample(scene, random, filmX, filmY, minLength_,
                                       [&](const BidirectionalSampler::Connection& c) {
                                         film.splat(c.filmX, c.filmY, c.contribution);
                                         added += luminance(c.contribution);
                                       });
    return added;
  }

 private:
  int minLength_;
  BidirectionalSampler sampler_;
};

class BdptIntegrator final : public Integrator {
 public:
  explicit BdptIntegrator(const OptionSet& options)
      : options_(options), maxDepth_(maxPathLength(options)) {
    requireRange(options, "minDepth", 1, kNoLimit);
    requireRange(options, "samplesPerPixel", 1, kNoLimit);
  }

  RenderResult render(const Scene& scene, const RenderRequest& request) override {
    return renderSamples(scene, request, options_.integer("samplesPerPixel"), [&] {
      return std::make_unique<BdptSampler>(options_.integer("minDepth"), maxDepth_);
    });
  }

 private:
  OptionSet options_;
  int maxDepth_;
};

constexpr Parameter kBdptParameters[] = {
    kMaxDepthParameter,
    kMinDepthParameter,
    {"samplesPerPixel", ParameterType::kInteger, "64",
     "samples for each pixel, if no budget is given"},
};

}  // namespace

IntegratorFactory bdptIntegrator() {
  return {{"bdpt", "bidirectional path tracing, all techniques, power heuristic", kBdptParameters},
          [](const OptionSet& options) -> std::unique_ptr<Integrator> {
            return std::make_unique<BdptIntegrator>(options);
          }};
}

}  // namespace h2mc
