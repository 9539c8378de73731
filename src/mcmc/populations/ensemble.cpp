// SPDX-License-Identifier: MIT
#include "mcmc/populations/ensemble.h"

#include <algorithm>
#include <cmath>

#include "mcmc/populations/epochs.h"
#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"
#include "render/integrator/ranks.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kChainStream = 0x636861696e, kResampleStream = 0x7265736d;
// The first epoch's mutations a pixel in a brief render, which is to know soon how many base samples it should have.
constexpr double kFirstEpochIfBrief = 0.25;
// Base samples for each mutation before their noise is known, and what one of them costs, in mutations: 1 to 1.4 on the
// project's scenes. No clock is asked, so that the picture does not depend on it.
constexpr double kFirstBase = 0.3, kBaseCost = 1.2;
// As many in a brief render: where there is time for fewer than so many samples a pixel, in which chains get nowhere.
constexpr double kFirstBaseIfBrief = 4, kBrief = 16;

double baseSamplesAtFirst(const OptionSet& options, double affordable) {
  const double wanted = options.number("baseSamples");
  if (options.string("largeStep") != "bidirectional") return 0;
  if (wanted >= 0) return wanted;
  return affordable < kBrief ? kFirstBaseIfBrief : kFirstBase;
}

}  // namespace

ChainEnsemble::ChainEnsemble(const Scene& scene, const MetropolisMethod& method,
                             const OptionSet& options, const Bootstrap& bootstrap, int minLength,
                             int maxLength, const RenderRequest& request, double affordable)
    : scene_(scene),
      seed_(request.seed),
      threads_(request.threads),
      maxLength_(maxLength),
      ranks_(request.ranks),
      useMap_(options.boolean("importanceMap")),
      target_(scene, maxLength, importance_),
      techniques_(minLength, maxLength),
      luminance_(bootstrap),
      population_(method.population()),
      chains_(at(std::max(options.integer("chains"), 1))),
      statistics_(request.pixelStatistics),
      image_(scene.film, request.threads, statistics_),
      learnsBase_(baseSamplesAtFirst(options, affordable) > 0 &&
                  options.number("baseSamples") < 0) {
  const std::vector<double> weights = bootstrap.techniqueLuminance();
  techniques_.setWeights(weights, std::vector<bool>(weights.size(), true));
  if (options.string("largeStep") != "bidirectional")
    luminance_ = LuminanceEstimate(bootstrap, techniques_);

  const std::size_t groups = std::min(chains_.size(), at(kMostGroups));
  groups_.reserve(groups);
  for (std::size_t g = 0; g < groups; ++g) {
    KernelMixture kernels = makeKernels(method, target_, techniques_, options, minLength);
    kernels.meanTarget = bootstrap.luminance().mean();
    kernels.baseSamples = baseSamplesAtFirst(options, affordable);
    kernels.brief = learnsBase_ && affordable < kBrief;
    kernels.dividesByHolding = kernels.baseSamples > 0 && options.boolean("divisionByHolding");
    kernels.width = static_cast<float>(scene.film.width);
    kernels.height = static_cast<float>(scene.film.height);
    const int kinds = kernels.kinds();
    Group& group = groups_.emplace_back(
        Group{{}, std::move(kernels), ChainStatistics(kinds, maxLength), {}, {}});
    group.films.states.counting = statistics_.counts;
    if (group.kernels.baseSamples > 0)
      group.base = std::make_unique<BaseSamples>(target_, minLength, seed_);
  }
  const Members members = population_->start(bootstrap, chains_.size(), maxLength, seed_, threads_);
  parallelFor(threads_, chains(), [&](int c) {
    chains_[at(c)] = std::make_unique<Chain>(
        target_, members.states[at(c)], Random(seed_, kChainStream, static_cast<std::uint64_t>(c)));
  });
  formGroups(members.half);
  if (options.has("replicas")) addReplicas(method, options, minLength);
}

void ChainEnsemble::addReplicas(const MetropolisMethod& method, const OptionSet& options,
                                int minLength) {
  const std::vector<double> powers =
      Replicas::powers(options.integer("replicas"), options.number("leastPower"));
  const double mean = luminance().mean;
  parallelFor(threads_, groups(), [&](int g) {
    Group& group = groups_[at(g)];
    const auto kernels = [&](const PathTarget& target) {
      return makeKernels(method, target, techniques_, options, minLength);
    };
    group.replicas =
        std::make_unique<Replicas>(target_, powers, mean, kernels, chains_[group.begin]->path(),
                                   seed_, static_cast<std::uint64_t>(g));
  });
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
    if (group.base)
      group.base->begin(2 * epoch_ + group.half, static_cast<int>(k), static_cast<int>(parts));
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
  if (group.replicas) {
    group.replicas->run(steps);
    for (std::size_t c = group.begin; c < group.end; ++c) group.replicas->exchange(*chains_[c]);
  }
  if (group.base)
    group.base->extendTo(group.kernels.baseSamples,
                         group.statistics.mutations - group.mutationsOfPast,
                         group.kernels.division(), group.films.samples, group.context.notFinite);
  image_.sort(group.films);
}

