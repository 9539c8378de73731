// SPDX-License-Identifier: MIT
// Variances and counts by pixel, against the spread of many renders.
#include "render/integrator/pixel_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <sstream>

#include "mcmc/populations/image_estimate.h"
#include "render/core/archive.h"
#include "render/core/random.h"
#include "tiny_render.h"

namespace h2mc {
namespace {

// Sums over many estimates of the same picture.
class Spread {
 public:
  void add(const Image& image, const Image& variance) {
    sums_.resize(image.pixels.size());
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const double value = image.pixels[i].y;
      sums_[i].value += value;
      sums_[i].square += value * value;
      sums_[i].variance += variance.pixels[i].y;
    }
    ++count_;
  }
  // The mean of the estimated variances over that which the estimates show, each pixel's relative to its value.
  double ratio() const {
    double estimated = 0, shown = 0, all = 0;
    const double n = count_;
    for (const Sum& sum : sums_) all += sum.value / n / static_cast<double>(sums_.size());
    for (const Sum& sum : sums_) {
      const double mean = sum.value / n, weight = 1 / squared(mean + 0.1 * all);
      shown += weight * (sum.square / n - mean * mean) * n / (n - 1);
      estimated += weight * sum.variance / n;
    }
    return estimated / shown;
  }

 private:
  struct Sum {
    double value = 0, square = 0, variance = 0;
  };
  std::vector<Sum> sums_;
  int count_ = 0;
};

// Independent mutations and large steps in two halves of different size, over two epochs of several stretches: exactly
// what the formula is made for. 1500 estimates of 16 pixels tell their variance to 1 %, and the estimates' mean, which
// have one degree of freedom each, to another.
TEST(PixelStatistics, VarianceOfIndependentMutations) {
  constexpr int kRuns = 1500, kPixels = 16;
  FilmSettings settings;
  settings.width = kPixels;
  settings.height = 1;
  Spread spread;
  for (int run = 0; run < kRuns; ++run) {
    Random random(7, 1, static_cast<std::uint64_t>(run));
    ImageEstimate estimate(settings, 1, {true, true});
    for (int epoch = 0; epoch < 2; ++epoch) {
      estimate.begin();
      for (int round = 0; round < 3; ++round) {
        ChainFilms films[2];
        std::vector<ImageEstimate::Part> parts;
        for (int half = 0; half < 2; ++half) {
          const int mutations = half == 0 ? 60 : 100;
          films[half].states.counting = true;
          // Radiance 1 + x, target the same times (2 - x), samples by themselves for a share of the picture.
          for (int i = 0; i < mutations; ++i) {
            float x;
            do x = random.uniform();
            while ((1 + x) * (2 - x) < 2.25 * random.uniformDouble());
            const double target = (1 + x) * (2 - x);
            films[half].states.splat(x, 0.5f, Rgbf(1 + x), 1, target, {0.5});
            films[half].states.land(x, 0.5f, 1);
          }
          for (int i = 0; i < mutations / 4; ++i) {
            const float x = random.uniform();
            const double target = (1 + x) * (2 - x);
            films[half].samples.splat(x, 0.5f, Rgbf(1 + x), target, {0.5});
          }
          estimate.sort(films[half]);
          parts.push_back({&films[half], half, mutations, mutations / 4});
        }
        estimate.add(parts);
      }
      if (epoch == 1) {
        // In the middle of a stretch as at its end.
        const Image before = estimate.variance(1.5, 0);
        estimate.end();
        const Image after = estimate.variance(1.5, 0);
        for (std::size_t i = 0; i < before.pixels.size(); ++i)
          EXPECT_NEAR(before.pixels[i].y, after.pixels[i].y, 1e-5 + 1e-3 * after.pixels[i].y);
      } else {
        estimate.end();
      }
    }
    spread.add(estimate.image(1.5), estimate.variance(1.5, 0));
    const std::vector<float> counts = estimate.counts();
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0.f), 2 * 3 * 160);
  }
  EXPECT_NEAR(spread.ratio(), 1, 0.06);
}

class OfRenders : public ::testing::TestWithParam<const char*> {
 protected:
  static RenderRequest request(std::uint64_t seed, long long budget, int threads = 2) {
    RenderRequest request;
    request.budget.mutationsPerPixel = budget;
    request.seed = seed;
    request.threads = threads;
    request.pixelStatistics = {true, true};
    return request;
  }
  static RenderResult render(const Scene& scene, const RenderRequest& request,
                             const char* chains = "16", const char* baseSamples = "0.5") {
    return test::renderTiny(GetParam(), scene, request,
                            {{"maxDepth", "5"}, {"chains", chains}, {"baseSamples", baseSamples}});
  }
};

