// SPDX-License-Identifier: MIT
// Spectra as linear Rec. 709 RGB.
#pragma once

#include <vector>

#include "render/core/types.h"

namespace h2mc {

struct SpectrumSample {
  double wavelength;  // nm
  double value;
};

// Integrates the piecewise linear spectrum (zero outside) against the CIE 1931 observer, Y of a
// constant 1 being 1. A colour that is more saturated than Rec. 709 has negative components.
// Precondition: wavelengths increase.
Rgbf spectrumToRgb(const std::vector<SpectrumSample>& samples);

// Radiance of a black body, W / (m^2 sr nm), converted in the same way. temperature > 0, in kelvin.
Rgbf blackbodyToRgb(double temperature);

// The colour with 0 for negative components. Where that changes it visibly (by over a thousandth of the largest
// component) and `saturated` is not null, *saturated becomes the colour as it was.
Rgbf intoGamut(const Rgbf& color, Rgbf* saturated = nullptr);

}  // namespace h2mc
