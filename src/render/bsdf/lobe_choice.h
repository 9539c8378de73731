// SPDX-License-Identifier: MIT
// The choice coordinate from the lobe: what mutations need that move vertices and then look for the
// primary coordinates that make them.
#pragma once

#include "render/bsdf/material.h"

namespace h2mc {

// How many lobes the BSDF has.
int lobeCount(const Bsdf& bsdf);

// Where chooseLobe(..., choice) gives `lobe`; empty if nowhere. Lobes own one interval each.
ChoiceInterval choiceInterval(std::span<const Bsdf> bsdfs, const Material& material,
                              const Vec2f& uv, const Vec3f& wi, float u0, float u1, LobeId lobe);

// Draws the non-delta lobe through which wo was sampled, each with its share of the density:
// probability lobePdf(lobe) / pdf. False when no lobe samples wo.
bool drawLobe(std::span<const Bsdf> bsdfs, const Material& material, const Vec2f& uv,
              const Vec3f& wi, const Vec3f& wo, float u, LobeId& lobe);

// The probability with which a delta lobe is drawn for wi, passing straight through included.
float deltaProbability(std::span<const Bsdf> bsdfs, const Material& material, const Vec2f& uv,
                       const Vec3f& wi);

// Width of the widest non-delta lobe of the BSDF that `lobe` belongs to, in radians; 0 if none.
float widestLobe(std::span<const Bsdf> bsdfs, const Material& material, LobeId lobe);

}  // namespace h2mc
