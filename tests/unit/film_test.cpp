// SPDX-License-Identifier: MIT
// The film: filters, their normalisation, accumulation.
#include "render/image/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace h2mc {
namespace {

FilmSettings settings(int width, int height, Filter filter) {
  FilmSettings s;
  s.width = width;
  s.height = height;
  s.filter = filter;
  return s;
}

Filter filter(Filter::Kind kind, float radius) {
  Filter f;
  f.kind = kind;
  f.radius = radius;
  f.stddev = radius / 4;
  return f;
}

std::vector<Filter> allFilters() {
  using Kind = Filter::Kind;
  return {filter(Kind::kBox, 0.5f),   filter(Kind::kBox, 1.3f),     filter(Kind::kTent, 1),
          filter(Kind::kTent, 2.7f),  filter(Kind::kGaussian, 2),   filter(Kind::kGaussian, 0.8f),
          filter(Kind::kMitchell, 2), filter(Kind::kMitchell, 3.5f)};
}

// Splats `radiance(x, y)` at the centres of a fine grid, and develops.
template <class F>
Image render(const FilmSettings& s, int perPixel, F radiance) {
  Film film(s);
  const int nx = s.width * perPixel, ny = s.height * perPixel;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const float x = (i + 0.5f) / nx, y = (j + 0.5f) / ny;
      film.splat(x, y, radiance(x, y));
    }
  return film.develop(1.0 / (static_cast<double>(nx) * ny));
}

TEST(Filter, ClosedForms) {
  const Filter box;
  EXPECT_EQ(box.evaluate(0.49f), box.evaluate(0));
  EXPECT_EQ(box.evaluate(0.51f), 0);

  const Filter tent = filter(Filter::Kind::kTent, 2);
  EXPECT_NEAR(tent.evaluate(-0.5f) / tent.evaluate(0), 0.75f, 1e-6);

  Filter gaussian = filter(Filter::Kind::kGaussian, 2);
  EXPECT_NEAR(gaussian.evaluate(0.5f) / gaussian.evaluate(0), std::exp(-0.5f), 2e-4);
  EXPECT_EQ(gaussian.evaluate(2), 0);
  EXPECT_GE(gaussian.evaluate(1.9f), 0);

  // B = C = 1/3: (16 - 2) / 18 at 0 and 1/18 at 1, and negative beyond.
  const Filter mitchell = filter(Filter::Kind::kMitchell, 2);
  EXPECT_NEAR(mitchell.evaluate(0), 16 / 18.f, 1e-6);
  EXPECT_NEAR(mitchell.evaluate(1), 1 / 18.f, 1e-6);
  EXPECT_NEAR(mitchell.evaluate(0.999999f), mitchell.evaluate(1.000001f), 1e-5);
  EXPECT_LT(mitchell.evaluate(1.5f), 0);
  EXPECT_NEAR(mitchell.evaluate(2), 0, 1e-6);
}

TEST(Film, AConstantStaysConstantToTheEdges) {
  for (const Filter& f : allFilters()) {
    const Image image =
        render(settings(9, 6, f), 64, [](float, float) { return Rgbf(2, 1, 0.5f); });
    for (const Rgbf& p : image.pixels) {
      EXPECT_NEAR(p.x, 2, 0.05) << "filter " << static_cast<int>(f.kind) << " radius " << f.radius;
      EXPECT_NEAR(p.y, 1, 0.025);
      EXPECT_NEAR(p.z, 0.5, 0.0125);
    }
  }
}

TEST(Film, ALinearRampStaysLinearInside) {
  for (const Filter& f : allFilters()) {
    const int width = 16;
    const Image image =
        render(settings(width, 12, f), 40, [](float x, float y) { return Rgbf(1 + x, 1 + y, 1); });
    for (int y = 4; y < 8; ++y)
      for (int x = 4; x < width - 4; ++x) {
        EXPECT_NEAR(image.at(x, y).x, 1 + (x + 0.5f) / width, 0.03)
            << "filter " << static_cast<int>(f.kind) << " radius " << f.radius;
        EXPECT_NEAR(image.at(x, y).y, 1 + (y + 0.5f) / 12, 0.03);
      }
  }
}

