// SPDX-License-Identifier: MIT
// Intervals, tests, fits and ranks of a comparison, against tables and closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "compare/curves.h"
#include "compare/power_law.h"
#include "compare/repeats.h"
#include "compare/summary.h"
#include "render/core/random.h"

namespace h2mc {
namespace {

// Fisher's table.
TEST(Repeats, StudentQuantiles) {
  EXPECT_NEAR(studentQuantile(1), 12.706, 1e-3);
  EXPECT_NEAR(studentQuantile(2), 4.303, 1e-3);
  EXPECT_NEAR(studentQuantile(10), 2.228, 1e-3);
  EXPECT_NEAR(studentQuantile(1e6), 1.960, 1e-3);
}

TEST(Repeats, IntervalOfAMean) {
  const std::vector<double> values{1, 2, 3};
  const Estimate e = meanEstimate(values);
  EXPECT_DOUBLE_EQ(e.value, 2);
  EXPECT_NEAR(e.high - 2, 4.303 / std::sqrt(3.0), 1e-3);
  EXPECT_NEAR(2 - e.low, e.high - 2, 1e-12);
  EXPECT_TRUE(std::isnan(meanEstimate(std::vector<double>{1}).low));
  const Estimate g = geometricMean(std::vector<double>{1, 4});
  EXPECT_NEAR(g.value, 2, 1e-12);
  EXPECT_NEAR(g.low * g.high, 4, 1e-9);
}

// The interval holds the truth as often as it says.
TEST(Repeats, IntervalsCoverTheTruth) {
  Random random(7, 1, 0);
  const auto normal = [&] {  // sum of twelve uniform numbers, less six
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += random.uniform();
    return sum;
  };
  int covered = 0, coveredMean = 0;
  constexpr int kTrials = 4000;
  for (int i = 0; i < kTrials; ++i) {
    const std::vector<double> c{normal(), normal(), normal()};
    const Estimate mean = meanEstimate(c);
    coveredMean += mean.low < 0 && mean.high > 0;
    std::vector<double> a, b;
    for (int k = 0; k < 8; ++k) a.push_back(normal());
    for (int k = 0; k < 6; ++k) b.push_back(3 * normal());
    const Estimate e = differenceOfMeans(a, b);
    covered += e.low < 0 && e.high > 0;
  }
  EXPECT_NEAR(coveredMean / double(kTrials), 0.95, 0.012);
  EXPECT_NEAR(covered / double(kTrials), 0.95, 0.015);
}

TEST(Repeats, WelchTest) {
  const std::vector<double> a{27.5, 21.0, 19.0, 23.6, 17.0, 17.9}, b{27.1, 22.0, 20.8, 23.4, 23.4};
  // By hand: t = 1.2099 with 8.293 degrees of freedom, and the density integrated numerically.
  EXPECT_NEAR(welchTest(a, b), 0.25966, 1e-4);
  EXPECT_NEAR(welchTest(a, b), welchTest(b, a), 1e-12);
  EXPECT_EQ(welchTest(std::vector<double>{1, 1}, std::vector<double>{1, 1}), 1);
  EXPECT_EQ(welchTest(std::vector<double>{1, 1}, std::vector<double>{2, 2}), 0);
  EXPECT_TRUE(std::isnan(welchTest(std::vector<double>{1}, b)));
}

TEST(Repeats, Holm) {
  const double nan = std::nan("");
  const std::vector<double> p{0.01, 0.04, nan, 0.03, 0.005};
  const std::vector<double> adjusted = holmAdjusted(p);
  EXPECT_NEAR(adjusted[4], 0.02, 1e-12);
  EXPECT_NEAR(adjusted[0], 0.03, 1e-12);
  EXPECT_NEAR(adjusted[3], 0.06, 1e-12);
  EXPECT_NEAR(adjusted[1], 0.06, 1e-12);  // never less than that of a smaller p
  EXPECT_TRUE(std::isnan(adjusted[2]));
}

TEST(PowerLaw, ExactPoints) {
  std::vector<TimedError> points;
  for (const double t : {1.0, 2.0, 5.0, 10.0}) points.push_back({t, 3 * std::pow(t, -0.8)});
  const PowerLaw law = fitPowerLaw(points);
  ASSERT_TRUE(law.valid);
  EXPECT_NEAR(law.p, 0.8, 1e-12);
  EXPECT_NEAR(std::exp(law.logC), 3, 1e-12);
  EXPECT_NEAR(law.timeFor(std::log(0.3)), std::pow(10, 1 / 0.8), 1e-9);
}

TEST(PowerLaw, NeedsTwoTimesAndPositiveErrors) {
  EXPECT_FALSE(fitPowerLaw({}).valid);
  EXPECT_FALSE(fitPowerLaw(std::vector<TimedError>{{1, 2}, {1, 3}}).valid);
  EXPECT_FALSE(fitPowerLaw(std::vector<TimedError>{{1, 0}, {2, 3}}).valid);
  const PowerLaw rising = fitPowerLaw(std::vector<TimedError>{{1, 1}, {2, 3}});
  EXPECT_TRUE(std::isinf(rising.timeFor(std::log(0.1))));
}

// A method whose error is `factor` times c / t in each repeat, with a scatter of so many per cent.
MethodRuns method(const std::string& name, double factor, const std::vector<double>& scatter) {
  MethodRuns runs;
  runs.name = name;
  for (const double s : scatter) {
    Repeat repeat;
    for (const double t : {1.0, 2.0, 4.0}) {
      Point point;
      point.mark = point.seconds = t;
      point.perPixel = 100 * t;
      point.errors["relmse"] = factor * (1 + s) / t;
      repeat.points.push_back(point);
    }
    runs.repeats.push_back(repeat);
  }
  return runs;
}

ComparisonPlan plan() {
  ComparisonPlan plan;
  plan.marks = {1, 2, 4};
  return plan;
}

TEST(Summary, TimeRatioAndRanks) {
  SceneRuns runs;
  const std::vector<double> scatter{-0.02, 0, 0.02};
  runs.methods = {method("slow", 3, scatter), method("fast", 1, scatter),
                  method("same", 1.005, {0.02, -0.02, 0})};
  const Summary summary = summarise(runs, plan(), "relmse", true);
  EXPECT_EQ(summary.best, 1);
  EXPECT_EQ(summary.position, 4);
  const MethodSummary& slow = summary.methods[0];
  EXPECT_NEAR(slow.error.value, 0.75, 1e-3);
  EXPECT_NEAR(slow.p.value, 1, 1e-9);
  EXPECT_NEAR(slow.timeRatio.value, 3, 1e-3);
  EXPECT_LT(slow.timeRatio.low, 3);
  EXPECT_GT(slow.timeRatio.low, 2.5);
  EXPECT_GT(slow.timeRatio.high, 3);
  EXPECT_EQ(slow.verdict, "worse");
  EXPECT_EQ(slow.rank, 3);
  EXPECT_EQ(summary.methods[1].verdict, "best");
  EXPECT_EQ(summary.methods[1].rank, 1);
  EXPECT_EQ(summary.methods[2].verdict, "no difference shown");
  EXPECT_EQ(summary.methods[2].rank, 1);
}

// The last is not shown to be worse than the best, but than the second; rank and verdict must not contradict.
TEST(Summary, RankAndVerdictSayTheSame) {
  SceneRuns runs;
  runs.methods = {method("wide", 1.6, {-0.5, 0.4, 0.05}), method("worst", 4, {-0.001, 0.001, 0}),
                  method("best", 1, {-0.45, 0.5, 0.02}),
                  method("second", 1.05, {-0.001, 0.001, 0})};
  const Summary summary = summarise(runs, plan(), "relmse", true);
  EXPECT_EQ(summary.best, 2);
  for (const MethodSummary& m : summary.methods)
    EXPECT_EQ(m.rank > 1, m.verdict == "worse") << m.name << ": " << m.rank << ", " << m.verdict;
  EXPECT_EQ(summary.methods[1].rank, 1)
      << "it is worse than the second, but not shown to be than the best";
  EXPECT_EQ(summary.order, (std::vector<std::size_t>{2, 3, 0, 1}));
}

TEST(Curve, TwoRepeatsHaveARange) {
  const MethodCurve two = methodCurve(method("two", 1, {-0.1, 0.1}), "relmse", true);
  ASSERT_EQ(two.size(), 3u);
  EXPECT_TRUE(two[2].bandIsRange);
  EXPECT_NEAR(two[2].bandLow, 0.9 / 4, 1e-12);
  EXPECT_NEAR(two[2].bandHigh, 1.1 / 4, 1e-12);
  EXPECT_NEAR(two[2].position, 4, 1e-12);
  const MethodCurve three = methodCurve(method("three", 1, {-0.1, 0, 0.1}), "relmse", false);
  EXPECT_FALSE(three[0].bandIsRange);
  EXPECT_EQ(three[0].bandHigh, three[0].error.high);
  EXPECT_NEAR(three[0].position, 100, 1e-10);
  EXPECT_TRUE(std::isnan(methodCurve(method("one", 1, {0}), "relmse", true)[0].bandLow));
}

TEST(Summary, OneRepeatShowsNothing) {
  SceneRuns runs;
  runs.methods = {method("a", 2, {0}), method("b", 1, {0})};
  const Summary summary = summarise(runs, plan(), "relmse", true);
  EXPECT_EQ(summary.methods[0].rank, 1);
  EXPECT_TRUE(std::isnan(summary.methods[0].error.low));
  EXPECT_NEAR(summary.methods[0].timeRatio.value, 2, 1e-9);
  EXPECT_NE(summary.methods[0].verdict, "worse");
}

// A method without an image at the mark is read off its own fit; one that never improves has no time.
TEST(Summary, FitsStandInAndMayNotFall) {
  SceneRuns runs;
  runs.methods = {method("a", 1, {-0.01, 0.01}), method("other", 1, {-0.01, 0.01}),
                  method("flat", 1, {0.1, -0.1})};
  for (Repeat& repeat : runs.methods[1].repeats) repeat.points.pop_back();
  for (Repeat& repeat : runs.methods[2].repeats)
    for (Point& point : repeat.points) point.errors["relmse"] = 5 + 0.001 * point.seconds;
  const Summary summary = summarise(runs, plan(), "relmse", true);
  EXPECT_TRUE(summary.methods[1].byFit);
  EXPECT_NEAR(summary.methods[1].error.value, 0.25, 1e-3);
  EXPECT_TRUE(std::isinf(summary.methods[2].timeRatio.value));
  const Summary work = summarise(runs, plan(), "relmse", false);
  EXPECT_NEAR(work.position, 200, 1e-9);  // as far as all have come
}

}  // namespace
}  // namespace h2mc
