// SPDX-License-Identifier: MIT
// Renderings against references, with error bars on both sides.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "mcmc/render/integrators.h"
#include "render/core/index.h"
#include "render/image/image_io.h"
#include "render/scene/scene_reader.h"

namespace h2mc::test {

inline Scene readTestScene(const std::string& file, int width = 0, int height = 0) {
  ReadOptions options;
  static const std::vector<IntegratorPlugin> plugins = [] {
    std::vector<IntegratorPlugin> list;
    for (const IntegratorFactory& f : allIntegrators()) list.push_back(f.plugin);
    return list;
  }();
  options.integrators = plugins;
  options.width = width;
  options.height = height;
  return readScene(file, options);
}

// Luminances of blocks of pixels, one set for each independent run.
struct Runs {
  std::vector<std::vector<double>> blocks;

  double mean(std::size_t block) const {
    double sum = 0;
    for (const auto& run : blocks) sum += run[block];
    return sum / static_cast<double>(blocks.size());
  }
  // Squared standard error of the mean.
  double variance(std::size_t block) const {
    const double m = mean(block), n = static_cast<double>(blocks.size());
    double sum = 0;
    for (const auto& run : blocks) sum += (run[block] - m) * (run[block] - m);
    return sum / (n * (n - 1));
  }
  std::size_t size() const { return blocks[0].size(); }
};

// Block sums over `edge` x `edge` pixels, and last the whole image, all as means a pixel.
inline std::vector<double> blockMeans(const Image& image, int edge, bool squared = false) {
  const int columns = (image.width + edge - 1) / edge, rows = (image.height + edge - 1) / edge;
  std::vector<double> sums(static_cast<std::size_t>(columns * rows) + 1, 0), counts(sums.size(), 0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double value = luminance(image.at(x, y));
      const auto block = at((y / edge) * columns + x / edge);
      for (const std::size_t k : {block, sums.size() - 1}) {
        sums[k] += squared ? value * value : value;
        counts[k] += 1;
      }
    }
  for (std::size_t k = 0; k < sums.size(); ++k)
    sums[k] /= squared ? counts[k] * counts[k] : counts[k];
  return sums;
}

// How many times the usual number of samples: the environment variable H2MC_TEST_EFFORT, 1 if unset.
// The error bars shrink with its root, and the tests demand that.
inline double testEffort() {
  const char* text = std::getenv("H2MC_TEST_EFFORT");
  const double effort = text ? std::atof(text) : 1;
  return effort > 0 ? effort : 1;
}

// `count` runs with seeds 1, 2, ..; the options override the integrator's defaults. Samples, and
// the bootstrap's, are multiplied by the test's effort.
inline Runs renderRuns(const Scene& scene, const std::string& integrator,
                       const std::vector<std::pair<std::string, std::string>>& options, int count,
                       long long samplesPerPixel, int edge) {
  Runs runs;
  for (const IntegratorFactory& factory : allIntegrators()) {
    if (factory.plugin.name != integrator) continue;
    OptionSet set(factory.plugin);
    for (const auto& [name, text] : scene.options)
      if (name == "maxDepth" || name == "minDepth") set.set(name, text);
    for (const auto& [name, text] : options) {
      const bool scaled = name == "bootstrapSamples" || name == "directSamples";
      set.set(name, scaled ? std::to_string(std::llround(std::stod(text) * testEffort())) : text);
    }
    for (int i = 0; i < count; ++i) {
      RenderRequest request;
      request.budget.samplesPerPixel =
          std::llround(static_cast<double>(samplesPerPixel) * testEffort());
      request.seed = static_cast<std::uint64_t>(i) + 1;
      const RenderResult result = factory.create(set)->render(scene, request);
      runs.blocks.push_back(blockMeans(result.image, edge));
    }
  }
  return runs;
}

// z-tests of every block and of the mean. With few runs the variances are themselves uncertain
// (Student's t), so blocks share theirs: a block's own plus the median relative one.
//
// `limitMean` is in standard errors; `resolution` is the relative standard error of the mean that the
// test must reach to be worth running.
inline void expectAgreement(const Runs& runs, const std::vector<double>& reference,
                            const std::vector<double>& referenceVariance, double resolution,
                            const std::string& what) {
  ASSERT_GE(runs.blocks.size(), 16u);
  ASSERT_EQ(runs.size(), reference.size());
  const std::size_t whole = runs.size() - 1;
  const double mean = reference[whole];
  const double sigma = std::sqrt(runs.variance(whole) + referenceVariance[whole]);
  EXPECT_LT(sigma, resolution * mean / std::sqrt(testEffort())) << what << ": too noisy to judge";
  const double z = (runs.mean(whole) - mean) / sigma;
  std::printf("%s: mean %.5f of %.5f (%+.3f %%), %.2f standard errors of %.3f %%\n", what.c_str(),
              runs.mean(whole), mean, 100 * (runs.mean(whole) / mean - 1), z, 100 * sigma / mean);
  // Student's t with 15 degrees of freedom is beyond 5 once in 6000 times.
  EXPECT_LT(std::abs(z), 5) << what;

  std::vector<double> relative;
  for (std::size_t k = 0; k < whole; ++k)
    if (reference[k] > 0) relative.push_back(runs.variance(k) / (reference[k] * reference[k]));
  std::nth_element(relative.begin(), relative.begin() + static_cast<long>(relative.size() / 2),
                   relative.end());
  const double typical = relative[relative.size() / 2];
  int outside = 0;
  for (std::size_t k = 0; k < whole; ++k) {
    const double shared = typical * reference[k] * reference[k];
    const double s = std::sqrt(std::max(runs.variance(k), shared) + referenceVariance[k]);
    outside += std::abs(runs.mean(k) - reference[k]) > 5 * s + 1e-6 * mean;
  }
  // 5 standard errors, heavy tails allowed for: one block, and two of every hundred.
  EXPECT_LE(outside, 1 + static_cast<int>(whole) / 50) << what << ": blocks of pixels that differ";
}

// The published references; false, loudly, where the folder is not there.
struct Reference {
  int width = 0, height = 0;
  std::vector<double> mean, variance;
};
inline bool readReference(const std::string& name, int edge, Reference& reference) {
  const std::string path = std::string(H2MC_DATA_DIR) + "/reference/" + name;
  if (!std::filesystem::exists(path + ".exr")) {
    std::printf("NOT TESTED: no reference %s.exr\n", path.c_str());
    return false;
  }
  const Image image = readImage(path + ".exr");
  reference.width = image.width;
  reference.height = image.height;
  reference.mean = blockMeans(image, edge);
  reference.variance = blockMeans(readImage(path + "_stderr.exr"), edge, true);
  return true;
}

}  // namespace h2mc::test
