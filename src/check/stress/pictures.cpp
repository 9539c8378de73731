// SPDX-License-Identifier: MIT
#include "check/stress/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mcmc/chain/statistics.h"
#include "mcmc/render/integrator_choice.h"
#include "render/core/random.h"

namespace h2mc {
namespace {

// What rounding may make of a mean, relative to it: no smaller error is believed.
constexpr double kRounding = 1e-4;
// What the short chains of a run may be off in their balances, relative to the mean: all runs of that
// length alike, so that it can't be seen in their scatter.
constexpr double kShortness = 0.01;
constexpr int kPictureChains = 64;
// Most samples of a bootstrap, which can't be interrupted.
constexpr long long kMostBootstrap = 200000;

enum Quantity { kMean, kAcross, kDown, kQuantities };
using Quantities = std::array<Moments, kQuantities>;

void add(const Image& image, Quantities& quantities, long long& broken) {
  std::array<double, kQuantities> sums{};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgbf& pixel = image.at(x, y);
      broken += !(std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z));
      const double l = luminance(pixel);
      sums[kMean] += l;
      sums[kAcross] += l * ((x + 0.5) / image.width - 0.5);
      sums[kDown] += l * ((y + 0.5) / image.height - 0.5);
    }
  const double pixels = static_cast<double>(image.width) * image.height;
  for (std::size_t k = 0; k < kQuantities; ++k) quantities[k].add(sums[k] / pixels);
}

PictureComparison::Estimate estimate(const Moments& m) {
  return {m.mean(), std::max(m.standardError(), kRounding * m.mean())};
}

}  // namespace

PictureComparison comparePictures(const Scene& scene, const PictureSettings& settings) {
  PictureComparison result;
  const double pixels = static_cast<double>(scene.film.width) * scene.film.height;
  const double perRun = static_cast<double>(settings.samples) / PictureComparison::kRuns;
  RenderRequest request;
  request.budget.samplesPerPixel = std::max(1LL, std::llround(perRun / pixels));
  const auto all = request.budget.samplesPerPixel * static_cast<long long>(pixels);
  request.threads = settings.threads;
  request.stop = settings.stop;

  Quantities of[2];
  const std::string wishes[2] = {
      // The chains do everything.
      fmt::format("h2mc:maxDepth={},chains={},bootstrapSamples={},directSamples=0",
                  settings.maxLength, kPictureChains, std::min(all, kMostBootstrap)),
      fmt::format("bdpt:maxDepth={}", settings.maxLength)};
  for (std::size_t which = 0; which < 2; ++which) {
    const auto renderer = chooseIntegrator(wishes[which], scene).integrator;
    for (int run = 0; run < PictureComparison::kRuns; ++run) {
      request.seed = mixBits(settings.seed) + static_cast<std::uint64_t>(run);
      const RenderResult rendered = renderer->render(scene, request);
      if (rendered.interrupted || (settings.stop && settings.stop->load())) {
        result.interrupted = true;
        return result;
      }
      add(rendered.image, of[which], result.brokenPixels);
      const nlohmann::json& statistics = rendered.statistics;
      result.notFinite += statistics.value("not finite", 0LL);
      if (result.firstNotFinite.empty())
        result.firstNotFinite = statistics.value("first not finite", "");
      if (statistics.contains("derivatives")) {
        result.derivatives.computed += statistics["derivatives"].value("computed", 0LL);
        result.derivatives.notFinite += statistics["derivatives"].value("not finite", 0LL);
      }
    }
  }
  result.made = true;
  result.h2mc = estimate(of[0][kMean]);
  result.bdpt = estimate(of[1][kMean]);
  const auto resolves = [](const PictureComparison::Estimate& e) {
    return e.error < PictureComparison::kResolved * e.mean;
  };
  result.resolved = resolves(result.h2mc) && resolves(result.bdpt);
  const double brighter = std::max(result.h2mc.mean, result.bdpt.mean);
  for (std::size_t k = 0; k < kQuantities; ++k) {
    const double difference = std::abs(of[0][k].mean() - of[1][k].mean());
    const double error = std::hypot(of[0][k].standardError(), of[1][k].standardError(),
                                    (k == kMean ? kRounding : kShortness) * brighter);
    // Not a number where a picture is broken.
    const double z = difference > 0 || std::isnan(difference) ? difference / error : 0;
    if (!(z <= result.z)) result.z = z;
  }
  return result;
}

}  // namespace h2mc