// Pixel value against the filter's integrals, computed here with Filter::evaluate.
TEST(Film, MatchesTheDefinitionPerPixel) {
  const auto radiance = [](double x, double y) { return 1 + std::sin(7 * x) * std::cos(5 * y); };
  for (const Filter& f : allFilters()) {
    const int width = 8, height = 5, n = 40;
    const Image image = render(settings(width, height, f), n, [&](float x, float y) {
      return Rgbf(static_cast<float>(radiance(x, y)));
    });
    for (int py = 0; py < height; ++py)
      for (int px = 0; px < width; ++px) {
        double sum = 0, weight = 0;
        for (int j = 0; j < height * n; ++j)
          for (int i = 0; i < width * n; ++i) {
            const double x = (i + 0.5) / n, y = (j + 0.5) / n;
            const double w = f.evaluate(static_cast<float>(x - px - 0.5)) *
                             f.evaluate(static_cast<float>(y - py - 0.5));
            sum += w * radiance(x / width, y / height);
            weight += w;
          }
        EXPECT_NEAR(image.at(px, py).x, sum / weight, 0.02 * sum / weight + 1e-3)
            << "filter " << static_cast<int>(f.kind) << " radius " << f.radius;
      }
  }
}

TEST(Film, TheBoxIsOnePixel) {
  Film film(settings(4, 2, Filter()));
  film.splat(0, 0, Rgbf(1));
  film.splat(0.999999f, 0.999999f, Rgbf(2));
  film.splat(std::nextafter(1.f, 0.f), std::nextafter(1.f, 0.f), Rgbf(4));
  film.splat(0.5f, 0.25f, Rgbf(8));
  const Image image = film.develop(1.0 / 8);  // 1 / pixels: the sums themselves
  EXPECT_EQ(image.at(0, 0).x, 1);
  EXPECT_EQ(image.at(3, 1).x, 6);
  EXPECT_EQ(image.at(2, 0).x, 8);
  EXPECT_EQ(image.at(1, 0).x, 0);
}

// The fast path and the general one agree: a box hardly wider than a pixel.
TEST(Film, TheFastPathIsTheGeneralOne) {
  const auto radiance = [](float x, float y) { return Rgbf(x * y, x, y); };
  const Image fast = render(settings(6, 5, filter(Filter::Kind::kBox, 0.5f)), 16, radiance);
  const Image general = render(settings(6, 5, filter(Filter::Kind::kBox, 0.502f)), 16, radiance);
  for (std::size_t i = 0; i < fast.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(fast.pixels[i][c], general.pixels[i][c], 0.01);
}

TEST(Film, OfOnePixel) {
  for (const Filter& f : allFilters()) {
    const Image image = render(settings(1, 1, f), 200, [](float, float) { return Rgbf(3); });
    EXPECT_NEAR(image.at(0, 0).x, 3, 0.02) << static_cast<int>(f.kind);
  }
}

TEST(Film, Clears) {
  Film film(settings(3, 3, filter(Filter::Kind::kGaussian, 2)));
  film.splat(0.3f, 0.7f, Rgbf(1, 2, 3));
  EXPECT_GT(film.develop(1).pixels[6].y, 0);
  film.clear();
  for (const Rgbf& p : film.develop(1).pixels) EXPECT_EQ(p, Rgbf(0));
}

TEST(Film, ManySamplesStayAccurate) {
  Film film(settings(1, 1, Filter()));
  const int n = 50'000'000;  // a float would stop at 16,777,216
  for (int i = 0; i < n; ++i) film.splat(0.5f, 0.5f, Rgbf(1, 0.1f, 0));
  const Image image = film.develop(1.0 / n);
  EXPECT_FLOAT_EQ(image.at(0, 0).x, 1);
  EXPECT_FLOAT_EQ(image.at(0, 0).y, 0.1f);
}

}  // namespace
}  // namespace h2mc
