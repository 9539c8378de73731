// SPDX-License-Identifier: MIT
#include "mcmc/populations/ensemble.h"

#include <algorithm>
#include <cmath>

#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kChainStream = 0x636861696e, kResampleStream = 0x7265736d;
// The first epoch's mutations a pixel.
constexpr double kFirstEpoch = 4;
// So many mutations make a cell of the importance map.
constexpr double kMutationsPerCell = 256;

}  // namespace

ChainEnsemble::ChainEnsemble(const Scene& scene, const MetropolisMethod& method,
                             const OptionSet& options, const Bootstrap& bootstrap, int minLength,
                             int maxLength, const RenderRequest& request)
    : scene_(scene),
      seed_(request.seed),
      threads_(request.threads),
      maxLength_(maxLength),
      useMap_(options.boolean("importanceMap")),
      target_(scene, maxLength, importance_),
      techniques_(minLength, maxLength),
      luminance_(bootstrap),
      population_(method.population()),
      chains_(at(std::max(options.integer("chains"), 1))),
      image_(scene.film, request.threads) {
  const std::vector<double> weights = bootstrap.techniqueLuminance();
  techniques_.setWeights(weights, std::vector<bool>(weights.size(), true));
  if (options.string("largeStep") != "bidirectional")
    luminance_ = LuminanceEstimate(bootstrap, techniques_);

  const std::size_t groups = std::min(chains_.size(), at(kMostGroups));
  groups_.reserve(groups);
  for (std::size_t g = 0; g < groups; ++g) {
    KernelMixture kernels = makeKernels(method, target_, techniques_, options, minLength);
    kernels.meanTarget = bootstrap.luminance().mean();
    const int kinds = kernels.kinds();
    groups_.push_back({{}, std::move(kernels), ChainStatistics(kinds, maxLength), {}});
  }
  const Members members = population_->start(bootstrap, chains_.size(), maxLength, seed_, threads_);
  parallelFor(threads_, chains(), [&](int c) {
    chains_[at(c)] = std::make_unique<Chain>(
        target_, members.states[at(c)], Random(seed_, kChainStream, static_cast<std::uint64_t>(c)));
  });
  formGroups(members.half);
}

void ChainEnsemble::formGroups(std::size_t half) {
  half_ = half;
  const std::size_t count = chains_.size(), groups = groups_.size();
  std::size_t ofFirst = half == count ? groups : 0;
  if (half > 0 && half < count)
    ofFirst = std::clamp<std::size_t>((groups * half + count / 2) / count, 1, groups - 1);
  for (std::size_t g = 0; g < groups; ++g) {
    Group& group = groups_[g];
    group.half = g < ofFirst ? 0 : 1;
    const std::size_t first = g < ofFirst ? 0 : half, size = g < ofFirst ? half : count - half;
    const std::size_t k = g < ofFirst ? g : g - ofFirst;
    const std::size_t parts = g < ofFirst ? ofFirst : groups - ofFirst;
    group.begin = first + size * k / parts;
    group.end = first + size * (k + 1) / parts;
  }
}

void ChainEnsemble::run(int index, long long steps) {
  Group& group = groups_[at(index)];
  for (std::size_t c = group.begin; c < group.end; ++c) {
    Chain& chain = *chains_[c];
    for (long long i = 0; i < steps; ++i)
      chain.step(group.kernels, group.films, group.statistics, group.context);
    chain.flush(group.kernels, group.films.states);
  }
  image_.sort(group.films);
}

void ChainEnsemble::endRound() {
  std::vector<ImageEstimate::Part> parts;
  for (Group& group : groups_) {
    const long long mutations = group.statistics.mutations;
    const long long largeSteps = group.statistics.largeSteps.count;
    parts.push_back({&group.films, group.half, mutations - group.mutationsBefore,
                     largeSteps - group.largeStepsBefore});
    group.mutationsBefore = mutations;
    group.largeStepsBefore = largeSteps;
  }
  image_.add(parts);
}

