// SPDX-License-Identifier: MIT
#include "mcmc/populations/image_estimate.h"

#include <cassert>

#include "mcmc/populations/landed.h"
#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// Mutations a pixel that are added up in floats before their sum is added to what there is: rounding is then
// below 1e-4 of a pixel even if all splats are the same, and below 1e-6 if they are not.
constexpr double kStretch = 1024;

}  // namespace

ImageEstimate::ImageEstimate(const FilmSettings& settings, int threads, PixelStatistics statistics)
    : settings_(settings),
      threads_(threads),
      statesFilm_(settings, measuredRows(settings)),
      samplesFilm_(settings, measuredRows(settings)),
      states_(at(settings.width) * at(settings.height)),
      samples_(states_.size()) {
  if (statistics.variance) apart_.emplace(settings, states_.size());
  if (statistics.counts) landed_.emplace(unfiltered(settings));
}

double ImageEstimate::pixels() const {
  return static_cast<double>(settings_.width) * settings_.height;
}

void ImageEstimate::sort(ChainFilms& films) const {
  const int bands = bandCount(threads_, settings_.height);
  films.states.splats.sort(statesFilm_, bands);
  films.samples.splats.sort(samplesFilm_, bands);
  if (landed_) films.states.landed.sort(*landed_, bands);
}

void ImageEstimate::add(std::span<const Part> parts) {
  std::vector<FilmPart> states, samples, ofFirst[2], landed;
  for (const Part& part : parts) {
    states.push_back({&part.films->states.splats, part.half});
    samples.push_back({&part.films->samples.splats, part.half});
    landed.push_back({&part.films->states.landed, 0});
    if (part.half == 0) {
      ofFirst[0].push_back(states.back());
      ofFirst[1].push_back(samples.back());
    }
    std::vector<Sums*> all{&stretch_, &epoch_[at(part.half)]};
    if (apart_) all.push_back(&apart_->stretch[at(part.half)]);
    for (Sums* sums : all) {
      sums->mutations += static_cast<double>(part.mutations);
      sums->samples += static_cast<double>(part.samples);
      sums->overTarget += part.films->states.overTarget;
    }
  }
  if (apart_) {
    addKeeping<float>(ofFirst[0], threads_, apart_->statesFilm);
    addKeeping<float>(ofFirst[1], threads_, apart_->samplesFilm);
  }
  if (landed_) addInOrder<double>(landed, threads_, *landed_);
  addInOrder<float>(states, threads_, statesFilm_);
  addInOrder<float>(samples, threads_, samplesFilm_);
  for (const Part& part : parts) part.films->clear();
  if (stretch_.mutations >= kStretch * pixels()) {
    endStretch();
    for (ShortFilm* film : films()) film->clear();
  }
}

std::vector<ShortFilm*> ImageEstimate::films() {
  std::vector<ShortFilm*> all{&statesFilm_, &samplesFilm_};
  if (apart_) all.insert(all.end(), {&apart_->statesFilm, &apart_->samplesFilm});
  return all;
}

void ImageEstimate::begin() {
  for (ShortFilm* film : films()) film->reserve();
}

void ImageEstimate::end() {
  endStretch();
  epoch_ = {};
  for (ShortFilm* film : films()) {
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
        if (!apart_) continue;
        const Difference more = differenceAt(x, y);
        if (more.states != Rgbf(0)) apart_->states[i] += more.states;
        if (more.samples != Rgbf(0)) apart_->samples[i] += more.samples;
      }
    });
    mutations_ += stretch_.mutations;
  }
  if (apart_) {
    for (std::size_t half = 0; half < 2; ++half)
      apart_->mutations[half] += apart_->stretch[half].mutations;
    apart_->stretch = {};
  }
  stretch_ = {};
}

// With a sum t of all on a film and h of half 0, what the halves' own pictures differ by is h / n_0 - (t - h) / n_1,
// the n being what either is to be divided by.
ImageEstimate::Difference ImageEstimate::differenceAt(int x, int y) const {
  const auto& [first, second] = apart_->stretch;
  const auto over = [&](double n) { return n > 0 ? stretch_.mutations / n : 0; };
  const auto difference = [&](const ShortFilm& half, const ShortFilm& both, double n0, double n1) {
    return half.pixel(x, y, over(n0) + over(n1)) - both.pixel(x, y, over(n1));
  };
  return {difference(apart_->statesFilm, statesFilm_, first.overTarget, second.overTarget),
          difference(apart_->samplesFilm, samplesFilm_, first.samples, second.samples)};
}

void ImageEstimate::Apart::archive(Archive& archive) {
  const std::size_t pixels = states.size();
  archive(statesFilm, samplesFilm, stretch, states, samples, mutations);
  if (states.size() != pixels || samples.size() != pixels)
    throw ArchiveError("it has another number of pixels");
}

void ImageEstimate::archive(Archive& archive) {
  archive(statesFilm_, samplesFilm_, stretch_, epoch_, states_, samples_, mutations_);
  if (apart_) archive(*apart_);
  if (landed_) archive(*landed_);
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

// Each half's picture is an estimate of its own, and the picture their mean with the weights w and 1 - w of their
// mutations. Where a mutation has variance v, the difference has v / n (1 / w + 1 / (1 - w)), the mean v / n. The mean
// luminance, which they share, makes the states' part of both as uncertain as it is.
Image ImageEstimate::variance(double luminance, double luminanceError) const {
  assert(apart_);
  Image result = image(luminance);
  const bool more = stretch_.mutations > 0;
  const double mutations = mutations_ + (more ? stretch_.mutations : 0);
  if (!(mutations > 0)) return result;
  const double first = apart_->mutations[0] + apart_->stretch[0].mutations;
  const double second = apart_->mutations[1] + apart_->stretch[1].mutations;
  const auto weights = static_cast<float>(first * second / squared(first + second));
  const double ofStates = stretch_.ofStates();
  const auto l = static_cast<float>(luminance), scale = static_cast<float>(1 / mutations);
  const auto error = static_cast<float>(luminanceError / mutations);
  forEachRow([&](int y, std::size_t i) {
    for (int x = 0; x < settings_.width; ++x, ++i) {
      Rgbf& pixel = result.pixels[i];
      if (!(weights > 0)) {
        pixel = squared(pixel);
        continue;
      }
      Rgbf states = states_[i];
      Difference difference{apart_->states[i], apart_->samples[i]};
      if (more) {
        const Difference now = differenceAt(x, y);
        states += statesFilm_.pixel(x, y, ofStates);
        difference.states += now.states;
        difference.samples += now.samples;
      }
      pixel = weights * squared((difference.states * l + difference.samples) * scale) +
              squared(states * error);
    }
  });
  return result;
}

std::vector<float> ImageEstimate::counts() const {
  assert(landed_);
  return landedCounts(*landed_, threads_);
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