// Expected: 1. The spread of 60 renders of 432 pixels is known to some percent, as chains' estimates have long tails.
TEST_P(OfRenders, VarianceIsTheSpreadOfManyRendersSlow) {
  const Scene scene = test::readTestScene(H2MC_SOURCE_DIR "/scenes/cornell/cornell.xml", 24, 18);
  const auto ratio = [&](long long mutations, const char* baseSamples) {
    Spread spread;
    for (int run = 0; run < 60; ++run) {
      const RenderResult result =
          render(scene, request(static_cast<std::uint64_t>(run) + 1, mutations), "64", baseSamples);
      spread.add(result.image, result.variance);
    }
    std::printf("%s: %lld mutations, base samples %s: estimated over shown variance %.3f\n",
                GetParam(), mutations, baseSamples, spread.ratio());
    return spread.ratio();
  };
  EXPECT_NEAR(ratio(40, "-1"), 1, 0.15);
  if (std::string_view(GetParam()) != "h2mc") return;
  // A picture mostly of samples, which are spread over the film more evenly than by chance.
  EXPECT_NEAR(ratio(40, "4"), 1, 0.15);
  EXPECT_NEAR(ratio(6, "4"), 1, 0.15);
}

// Nothing of the picture changes, counts are of all that was done, and threads make no difference.
TEST_P(OfRenders, CostNothingElse) {
  const Scene scene = test::tinyRing();
  const RenderResult with = render(scene, request(5, 60));
  RenderRequest plain = request(5, 60);
  plain.pixelStatistics = {};
  const RenderResult without = render(scene, plain);
  EXPECT_EQ(with.image.pixels, without.image.pixels);
  EXPECT_TRUE(without.variance.pixels.empty());
  EXPECT_TRUE(without.counts.empty());
  const double counted = std::accumulate(with.counts.begin(), with.counts.end(), 0.0);
  EXPECT_NEAR(counted, static_cast<double>(with.samples), 1e-4 * counted);
  const RenderResult one = render(scene, request(5, 60, 1));
  EXPECT_EQ(one.variance.pixels, with.variance.pixels);
  EXPECT_EQ(one.counts, with.counts);
}

// In the middle of what a film holds, and of direct light.
TEST_P(OfRenders, GoOnFromAnArchive) {
  const Scene scene = test::tinyRing();
  std::vector<std::string> states;
  RenderRequest first = request(5, 60);
  first.watch = [&](RenderInProgress& now) {
    if (!now.isExact() && !now.isOver()) return;
    std::ostringstream stream;
    Archive archive(stream);
    now.save(archive);
    states.push_back(stream.str());
  };
  const RenderResult whole = render(scene, first);
  ASSERT_GE(states.size(), 8u);
  for (std::size_t k = 0; k < 5; ++k) {
    const std::string& state = states[(states.size() - 1) * k / 4];
    std::istringstream stream(state);
    Archive archive(stream, state.size());
    RenderRequest again = request(5, 60);
    again.resume = &archive;
    again.watch = [](RenderInProgress&) {};
    const RenderResult result = render(scene, again);
    EXPECT_EQ(archive.left(), 0u);
    EXPECT_EQ(result.variance.pixels, whole.variance.pixels) << k;
    EXPECT_EQ(result.counts, whole.counts) << k;
  }
}

// One sample a pixel has no second half: the square of what there is.
TEST(PixelStatistics, VarianceOfOneSample) {
  const Scene scene = test::tinyRing();
  RenderRequest request;
  request.budget.samplesPerPixel = 1;
  request.pixelStatistics = {true, true};
  const RenderResult result = test::renderTiny("path", scene, request, {});
  for (std::size_t i = 0; i < result.image.pixels.size(); ++i) {
    const double square = squared(static_cast<double>(result.image.pixels[i].x));
    EXPECT_NEAR(result.variance.pixels[i].x, square, 1e-4 * square);
  }
  EXPECT_EQ(result.counts, std::vector<float>(24 * 18, 1.f));
}

INSTANTIATE_TEST_SUITE_P(Integrators, OfRenders,
                         ::testing::Values("path", "bdpt", "photon", "mmlt", "h2mc", "lmc", "rjmlt",
                                           "mlt", "pssmlt", "remlt", "erpt", "restore"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace h2mc
