// SPDX-License-Identifier: MIT
#include "render/photon/wide_lobes.h"

#include "render/bsdf/lobe_choice.h"

namespace h2mc {

WideLobes::WideLobes(std::span<const Bsdf> bsdfs, std::span<const Material> materials,
                     float narrowest)
    : bsdfs_(bsdfs), narrowest_(narrowest) {
  for (const Material& material : materials) kinds_.push_back(kindsOf(material));
}

WideLobes::Kinds WideLobes::kindsOf(const Material& material) const {
  if (const Blend* blend = material.blend.get()) {
    const Kinds a = kindsOf(*blend->first), b = kindsOf(*blend->second);
    return {a.wide || b.wide, a.narrow || b.narrow};
  }
  Kinds kinds;
  for (const int side : {material.front, material.back}) {
    if (side < 0) continue;
    for (int i = 0; i < lobeCount(bsdfs_[at(side)]); ++i) {
      LobeId lobe{static_cast<std::uint8_t>(i), side != material.front};
      if (isDelta(bsdfs_, material, lobe)) continue;
      (isWide(material, lobe) ? kinds.wide : kinds.narrow) = true;
    }
  }
  return kinds;
}

WideLobes::Densities WideLobes::split(const Material& material, const Vec2f& uv, const Vec3f& wi,
                                      const Vec3f& wo) const {
  if (const Blend* blend = material.blend.get()) {
    const float w = blend->weightAt<float>(uv);
    const Densities a = split(*blend->first, uv, wi, wo), b = split(*blend->second, uv, wi, wo);
    return {(1 - w) * a.wide + w * b.wide, (1 - w) * a.all + w * b.all};
  }
  Densities densities;
  LobeId lobe;
  const Bsdf* const bsdf = detail::seen(bsdfs_, material, wi.z, lobe.back);
  for (int i = 0; bsdf && i < lobeCount(*bsdf); ++i) {
    lobe.lobe = static_cast<std::uint8_t>(i);
    const float pdf = lobePdf<float>(bsdfs_, material, uv, wi, wo, lobe);
    densities.all += pdf;
    if (isWide(material, lobe)) densities.wide += pdf;
  }
  return densities;
}

}  // namespace h2mc
