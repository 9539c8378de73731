// SPDX-License-Identifier: MIT
#include "mcmc/populations/image_estimate.h"

#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// Mutations a pixel that are added up in floats before their sum is added to what there is: rounding is then
// below 1e-4 of a pixel even if all splats are the same, and below 1e-6 if they are not.
constexpr double kStretch = 1024;

}  // namespace

ImageEstimate::ImageEstimate(const FilmSettings& settings, int threads)
    : settings_(settings),
      threads_(threads),
      statesFilm_(settings, measuredRows(settings)),
      samplesFilm_(settings, measuredRows(settings)),
      states_(at(settings.width) * at(settings.height)),
      samples_(states_.size()) {}

double ImageEstimate::pixels() const {
  return static_cast<double>(settings_.width) * settings_.height;
}

void ImageEstimate::sort(ChainFilms& films) const {
  const int bands = bandCount(threads_, settings_.height);
  films.states.splats.sort(statesFilm_, bands);
  films.samples.splats.sort(samplesFilm_, bands);
}

void ImageEstimate::add(std::span<const Part> parts) {
  std::vector<FilmPart> states, samples;
  for (const Part& part : parts) {
    states.push_back({&part.films->states.splats, part.half});
    samples.push_back({&part.films->samples.splats, part.half});
    for (Sums* sums : {&stretch_, &epoch_[at(part.half)]}) {
      sums->mutations += static_cast<double>(part.mutations);
      sums->samples += static_cast<double>(part.samples);
      sums->overTarget += part.films->states.overTarget;
    }
  }
  addInOrder<float>(states, threads_, statesFilm_);
  addInOrder<float>(samples, threads_, samplesFilm_);
  for (const Part& part : parts) part.films->clear();
  if (stretch_.mutations >= kStretch * pixels()) {
    endStretch();
    statesFilm_.clear();
    samplesFilm_.clear();
  }
}

void ImageEstimate::begin() {
  statesFilm_.reserve();
  samplesFilm_.reserve();
}

void ImageEstimate::end() {
  endStretch();
  epoch_ = {};
  for (ShortFilm* film : {&statesFilm_, &samplesFilm_}) {
    film->release();
    film->clearHalves();
  }
}

void ImageEstimate::forEachRow(const std::function<void(int, std::size_t)>& work) const {
  parallelFor(threads_, settings_.height, [&](int y) { work(y, at(y) * at(settings_.width)); });
}

void ImageEstimate::endStretch() {
  if (stretch_.mutations > 0) {
    const double ofStates = stretch_.ofStates(), ofSamples = stretch_.ofSamples();
    forEachRow([&](int y, std::size_t i) {
      for (int x = 0; x < settings_.width; ++x, ++i) {
        // Pages that stay zero are not written to.
        const Rgbf states = statesFilm_.pixel(x, y, ofStates);
        const Rgbf samples = samplesFilm_.pixel(x, y, ofSamples);
        if (states != Rgbf(0)) states_[i] += states;
        if (samples != Rgbf(0)) samples_[i] += samples;
      }
    });
    mutations_ += stretch_.mutations;
  }
  stretch_ = {};
}

void ImageEstimate::archive(Archive& archive) {
  archive(statesFilm_, samplesFilm_, stretch_, epoch_, states_, samples_, mutations_);
}

Image ImageEstimate::image(double luminance) const {
  Image image(settings_.width, settings_.height);
  const bool more = stretch_.mutations > 0;
  const double mutations = mutations_ + stretch_.mutations;
  if (!(mutations > 0)) return image;
  const double ofStates = stretch_.ofStates(), ofSamples = stretch_.ofSamples();
  const auto l = static_cast<float>(luminance), scale = static_cast<float>(1 / mutations);
  forEachRow([&](int y, std::size_t i) {
    for (int x = 0; x < settings_.width; ++x, ++i) {
      Rgbf states = states_[i], samples = samples_[i];
      if (more) {
        states += statesFilm_.pixel(x, y, ofStates);
        samples += samplesFilm_.pixel(x, y, ofSamples);
      }
      image.pixels[i] = (states * l + samples) * scale;
    }
  });
  return image;
}

TwoEstimates ImageEstimate::stateHalves(double luminance) const {
  TwoEstimates result;
  const auto half = [&](int h, Image& image, double& mutationsAPixel) {
    const Sums& sums = epoch_[at(h)];
    if (!(sums.overTarget > 0)) return;
    image = statesFilm_.developHalf(h, luminance * sums.ofStates() / sums.mutations);
    mutationsAPixel = sums.mutations / pixels();
  };
  half(0, result.a, result.samplesA);
  half(1, result.b, result.samplesB);
  return result;
}

TwoEstimates ImageEstimate::sampleHalves() const {
  TwoEstimates result;
  const auto half = [&](int h, Image& image, double& samplesAPixel) {
    const Sums& sums = epoch_[at(h)];
    if (!(sums.samples > 0)) return;
    image = samplesFilm_.developHalf(h, 1 / sums.samples);
    samplesAPixel = sums.samples / pixels();
  };
  half(0, result.a, result.samplesA);
  half(1, result.b, result.samplesB);
  return result;
}

TwoEstimates ImageEstimate::halves(double luminance) const {
  TwoEstimates result = stateHalves(luminance);
  const TwoEstimates samples = sampleHalves();
  const auto add = [](Image& image, const Image& more) {
    if (image.pixels.empty()) return;
    for (std::size_t i = 0; i < more.pixels.size(); ++i) image.pixels[i] += more.pixels[i];
  };
  add(result.a, samples.a);
  add(result.b, samples.b);
  return result;
}

}  // namespace h2mc
