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
// constant 1 being 1; negative components become 0. Precondition: wavelengths increase.
Rgbf spectrumToRgb(const std::vector<SpectrumSample>& samples);

// Radiance of a black body, W / (m^2 sr nm), converted in the same way. temperature > 0, in kelvin.
Rgbf blackbodyToRgb(double temperature);

}  // namespace h2mc
