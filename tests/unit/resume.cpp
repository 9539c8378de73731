// SPDX-License-Identifier: MIT
// Renders that go on from what an earlier one has saved.
#include <gtest/gtest.h>

#include <sstream>

#include "render/core/archive.h"
#include "render/integrator/parallel_rounds.h"
#include "tiny_render.h"

namespace h2mc {
namespace {

struct Pair {
  int a = 0;
  std::vector<double> b;
  void archive(Archive& archive) { archive(a, b); }
  bool operator==(const Pair&) const = default;
};

TEST(Archive, GivesBackWhatItGot) {
  std::stringstream stream;
  Pair pair{3, {1, 2.5}};
  std::vector<Pair> pairs{{1, {}}, {2, {7}}};
  std::vector<std::vector<int>> lists{{1}, {}, {2, 3}};
  std::optional<double> some = 4.0, none;
  std::string text("a\0b", 3);
  std::array<Pair, 2> array{pair, Pair{}};
  ZeroedArray<int> zeros(5);
  zeros[3] = 9;
  Archive out(stream);
  out(pair, pairs, lists, some, none, text, array, zeros);

  Pair pair2;
  std::vector<Pair> pairs2{{9, {9}}};
  std::vector<std::vector<int>> lists2;
  std::optional<double> some2, none2 = 1.0;
  std::string text2;
  std::array<Pair, 2> array2;
  ZeroedArray<int> zeros2;
  Archive in(stream, stream.str().size());
  in(pair2, pairs2, lists2, some2, none2, text2, array2, zeros2);
  EXPECT_EQ(pair2, pair);
  EXPECT_EQ(pairs2, pairs);
  EXPECT_EQ(lists2, lists);
  EXPECT_EQ(some2, some);
  EXPECT_EQ(none2, none);
  EXPECT_EQ(text2, text);
  EXPECT_EQ(array2, array);
  EXPECT_EQ(std::vector<int>(zeros2.begin(), zeros2.end()), (std::vector<int>{0, 0, 0, 9, 0}));
  EXPECT_EQ(in.left(), 0u);
  EXPECT_EQ(in.checksum(), out.checksum());
}

// Whatever the length that it says, no more is allocated than the stream can hold.
TEST(Archive, RefusesWhatCannotBe) {
  for (const std::uint64_t size : {std::uint64_t{3}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    std::stringstream stream;
    Archive out(stream);
    std::uint64_t count = size;
    double one = 1;
    out(count, one, one);
    std::vector<double> values;
    Archive in(stream, stream.str().size());
    EXPECT_THROW(in(values), ArchiveError) << size;
  }
  std::stringstream full;
  full.setstate(std::ios::failbit);
  Archive out(full);
  int value = 1;
  EXPECT_THROW(out(value), ArchiveError);
}

class Resume : public ::testing::TestWithParam<const char*> {
 protected:
  static RenderResult render(const Scene& scene, const RenderRequest& request) {
    return test::renderTiny(GetParam(), scene, request, {{"maxDepth", "5"}});
  }

  static RenderRequest request(long long budget, int threads) {
    RenderRequest r;
    r.budget.mutationsPerPixel = budget;
    r.seed = 5;
    r.threads = threads;
    return r;
  }

  struct Saved {
    std::string state;
    bool over = false;
  };
  // The states on the way, all that are exact, and the last.
  static RenderResult renderAndSave(const Scene& scene, RenderRequest r,
                                    std::vector<Saved>& states) {
    r.watch = [&](RenderInProgress& now) {
      if (!now.isExact() && !now.isOver()) return;
      std::ostringstream stream;
      Archive archive(stream);
      now.save(archive);
      states.push_back({stream.str(), now.isOver()});
    };
    return render(scene, r);
  }
  static RenderResult goOn(const Scene& scene, RenderRequest r, const std::string& state) {
    std::istringstream stream(state);
    Archive archive(stream, state.size());
    r.resume = &archive;
    r.watch = [](RenderInProgress&) {};
    RenderResult result = render(scene, r);
    EXPECT_EQ(archive.left(), 0u);
    return result;
  }
};

// From any moment, in the first direct light, in an epoch and between two, with another number of threads: the image,
// its brightness and the number of samples are those of a render that nobody has interrupted or watched.
TEST_P(Resume, GivesTheSameImage) {
  const Scene scene = test::tinyRing();
  const RenderResult plain = render(scene, request(60, 1));
  std::vector<Saved> states;
  const RenderResult watched = renderAndSave(scene, request(60, 2), states);
  EXPECT_EQ(plain.image.pixels, watched.image.pixels);
  ASSERT_GE(states.size(), 8u);
  // Five of them, evenly spread, the last but one among them.
  for (std::size_t k = 0; k < 5; ++k) {
    const std::size_t index = (states.size() - 2) * k / 4;
    const RenderResult result = goOn(scene, request(60, k % 2 == 0 ? 1 : 2), states[index].state);
    EXPECT_EQ(result.image.pixels, plain.image.pixels) << index << " of " << states.size();
    EXPECT_EQ(result.samples, plain.samples);
    EXPECT_EQ(result.meanLuminance, plain.meanLuminance);
    EXPECT_FALSE(result.interrupted);
  }
}

// A finished render takes more; one that has all that it was to have is not changed.
TEST_P(Resume, TakesALargerBudget) {
  const Scene scene = test::tinyRing();
  std::vector<Saved> states;
  const RenderResult first = renderAndSave(scene, request(20, 2), states);
  ASSERT_TRUE(states.back().over);
  const RenderResult same = goOn(scene, request(20, 1), states.back().state);
  EXPECT_EQ(same.samples, first.samples);
  EXPECT_EQ(same.image.pixels, first.image.pixels);
  const RenderResult more = goOn(scene, request(90, 1), states.back().state);
  const RenderResult whole = render(scene, request(90, 1));
  EXPECT_EQ(more.samples, whole.samples);
  EXPECT_NE(more.image.pixels, first.image.pixels);
  // Both are the same picture.
  EXPECT_NEAR(more.meanLuminance, whole.meanLuminance,
              5 * std::hypot(more.meanLuminanceError, whole.meanLuminanceError));
}

// The clock goes on too.
TEST_P(Resume, TimeIsThatOfBoth) {
  const Scene scene = test::tinyRing();
  RenderRequest r = request(0, 2);
  r.budget.seconds = 0.4;
  std::vector<Saved> states;
  renderAndSave(scene, r, states);
  const double before = wallClock();
  r.budget.seconds = 0.6;
  const RenderResult result = goOn(scene, r, states.back().state);
  EXPECT_GT(result.wallSeconds, 0.5);
  EXPECT_LT(result.wallSeconds - (wallClock() - before), 0.55);
  EXPECT_GT(result.wallSeconds - (wallClock() - before), 0.2);
}

// What was saved for another render is refused where it would not fit.
TEST_P(Resume, RefusesWhatDoesNotFit) {
  const Scene scene = test::tinyRing();
  std::vector<Saved> states;
  renderAndSave(scene, request(20, 1), states);
  const Scene other = test::readTestScene(H2MC_SOURCE_DIR "/scenes/ring/ring.xml", 12, 9);
  const std::string& state = states.back().state;
  EXPECT_THROW(goOn(other, request(20, 1), state), ArchiveError);
  EXPECT_THROW(goOn(scene, request(20, 1), state.substr(0, state.size() / 2)), ArchiveError);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Resume,
                         ::testing::Values("path", "bdpt", "photon", "mmlt", "h2mc", "lmc", "rjmlt",
                                           "mlt", "pssmlt", "remlt", "erpt", "restore"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace h2mc
