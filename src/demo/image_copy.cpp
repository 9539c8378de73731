// SPDX-License-Identifier: MIT
#include "demo/image_copy.h"

#include <algorithm>
#include <cmath>

#include "compare/embed.h"
#include "render/core/index.h"
#include "render/image/metrics.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

using nlohmann::json;

constexpr std::size_t kWalk = 600;  // states that the page draws
constexpr long long kLevels[] = {1, 8, 64, 256};
constexpr long long kSweepLevel = 16;
constexpr int kSweepSteps = 13;
constexpr float kSmallestSigma = 5e-4f, kLargestSigma = 0.5f;

std::vector<CopyKernel> kernelsOf(const ImageCopySettings& s) {
  return {
      {"small",
       "Isotropic small mutations alone. Most are accepted, but the chain wanders: at first "
       "it knows only one corner of the picture.",
       0, s.sigma, false},
      {"large",
       "Every proposal is a uniform point. Nothing is remembered, and in a picture with "
       "bright spots many proposals are rejected.",
       1, s.sigma, false},
      {"mixed", "Small mutations, and now and then a large one that takes the chain elsewhere.",
       s.largeShare, s.sigma, false},
      {"Hessian-Hamiltonian",
       "Large ones as before; small ones drawn from the Gaussian that gradient and Hessian of the "
       "log "
       "luminance give: long along what is flat, short across edges, moved uphill.",
       s.largeShare, s.priorSigma, true},
  };
}

}  // namespace

CopyChain::CopyChain(const PictureTarget& target, const CopyKernel& kernel, std::uint64_t seed)
    : target_(target),
      kernel_(kernel),
      random_(seed, 0x636f7079, 0),
      film_(target.width(), target.height()) {
  const Image means = target.pixelMeans();
  brightness_ = meanLuminance(means);
  double u = random_.uniform() * brightness_ * static_cast<double>(means.pixels.size());
  std::size_t i = 0;
  for (; i + 1 < means.pixels.size(); ++i) {
    u -= luminance(means.pixels[i]);
    if (u < 0) break;
  }
  const std::size_t width = static_cast<std::size_t>(target.width());
  const std::size_t column = i % width, row = i / width;
  current_.x = (static_cast<float>(column) + random_.uniform()) / static_cast<float>(width);
  current_.y = (static_cast<float>(row) + random_.uniform()) / static_cast<float>(target.height());
  evaluate(current_);
}

void CopyChain::evaluate(State& state) const {
  state.color = target_.color(state.x, state.y);
  state.target = luminance(state.color);
  state.hasGaussian = false;
}

void CopyChain::prepare(State& state) const {
  if (state.hasGaussian) return;
  state.hasGaussian = true;
  HamiltonianSettings settings;
  settings.sigma = kernel_.sigma;
  Derivative derivative;
  target_.differentiate(state.x, state.y, derivative);
  hamiltonianGaussian(derivative, settings, state.gaussian);
}

bool CopyChain::propose(bool large, State& proposed, double& logRatio) {
  logRatio = 0;
  if (large) {
    proposed.x = random_.uniform();
    proposed.y = random_.uniform();
    evaluate(proposed);
    return true;
  }
  float offset[2];
  if (kernel_.hamiltonian) {
    prepare(current_);
    current_.gaussian.sample(random_, offset);
  } else {
    for (float& o : offset) o = kernel_.sigma * random_.normal();
  }
  proposed.x = current_.x + offset[0];
  proposed.y = current_.y + offset[1];
  if (!(proposed.x >= 0 && proposed.x < 1 && proposed.y >= 0 && proposed.y < 1)) return false;
  evaluate(proposed);
  if (kernel_.hamiltonian) {
    prepare(proposed);
    const float back[2] = {-offset[0], -offset[1]};
    logRatio = proposed.gaussian.logDensity(back) - current_.gaussian.logDensity(offset);
  }
  return true;
}

void CopyChain::splat(const State& state, double weight) {
  const auto pixel = [](float x, int size) {
    return std::clamp(static_cast<int>(x * static_cast<float>(size)), 0, size - 1);
  };
  film_.at(pixel(state.x, film_.width), pixel(state.y, film_.height)) +=
      state.color * static_cast<float>(weight / state.target);
}

