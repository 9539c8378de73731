// SPDX-License-Identifier: MIT
// Colours as scene files write them.
#pragma once

#include <string_view>

#include "render/scene/scene_document.h"

namespace h2mc {

// Whether elements of that name give a colour: rgb, spectrum, float, ...
bool isColorElement(std::string_view name);
// Mitsuba 2's and 3's spectra that are a plugin and yet a single colour.
bool isPlainSpectrum(const XmlElement& element);

// The colour that an <rgb>, <srgb>, <spectrum>, <blackbody> or number element gives; of a spectrum, see intoGamut().
Rgbf readColor(const SceneDocument& document, const XmlElement& element, bool mayBeNegative = false,
               Rgbf* saturated = nullptr);

}  // namespace h2mc
