// SPDX-License-Identifier: MIT
// A path's technique and primary sample as a line of text, exact to the last bit: what replays it.
#pragma once

#include <string>

#include "render/path/primary_sample.h"

namespace h2mc {

// "s=2 t=3 u=0x1.8p-1,... choice=0x1p-2,...", " aperture=0x1p-1,0x1p-2" where it is not the centre
// and " time=0x1p-1" where it is not 0: hexadecimal floats, so that nothing is rounded.
std::string pathText(const Technique& technique, const PrimarySample& sample);

// The reverse; numbers may be decimal as well. Returns what is wrong with the text, empty if nothing:
// the technique must be one that exists, with as many coordinates in [0, 1) as it has.
std::string parsePathText(const std::string& text, Technique& technique, PrimarySample& sample);

}  // namespace h2mc