void ChainEnsemble::endRound() {
  exchange(ranks_, groups(), [&](Archive& archive, int g) {
    Group& group = groups_[at(g)];
    archive(group.films, group.statistics.mutations, group.statistics.largeSteps);
    if (group.base) archive(*group.base);
  });
  if (ranks_)
    parallelFor(threads_, groups(), [&, own = shareOf(ranks_, groups())](int g) {
      if (!own.has(g)) image_.sort(groups_[at(g)].films);
    });
  std::vector<ImageEstimate::Part> parts;
  for (Group& group : groups_) {
    const long long mutations = group.statistics.mutations;
    const long long samples = group.samples().count;
    parts.push_back({&group.films, group.half, mutations - group.mutationsBefore,
                     samples - group.samplesBefore});
    group.mutationsBefore = mutations;
    group.samplesBefore = samples;
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

int ChainEnsemble::cell() const { return knownCell(mutationsPerPixel()); }

bool ChainEnsemble::epochIsOver() const {
  const double first = groups_[0].kernels.brief ? kFirstEpochIfBrief : kFirstEpoch;
  return mutationsPerPixel() >= epochEnd(epoch_, first);
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

double ChainEnsemble::mutationCost() const {
  return 1 + kBaseCost * groups_[0].kernels.baseSamples;
}

Moments ChainEnsemble::baseSamples() const {
  Moments all;
  for (const Group& group : groups_)
    if (group.base) all.add(group.base->luminance());
  return all;
}

Moments ChainEnsemble::samples() const {
  Moments all;
  for (const Group& group : groups_) all.add(group.samples());
  return all;
}

void ChainEnsemble::measure(const std::vector<double>& weights) {
  stateNoise_ = varianceOfOneSample(image_.stateHalves(luminance().mean), weights);
  sampleNoise_ = varianceOfOneSample(image_.sampleHalves(), weights);
  if (!learnsBase_) return;
  // Large steps are samples too.
  const double samples = samplesAMutation(sampleNoise_, kBaseCost, stateNoise_, 1);
  for (Group& group : groups_)
    group.kernels.baseSamples = std::max(0., samples - group.kernels.largeProbability);
}

void ChainEnsemble::nextEpoch(const Image* direct) {
  ++epoch_;

  const ChainStatistics total = statistics();
  const double mean = luminance().mean;
  const ImportanceMap next = useMap_ ? nextMap(mean, direct) : importance_;
  const Members members = renewed(next);
  importance_ = next;
  formGroups(members.half);
  parallelFor(threads_, groups(), [&](int g) {
    Group& group = groups_[at(g)];
    group.kernels.meanTarget = mean;
    group.mutationsOfPast = group.statistics.mutations;
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

void ChainEnsemble::archiveGroup(Archive& archive, Group& group) {
  archive(group.kernels, group.statistics, group.context.derivatives, group.context.notFinite,
          group.mutationsBefore, group.samplesBefore, group.mutationsOfPast);
  if (group.base) archive(*group.base);
  if (group.replicas) archive(*group.replicas);
}

void ChainEnsemble::gather() {
  exchange(ranks_, groups(), [&](Archive& archive, int g) {
    Group& group = groups_[at(g)];
    for (std::size_t c = group.begin; c < group.end; ++c) archive(*chains_[c]);
    archiveGroup(archive, group);
  });
}

void ChainEnsemble::archive(Archive& archive) {
  archive(importance_, half_, epoch_, image_, stateNoise_, sampleNoise_);
  if (archive.reading()) formGroups(half_);
  for (const auto& chain : chains_) archive(*chain);
  for (Group& group : groups_) archiveGroup(archive, group);
}

nlohmann::json ChainEnsemble::replicasJson() const {
  nlohmann::json rungs = nlohmann::json::array();
  const std::size_t count = groups_[0].replicas->rungs().size();
  for (std::size_t r = 0; r < count; ++r) {
    Replicas::Rung all{};
    for (const Group& group : groups_) all.add(group.replicas->rungs()[r]);
    rungs.push_back({{"power", all.power},
                     {"mutations", all.mutations},
                     {"exchanges", all.exchanges.proposed},
                     {"accepted", all.exchanges.expected /
                                      static_cast<double>(std::max(all.exchanges.proposed, 1LL))}});
  }
  return rungs;
}

RenderResult ChainEnsemble::result() const {
  const ChainStatistics total = statistics();
  const auto [mean, error] = luminance();
  long long neverMoved = 0;
  for (const auto& chain : chains_) neverMoved += !chain->moved();

  RenderResult result;
  result.sampleUnit = "mutations";
  result.image = image_.image(mean);
  if (statistics_.variance) result.variance = image_.variance(mean, error);
  if (statistics_.counts) result.counts = image_.counts();
  result.samples = total.mutations;
  result.meanLuminance = mean;
  result.meanLuminanceError = error;
  result.statistics = total.json(groups_[0].kernels.kindNames());
  result.statistics["chains"] = chains();
  result.statistics["chains that never moved"] = neverMoved;
  result.statistics["epochs"] = epoch_ + 1;
  result.statistics["bootstrap"] = luminance_.bootstrapJson();
  result.statistics["large steps"] = luminance_.largeStepsJson(total.largeSteps);
  if (groups_[0].base) {
    const Moments base = baseSamples();
    result.statistics["base samples"] = {
        {"samples", base.count},
        {"samples per pixel", perPixel(static_cast<double>(base.count))},
        {"samples a mutation", groups_[0].kernels.baseSamples},
        {"mean luminance", base.mean()},
        {"standard error", base.standardError()}};
  }
  if (groups_[0].replicas) result.statistics["replicas"] = replicasJson();
  const auto noise = [&](double ofOne, long long count) {
    return count > 0 ? ofOne / perPixel(static_cast<double>(count)) : 0;
  };
  result.statistics["noise"] = {{"states", noise(stateNoise_, total.mutations)},
                                {"samples", noise(sampleNoise_, samples().count)}};
  return result;
}

}  // namespace h2mc
