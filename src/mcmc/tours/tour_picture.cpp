// SPDX-License-Identifier: MIT
#include "mcmc/tours/tour_picture.h"

#include "mcmc/populations/landed.h"
#include "render/core/archive.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {

TourPicture::TourPicture(const FilmSettings& settings, int threads, double weight,
                         PixelStatistics statistics)
    : threads_(threads), weight_(weight), film_(settings, measuredRows(settings)) {
  if (statistics.variance) first_.emplace(settings);
  if (statistics.counts) landed_.emplace(unfiltered(settings));
}

void TourPicture::sort(ChainFilms& films) const {
  const int bands = bandCount(threads_, film_.height());
  films.states.splats.sort(film_, bands);
  if (landed_) films.states.landed.sort(*landed_, bands);
}

void TourPicture::add(std::span<const Part> parts) {
  std::vector<FilmPart> splats, ofFirst, landed;
  for (const Part& part : parts) {
    splats.push_back({&part.films->states.splats, part.half});
    landed.push_back({&part.films->states.landed, 0});
    if (part.half == 0) ofFirst.push_back(splats.back());
    samples_[at(part.half)] += static_cast<double>(part.samples);
  }
  if (first_) addKeeping<double>(ofFirst, threads_, *first_);
  if (landed_) addInOrder<double>(landed, threads_, *landed_);
  addInOrder<double>(splats, threads_, film_);
  for (const Part& part : parts) part.films->clear();
}

void TourPicture::archive(Archive& archive) {
  archive(film_, samples_);
  if (first_) archive(*first_);
  if (landed_) archive(*landed_);
}

Image TourPicture::image() const { return film_.develop(scale(samples()), threads_); }

TwoEstimates TourPicture::halves(double mutationsASample) const {
  TwoEstimates result;
  const double pixels = static_cast<double>(film_.width()) * film_.height();
  const auto half = [&](int h, Image& image, double& mutationsAPixel) {
    const double count = samples_[at(h)];
    if (!(count > 0)) return;
    image = film_.developHalf(h, scale(count));
    mutationsAPixel = count * mutationsASample / pixels;
  };
  half(0, result.a, result.samplesA);
  half(1, result.b, result.samplesB);
  return result;
}

// The picture is (n_0 a + n_1 b) / n. Where one sample has variance v, a - b has v / n_0 + v / n_1, the picture v / n.
Image TourPicture::variance() const {
  Image result = image();
  const double n0 = samples_[0], n1 = samples_[1];
  const bool both = n0 > 0 && n1 > 0;
  const auto share = static_cast<float>(both ? n0 * n1 / squared(n0 + n1) : 1);
  parallelFor(threads_, result.height, [&](int y) {
    for (int x = 0; x < result.width; ++x) {
      Rgbf& pixel = result.at(x, y);
      if (both) pixel = first_->pixel(x, y, scale(n0) + scale(n1)) - film_.pixel(x, y, scale(n1));
      pixel = share * squared(pixel);
    }
  });
  return result;
}

std::vector<float> TourPicture::counts() const { return landedCounts(*landed_, threads_); }

}  // namespace h2mc
