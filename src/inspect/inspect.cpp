// SPDX-License-Identifier: MIT
#include "inspect/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "inspect/film_preview.h"
#include "inspect/path_search.h"
#include "inspect/ridge.h"
#include "mcmc/mutations/hamiltonian_step.h"
#include "mcmc/populations/bootstrap.h"
#include "mcmc/render/direct_lighting.h"
#include "render/core/index.h"
#include "render/integrator/common_options.h"
#include "render/scene/suggestion.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kProposalStream = 0x696e7372;
// Slices reach so many standard deviations to either side.
constexpr double kReach = 4;
// Eigenvectors that are paired with one another, beside the weakest.
constexpr std::size_t kStrongest = 4;
constexpr std::size_t kMostCoordinatePairs = 8;
constexpr long long kTechniqueSamples = 20000;
// Paths of which the one with the clearest ridge is shown.
constexpr std::size_t kRidgeCandidates = 32;

std::pair<std::string, std::string> splitPair(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return {text, ""};
  return {text.substr(0, comma), text.substr(comma + 1)};
}

bool isDirectionName(const std::string& name) {
  if (name == "time") return true;
  return name.size() >= 2 && name.size() <= 4 && (name[0] == 'e' || name[0] == 'u') &&
         std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

using NamedPair = std::pair<std::string, std::string>;

// The chosen pair, then those that the page offers beside it.
std::vector<NamedPair> pairNames(const LocalModel& model, const Path& path,
                                 const std::string& chosen) {
  std::vector<NamedPair> pairs;
  const auto add = [&](const std::string& x, const std::string& y) {
    for (const NamedPair& known : pairs)
      if (known == NamedPair{x, y}) return;
    pairs.emplace_back(x, y);
  };
  if (!chosen.empty()) {
    const auto [x, y] = splitPair(chosen);
    add(x, y);
  }
  std::vector<std::string> eigen;
  for (std::size_t i = 1; i <= std::min(kStrongest, model.eigen.size()); ++i)
    eigen.push_back(fmt::format("e{}", i));
  if (model.eigen.size() > kStrongest) eigen.push_back(fmt::format("e{}", model.eigen.size()));
  for (std::size_t i = 0; i < eigen.size(); ++i)
    for (std::size_t j = i + 1; j < eigen.size(); ++j) add(eigen[i], eigen[j]);
  const auto own = at(path.technique.dimension());
  for (std::size_t i = 0; i < std::min(own, 2 * kMostCoordinatePairs); i += 2)
    add(fmt::format("u{}", i), fmt::format("u{}", i + 1));
  if (path.aperture) add("aperture0", "aperture1");
  if (path.moving) add("u0", "time");
  return pairs;
}

Direction directionOf(const LocalModel& model, const std::string& name) {
  Direction direction = model.direction(name);
  if (!direction.vector.empty()) return direction;
  if (name[0] == 'e' && !model.available)
    throw InspectError("--pair: no eigenvector \"" + name + "\": " + model.reason);
  throw InspectError("--pair: this path has no \"" + name +
                     "\"; available: " + joined(model.names()));
}

// Half the edge of a slice on the scale of the Gaussian, its centre of mass well inside.
double closeHalf(const LocalModel& model, const Direction& direction) {
  return std::min(0.5, kReach * model.deviationAlong(direction.vector) +
                           std::abs(model.driftAlong(direction.vector)));
}

// Half the edge of the wide slices.
double wideHalf(const Scene& scene, const InspectSettings& settings, const Inspection& result) {
  if (settings.sliceSize > 0) return settings.sliceSize / 2;
  if (settings.choice == PathChoice::kRidge)
    return ridgeAt(scene, result.path, result.model, settings.threads, settings.stop).half;
  return std::min(kReach * result.model.settings.sigma, 0.5);
}

void tracePairs(const Scene& scene, const InspectSettings& settings, Inspection& result) {
  const double wide = wideHalf(scene, settings, result);
  for (const auto& [x, y] : pairNames(result.model, result.path, settings.pair)) {
    if (settings.stop && *settings.stop) return;
    InspectedPair pair{directionOf(result.model, x), directionOf(result.model, y), {}, {}};
    const auto trace = [&](double halfX, double halfY) {
      return traceSlice(scene, result.path, pair.x, pair.y, halfX, halfY, settings.resolution,
                        settings.threads, settings.stop);
    };
    pair.wide = trace(wide, wide);
    pair.close = trace(closeHalf(result.model, pair.x), closeHalf(result.model, pair.y));
    result.pairs.push_back(std::move(pair));
  }
}

// In edges.
struct PathLengths {
  int shortest = 1, longest = 1;
  int usual = 1;  // the shortest that chains see where shorter ones are left to path tracing
};

PathLengths lengthsOf(const Scene& scene, const OptionSet& options,
                      const InspectSettings& settings) {
  PathLengths lengths{options.integer("minDepth"), maxPathLength(options), 1};
  if (settings.choice == PathChoice::kGiven) {
    lengths.longest = std::max(lengths.longest, settings.given.length());
    lengths.shortest = std::min(lengths.shortest, settings.given.length());
  }
  const bool split = options.integer("directSamples") != 0;
  lengths.usual = std::max(lengths.shortest, split ? DirectLighting::longest(scene) + 1 : 1);
  if (lengths.usual > lengths.longest) lengths.usual = lengths.shortest;
  return lengths;
}

// The path, of some, around which the target is a ridge most of all; the first of those that are none.
const Path& clearestRidge(const Scene& scene, const std::vector<Path>& paths,
                          const HamiltonianSettings& hamiltonian, const InspectSettings& settings) {
  const Path* best = &paths.front();
  double most = 0;
  for (const Path& path : paths) {
    const LocalModel model = localModel(scene, path, hamiltonian);
    const double strength = ridgeAt(scene, path, model, settings.threads, settings.stop).strength;
    if (strength > most) {
      most = strength;
      best = &path;
    }
  }
  return *best;
}

void choosePath(const SceneTarget& target, KernelMixture& kernels, const PathLengths& lengths,
                const OptionSet& options, const InspectSettings& settings, Inspection& result) {
  Path& path = result.path;
  if (settings.choice == PathChoice::kGiven) {
    path.technique = settings.given;
    path.sample = settings.givenSample;
    if (!target.evaluate(path))
      throw InspectError("--replay: in this scene that path carries no light");
    return;
  }
  const bool ridge = settings.choice == PathChoice::kRidge;
  for (const int length : {lengths.usual, lengths.shortest}) {
    const std::vector<Path> found =
        findPaths(target, kernels, length, settings, ridge ? kRidgeCandidates : 1, result.search);
    if (settings.stop && *settings.stop) return;
    if (found.empty()) continue;
    path = ridge ? clearestRidge(target.scene(), found, hamiltonianSettings(options), settings)
                 : found.front();
    return;
  }
  throw DarkPixel(fmt::format(
      "no light arrives at pixel {},{}: of {} samples through it, with paths of {} to {} edges, "
      "none contributes",
      settings.pixelX, settings.pixelY, result.search.samples, lengths.shortest, lengths.longest));
}

}  // namespace

