// SPDX-License-Identifier: MIT
// Groups that share a film.
#include "render/integrator/splat_list.h"

#include <gtest/gtest.h>

#include "image_check.h"
#include "render/core/random.h"
#include "render/integrator/sampling_integrator.h"

namespace h2mc {
namespace {

FilmSettings settings(int width, int height, Filter::Kind kind, float radius) {
  FilmSettings s;
  s.width = width;
  s.height = height;
  s.filter.kind = kind;
  s.filter.radius = radius;
  return s;
}

const FilmSettings kFilms[] = {
    settings(37, 23, Filter::Kind::kBox, 0.5f), settings(37, 23, Filter::Kind::kMitchell, 2),
    settings(5, 1, Filter::Kind::kGaussian, 2), settings(64, 300, Filter::Kind::kTent, 1)};

// Numbers whose sum depends on their order.
template <class Add>
void forEachSplat(int list, const Add& add) {
  Random random(5, 7, static_cast<std::uint64_t>(list));
  for (int i = 0; i < 400; ++i) {
    const float x = random.uniform(), y = random.uniform();
    add(x, y, Rgbf(std::exp(20 * random.uniform()), random.uniform(), 1));
  }
}

constexpr int kLists = 7, kRounds = 3;

// The sums of a film to which all is added one after the other, to the last bit.
template <class Real>
void addsInOrder(const FilmSettings& s) {
  BasicFilm<Real> plain(s, 2);
  for (int round = 0; round < kRounds; ++round)
    for (int list = 0; list < kLists; ++list)
      forEachSplat(round * kLists + list, [&](float x, float y, const Rgbf& value) {
        plain.splat(x, y, value, {0, s.height}, list % 2);
      });
  for (const int threads : {1, 2, 3, 16}) {
    BasicFilm<Real> film(s, 2);
    std::vector<SplatList> lists(kLists);
    std::vector<FilmPart> parts;
    for (int list = 0; list < kLists; ++list) parts.push_back({&lists[at(list)], list % 2});
    for (int round = 0; round < kRounds; ++round) {
      for (int list = 0; list < kLists; ++list) {
        SplatList& own = lists[at(list)];
        EXPECT_EQ(own.size(), 0u);
        forEachSplat(round * kLists + list,
                     [&](float x, float y, const Rgbf& value) { own.splat(x, y, value); });
        own.sort(film, bandCount(threads, s.height));
      }
      addInOrder<Real>(parts, threads, film);
    }
    EXPECT_EQ(film.develop(1).pixels, plain.develop(1).pixels) << threads;
    for (const int half : {0, 1})
      EXPECT_EQ(film.developHalf(half, 1).pixels, plain.developHalf(half, 1).pixels) << threads;
  }
}

TEST(SplatList, AddsInTheOrderOfTheLists) {
  for (const FilmSettings& s : kFilms) {
    addsInOrder<float>(s);
    addsInOrder<double>(s);
  }
}

TEST(SplatList, BandsAreNotMoreThanRows) {
  EXPECT_EQ(bandCount(2, 3), 3);
  EXPECT_EQ(bandCount(256, 1), 1);
  EXPECT_GE(bandCount(256, 2160), 256);
}

TEST(SplatList, ThereIsWorkFor256Threads) {
  for (const auto& [width, height] :
       {std::pair{512, 384}, {1920, 1080}, {3840, 2160}, {16384, 1}}) {
    const long long pixels = static_cast<long long>(width) * height;
    EXPECT_GE(groupCount(pixels), 256) << width;
  }
}

// The measured rows of both halves, by the numbers of splats of each, make the picture.
TEST(Film, HalvesMakeTheWhole) {
  for (const FilmSettings& s : kFilms) {
    Film film(s, 3);
    for (const int half : {0, 1})
      forEachSplat(half, [&](float x, float y, const Rgbf& value) {
        film.splat(x, y, value, {0, s.height}, half);
      });
    const Image whole = film.develop(1), a = film.developHalf(0, 1), b = film.developHalf(1, 1);
    ASSERT_EQ(a.height, (s.height + 2) / 3);
    for (int row = 0; row < a.height; ++row)
      for (int x = 0; x < s.width; ++x) {
        // Filters with negative lobes leave differences of splats of up to exp(20), each rounded to a float.
        const double one = a.at(x, row).x, other = b.at(x, row).x;
        EXPECT_NEAR(one + other, luminance(whole.at(x, 3 * row)),
                    1e-6 * (std::abs(one) + std::abs(other) + kLuminance[0] * std::exp(20)));
      }
    film.clearHalves();
    for (const Rgbf& pixel : film.developHalf(1, 1).pixels) EXPECT_EQ(pixel, Rgbf(0));
    EXPECT_EQ(film.develop(1).pixels, whole.pixels);
  }
}

// Radiance of the film position itself, once for each sample.
class Position final : public PixelSampler {
 public:
  double sample(const Scene&, Random&, float filmX, float filmY, SplatList& film,
                SampleTally&) override {
    const Rgbf value(filmX, filmY, 1);
    film.splat(filmX, filmY, value);
    return luminance(value);
  }
};

// A first pass that is cut short covers the picture evenly, whatever its seed.
TEST(SampledFilm, AShortPassIsSpreadEvenly) {
  Scene scene;
  scene.film = settings(1600, 1200, Filter::Kind::kBox, 0.5f);
  for (const std::uint64_t seed : {1, 2, 3}) {
    SampledFilm sampled(scene, [] { return std::make_unique<Position>(); });
    ASSERT_GE(sampled.roundsAPass(), 8);
    RenderRequest request;
    request.seed = seed;
    RoundsPlan plan;
    plan.rounds = sampled.roundsAPass() / 4 + 1;
    sampled.add(request, RenderClock(), plan);
    const long long samples = sampled.tally(0).samples;
    EXPECT_NEAR(
        static_cast<double>(samples),
        1600 * 1200 * static_cast<double>(plan.rounds) / static_cast<double>(sampled.roundsAPass()),
        10000);
    const Image image = sampled.film().develop(1 / static_cast<double>(samples));
    constexpr int kBlock = 100;
    for (int y = 0; y < 1200; y += kBlock)
      for (int x = 0; x < 1600; x += kBlock) {
        double red = 0, blue = 0;
        for (int j = 0; j < kBlock; ++j)
          for (int i = 0; i < kBlock; ++i) {
            red += image.at(x + i, y + j).x;
            blue += image.at(x + i, y + j).z;
          }
        EXPECT_NEAR(red / kBlock / kBlock, (x + kBlock / 2) / 1600., 0.03);
        EXPECT_NEAR(blue / kBlock / kBlock, 1, 0.03);
      }
  }
}

// Whoever waits for an interrupted render does not wait for a pass, and the picture is as even as before.
TEST(SampledFilm, StopsWithinAPass) {
  Scene scene;
  scene.film = settings(1600, 1200, Filter::Kind::kBox, 0.5f);
  SampledFilm sampled(scene, [] { return std::make_unique<Position>(); });
  std::atomic<bool> stop{false};
  RenderRequest request;
  request.stop = &stop;
  RoundsPlan plan;
  plan.rounds = 5 * sampled.roundsAPass();
  request.progress = [&](const RenderProgress& p) { stop = stop || p.fraction > 0.27; };
  const RoundsResult result = sampled.add(request, RenderClock(), plan);
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.rounds, 5 * sampled.roundsAPass() * 27 / 100 + 1);
  const Image image = sampled.film().develop(1 / static_cast<double>(sampled.tally(0).samples));
  constexpr int kBlock = 100;
  for (int y = 0; y < 1200; y += kBlock)
    for (int x = 0; x < 1600; x += kBlock) {
      double sum = 0;
      for (int j = 0; j < kBlock; ++j)
        for (int i = 0; i < kBlock; ++i) sum += image.at(x + i, y + j).z;
      EXPECT_NEAR(sum / kBlock / kBlock, 1, 0.03);
    }
}

// All pixels once, in as many rounds as make a pass; a pass after the first is not cut short by the time.
TEST(SampledFilm, PassesAreWhole) {
  Scene scene;
  scene.film = settings(1001, 777, Filter::Kind::kBox, 0.5f);
  SampledFilm sampled(scene, [] { return std::make_unique<Position>(); });
  RenderRequest request;
  RoundsPlan plan;
  plan.rounds = 2 * sampled.roundsAPass();
  sampled.add(request, RenderClock(), plan);
  EXPECT_EQ(sampled.tally(0).samples, 2 * 1001 * 777);
  // Rounding may put a sample into the next pixel, once in some 30,000.
  int others = 0;
  double sum = 0;
  const Image image = sampled.film().develop(1 / (2. * 1001 * 777));
  for (const Rgbf& pixel : image.pixels) {
    others += std::abs(pixel.z - 1) > 1e-5f;
    sum += pixel.z;
  }
  EXPECT_LT(others, 1001 * 777 / 2000);
  EXPECT_NEAR(sum, 1001 * 777, 1);
}

}  // namespace
}  // namespace h2mc
