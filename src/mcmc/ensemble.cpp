#include "mcmc/ensemble.h"

#include <algorithm>
#include <cmath>

#include "mcmc/metropolis_integrator.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kStartStream = 0x73746172, kChainStream = 0x636861696e,
                        kResampleStream = 0x7265736d;
// The first epoch's mutations a pixel.
constexpr double kFirstEpoch = 4;
// So many mutations make a cell of the importance map.
constexpr double kMutationsPerCell = 256;

// A multiplexed large step sees one technique where a bootstrap sample sees all: how much its estimate
// of the mean luminance is worth. The bootstrap knows both variances.
double multiplexedWeight(const Bootstrap& bootstrap, const TechniqueDistribution& techniques) {
  double multiplexed = 0;
  const std::vector<double> squares = bootstrap.techniqueSquares();
  for (int k = 0; k < techniques.size(); ++k)
    if (techniques.probability(k) > 0)
      multiplexed += squares[static_cast<std::size_t>(k)] / techniques.probability(k);
  const Moments& first = bootstrap.luminance();
  const double spread = std::max(multiplexed - squared(first.mean()), 1e-30);
  return std::min(1.0, first.variance() / spread);
}

}  // namespace

ChainEnsemble::ChainEnsemble(const Scene& scene, const MetropolisMethod& method,
                             const OptionSet& options, const Bootstrap& bootstrap, int minLength,
                             int maxLength, const RenderRequest& request)
    : scene_(scene),
      bootstrap_(bootstrap),
      seed_(request.seed),
      threads_(request.threads),
      maxLength_(maxLength),
      chains_(std::max(options.integer("chains"), 1)),
      useMap_(options.boolean("importanceMap")),
      target_(scene, maxLength, importance_),
      techniques_(minLength, maxLength) {
  const std::vector<double> weights = bootstrap.techniqueLuminance();
  techniques_.setWeights(weights, std::vector<bool>(weights.size(), true));
  const bool bidirectional = options.string("largeStep") == "bidirectional";
  if (!bidirectional) largeStepWeight_ = multiplexedWeight(bootstrap, techniques_);

  const int groups = groupCount(scene.film);
  groups_.reserve(static_cast<std::size_t>(groups));
  for (int g = 0; g < groups; ++g) {
    KernelMixture kernels = makeKernels(method, target_, techniques_, options, minLength);
    kernels.brightness = bootstrap.luminance().mean();
    const int kinds = kernels.kinds();
    groups_.push_back({ChainFilms(scene.film),
                       std::move(kernels),
                       ChainStatistics(kinds, maxLength),
                       {},
                       {},
                       0,
                       0});
  }
  // Spread evenly over the bootstrap's samples: none gets more chains than its share by chance.
  const double offset =
      Random(seed_, kStartStream, static_cast<std::uint64_t>(chains_)).uniformDouble();
  parallelFor(threads_, groups, [&](int g) {
    Path start(maxLength_);
    for (int c = g; c < chains_; c += groups) {
      Random random(seed_, kStartStream, static_cast<std::uint64_t>(c));
      bootstrap_.drawStart((c + offset) / chains_, random, start);
      groups_[static_cast<std::size_t>(g)].chains.push_back(std::make_unique<Chain>(
          target_, start, Random(seed_, kChainStream, static_cast<std::uint64_t>(c))));
    }
  });
}

void ChainEnsemble::run(int index, long long steps) {
  Group& group = groups_[static_cast<std::size_t>(index)];
  for (const auto& chain : group.chains)
    for (long long i = 0; i < steps; ++i)
      chain->step(group.kernels, group.films, group.statistics, group.context);
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

void ChainEnsemble::Accumulated::add(const Image& states, double statesLuminance,
                                     const Image& samples, double samplesLuminance, double weight) {
  perLuminance.resize(states.pixels.size(), Rgbf(0));
  rest.resize(states.pixels.size(), Rgbf(0));
  mutations += weight;
  const float scale = static_cast<float>(weight / statesLuminance);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Rgbf own = states.pixels[i] * scale;
    perLuminance[i] += own;
    rest[i] +=
        samples.pixels[i] * static_cast<float>(weight) - own * static_cast<float>(samplesLuminance);
  }
}

Image ChainEnsemble::Accumulated::image(const FilmSettings& film, double luminance) const {
  Image image(film.width, film.height);
  if (!(mutations > 0)) return image;
  const float scale = static_cast<float>(1 / mutations), l = static_cast<float>(luminance);
  for (std::size_t i = 0; i < rest.size(); ++i)
    image.pixels[i] = (perLuminance[i] * l + rest[i]) * scale;
  return image;
}

ChainStatistics ChainEnsemble::statistics() const {
  ChainStatistics total(groups_[0].kernels.kinds(), maxLength_);
  for (const Group& group : groups_) {
    ChainStatistics own = group.statistics;
    own.derivatives = group.context.derivatives;
    total.add(own);
  }
  return total;
}

