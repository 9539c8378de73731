// SPDX-License-Identifier: MIT
// The BSDF "principled" of scene files: names, defaults and meaning are Mitsuba 3's.
#pragma once

#include "render/bsdf/bsdf.h"

namespace h2mc {

namespace detail {
constexpr Parameter unusedRate(std::string_view name) {
  return {name, ParameterType::kNumber,
          "1",  "how other renderers sample; no effect on the image",
          "",   "",
          true};
}
}  // namespace detail

inline constexpr Parameter kPrincipledParameters[] = {
    {"baseColor", ParameterType::kTexture, "0.5", "the material's colour"},
    {"roughness", ParameterType::kTexture, "0.5",
     "of facets and base, 0 to 1: root of the facets' root mean square slope"},
    {"anisotropic", ParameterType::kTexture, "0",
     "how much rougher the facets are along u than across, 0 to 1"},
    {"metallic", ParameterType::kTexture, "0", "share of the metal, 0 to 1"},
    {"specTrans", ParameterType::kTexture, "0",
     "share of what lets light through in the rest, 0 to 1"},
    {"eta", ParameterType::kNumber, "",
     "refractive index inside over that outside, 0.01 to 100; from specular"},
    {"specular", ParameterType::kNumber, "0.5",
     "instead of eta: reflectance at right angles over 0.08, 0 to 1"},
    {"specTint", ParameterType::kTexture, "0",
     "how far the rest's reflection has the colour's tint, 0 to 1"},
    {"sheen", ParameterType::kTexture, "0", "reflection at grazing angles as of cloth, 0 to 1"},
    {"sheenTint", ParameterType::kTexture, "0", "how far that has the colour's tint, 0 to 1"},
    {"flatness", ParameterType::kTexture, "0",
     "how far the base looks as if light scattered below it, 0 to 1"},
    {"clearcoat", ParameterType::kTexture, "0", "share of a second, clear reflection, 0 to 1"},
    {"clearcoatGloss", ParameterType::kTexture, "0", "how sharp that is, 0 to 1"},
    detail::unusedRate("diffuseReflectanceSamplingRate"),
    detail::unusedRate("mainSpecularSamplingRate"),
    detail::unusedRate("clearcoatSamplingRate")};

Bsdf createPrincipled(const Properties& p);

}  // namespace h2mc
