// SPDX-License-Identifier: MIT
// Refractive indices by name.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "render/core/types.h"

namespace h2mc {

// Of a dielectric ("bk7", "water"; any case), at 589 nm [Hecht, "Optics"].
std::optional<float> dielectricIndex(std::string_view name);
std::string dielectricNames();  // "vacuum, helium, ..."

struct NamedConductor {
  std::string_view name;
  float eta[3], k[3];
};
// A metal's complex index ("Au"; any case), null if unknown. As linear RGB: measured spectra
// [Palik, "Handbook of Optical Constants of Solids"; Weaver; luxpop] weighted with the CIE colour
// matching functions, which is what Mitsuba 0.6 makes of them.
const NamedConductor* conductorByName(std::string_view name);
std::string conductorNames();

}  // namespace h2mc
