// SPDX-License-Identifier: MIT
// Langevin steps: by the gradient alone, preconditioned by what gradients the chains have met.
#pragma once

#include <map>
#include <vector>

#include "mcmc/mutations/gaussian_step.h"
#include "mcmc/mutations/step_sizes.h"
#include "render/core/archive.h"

namespace h2mc {

// Mean squares of the log target's derivatives, for each technique and coordinate, for paths that depend on time and
// others apart; frozen between calls of learn().
class GradientSquares {
 public:
  // Adds the gradient at a path to `sums`, which grow as needed.
  static void add(const Path& path, const Gradient& gradient, std::vector<double>& sums);
  // Takes the means of what was summed.
  void learn(const std::vector<double>& sums);
  void archive(Archive& archive) { archive(means_); }
  // Of the path's coordinates; null where too little is known.
  const float* of(const Path& path) const;

 private:
  std::vector<float> means_;
};

// A Langevin step [Roberts and Tweedie 1996] with a diagonal preconditioner learned from past gradients [Luan et al.
// 2020, "Langevin Monte Carlo Rendering with Gradient-based Adaptation"]. With g the gradient of the log target at
// the state and G_i the mean of g_i^2 over the states of past epochs in the same technique, coordinate i moves by
//
//     N(variance_i g_i / 2, variance_i),    f^2 / variance_i = 1 / sigma^2 + max(G_i, g_i^2) / stepSize^2,
//
// f being StepSizes' factor, the drift bounded to maxDrift deviations. The Gaussian is a function of the state while an
// epoch lasts, and the reverse density is that of the Gaussian at the proposal: the step is exact. (The authors'
// program lets the preconditioner follow the chain, whose reverse density is another one.)
//
// Or with the authors' preconditioner, as far as it can be a function of the state: g scaled to a norm of at most 100,
//
//     1 / variance_i = 1 / (stepSize^2 (M_i + 1)) + 1 / sigma^2,    M_i = 1 / (0.001 + sqrt(G_i)) within [0.01, 100],
//
// and N(variance_i / 2 times g_i within [-5, 5], variance_i). Where theirs has running means of g and g^2 along the
// chain, g is that of the state, and G_i the mean over past epochs, or g_i^2 before there is one.
class LangevinStep final : public GaussianStep {
 public:
  struct Settings {
    float sigma = 0.01f;
    float stepSize = 1;
    float maxDrift = 3;
    double targetAcceptance = 0;  // as StepSizes
    bool published = false;       // the authors' preconditioner
  };
  // Keeps a reference.
  LangevinStep(const Target& target, const Settings& settings, SlotNumbers& slots)
      : GaussianStep(target, settings.sigma, slots),
        settings_(settings),
        sizes_(settings.targetAcceptance) {}
  std::string_view name() const override { return "langevin"; }
  void learn(const ChainStatistics& statistics, std::size_t kind) override;
  void archive(Archive& archive) override { archive(squares_, sizes_); }

 private:
  void make(const Path& path, MutationContext& context, Gaussian& gaussian) const override;
  struct Law {
    float variance, drift;
  };
  // Of a coordinate with this derivative, and mean square of it; null: not known. `size2`: the square of StepSizes'.
  Law lawOf(float g, const float* square, float size2) const;
  Law publishedLawOf(float g, const float* square, float size2) const;

  Settings settings_;
  GradientSquares squares_;
  StepSizes sizes_;
};

MutationPlugin langevinStep();

}  // namespace h2mc
