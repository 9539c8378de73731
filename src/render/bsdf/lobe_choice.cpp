// SPDX-License-Identifier: MIT
#include "render/bsdf/lobe_choice.h"

#include <algorithm>

#include "render/bsdf/lobe_kinds.h"

namespace h2mc {

int lobeCount(const Bsdf& bsdf) {
  return std::visit([](const auto& b) { return lobesOf(b); }, bsdf);
}

ChoiceInterval choiceInterval(std::span<const Bsdf> bsdfs, const Material& material,
                              const Vec2f& uv, const Vec3f& wi, float u0, float u1, LobeId lobe) {
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, wi.z, back);
  // A BSDF's lobes, then passing through where it is not opaque.
  const float opaque =
      material.opacity ? detail::opacityProbability(evaluate<float>(*material.opacity, uv)) : 1;
  if (lobe.null) return {opaque, 1};
  if (const Blend* blend = material.blend.get()) {
    const bool second = lobe.part & 1;
    lobe.part >>= 1;
    const float w = blend->weightAt<float>(uv);
    const float begin = second ? 1 - w : 0, share = second ? w : 1 - w;
    const ChoiceInterval inner =
        choiceInterval(bsdfs, second ? *blend->second : *blend->first, uv, wi, u0, u1, lobe);
    return {(begin + share * inner.begin) * opaque, (begin + share * inner.end) * opaque};
  }
  if (!bsdf || lobe.back != back) return {};
  const ChoiceInterval inner = std::visit(
      [&](const auto& b) {
        return choiceIntervalOf(b, uv, detail::facing(wi, back), u0, u1, lobe.lobe);
      },
      *bsdf);
  return {inner.begin * opaque, inner.end * opaque};
}

bool drawLobe(std::span<const Bsdf> bsdfs, const Material& material, const Vec2f& uv,
              const Vec3f& wi, const Vec3f& wo, float u, LobeId& lobe) {
  if (const Blend* blend = material.blend.get()) {
    const float w = blend->weightAt<float>(uv);
    const float first = (1 - w) * evaluateMaterial<float>(bsdfs, *blend->first, uv, wi, wo).pdf;
    const float second = w * evaluateMaterial<float>(bsdfs, *blend->second, uv, wi, wo).pdf;
    const float split = first > 0 ? first / (first + second) : 0;
    const bool takesSecond = u >= split;
    u = takesSecond ? (u - split) / (1 - split) : u / split;
    if (!drawLobe(bsdfs, takesSecond ? *blend->second : *blend->first, uv, wi, wo, u, lobe))
      return false;
    lobe.part = static_cast<std::uint8_t>(lobe.part << 1 | (takesSecond ? 1 : 0));
    return true;
  }
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, wi.z, back);
  if (!bsdf) return false;
  const float total = evaluateMaterial<float>(bsdfs, material, uv, wi, wo).pdf;
  if (!(total > 0)) return false;
  u *= total;
  LobeId candidate{0, back, false};
  bool found = false;
  for (int i = 0; i < lobeCount(*bsdf); ++i) {
    candidate.lobe = static_cast<std::uint8_t>(i);
    const float pdf = lobePdf<float>(bsdfs, material, uv, wi, wo, candidate);
    if (!(pdf > 0)) continue;
    lobe = candidate;
    found = true;
    if ((u -= pdf) < 0) break;
  }
  return found;
}

float deltaProbability(std::span<const Bsdf> bsdfs, const Material& material, const Vec2f& uv,
                       const Vec3f& wi) {
  float sum = 0;
  LobeId lobe;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, wi.z, lobe.back);
  const auto add = [&] {
    if (!isDelta(bsdfs, material, lobe)) return;
    // Which delta lobe is drawn depends on no coordinates but the choice.
    const ChoiceInterval choice = choiceInterval(bsdfs, material, uv, wi, 0, 0, lobe);
    sum += choice.end - choice.begin;
  };
  for (int i = 0; bsdf && i < lobeCount(*bsdf); ++i) {
    lobe.lobe = static_cast<std::uint8_t>(i);
    add();
  }
  lobe.null = true;
  add();
  return sum;
}

float widestLobe(std::span<const Bsdf> bsdfs, const Material& material, LobeId lobe) {
  const Bsdf* const bsdf = lobe.null ? nullptr : detail::ofLobe(bsdfs, material, lobe);
  float widest = 0;
  for (int i = 0; bsdf && i < lobeCount(*bsdf); ++i) {
    lobe.lobe = static_cast<std::uint8_t>(i);
    if (!isDelta(bsdfs, material, lobe))
      widest = std::max(widest, lobeWidth(bsdfs, material, lobe));
  }
  return widest;
}

}  // namespace h2mc
