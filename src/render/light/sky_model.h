// SPDX-License-Identifier: MIT
// The clear sky by day: its light [Hosek and Wilkie 2012, "An Analytic Model for Full Spectral Sky-Dome Radiance"], and
// the sun's after it has come through the air [Preetham et al. 1999, "A Practical Analytic Model for Daylight"]. Linear
// Rec. 709 RGB, W / (m^2 sr nm); +y is up. An azimuth is measured from -z towards +x.
#pragma once

#include <array>
#include <numbers>

#include "render/core/types.h"

namespace h2mc {

inline constexpr double kPiD = std::numbers::pi;

// Where and when, for sunDirectionAt().
struct PlaceAndTime {
  double latitude, longitude;  // degrees, north and east
  double timezone;             // hours before Greenwich's
  int year, month, day;
  double hour, minute, second;  // local time
};
// Unit, towards the sun: east is +x, north is -z. Within half a minute of arc from 1999 to 2015 [Blanco-Muriel et al.
// 2001, "Computing the Solar Vector"].
glm::dvec3 sunDirectionAt(const PlaceAndTime& when);

// Half the sun's apparent angle, in radians.
inline constexpr double kSunRadius = 0.2679 * 0.017453292519943295;

// Mean radiance of the sun's disc, `zenithAngle` from the zenith, in radians, up to a quarter turn. Turbidity: 1 to 10.
Rgbf sunRadiance(double zenithAngle, double turbidity);

class SkyModel {
 public:
  // turbidity: 1 to 10. albedo: of the ground, 0 to 1 in each channel. sun: unit, not below the horizon.
  SkyModel(double turbidity, const Rgbf& albedo, const glm::dvec3& sun);

  // From a unit direction, whose cosine to the zenith counts as 0 where it is less; not negative.
  Rgbf radiance(const glm::dvec3& direction) const;

 private:
  struct Channel {
    std::array<double, 9> shape;
    double mean;
  };
  std::array<Channel, 3> channels_;
  glm::dvec3 sun_;
};

}  // namespace h2mc
