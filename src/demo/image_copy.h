// SPDX-License-Identifier: MIT
// Copying a picture by Metropolis sampling of its luminance: the method without light transport, in
// two dimensions that can be seen.
#pragma once

#include <atomic>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "demo/picture_target.h"
#include "mcmc/mutations/gaussian.h"
#include "render/core/random.h"

namespace h2mc {

// The mutations of one chain.
struct CopyKernel {
  std::string name, text;
  double largeShare = 0;  // of mutations that go to a uniform point
  float sigma = 0.01f;    // of small ones, of the picture's edges; for Hamiltonian ones the prior's
  bool hamiltonian = false;  // small mutations are shaped by the Hessian of the log luminance
};

// One Metropolis-Hastings chain with the picture's luminance as its target. Proposals that leave
// the picture are rejected.
class CopyChain {
 public:
  // Keeps a reference. The chain starts where the picture has luminance, by its own distribution.
  CopyChain(const PictureTarget& target, const CopyKernel& kernel, std::uint64_t seed);

  // Makes mutations.
  void run(long long mutations);

  // The copy so far: visits, each state with its expected weight and divided by its luminance,
  // scaled to the picture's mean luminance, which is known here.
  Image copy() const;
  long long mutations() const { return mutations_; }
  // Mean acceptance probability of small mutations, of all where there are none.
  double acceptance() const;
  // Where the chain was after each of the first mutations, x and y in [0, 1].
  const std::vector<std::pair<float, float>>& walk() const { return walk_; }

 private:
  struct State {
    float x = 0.5f, y = 0.5f;
    Rgbf color{0};
    double target = 0;
    bool hasGaussian = false;
    Gaussian gaussian;
  };
  void evaluate(State& state) const;
  void prepare(State& state) const;
  // False: outside the picture. logRatio: log q(back) - log q(forth).
  bool propose(bool large, State& proposed, double& logRatio);
  void splat(const State& state, double weight);

  const PictureTarget& target_;
  CopyKernel kernel_;
  Random random_;
  State current_;
  double brightness_ = 0;  // mean luminance of the picture
  Image film_;
  std::vector<std::pair<float, float>> walk_;
  long long mutations_ = 0, small_ = 0;
  double accepted_ = 0, acceptedSmall_ = 0;
};

struct ImageCopySettings {
  float sigma = 0.01f;       // of isotropic small mutations
  float priorSigma = 0.05f;  // of Hamiltonian ones
  double largeShare = 0.2;   // of the mixtures
  std::uint64_t seed = 0;
  int threads = 0;
};

// Copies at 1, 8, 64 and 256 mutations a pixel with each kernel, and acceptance and error over step
// sizes at 16: everything that the page shows. Returns null when stopped.
nlohmann::json copyImage(const PictureTarget& target, const ImageCopySettings& settings,
                         const std::atomic<bool>& stop);

// The page, one HTML file. `name`: the picture's.
std::string imageCopyPage(const nlohmann::json& result, const std::string& name);

}  // namespace h2mc
