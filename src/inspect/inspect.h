// SPDX-License-Identifier: MIT
// One path of a pixel and what the mutations see of the target around it: `h2mc inspect`.
//
// All offsets are in primary coordinates, from the path's primary sample.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "inspect/local_model.h"
#include "inspect/proposals.h"
#include "inspect/slice.h"
#include "mcmc/methods/method.h"
#include "render/core/user_error.h"
#include "render/image/image.h"

namespace h2mc {

// The wish can't be met: what() is the whole message.
class InspectError : public UserError {
 public:
  using UserError::UserError;
};

// No path through the pixel contributes: nobody's mistake.
class DarkPixel : public InspectError {
 public:
  using InspectError::InspectError;
};

// Which of a pixel's paths.
enum class PathChoice : std::uint8_t {
  kRidge,  // of some that are drawn in proportion to the target, the one with the clearest ridge (ridge.h)
  kChain,    // the last state of a chain that is confined to the pixel
  kLargest,  // the one with the largest target of all that were met
  kGiven,    // InspectSettings::given
};

struct InspectSettings {
  int pixelX = 0, pixelY = 0;  // from the film's upper left corner; not looked at with kGiven
  PathChoice choice = PathChoice::kChain;
  Technique given;
  PrimarySample givenSample;
  long long samples = 16384;   // bidirectional samples through the pixel
  long long mutations = 4096;  // of the chain
  int proposals = 400;         // of each kind
  int resolution = 129;  // cells along a slice's edge; the middle of an odd number is the state
  // Edge of the wide slices; 0: what shows the ridge with kRidge, else eight standard deviations of the prior.
  double sliceSize = 0;
  std::string pair;  // "e1,e2", "u0,u1"; empty: the two strongest eigenvectors
  std::uint64_t seed = 0;
  int threads = 0;  // 0: one a core
  const std::atomic<bool>* stop = nullptr;
};

// Two directions, with the target on the plane that they span: once wide, once on the scale of the Gaussian along each.
struct InspectedPair {
  Direction x, y;
  Slice wide, close;
};

// How the path was found.
struct PathSearch {
  long long samples = 0;       // bidirectional samples through the pixel
  long long contributing = 0;  // connections of theirs
  int minLength = 1;           // edges of the shortest paths that were looked at
  double accepted = 0;         // share of the chain's mutations
};

struct Inspection {
  explicit Inspection(int maxLength) : path(maxLength) {}

  Path path;
  int pixelX = 0, pixelY = 0;  // where it is
  PathSearch search;
  LocalModel model;
  std::vector<InspectedPair> pairs;  // the chosen one first
  std::vector<ProposalKind> kinds;   // the mixture's, in its order
  Image film;                        // the scene in small, previewFilm()
  bool interrupted = false;          // then nothing but `search` need be there
};

// "e3" or "u0" or "time", twice, with a comma between: throws InspectError for anything else.
void checkPairText(const std::string& text);

// Finds a path, differentiates it, and looks around it with the method's mutations. The same for the
// same settings, whatever the number of threads. Throws DarkPixel, and InspectError
// if `pair` asks for what the path doesn't have.
Inspection inspect(const Scene& scene, const MetropolisMethod& method, const OptionSet& options,
                   const InspectSettings& settings);

}  // namespace h2mc
