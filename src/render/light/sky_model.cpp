// SPDX-License-Identifier: MIT
#include "render/light/sky_model.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "render/core/index.h"
#include "render/light/sky_coefficients.h"
#include "render/scene/spectrum.h"

namespace h2mc {
namespace {

// The model's RGB has the sums of the CIE's matching functions in it: divided by that of y, white is 1.
constexpr double kObserver = 106.856980;

// Of six control points over the sun's elevation: a Bezier curve of degree 5 in its cube root [Hosek and Wilkie 2012,
// section 5.3]. Point i is at points[i * stride].
double overElevation(double x, const float* points, std::size_t stride) {
  constexpr std::array<double, 6> kBinomial = {1, 5, 10, 10, 5, 1};
  double sum = 0;
  for (std::size_t i = 0; i < kBinomial.size(); ++i)
    sum += kBinomial[i] * std::pow(x, static_cast<double>(i)) *
           std::pow(1 - x, 5 - static_cast<double>(i)) * static_cast<double>(points[i * stride]);
  return sum;
}

// A spectrum from 0 outside, with straight lines between.
struct Table {
  std::span<const SpectrumSample> samples;

  double at(double wavelength) const {
    const auto after = std::upper_bound(
        samples.begin(), samples.end(), wavelength,
        [](double w, const SpectrumSample& sample) { return w < sample.wavelength; });
    if (after == samples.begin()) return 0;
    const SpectrumSample& a = *(after - 1);
    if (after == samples.end()) return wavelength == a.wavelength ? a.value : 0;
    const double t = (wavelength - a.wavelength) / (after->wavelength - a.wavelength);
    return a.value + t * (after->value - a.value);
  }
};

// Preetham et al. 1999, table 2: nm, and the sun's radiance above the air in W / (m^2 sr nm), absorption by ozone in
// 1 / cm, by the mixed gases and by water vapour in 1 / m.
constexpr SpectrumSample kSun[] = {
    {380, 16559.0}, {390, 16233.7}, {400, 21127.5}, {410, 25888.2}, {420, 25829.1}, {430, 24232.3},
    {440, 26760.5}, {450, 29658.3}, {460, 30545.4}, {470, 30057.5}, {480, 30663.7}, {490, 28830.4},
    {500, 28712.1}, {510, 27825.0}, {520, 27100.6}, {530, 27233.6}, {540, 26361.3}, {550, 25503.8},
    {560, 25060.2}, {570, 25311.6}, {580, 25355.9}, {590, 25134.2}, {600, 24631.5}, {610, 24173.2},
    {620, 23685.3}, {630, 23212.1}, {640, 22827.7}, {650, 22339.8}, {660, 21970.2}, {670, 21526.7},
    {680, 21097.9}, {690, 20728.3}, {700, 20240.4}, {710, 19870.8}, {720, 19427.2}, {730, 19072.4},
    {740, 18628.9}, {750, 18259.2}};
constexpr SpectrumSample kOzone[] = {
    {300, 10},   {305, 4.8},  {310, 2.7},  {315, 1.35}, {320, .8},   {325, .38},  {330, .16},
    {335, .075}, {340, .04},  {345, .019}, {350, .007}, {355, 0},    {445, .003}, {450, .003},
    {455, .004}, {460, .006}, {465, .008}, {470, .009}, {475, .012}, {480, .014}, {485, .017},
    {490, .021}, {495, .025}, {500, .03},  {505, .035}, {510, .04},  {515, .045}, {520, .048},
    {525, .057}, {530, .063}, {535, .07},  {540, .075}, {545, .08},  {550, .085}, {555, .095},
    {560, .103}, {565, .11},  {570, .12},  {575, .122}, {580, .12},  {585, .118}, {590, .115},
    {595, .12},  {600, .125}, {605, .13},  {610, .12},  {620, .105}, {630, .09},  {640, .079},
    {650, .067}, {660, .057}, {670, .048}, {680, .036}, {690, .028}, {700, .023}, {710, .018},
    {720, .014}, {730, .011}, {740, .01},  {750, .009}, {760, .007}, {770, .004}, {780, 0}};
constexpr SpectrumSample kGases[] = {{759, 0}, {760, 3}, {770, .21}, {771, 0}};
constexpr SpectrumSample kWater[] = {
    {689, 0},    {690, .016}, {700, .024}, {710, .0125}, {720, 1},     {730, .87}, {740, .061},
    {750, .001}, {760, 1e-5}, {770, 1e-5}, {780, 6e-4},  {790, .0175}, {800, .036}};

// Julian days since noon of 1 January 2000, of a day in the Gregorian calendar at `hours` of universal time
// [Fliegel and van Flandern 1968].
double julianDays(int year, int month, int day, double hours) {
  const int early = (month - 14) / 12;
  const int number = 1461 * (year + 4800 + early) / 4 + 367 * (month - 2 - 12 * early) / 12 -
                     3 * ((year + 4900 + early) / 100) / 4 + day - 32075;
  return number - 0.5 + hours / 24 - 2451545.0;
}

}  // namespace

glm::dvec3 sunDirectionAt(const PlaceAndTime& when) {
  constexpr double kEarthRadius = 6371.01, kDistance = 149597890;  // km
  constexpr double kDegree = kPiD / 180;
  const double hours = when.hour - when.timezone + (when.minute + when.second / 60) / 60;
  const double days = julianDays(when.year, when.month, when.day, hours);

  // In the ecliptic.
  const double omega = 2.1429 - 0.0010394594 * days;
  const double meanLongitude = 4.8950630 + 0.017202791698 * days;
  const double anomaly = 6.2400600 + 0.0172019699 * days;
  const double longitude = meanLongitude + 0.03341607 * std::sin(anomaly) +
                           0.00034894 * std::sin(2 * anomaly) - 0.0001134 -
                           0.0000203 * std::sin(omega);
  const double obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * std::cos(omega);

  // On the celestial sphere.
  const double ascension =
      std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));

  // As seen from the place.
  const double sidereal = 6.6974243242 + 0.0657098283 * days + hours;
  const double hourAngle = (sidereal * 15 + when.longitude) * kDegree - ascension;
  const double latitude = when.latitude * kDegree;
  double zenith =
      std::acos(std::clamp(std::cos(latitude) * std::cos(hourAngle) * std::cos(declination) +
                               std::sin(declination) * std::sin(latitude),
                           -1.0, 1.0));
  const double azimuth =
      std::atan2(-std::sin(hourAngle), std::tan(declination) * std::cos(latitude) -
                                           std::sin(latitude) * std::cos(hourAngle));
  zenith += kEarthRadius / kDistance * std::sin(zenith);  // parallax
  return {std::sin(azimuth) * std::sin(zenith), std::cos(zenith),
          -std::cos(azimuth) * std::sin(zenith)};
}

