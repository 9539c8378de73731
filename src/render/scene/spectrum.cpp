// SPDX-License-Identifier: MIT
#include "render/scene/spectrum.h"

#include <algorithm>
#include <cmath>

namespace h2mc {
namespace {

constexpr double kFirst = 360, kLast = 830, kStep = 0.5;

double lobe(double x, double peak, double widthBelow, double widthAbove) {
  const double t = (x - peak) / (x < peak ? widthBelow : widthAbove);
  return std::exp(-0.5 * t * t);
}

// The 2-degree observer [Wyman, Sloan, Shirley 2013, "Simple Analytic Approximations to the CIE XYZ
// Color Matching Functions", eq. 4].
glm::dvec3 observer(double w) {
  return {1.056 * lobe(w, 599.8, 37.9, 31.0) + 0.362 * lobe(w, 442.0, 16.0, 26.7) -
              0.065 * lobe(w, 501.1, 20.4, 26.2),
          0.821 * lobe(w, 568.8, 46.9, 40.5) + 0.286 * lobe(w, 530.9, 16.3, 31.1),
          1.217 * lobe(w, 437.0, 11.8, 36.0) + 0.681 * lobe(w, 459.0, 26.0, 13.8)};
}

template <class Function>
Rgbf integrate(const Function& spectrum) {
  glm::dvec3 xyz(0);
  double normalisation = 0;
  for (double w = kFirst + kStep / 2; w < kLast; w += kStep) {
    const glm::dvec3 weight = observer(w);
    xyz += weight * spectrum(w);
    normalisation += weight.y;
  }
  xyz /= normalisation;
  const double r = 3.240479 * xyz.x - 1.537150 * xyz.y - 0.498535 * xyz.z;
  const double g = -0.969256 * xyz.x + 1.875991 * xyz.y + 0.041556 * xyz.z;
  const double b = 0.055648 * xyz.x - 0.204043 * xyz.y + 1.057311 * xyz.z;
  return Rgbf(glm::dvec3(r, g, b));
}

}  // namespace

Rgbf spectrumToRgb(const std::vector<SpectrumSample>& samples) {
  return integrate([&](double w) {
    const auto after = std::upper_bound(
        samples.begin(), samples.end(), w,
        [](double x, const SpectrumSample& sample) { return x < sample.wavelength; });
    if (after == samples.begin() || after == samples.end()) return 0.0;
    const SpectrumSample& a = *(after - 1);
    const double t = (w - a.wavelength) / (after->wavelength - a.wavelength);
    return a.value + t * (after->value - a.value);
  });
}

Rgbf blackbodyToRgb(double temperature) {
  constexpr double c = 299792458, h = 6.62607015e-34, k = 1.380649e-23;
  return integrate([&](double nanometres) {
    const double w = nanometres * 1e-9;
    return 2 * h * c * c / (std::pow(w, 5) * std::expm1(h * c / (w * k * temperature))) * 1e-9;
  });
}

Rgbf intoGamut(const Rgbf& color, Rgbf* saturated) {
  const float least = std::min({color.x, color.y, color.z}),
              most = std::max({color.x, color.y, color.z});
  if (saturated && least < -1e-3f * most) *saturated = color;
  return glm::max(color, Rgbf(0));
}

}  // namespace h2mc
