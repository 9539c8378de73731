// SPDX-License-Identifier: MIT
// Chains of which most coordinates are read now and then only: lazily made steps keep the distribution of all of them,
// read or not, and the usual mistakes in making them do not.
#include "mcmc/mutations/lazy_point.h"

#include <gtest/gtest.h>

#include <array>

#include "chi_square.h"
#include "render/core/unit_interval.h"

namespace h2mc::test {
namespace {

constexpr int kCoordinates = 4;
using Cube = std::array<float, kCoordinates>;

// The target as a function of coordinates that it reads one by one. The second is read in half of the cube, the third
// in a tenth of it; the fourth never. Steps and spikes as narrow as a step.
template <class Read>
double target(Read&& read) {
  const auto spiky = [](float u) { return static_cast<int>(u * 12) % 3 == 0 ? 4.0 : 0.5; };
  const float first = read(0);
  if (first < 0.5f) return 1 + first;
  const float second = read(1);
  if (second < 0.8f) return spiky(second);
  return 0.7 * spiky(read(2));
}
constexpr double kHighest = 4;

enum class Mistake { kNone, kMissesSteps, kLargeKeepsUnread };

// A point with the mistakes that it could have.
class Mistaken {
 public:
  explicit Mistaken(Mistake mistake) : mistake_(mistake) { point_.begin(kCoordinates); }

  template <class Step>
  float read(int place, Random& random, const Step& step) {
    return point_.read(place, random, [&](int i, float u) {
      return mistake_ == Mistake::kMissesSteps ? u : step(i, u);
    });
  }
  void set(int place, float value) { point_.set(place, value); }
  void small(const Mistaken& from) { point_.follow(from.point_); }
  void large(const Mistaken& from) {
    if (mistake_ == Mistake::kLargeKeepsUnread)
      point_ = from.point_;
    else
      point_.begin(kCoordinates);
  }

 private:
  LazyPoint point_;
  Mistake mistake_;
};

// Of all coordinates; the first three matter.
int cellOf(const Cube& u) {
  const auto cell = [](float x, int cells) {
    return static_cast<int>(x * static_cast<float>(cells));
  };
  return ((cell(u[0], 4) * 12 + cell(u[1], 12)) * 12 + cell(u[2], 12)) * 3 + cell(u[3], 3);
}
constexpr int kCells = 4 * 12 * 12 * 3;

// Chains from exact starts of which, as from a bidirectional sample, only what was read is known.
ChiSquareVerdict run(Mistake mistake, int steps) {
  constexpr int kChains = 400000;
  std::vector<double> seen(kCells, 0), expected(kCells, 0);
  constexpr int kFine = 120;
  const auto middle = [](int i) { return (static_cast<float>(i) + 0.5f) / kFine; };
  double sum = 0;
  for (int i = 0; i < kFine; ++i)
    for (int j = 0; j < kFine; ++j)
      for (int k = 0; k < kFine; ++k) {
        const Cube u{middle(i), middle(j), middle(k), 0};
        const double f = target([&](int place) { return u[at(place)]; });
        for (int l = 0; l < 3; ++l) expected[at(cellOf({u[0], u[1], u[2], middle(40 * l)}))] += f;
        sum += 3 * f;
      }
  for (double& e : expected) e *= kChains / sum;

  for (int c = 0; c < kChains; ++c) {
    Random random(3, 0, static_cast<std::uint64_t>(c));
    const auto step = [&](int, float u) { return wrap(u + 0.03f * random.normal()); };
    Mistaken current(mistake), proposed(mistake);
    double f;
    do {
      current = Mistaken(mistake);
      f = target([&](int place) { return current.read(place, random, step); });
    } while (f < kHighest * random.uniformDouble());
    for (int k = 0; k < steps; ++k) {
      double g;
      if (random.uniform() < 0.1f) {
        proposed.large(current);
        g = target([&](int place) {
          const float u = random.uniform();
          proposed.set(place, u);
          return u;
        });
      } else {
        proposed.small(current);
        g = target([&](int place) {
          const float u = step(place, current.read(place, random, step));
          proposed.set(place, u);
          return u;
        });
      }
      if (random.uniformDouble() * f >= g) continue;
      std::swap(current, proposed);
      f = g;
    }
    Cube u;
    for (int i = 0; i < kCoordinates; ++i) u[at(i)] = current.read(i, random, step);
    seen[at(cellOf(u))] += 1;
  }
  return chiSquareTest(seen, expected, 6);
}

TEST(LazyPoint, KeepsTheDistributionSlow) {
  for (const int steps : {1, 10, 40}) {
    const ChiSquareVerdict verdict = run(Mistake::kNone, steps);
    std::printf("%d steps: p %.2g\n", steps, verdict.pValue);
    EXPECT_TRUE(verdict.passed) << verdict.message;
  }
}

TEST(LazyPoint, MistakesAreSeenSlow) {
  for (const Mistake mistake : {Mistake::kMissesSteps, Mistake::kLargeKeepsUnread}) {
    const ChiSquareVerdict verdict = run(mistake, 40);
    std::printf("mistake %d: p %.2g\n", static_cast<int>(mistake), verdict.pValue);
    EXPECT_FALSE(verdict.passed) << static_cast<int>(mistake);
  }
}

}  // namespace
}  // namespace h2mc::test
