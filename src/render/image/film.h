// The film: where samples become pixels.
#pragma once

#include <vector>

#include "render/camera/film_settings.h"
#include "render/image/image.h"

namespace h2mc {

// Accumulates samples, spread over pixels by the film's filter. Not synchronised: one a thread, or
// a task, merged in an order that does not depend on timing.
//
// Accumulators are doubles: 1e9 samples on one pixel stay accurate to 1e-7.
class Film {
 public:
  explicit Film(const FilmSettings& settings);

  // Adds a sample at (filmX, filmY) in [0, 1)^2, (0, 0) being the upper left corner.
  // Precondition: every channel is finite.
  void splat(float filmX, float filmY, const Rgbf& value);

  // Adds what the other film holds. Precondition: the same settings.
  void merge(const Film& other);

  void clear();

  // The picture. Pixel j is the mean of radiance L over the film, weighted by the filter h:
  //
  //     integral of h(x - xj) L(x) dx / integral of h(x - xj) dx,
  //
  // both over the part of h that lies on the film, provided that `scale` times the sum of the
  // splatted values, each weighted by any function w(x), has the mean "integral of w L over the
  // unit square". So n samples of L, uniform on the film, are developed with 1 / n, whether they are
  // independent or n / (width * height) in each pixel; and so are n mutations of a Markov chain that
  // splat L / (target's density), or L / luminance(L) * (mean luminance of the film).
  Image develop(double scale) const;

  const FilmSettings& settings() const { return settings_; }
  int width() const { return settings_.width; }
  int height() const { return settings_.height; }

 private:
  struct Accumulator {
    double r = 0, g = 0, b = 0;
  };
  struct Weights;  // of one dimension's pixels

  Weights weights(double position, int size) const;
  double filterIntegral(double from, double to) const;
  std::vector<double> normalisation(int size) const;

  FilmSettings settings_;
  bool onePixel_ = false;  // a box of a pixel's size: nothing to spread
  // The filter from 0 to its radius at equal steps, read by linear interpolation, and its integral
  // from 0; empty for boxes.
  std::vector<float> table_;
  std::vector<double> integral_;
  std::vector<double> normalX_, normalY_;  // integral of h over the film for each column, row
  std::vector<Accumulator> pixels_;
};

}  // namespace h2mc