void checkPairText(const std::string& text) {
  const auto [x, y] = splitPair(text);
  if (!isDirectionName(x) || !isDirectionName(y))
    throw InspectError(
        "--pair: expected two names with a comma between, e1,e2 (eigenvectors) or "
        "u0,u1 (coordinates), got \"" +
        text + "\"");
  if (x == y) throw InspectError("--pair: \"" + text + "\" is the same direction twice");
  if ((x[0] == 'e') != (y[0] == 'e'))
    throw InspectError("--pair: \"" + text +
                       "\" mixes an eigenvector with a coordinate, which are not at right angles");
}

Inspection inspect(const Scene& scene, const MetropolisMethod& method, const OptionSet& options,
                   const InspectSettings& settings) {
  if (!settings.pair.empty()) checkPairText(settings.pair);
  const PathLengths lengths = lengthsOf(scene, options, settings);
  const int maxLength = lengths.longest;
  const ImportanceMap everywhere;
  const SceneTarget target(scene, maxLength, everywhere);
  TechniqueDistribution techniques(lengths.shortest, maxLength);
  if (options.string("largeStep") != "bidirectional") {
    const Bootstrap bootstrap(scene, lengths.shortest, maxLength, kTechniqueSamples, settings.seed,
                              settings.threads);
    const std::vector<double> weights = bootstrap.techniqueLuminance();
    techniques.setWeights(weights, std::vector<bool>(weights.size(), true));
  }
  const auto kernelsFrom = [&](int minLength) {
    return makeKernels(method, target, techniques, options, minLength);
  };
  KernelMixture kernels = kernelsFrom(lengths.usual);

  Inspection result(maxLength);
  const auto stopped = [&] { return settings.stop && *settings.stop; };
  choosePath(target, kernels, lengths, options, settings, result);
  if ((result.interrupted = stopped())) return result;
  // Large steps propose what the chain of such a path would see.
  if (result.path.technique.length() < lengths.usual) kernels = kernelsFrom(lengths.shortest);
  result.pixelX = pixelAt(result.path.filmX, scene.film.width);
  result.pixelY = pixelAt(result.path.filmY, scene.film.height);
  result.model = localModel(scene, result.path, hamiltonianSettings(options));

  tracePairs(scene, settings, result);
  ChainState state(maxLength);
  state.path = result.path;
  for (std::size_t k = 0; k < static_cast<std::size_t>(kernels.kinds()) && !stopped(); ++k) {
    if (!kernels.mutation(k).applies(result.path)) continue;
    result.kinds.push_back(propose(scene, kernels.mutation(k), state, result.model,
                                   settings.proposals, Random(settings.seed, kProposalStream, k)));
  }
  result.film = previewFilm(scene, maxLength, settings.seed, settings.threads, settings.stop);
  result.interrupted = stopped();
  return result;
}

}  // namespace h2mc
