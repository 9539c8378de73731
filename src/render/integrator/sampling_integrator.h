// What path and bdpt share: a number of independent samples for each pixel, added up on films.
#pragma once

#include "render/core/random.h"
#include "render/image/film.h"
#include "render/integrator/integrator.h"
#include "render/scene/scene.h"

namespace h2mc {

// Tallies of one group, merged in the groups' order.
struct SampleTally {
  double luminance = 0, squares = 0;  // of whole samples, splats to other pixels included
  long long samples = 0;
  long long notFinite = 0;  // contributions left out
};

// Draws the samples of one group: owns what must not be shared.
class PixelSampler {
 public:
  virtual ~PixelSampler() = default;
  // Adds one sample to the film, whose camera ray passes through (filmX, filmY).
  // Returns the luminance of all that it has added.
  virtual double sample(const Scene& scene, Random& random, float filmX, float filmY, Film& film,
                        SampleTally& tally) = 0;
};

// Renders samplesPerPixel passes (or by time) with a sampler for each group.
RenderResult renderSamples(const Scene& scene, const RenderRequest& request,
                           int defaultSamplesPerPixel,
                           const std::function<std::unique_ptr<PixelSampler>()>& makeSampler);

}  // namespace h2mc
