// SPDX-License-Identifier: MIT
#include "render/bsdf/principled_plugin.h"

#include <fmt/format.h>

#include <cmath>

#include "render/scene/change_note.h"
#include "render/scene/properties.h"
#include "render/scene/ranges.h"

namespace h2mc {
namespace {

constexpr float kLargestColor = 1000;
// In the order of PrincipledValues.
constexpr const char* kNumberNames[Principled::kNumbers] = {
    "roughness", "anisotropic", "metallic", "specTrans", "specTint",
    "sheen",     "sheenTint",   "flatness", "clearcoat", "clearcoatGloss"};

bool isConstant(const TexturePtr& texture) {
  return std::holds_alternative<ConstantTexture>(*texture);
}

// The mean of a parameter that goes from 0 to 1: what is beyond is held to that.
float numberOf(const Properties& p, const char* name, const TexturePtr& texture) {
  const float mean = scalarOf(average(*texture)), used = std::clamp(mean, 0.f, 1.f);
  if (isConstant(texture) && used != mean)
    noteChange(p, name, fmt::format("{:g}", mean), fmt::format("{:g}", used));
  return used;
}

// The relative index, of which what refracts has one that is not 1.
float readIndex(const Properties& p, bool refracts) {
  if (p.given("eta") && p.given("specular")) p.fail("specular", "give either eta or specular");
  if (p.given("eta")) {
    constexpr float kLowest = 0.01f, kHighest = 100, kNearOne = 1.001f;
    const float eta = numberIn(p, "eta", kLowest, kHighest);
    if (eta != 1 || !refracts) return eta;
    noteChange(p, "eta", "1", fmt::format("{:g}, which refracts", kNearOne));
    return kNearOne;
  }
  // [Burley 2015, section 2.2]
  float specular = numberIn(p, "specular", 0, 1);
  if (refracts && specular == 0) {
    specular = 1e-3f;
    noteChange(p, "specular", "0", fmt::format("{:g}, which refracts", specular));
  }
  return static_cast<float>(2 / (1 - std::sqrt(0.08 * double(specular))) - 1);
}

}  // namespace

Bsdf createPrincipled(const Properties& p) {
  Principled b;
  Principled::Textures textures;
  textures.color = textureUpTo(p, "baseColor", kLargestColor);
  bool constant = isConstant(textures.color);
  for (int i = 0; i < Principled::kNumbers; ++i) {
    textures.numbers[i] = p.texture(kNumberNames[i]);
    constant = constant && isConstant(textures.numbers[i]);
  }
  b.means = PrincipledValues<float>(average(*textures.color), [&](int i) {
    return numberOf(p, kNumberNames[i], textures.numbers[i]);
  });
  const auto isZero = [&](int i) {
    return isConstant(textures.numbers[i]) && scalarOf(average(*textures.numbers[i])) <= 0;
  };
  b.isIsotropic = isZero(1);
  b.refracts = !isZero(3);
  b.eta = readIndex(p, b.refracts);
  if (!constant) b.textures = std::make_shared<const Principled::Textures>(std::move(textures));
  return FurtherBsdf{b};
}

}  // namespace h2mc
