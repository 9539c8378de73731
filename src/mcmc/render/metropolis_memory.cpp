// SPDX-License-Identifier: MIT
#include "mcmc/render/metropolis_memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "mcmc/chain/chain.h"
#include "render/core/index.h"
#include "render/integrator/memory_need.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// Bytes a pixel. The chains' films and sums (ImageEstimate) are 48, of which 24 go between two epochs; then there is
// either a film for direct light, or the pictures that make an importance map. Direct light's own picture stays.
constexpr double kBetweenEpochs = 24 + 24, kInEpoch = 48, kImage = sizeof(Rgbf);
// Variances have films and sums of one half of the chains, and their pictures; of direct light those of one half, of
// what was made and of what is being made. Counts have a film.
constexpr double kVariance = 48 + 2 * kImage, kDirectVariance = 2 * kImage,
                 kCounts = 24 + sizeof(float);

double bytesAPath(int maxLength) {
  return static_cast<double>(sizeof(Path)) +
         2.0 * static_cast<double>(at(maxLength) + 2) * static_cast<double>(sizeof(TracedVertex));
}

// A chain has a path and a proposal, and a third path is where it starts or goes on to. Then what it splats in a round
// and what kernels keep of its states, as measured: most of it is Gaussians and paths as such, of which only the pages
// that are used are there.
constexpr double kSplats = 1500;
double bytesAChain(const OptionSet& options, int maxLength) {
  constexpr double kPathSpace = 9000, kTechniques = 5500;
  const double ofGaussians = 10750 + 250.0 * maxLength;
  double kept = kSplats;
  if (options.has("trajectoryLength") || options.has("stepSize")) kept += ofGaussians;
  if (options.has("roughnessThreshold"))
    kept += kPathSpace;
  else if (options.has("techniqueProbability"))
    kept += kTechniques;
  return 3 * bytesAPath(maxLength) + kept;
}

}  // namespace

void requireMetropolisMemory(const Scene& scene, const OptionSet& options,
                             const RenderRequest& request, int maxLength,
                             long long bootstrapSamples) {
  const bool direct = options.integer("directSamples") != 0;
  const bool marks = !request.marks.empty();
  const PixelStatistics& asked = request.pixelStatistics;
  double pixel =
      (direct ? kImage : 0) + (marks ? kInEpoch + (direct ? 24 : kImage) : kBetweenEpochs);
  if (asked.variance) pixel += kVariance + (direct ? kDirectVariance : 0);
  if (asked.counts) pixel += kCounts;
  const double chains = options.integer("chains");
  double replicas = 0;
  if (options.has("replicas"))
    replicas = std::min(chains, double(kMostGroups)) * options.integer("replicas");
  const double samples = static_cast<double>(bootstrapSamples);
  const double chain = bytesAChain(options, maxLength) + (asked.counts ? kSplats : 0);
  requireMemory(
      {filmMemory(scene.film, pixel),
       {chains * chain, fmt::format("{:.0f} chains of paths of up to {} edges", chains, maxLength),
        "expected fewer by the option \"chains\""},
       {replicas * chain, fmt::format("{:.0f} replicas of them", replicas),
        "expected fewer by the option \"replicas\""},
       {samples * sizeof(double), fmt::format("{:.0f} bootstrap samples", samples),
        "expected fewer by the option \"bootstrapSamples\""}});
}

}  // namespace h2mc
