// SPDX-License-Identifier: MIT
// What alternatives of the scene's variants are called, as scene files name them.
#pragma once

#include <span>
#include <string_view>

#include "render/scene/scene.h"

namespace h2mc {

// Static strings. "triangle mesh", "sphere" or "disk".
const char* kindOf(const Shape& shape);
const char* kindOf(const Light& light);
const char* kindOf(const Bsdf& bsdf);

// By index of the variant Light.
std::span<const char* const> lightKinds();
// By bsdfKindIndex: all that kindOf can say of a BSDF.
std::span<const char* const> bsdfKinds();
int bsdfKindIndex(const Bsdf& bsdf);

}  // namespace h2mc