void CopyChain::run(long long mutations) {
  State proposed;
  for (long long i = 0; i < mutations; ++i) {
    const bool large = random_.uniform() < kernel_.largeShare;
    double logRatio = 0, acceptance = 0;
    if (propose(large, proposed, logRatio))
      acceptance = std::min(1.0, proposed.target / current_.target * std::exp(logRatio));
    splat(current_, 1 - acceptance);
    if (acceptance > 0) splat(proposed, acceptance);
    accepted_ += acceptance;
    if (!large) {
      ++small_;
      acceptedSmall_ += acceptance;
    }
    if (random_.uniform() < acceptance) std::swap(current_, proposed);
    if (walk_.size() < kWalk) walk_.emplace_back(current_.x, current_.y);
    ++mutations_;
  }
}

Image CopyChain::copy() const {
  Image result = film_;
  const float scale = static_cast<float>(brightness_ * static_cast<double>(film_.pixels.size()) /
                                         static_cast<double>(std::max<long long>(mutations_, 1)));
  for (Rgbf& p : result.pixels) p *= scale;
  return result;
}

double CopyChain::acceptance() const {
  if (small_ > 0) return acceptedSmall_ / static_cast<double>(small_);
  return mutations_ > 0 ? accepted_ / static_cast<double>(mutations_) : 0;
}

json copyImage(const PictureTarget& target, const ImageCopySettings& settings,
               const std::atomic<bool>& stop) {
  const Image reference = target.pixelMeans();
  const long long pixels = static_cast<long long>(reference.pixels.size());
  const float white = whiteScale(reference);
  const Metric& relmse = *findMetric("relmse");

  // Chains and step sizes side by side: each has random numbers of its own.
  const std::vector<CopyKernel> kernels = kernelsOf(settings);
  const int chains = static_cast<int>(kernels.size());
  std::vector<json> methods(kernels.size()), sweep(2 * kSweepSteps);
  parallelFor(settings.threads, chains + 2 * kSweepSteps, [&](int task) {
    if (stop) return;
    if (task < chains) {
      const CopyKernel& kernel = kernels[at(chains - 1 - task)];  // slow first
      CopyChain chain(target, kernel, settings.seed);
      json levels = json::array();
      for (const long long level : kLevels) {
        while (chain.mutations() < level * pixels && !stop)
          chain.run(std::min(pixels, level * pixels - chain.mutations()));
        const Image copy = chain.copy();
        levels.push_back({{"perPixel", level},
                          {"acceptance", chain.acceptance()},
                          {"relmse", relmse.compute(copy, reference)},
                          {"pixels", base64Srgb(copy, white)}});
      }
      json walk = json::array();
      for (const auto& [x, y] : chain.walk()) walk.push_back({x, y});
      methods[at(chains - 1 - task)] = {{"name", kernel.name},   {"text", kernel.text},
                                        {"sigma", kernel.sigma}, {"largeShare", kernel.largeShare},
                                        {"levels", levels},      {"walk", walk}};
      return;
    }
    const int step = (task - chains) % kSweepSteps;
    CopyKernel kernel;
    kernel.hamiltonian = task - chains >= kSweepSteps;
    kernel.largeShare = settings.largeShare;
    kernel.sigma = kSmallestSigma * std::pow(kLargestSigma / kSmallestSigma,
                                             static_cast<float>(step) / (kSweepSteps - 1));
    CopyChain chain(target, kernel, settings.seed + 1);
    chain.run(kSweepLevel * pixels);
    sweep[at(task - chains)] = {{"sigma", kernel.sigma},
                                {"acceptance", chain.acceptance()},
                                {"relmse", relmse.compute(chain.copy(), reference)}};
  });
  if (stop) return nullptr;
  return {{"width", reference.width},
          {"height", reference.height},
          {"reference", base64Srgb(reference, white)},
          {"sweepPerPixel", kSweepLevel},
          {"largeShare", settings.largeShare},
          {"methods", methods},
          {"sweep",
           {{"isotropic", json(std::vector<json>(sweep.begin(), sweep.begin() + kSweepSteps))},
            {"hamiltonian", json(std::vector<json>(sweep.begin() + kSweepSteps, sweep.end()))}}}};
}

}  // namespace h2mc
