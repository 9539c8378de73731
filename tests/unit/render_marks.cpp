// SPDX-License-Identifier: MIT
// Images on the way of a render.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "render/integrator/parallel_rounds.h"
#include "tiny_render.h"

namespace h2mc {
namespace {

void sleep(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

TEST(RenderClock, LeavesOutWhatIsExcluded) {
  RenderClock clock;
  clock.exclude([] { sleep(0.2); });
  EXPECT_LT(clock.wallSeconds(), 0.15);
  sleep(0.05);
  EXPECT_GE(clock.wallSeconds(), 0.05);
}

TEST(Rounds, MarksInRounds) {
  RoundsPlan plan;
  plan.rounds = 7;
  plan.marks = {0.5, 1, 3.5, 7};
  std::vector<long long> seen;
  plan.atMark = [&](std::size_t mark, const RoundsResult& so) {
    EXPECT_EQ(mark, seen.size());
    seen.push_back(so.rounds);
  };
  RenderClock clock;
  runRounds({}, clock, 1, plan, [](int, long long) {});
  EXPECT_EQ(seen, (std::vector<long long>{1, 1, 4, 7}));
}

TEST(Rounds, MarksInSecondsAreHitWithinHalfARound) {
  RenderClock clock;
  RoundsPlan plan;
  plan.seconds = 0.4;
  plan.marks = {0.1, 0.25, 0.4};
  std::vector<double> seen;
  plan.atMark = [&](std::size_t, const RoundsResult&) {
    seen.push_back(clock.wallSeconds());
    clock.exclude([] { sleep(0.3); });
  };
  runRounds({}, clock, 1, plan, [](int, long long) { sleep(0.01); });
  ASSERT_EQ(seen.size(), 3u);
  // A busy machine may be late, never early.
  for (std::size_t i = 0; i < 3; ++i) EXPECT_GT(seen[i], plan.marks[i] - 0.02);
  EXPECT_LT(clock.wallSeconds(), 1.2) << "the pauses do not count";
}

TEST(Rounds, NoMarksAfterAnInterruption) {
  std::atomic<bool> stop{false};
  RenderRequest request;
  request.stop = &stop;
  RoundsPlan plan;
  plan.rounds = 10;
  plan.marks = {2, 10};
  std::vector<long long> seen;
  plan.atMark = [&](std::size_t, const RoundsResult& so) { seen.push_back(so.rounds); };
  RenderClock clock;
  const RoundsResult result = runRounds(request, clock, 1, plan, [&](int, long long round) {
    if (round == 4) stop = true;
  });
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(seen, std::vector<long long>{2});
}

class Marks : public ::testing::TestWithParam<const char*> {
 protected:
  static RenderResult render(const Scene& scene, const RenderRequest& request, int direct) {
    return test::renderTiny(GetParam(), scene, request,
                            {{"maxDepth", "4"}, {"directSamples", std::to_string(direct)}});
  }

  static bool same(const Image& a, const Image& b) { return a.pixels == b.pixels; }
};

// The chains go on as if nobody had looked, whatever the number of threads.
TEST_P(Marks, ChangeNothing) {
  const Scene scene = test::tinyRing();
  RenderRequest request;
  request.budget.mutationsPerPixel = 40;
  request.seed = 3;
  request.threads = 1;
  const RenderResult plain = render(scene, request, 0);

  request.marks = {10, 20, 40};
  request.threads = 2;
  std::vector<RenderResult> seen;
  request.atMark = [&](std::size_t mark, const RenderResult& so) {
    EXPECT_EQ(mark, seen.size());
    seen.push_back(so);
  };
  const RenderResult marked = render(scene, request, 0);
  EXPECT_TRUE(same(plain.image, marked.image));
  ASSERT_EQ(seen.size(), 3u);
  EXPECT_TRUE(same(seen[2].image, marked.image));
  EXPECT_FALSE(same(seen[0].image, seen[1].image));
  const double pixels = 24 * 18;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GE(static_cast<double>(seen[i].samples), request.marks[i] * pixels);
    EXPECT_EQ(seen[i].sampleUnit, marked.sampleUnit);
    if (i > 0) {
      EXPECT_GT(seen[i].wallSeconds, seen[i - 1].wallSeconds);
    }
  }
  EXPECT_LE(seen[2].wallSeconds, marked.wallSeconds + 1e-3);  // made at the same moment
}

// Direct lighting that is split off grows with the marks, and is the same for any number of threads.
TEST_P(Marks, DirectLightingGrows) {
  const Scene scene = test::tinyRing();
  RenderRequest request;
  request.budget.mutationsPerPixel = 64;
  request.marks = {16, 64};
  request.threads = 1;
  std::vector<RenderResult> seen;
  request.atMark = [&](std::size_t, const RenderResult& so) { seen.push_back(so); };
  const RenderResult one = render(scene, request, -1);
  request.threads = 2;
  const RenderResult two = render(scene, request, -1);
  EXPECT_TRUE(same(one.image, two.image));
  ASSERT_EQ(seen.size(), 4u);
  EXPECT_TRUE(same(seen[0].image, seen[2].image));
  EXPECT_TRUE(same(seen[1].image, one.image));
  if (one.statistics.contains("direct lighting")) {
    EXPECT_GE(seen[0].statistics["direct lighting"]["samples per pixel"], 4);
    EXPECT_GE(seen[1].statistics["direct lighting"]["samples per pixel"], 16);
    EXPECT_EQ(one.statistics["direct lighting"]["samples per pixel"],
              two.statistics["direct lighting"]["samples per pixel"]);
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, Marks,
                         ::testing::Values("path", "bdpt", "photon", "mmlt", "h2mc"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace h2mc