void ChainEnsemble::addEpoch(Accumulated& accumulated, std::size_t first, std::size_t step) const {
  ChainFilms films(scene_.film);
  double mutations = 0, largeSteps = 0;
  for (std::size_t g = first; g < groups_.size(); g += step) {
    const Group& group = groups_[g];
    films.states.merge(group.films.states);
    films.samples.merge(group.films.samples);
    for (const auto& chain : group.chains) chain->splatPending(group.kernels, films.states);
    mutations += static_cast<double>(group.statistics.mutations - group.mutationsBefore);
    largeSteps += static_cast<double>(group.statistics.largeSteps.count - group.largeStepsBefore);
  }
  if (!(films.states.luminance > 0)) return;
  const double ofSamples = largeSteps > 0 ? 1 / largeSteps : 0;
  accumulated.add(films.states.film.develop(1 / mutations), films.states.luminance / mutations,
                  films.samples.film.develop(ofSamples), films.samples.luminance * ofSamples,
                  mutations);
}

ChainEnsemble::Luminance ChainEnsemble::luminance(const ChainStatistics& total) const {
  const Moments &first = bootstrap_.luminance(), &second = total.largeSteps;
  const double n0 = static_cast<double>(first.count);
  const double n1 = largeStepWeight_ * static_cast<double>(second.count);
  return {(n0 * first.mean() + n1 * second.mean()) / (n0 + n1),
          std::hypot(n0 * first.standardError(), n1 * second.standardError()) / (n0 + n1)};
}

TwoEstimates ChainEnsemble::halves() const {
  const double brightness = luminance(statistics()).mean;
  TwoEstimates result;
  const auto half = [&](std::size_t first, Image& image, double& samples) {
    Accumulated own;
    addEpoch(own, first, 2);
    if (!(own.mutations > 0)) return;
    image = own.image(scene_.film, brightness);
    samples = perPixel(own.mutations);
  };
  half(0, result.a, result.samplesA);
  half(1, result.b, result.samplesB);
  return result;
}

ImportanceMap ChainEnsemble::nextMap(double brightness, const Image* direct) const {
  const Image sampled = past_.image(scene_.film, brightness);
  Image picture = sampled;
  if (direct)
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] += direct->pixels[i];
  return ImportanceMap(picture, sampled, cell());
}

void ChainEnsemble::nextEpoch(const Image* direct) {
  for (Group& group : groups_)
    for (const auto& chain : group.chains) chain->flush(group.kernels, group.films.states);
  addEpoch(past_, 0, 1);
  ++epoch_;

  const ChainStatistics total = statistics();
  const double brightness = luminance(total).mean;
  const ImportanceMap next = useMap_ ? nextMap(brightness, direct) : importance_;
  const std::vector<Path> starts = resampled(next);
  importance_ = next;
  parallelFor(threads_, groups(), [&](int g) {
    Group& group = groups_[static_cast<std::size_t>(g)];
    group.films.clear();
    group.mutationsBefore = group.statistics.mutations;
    group.largeStepsBefore = group.statistics.largeSteps.count;
    group.kernels.brightness = brightness;
    group.kernels.learn(total);
    for (std::size_t i = 0; i < group.chains.size(); ++i)
      group.chains[i]->restart(starts[static_cast<std::size_t>(g) + i * groups_.size()]);
  });
}

// Systematic resampling: state k is taken floor or ceil of (its share) * chains times.
std::vector<Path> ChainEnsemble::resampled(const ImportanceMap& next) const {
  const auto count = static_cast<std::size_t>(chains_);
  const auto pathOf = [&](std::size_t k) -> const Path& {
    return groups_[k % groups_.size()].chains[k / groups_.size()]->path();
  };
  std::vector<double> cumulative(count);
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Path& path = pathOf(k);
    sum += next(path.filmX, path.filmY) / importance_(path.filmX, path.filmY);
    cumulative[k] = sum;
  }
  Random random(seed_, kResampleStream, static_cast<std::uint64_t>(epoch_));
  const double offset = random.uniformDouble();
  std::vector<Path> result;
  result.reserve(count);
  std::size_t k = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = (static_cast<double>(i) + offset) / static_cast<double>(count) * sum;
    while (k + 1 < count && cumulative[k] <= at) ++k;
    Path& path = result.emplace_back(pathOf(k));
    path.target = h2mc::luminance(path.contribution) * next(path.filmX, path.filmY);
  }
  return result;
}

RenderResult ChainEnsemble::result() const {
  const ChainStatistics total = statistics();
  const auto [mean, error] = luminance(total);
  Accumulated all = past_;
  addEpoch(all, 0, 1);
  long long neverMoved = 0;
  for (const Group& group : groups_)
    for (const auto& chain : group.chains) neverMoved += !chain->moved();

  RenderResult result;
  result.sampleUnit = "mutations";
  result.image = all.image(scene_.film, mean);
  result.samples = total.mutations;
  result.meanLuminance = mean;
  result.meanLuminanceError = error;
  result.statistics = total.json(groups_[0].kernels.kindNames());
  result.statistics["chains"] = chains_;
  result.statistics["chains that never moved"] = neverMoved;
  result.statistics["epochs"] = epoch_ + 1;
  const Moments& first = bootstrap_.luminance();
  result.statistics["bootstrap"] = {{"samples", first.count},
                                    {"mean luminance", first.mean()},
                                    {"standard error", first.standardError()},
                                    {"not finite", bootstrap_.notFinite()}};
  result.statistics["large steps"] = {{"mean luminance", total.largeSteps.mean()},
                                      {"standard error", total.largeSteps.standardError()},
                                      {"weight", largeStepWeight_}};
  return result;
}

}  // namespace h2mc
