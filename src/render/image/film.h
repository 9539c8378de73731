// SPDX-License-Identifier: MIT
// The film: where samples become pixels.
#pragma once

#include <array>
#include <vector>

#include "render/camera/film_settings.h"
#include "render/core/index.h"
#include "render/core/zeroed_array.h"
#include "render/image/image.h"

namespace h2mc {

class Archive;

// Rows begin .. end - 1 of a film.
struct RowRange {
  int begin = 0, end = 0;
};

// Accumulates samples, spread over pixels by the film's filter. Not synchronised: threads may add to
// different rows at the same time, and to nothing else.
//
// `Real` is what a channel is added up in. A double takes 24 bytes a pixel and stays accurate to 1e-7 for
// 1e9 samples on one pixel. A float takes 12, and n equal samples are off by n * 3e-8 of the sum at worst:
// for films that are emptied before n is large.
template <class Real>
class BasicFilm {
 public:
  // Precondition: the filter's radius lies between Filter::kNarrowest and Filter::kWidest.
  explicit BasicFilm(const FilmSettings& settings);
  // A film that also keeps apart what either of two halves adds to every `step`-th row, as luminance in
  // double.
  BasicFilm(const FilmSettings& settings, int step);

  // Adds a sample at (filmX, filmY) in [0, 1)^2, (0, 0) being the upper left corner.
  // Precondition: every channel is finite.
  void splat(float filmX, float filmY, const Rgbf& value) {
    splat(filmX, filmY, value, {0, height()}, 0);
  }
  // Adds what of it falls on these rows, for half 0 or 1.
  void splat(float filmX, float filmY, const Rgbf& value, RowRange rows, int half);
  // The rows that a sample at filmY reaches; at least one.
  RowRange rowsOf(float filmY) const;

  void clear();
  void clearHalves();
  // Clears the picture, not the halves, and gives its memory back until reserve(), which has to come before
  // anything else.
  void release();
  void reserve();

  // The picture. Pixel j is the mean of radiance L over the film, weighted by the filter h:
  //
  //     integral of h(x - xj) L(x) dx / integral of h(x - xj) dx,
  //
  // both over the part of h that lies on the film, provided that `scale` times the sum of the
  // splatted values, each weighted by any function w(x), has the mean "integral of w L over the
  // unit square". So n samples of L, uniform on the film, are developed with 1 / n, whether they are
  // independent or n / (width * height) in each pixel; and so are n mutations of a Markov chain that
  // splat L / (target's density), or L / luminance(L) * (mean luminance of the film).
  Image develop(double scale, int threads = 1) const;
  // One pixel of it.
  Rgbf pixel(int x, int y, double scale) const;
  // The rows 0, step, 2 * step, .. of the picture that a half makes by itself, grey.
  Image developHalf(int half, double scale) const;

  // What was added. Throws ArchiveError where it was to a film of another size.
  void archive(Archive& archive);

  const FilmSettings& settings() const { return settings_; }
  int width() const { return settings_.width; }
  int height() const { return settings_.height; }

 private:
  using Accumulator = std::array<Real, 3>;
  struct Weights;  // of one dimension's pixels

  Weights weights(double position, RowRange range) const;
  // Pixels of a row or column whose centre is no further away than the filter's radius.
  RowRange reach(double position, int size) const;
  void addToHalf(int half, int x, int y, double luminance) {
    halves_[half][at(y / step_) * at(settings_.width) + at(x)] += luminance;
  }
  std::size_t pixelCount() const { return at(settings_.width) * at(settings_.height); }
  double factor(int x, int y, double scale) const;
  double filterIntegral(double from, double to) const;
  std::vector<double> normalisation(int size) const;

  FilmSettings settings_;
  bool onePixel_ = false;  // a box of a pixel's size: nothing to spread
  // The filter from 0 to its radius at equal steps, read by linear interpolation, and its integral
  // from 0; empty for boxes.
  std::vector<float> table_;
  std::vector<double> integral_;
  std::vector<double> normalX_, normalY_;  // integral of h over the film for each column, row
  ZeroedArray<Accumulator> pixels_;
  int step_ = 0;  // 0: no halves
  std::vector<double> halves_[2];
};

using Film = BasicFilm<double>;
using ShortFilm = BasicFilm<float>;

extern template class BasicFilm<double>;
extern template class BasicFilm<float>;

}  // namespace h2mc
