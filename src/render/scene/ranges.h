// SPDX-License-Identifier: MIT
// Parameters that lie in a range, and the message for those that don't: it says the value and the range.
#pragma once

#include "render/scene/properties.h"

namespace h2mc {

// The number, which lies from `low` to `high`; fails (SceneError) otherwise.
float numberIn(const Properties& p, std::string_view name, float low, float high);
// The number, which is above 0 and at most `high`.
float numberAbove0(const Properties& p, std::string_view name, float high);
// The same for an integer.
int integerIn(const Properties& p, std::string_view name, int low, int high);
// The parameter "gamma" of a picture: -1, 0, or an exponent.
float readGamma(const Properties& p);
// A colour or texture whose values are at most `high`.
TexturePtr textureUpTo(const Properties& p, std::string_view name, float high);

}  // namespace h2mc