double ChainEnsemble::perPixel(double mutations) const {
  return mutations / (static_cast<double>(scene_.film.width) * scene_.film.height);
}

double ChainEnsemble::mutationsPerPixel() const {
  long long mutations = 0;
  for (const Group& group : groups_) mutations += group.statistics.mutations;
  return perPixel(static_cast<double>(mutations));
}

int ChainEnsemble::cell() const {
  return std::max(
      1, static_cast<int>(std::lround(std::sqrt(kMutationsPerCell / mutationsPerPixel()))));
}

bool ChainEnsemble::epochIsOver() const {
  return mutationsPerPixel() >= kFirstEpoch * std::pow(kGrowth, epoch_);
}

ChainStatistics ChainEnsemble::statistics() const {
  ChainStatistics total(groups_[0].kernels.kinds(), maxLength_);
  for (const Group& group : groups_) {
    ChainStatistics own = group.statistics;
    own.derivatives = group.context.derivatives;
    own.notFinite = group.context.notFinite;
    total.add(own);
  }
  return total;
}

ImportanceMap ChainEnsemble::nextMap(double luminance, const Image* direct) const {
  const Image sampled = image_.image(luminance);
  Image picture = sampled;
  if (direct)
    for (std::size_t i = 0; i < direct->pixels.size(); ++i) picture.pixels[i] += direct->pixels[i];
  return ImportanceMap(picture, sampled, cell());
}

void ChainEnsemble::nextEpoch(const Image* direct) {
  ++epoch_;

  const ChainStatistics total = statistics();
  const double luminance = luminance_.with(total.largeSteps).mean;
  const ImportanceMap next = useMap_ ? nextMap(luminance, direct) : importance_;
  const Members members = renewed(next);
  importance_ = next;
  formGroups(members.half);
  parallelFor(threads_, groups(), [&](int g) {
    Group& group = groups_[at(g)];
    group.kernels.meanTarget = luminance;
    group.kernels.learn(total);
    for (std::size_t c = group.begin; c < group.end; ++c) chains_[c]->restart(members.states[c]);
  });
  image_.begin();
}

Members ChainEnsemble::renewed(const ImportanceMap& next) const {
  std::vector<const Path*> states;
  std::vector<double> weights;
  for (const auto& chain : chains_) {
    const Path& path = chain->path();
    states.push_back(&path);
    weights.push_back(next(path.filmX, path.filmY) / importance_(path.filmX, path.filmY));
  }
  Random random(seed_, kResampleStream, static_cast<std::uint64_t>(epoch_));
  Members members = population_->renew(states, half_, weights, random);
  for (Path& path : members.states)
    path.target = h2mc::luminance(path.contribution) * next(path.filmX, path.filmY);
  return members;
}

void ChainEnsemble::archive(Archive& archive) {
  archive(importance_, half_, epoch_, image_);
  for (const auto& chain : chains_) archive(*chain);
  for (Group& group : groups_)
    archive(group.kernels, group.statistics, group.context.derivatives, group.context.notFinite,
            group.mutationsBefore, group.largeStepsBefore);
  if (archive.reading()) formGroups(half_);
}

RenderResult ChainEnsemble::result() const {
  const ChainStatistics total = statistics();
  const auto [mean, error] = luminance_.with(total.largeSteps);
  long long neverMoved = 0;
  for (const auto& chain : chains_) neverMoved += !chain->moved();

  RenderResult result;
  result.sampleUnit = "mutations";
  result.image = image_.image(mean);
  result.samples = total.mutations;
  result.meanLuminance = mean;
  result.meanLuminanceError = error;
  result.statistics = total.json(groups_[0].kernels.kindNames());
  result.statistics["chains"] = chains();
  result.statistics["chains that never moved"] = neverMoved;
  result.statistics["epochs"] = epoch_ + 1;
  result.statistics["bootstrap"] = luminance_.bootstrapJson();
  result.statistics["large steps"] = luminance_.largeStepsJson(total.largeSteps);
  return result;
}

}  // namespace h2mc
