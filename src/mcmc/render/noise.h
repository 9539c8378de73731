// SPDX-License-Identifier: MIT
// How noisy a picture is, from two independent estimates of it.
#pragma once

#include <vector>

#include "render/camera/film_settings.h"
#include "render/image/image.h"

namespace h2mc {

// Noise is a mean over pixels: of large pictures, a quarter of a million of them tell it well enough. Every
// so many-th row is looked at.
int measuredRows(const FilmSettings& film);

// Two images of the same size with the same expectation, made of so many samples (or mutations) a
// pixel each; 0 and an empty image where there is none.
struct TwoEstimates {
  Image a, b;
  double samplesA = 0, samplesB = 0;

  // Their mean, each with its number of samples.
  Image mean() const;
};

// What makes a squared error of each pixel a relative one: 1 / (luminance + a tenth of the mean)^2,
// relMSE's floor, where the luminance is that of the sum of two images of the same size: of `sharp` as
// it is, of `noisy` averaged over cells of so many pixels.
std::vector<double> relativeWeights(const Image& sharp, const Image& noisy, int cellWidth,
                                    int cellHeight);

// Variance of an estimate by one sample a pixel: weighted mean over the pixels' luminances of
// (a - b)^2 / (1 / samplesA + 1 / samplesB), which has that expectation where samples are independent.
// 0 without two estimates.
double varianceOfOneSample(const TwoEstimates& estimates, const std::vector<double>& weights);

// The number of samples for each mutation that makes perSample / samples + perMutation / mutations
// least at a given cost of both, costs in the same unit; samples get no more than nine tenths of it.
double samplesAMutation(double perSample, double sampleCost, double perMutation,
                        double mutationCost);

}  // namespace h2mc
