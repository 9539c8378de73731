// SPDX-License-Identifier: MIT
// Whether chains that a mixture of kernels drives keep their target's distribution, and whether what they splat has the
// image as its mean.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "exact_starts.h"
#include "mcmc/chain/chain.h"
#include "paired_table.h"

namespace h2mc::test {

struct ExactnessPlan {
  int samples = 300000;  // bidirectional ones, a fifth of which or so start a chain
  int steps = 20;        // of each chain
  std::uint64_t seed = 1;
  int learnAfter = 0;  // samples after which kernels learn from what was counted; 0: never
  int verdicts = 1;    // how many there are in the whole test, for Sidak's correction
};

struct ExactnessReport {
  bool passed = true;
  double smallestP = 1;
  double acceptance = 0;  // mean over all steps
  std::string text;

  void add(const std::string& what, double p, const std::string& message, int verdicts) {
    smallestP = std::min(smallestP, p);
    if (p >= sidak(kFalseAlarmRate, verdicts)) return;
    passed = false;
    text += what + ": " + message + "\n";
  }
};

namespace detail {

inline constexpr int kColumns = 4, kRows = 3;
inline int cellOf(float x, int cells) {
  return std::clamp(static_cast<int>(x * static_cast<float>(cells)), 0, cells - 1);
}
inline int techniqueOf(const Path& path) {
  const int length = path.technique.length();
  return length * (length + 1) / 2 + path.technique.s;
}

// In which cells of each table a state lies.
constexpr std::size_t kTables = 6;
inline constexpr const char* kTableNames[kTables] = {"technique x film",
                                                     "technique x octave of the target",
                                                     "technique x middle coordinate",
                                                     "technique x last coordinate",
                                                     "technique x time",
                                                     "technique x aperture"};
inline std::array<int, kTables> cellsOf(const Path& path, double meanTarget) {
  const int technique = techniqueOf(path), dimension = path.technique.dimension();
  const int film = cellOf(path.filmY, kRows) * kColumns + cellOf(path.filmX, kColumns);
  const int octave = std::clamp(std::ilogb(path.target / meanTarget), -12, 12) + 12;
  const auto u = [&](int i) { return cellOf(path.sample.u[at(i)], 6); };
  return {
      technique * 12 + film,
      technique * 25 + octave,
      technique * 6 + u(dimension / 2),
      technique * 6 + u(dimension - 2),
      technique * 6 + cellOf(path.sample.time, 6),
      technique * 9 + cellOf(path.sample.aperture[0], 3) * 3 + cellOf(path.sample.aperture[1], 3)};
}

// Blocks of the film, and the whole of it last.
using Blocks = std::array<double, kColumns * kRows + 1>;

struct BlockMoments {
  Blocks sum{}, squares{};
  double count = 0;
  void add(const Blocks& values) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      sum[k] += values[k];
      squares[k] += values[k] * values[k];
    }
    count += 1;
  }
  double mean(std::size_t k) const { return count > 0 ? sum[k] / count : 0; }
  double varianceOfMean(std::size_t k) const {
    return count > 0 ? (squares[k] / count - mean(k) * mean(k)) / count : 0;
  }
};

inline FilmSettings blockFilm() { return {kColumns, kRows, {}}; }

// Adds `scale` times the luminance of each block.
inline void addBlocks(const Film& film, double scale, Blocks& blocks) {
  const Image image = film.develop(scale / (kColumns * kRows));
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const double value = luminance(image.at(x, y));
      blocks[at(y * kColumns + x)] += value;
      blocks.back() += value;
    }
}

// The same of what waits in a list.
inline void addBlocks(SplatList& splats, double scale, Blocks& blocks) {
  Film film(blockFilm());
  splats.sort(film, 1);
  splats.addBand(0, 0, film);
  addBlocks(film, scale, blocks);
}

}  // namespace detail

// Runs a chain of `plan.steps` steps from each start. Tables of states before and after: PairedTable. The film: what a
// chain splats in its steps, against the bidirectional sample that it started from. Where `kernels.meanTarget` is
// known, large steps count as samples too: every second chain says what they add.
inline ExactnessReport checkExactness(const PathTarget& target, KernelMixture& kernels,
                                      int minLength, const ExactnessPlan& plan) {
  using namespace detail;
  ExactStarts starts(target, minLength, plan.seed);
  std::array<PairedTable, kTables> tables;
  BlockMoments ofStates, ofSamples;
  Moments
      octaves;  // how much brighter, in octaves, a chain has become: the functional that most mistakes change
  ChainStatistics statistics(kernels.kinds(), target.maxLength());
  MutationContext context;
  Path start(target.maxLength());
  ChainFilms films;
  Film reference(blockFilm());
  const bool samplesCount = kernels.meanTarget.has_value();
  for (int i = 0; i < plan.samples; ++i) {
    if (plan.learnAfter > 0 && i == plan.learnAfter) kernels.learn(statistics);
    const double weight = starts.start(i, start);
    films.clear();
    if (weight > 0) {
      Chain chain(target, start, Random(plan.seed, 2, static_cast<std::uint64_t>(i)));
      const auto before = cellsOf(chain.path(), starts.meanTarget());
      for (int k = 0; k < plan.steps; ++k) chain.step(kernels, films, statistics, context);
      chain.flush(kernels, films.states);
      const auto after = cellsOf(chain.path(), starts.meanTarget());
      for (std::size_t t = 0; t < kTables; ++t) tables[t].add(before[t], after[t], weight);
      octaves.add(weight * std::log2(chain.path().target / double(start.target)));
    }
    Blocks blocks{};
    if (samplesCount && i % 2 == 1) {
      if (!(weight > 0)) continue;
      addBlocks(films.samples.splats, 1 / (plan.steps * kernels.largeProbability), blocks);
      ofSamples.add(blocks);
      continue;
    }
    reference.clear();
    for (const auto& c : starts.connections()) reference.splat(c.filmX, c.filmY, c.contribution);
    addBlocks(reference, -1, blocks);
    addBlocks(films.states.splats, starts.bound() * weight / plan.steps, blocks);
    ofStates.add(blocks);
  }

  ExactnessReport report;
  AcceptanceCount all;
  for (const auto& kind : statistics.acceptance)
    for (const AcceptanceCount& count : kind) all.add(count);
  report.acceptance = all.expected / static_cast<double>(std::max(all.proposed, 1LL));
  for (std::size_t t = 0; t < kTables; ++t) {
    const ChiSquareVerdict verdict = tables[t].test(plan.verdicts);
    report.add(kTableNames[t], verdict.pValue, verdict.message, plan.verdicts);
  }
  const auto add = [&](const std::string& what, double mean, double variance) {
    if (!(variance > 0)) return;
    const double z = mean / std::sqrt(variance);
    report.add(what, std::erfc(std::abs(z) / std::sqrt(2.0)),
               std::to_string(z) + " standard errors off", plan.verdicts);
  };
  add("mean log2 of the target", octaves.mean(), squared(octaves.standardError()));
  for (std::size_t k = 0; k < ofStates.sum.size(); ++k)
    add("film block " + std::to_string(k), ofStates.mean(k) + ofSamples.mean(k),
        ofStates.varianceOfMean(k) + ofSamples.varianceOfMean(k));
  return report;
}

}  // namespace h2mc::test