Rgbf sunRadiance(double zenithAngle, double turbidity) {
  constexpr double kOzoneLength = 0.35, kWaterLength = 2, kAerosolExponent = 1.3;
  const double beta = 0.04608365822050 * turbidity - 0.04586025928522;
  // Relative optical mass.
  const double mass =
      1 / (std::cos(zenithAngle) + 0.15 * std::pow(93.885 - zenithAngle * 180 / kPiD, -1.253));
  const Table sun{kSun}, ozone{kOzone}, gases{kGases}, water{kWater};
  std::vector<SpectrumSample> spectrum;
  for (double w = 350; w <= 800; w += 5) {
    const double micrometres = w / 1000;
    const double g = gases.at(w) * mass, v = water.at(w) * kWaterLength * mass;
    // Rayleigh scattering, aerosols, ozone, mixed gases, water vapour.
    const double depth =
        0.008735 * std::pow(micrometres, -4.08) * mass +
        beta * std::pow(micrometres, -kAerosolExponent) * mass + ozone.at(w) * kOzoneLength * mass +
        1.41 * g / std::pow(1 + 118.93 * g, 0.45) + 0.2385 * v / std::pow(1 + 20.07 * v, 0.45);
    spectrum.push_back({w, sun.at(w) * std::exp(-depth)});
  }
  return intoGamut(spectrumToRgb(spectrum));
}

SkyModel::SkyModel(double turbidity, const Rgbf& albedo, const glm::dvec3& sun) : sun_(sun) {
  const double elevation = std::asin(std::clamp(sun.y, 0.0, 1.0));
  const double x = std::cbrt(elevation / (kPiD / 2));
  const double t = std::clamp(turbidity, 1.0, 10.0) - 1;
  const auto lower = static_cast<std::size_t>(std::min(t, 8.0));
  const double t1 = t - static_cast<double>(lower);
  for (int c = 0; c < 3; ++c) {
    const double a = std::clamp(static_cast<double>(albedo[c]), 0.0, 1.0);
    Channel& channel = channels_[at(c)];
    channel.shape.fill(0);
    channel.mean = 0;
    for (std::size_t ground = 0; ground < 2; ++ground)
      for (std::size_t k = 0; k < 2; ++k) {
        const double weight = (ground ? a : 1 - a) * (k ? t1 : 1 - t1);
        const float* shape = kSkyShape[c][ground][lower + k];
        for (std::size_t i = 0; i < channel.shape.size(); ++i)
          channel.shape[i] += weight * overElevation(x, shape + i, channel.shape.size());
        channel.mean += weight * overElevation(x, kSkyRadiance[c][ground][lower + k], 1);
      }
  }
}

Rgbf SkyModel::radiance(const glm::dvec3& direction) const {
  const double cosTheta = std::max(direction.y, 0.0);
  const double cosGamma = std::clamp(glm::dot(direction, sun_), -1.0, 1.0);
  const double gamma = std::acos(cosGamma), cos2 = cosGamma * cosGamma;
  Rgbf result;
  for (int c = 0; c < 3; ++c) {
    const auto& [shape, mean] = channels_[at(c)];
    const auto& [A, B, C, D, E, F, G, I, H] = shape;
    // [Hosek and Wilkie 2012, eq. 8]; the halo around the sun is their chi.
    const double chi = (1 + cos2) / std::pow(1 + H * H - 2 * H * cosGamma, 1.5);
    const double f = (1 + A * std::exp(B / (cosTheta + 0.01))) *
                     (C + D * std::exp(E * gamma) + F * cos2 + G * chi + I * std::sqrt(cosTheta));
    result[c] = static_cast<float>(std::max(f * mean / kObserver, 0.0));
  }
  return result;
}

}  // namespace h2mc
