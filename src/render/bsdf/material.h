// SPDX-License-Identifier: MIT
// Materials: what a surface point scatters with, after sides and opacity are sorted out. The same
// questions as to a BSDF, with a lobe that names the BSDF too.
#pragma once

#include "render/bsdf/bsdf.h"
#include "render/core/hemisphere.h"
#include "render/core/index.h"

namespace h2mc {

// A discrete choice of scattering at a vertex: part of a path's topology.
struct LobeId {
  std::uint8_t lobe = 0;  // of the BSDF
  bool back = false;      // the BSDF on the back, with both directions flipped
  bool null = false;      // straight on through the surface, where it is not opaque
  std::uint8_t part = 0;  // of a blend, bit by bit from the outermost: 0 the first, 1 the second
  bool operator==(const LobeId&) const = default;
};

// How many materials one in another a blend may have: LobeId::part's bits.
inline constexpr int kDeepestBlend = 8;

namespace detail {

// What of a blend the lobe belongs to: the material itself where it is none.
inline const Material& partOf(const Material& material, LobeId lobe) {
  const Material* m = &material;
  for (; m->blend; lobe.part >>= 1) m = (lobe.part & 1 ? m->blend->second : m->blend->first).get();
  return *m;
}

// The BSDF that sees a direction with this z (the back's sees it flipped), null if none scatters.
template <class S>
const Bsdf* seen(std::span<const Bsdf> bsdfs, const Material& material, S z, bool& back) {
  back = z < 0 && (material.twosided || material.back >= 0);
  const int index = back ? material.back : material.front;
  return index < 0 ? nullptr : &bsdfs[at(index)];
}
inline const Bsdf* ofLobe(std::span<const Bsdf> bsdfs, const Material& whole, LobeId lobe) {
  const Material& material = partOf(whole, lobe);
  const int index = lobe.back ? material.back : material.front;
  return index < 0 ? nullptr : &bsdfs[at(index)];
}
template <class T>
Vec3<T> facing(const Vec3<T>& w, bool back) {
  return back ? flipped(w) : w;
}

// Probability of meeting the BSDF where the material has an opacity.
template <class T>
T opacityProbability(const Rgb<T>& opacity) {
  return ad::clamp(luminance(opacity), Scalar<T>(0), Scalar<T>(1));
}

// With the material's opacity, which it has.
template <class T>
BsdfValue<T> behindOpacity(const Material& material, const Vec2<T>& uv, const BsdfValue<T>& r) {
  const Rgb<T> opacity = evaluate<T>(*material.opacity, uv);
  const T p = opacityProbability(opacity);
  return {r.value * opacity, r.pdf * p, r.pdfReverse * p};
}
template <class T>
SampledBsdf<T> behindOpacity(const Material& material, const Vec2<T>& uv, SampledBsdf<T> r) {
  const Rgb<T> opacity = evaluate<T>(*material.opacity, uv);
  const T p = opacityProbability(opacity);
  if (!(value(p) > 0)) return SampledBsdf<T>::zero();
  r.weight = r.weight * opacity * T(Scalar<T>(1) / p);
  r.pdf = r.pdf * p;
  r.pdfReverse = r.pdfReverse * p;
  return r;
}

template <class T>
BsdfValue<T> evaluateBlend(std::span<const Bsdf> bsdfs, const Material& material, const Vec2<T>& uv,
                           const Vec3<T>& wi, const Vec3<T>& wo);
template <class T>
SampledBsdf<T> sampledBlend(std::span<const Bsdf> bsdfs, const Material& material,
                            const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo);

}  // namespace detail

template <class T>
BsdfValue<T> evaluateMaterial(std::span<const Bsdf> bsdfs, const Material& material,
                              const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) {
  if (material.blend) [[unlikely]]
    return detail::evaluateBlend<T>(bsdfs, material, uv, wi, wo);
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, value(wi.z), back);
  if (!bsdf) return BsdfValue<T>::zero();
  const auto inner = [&](const Vec3<T>& i, const Vec3<T>& o) {
    return std::visit([&](const auto& b) { return b.template evaluate<T>(uv, i, o); }, *bsdf);
  };
  if (!material.opacity) return back ? inner(flipped(wi), flipped(wo)) : inner(wi, wo);
  const BsdfValue<T> r = back ? inner(flipped(wi), flipped(wo)) : inner(wi, wo);
  return detail::behindOpacity(material, uv, r);
}

// Where wo was drawn for wi. A BSDF without a formula of its own for this has that of evaluate().
template <class T>
SampledBsdf<T> sampledMaterial(std::span<const Bsdf> bsdfs, const Material& material,
                               const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) {
  if (material.blend) [[unlikely]]
    return detail::sampledBlend<T>(bsdfs, material, uv, wi, wo);
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, value(wi.z), back);
  if (!bsdf) return SampledBsdf<T>::zero();
  const auto inner = [&](const Vec3<T>& i, const Vec3<T>& o) {
    return std::visit(
        [&](const auto& b) {
          if constexpr (requires { b.template sampled<T>(uv, i, o); }) {
            return b.template sampled<T>(uv, i, o);
          } else {
            const BsdfValue<T> e = b.template evaluate<T>(uv, i, o);
            if (!(value(e.pdf) > 0)) return SampledBsdf<T>::zero();
            return SampledBsdf<T>{e.value * T(Scalar<T>(1) / e.pdf), e.pdf, e.pdfReverse};
          }
        },
        *bsdf);
  };
  if (!material.opacity) return back ? inner(flipped(wi), flipped(wo)) : inner(wi, wo);
  const SampledBsdf<T> r = back ? inner(flipped(wi), flipped(wo)) : inner(wi, wo);
  return detail::behindOpacity(material, uv, r);
}

namespace detail {

// Takes the part of a blend that `choice` falls to, and leaves its place there in `choice`.
inline bool chooseSecond(const Blend& blend, const Vec2f& uv, float& choice) {
  const float w = blend.weightAt<float>(uv), first = 1 - w;
  const bool second = choice >= first;
  choice = toUnitInterval(second ? (double(choice) - first) / w : double(choice) / first);
  return second;
}

// Of chooseLobe choosing the lobe's part of a blend.
template <class T>
[[gnu::noinline]] T partProbability(const Material& material, const Vec2<T>& uv, LobeId lobe) {
  T probability(Scalar<T>(1));
  for (const Material* m = &material; m->blend; lobe.part >>= 1) {
    const T w = m->blend->weightAt<T>(uv);
    const bool second = lobe.part & 1;
    probability = probability * (second ? w : T(Scalar<T>(1) - w));
    m = (second ? m->blend->second : m->blend->first).get();
  }
  return probability;
}
inline float scaleOf(const Material& material, LobeId lobe) {
  float scale = 1;
  for (const Material* m = &material; m->blend; lobe.part >>= 1) {
    scale *= m->blend->scale;
    m = (lobe.part & 1 ? m->blend->second : m->blend->first).get();
  }
  return scale;
}

template <class T>
[[gnu::noinline]] BsdfValue<T> evaluateBlend(std::span<const Bsdf> bsdfs, const Material& material,
                                             const Vec2<T>& uv, const Vec3<T>& wi,
                                             const Vec3<T>& wo) {
  using S = Scalar<T>;
  const Blend& blend = *material.blend;
  const T w = blend.weightAt<T>(uv), v = S(1) - w;
  const BsdfValue<T> a = evaluateMaterial<T>(bsdfs, *blend.first, uv, wi, wo);
  const BsdfValue<T> b = evaluateMaterial<T>(bsdfs, *blend.second, uv, wi, wo);
  const S scale = blend.scale;
  const BsdfValue<T> r{(a.value * v + b.value * w) * T(scale), a.pdf * v + b.pdf * w,
                       a.pdfReverse * v + b.pdfReverse * w};
  return material.opacity ? behindOpacity(material, uv, r) : r;
}

template <class T>
[[gnu::noinline]] SampledBsdf<T> sampledBlend(std::span<const Bsdf> bsdfs, const Material& material,
                                              const Vec2<T>& uv, const Vec3<T>& wi,
                                              const Vec3<T>& wo) {
  using S = Scalar<T>;
  const Blend& blend = *material.blend;
  const T w = blend.weightAt<T>(uv), v = S(1) - w;
  const SampledBsdf<T> a = sampledMaterial<T>(bsdfs, *blend.first, uv, wi, wo);
  const SampledBsdf<T> b = sampledMaterial<T>(bsdfs, *blend.second, uv, wi, wo);
  SampledBsdf<T> r = SampledBsdf<T>::zero();
  r.pdf = a.pdf * v + b.pdf * w;
  if (!(value(r.pdf) > 0)) return r;
  r.pdfReverse = a.pdfReverse * v + b.pdfReverse * w;
  const MixtureShares<T> shares(a.pdf, b.pdf, v, w);
  const S scale = blend.scale;
  r.weight = a.weight * T(shares.first * v * scale) + b.weight * T(shares.second * w * scale);
  // Two that refract do so by the same index: the scene reader sees to that.
  r.importance = value(a.pdf) > 0 ? a.importance : b.importance;
  return material.opacity ? behindOpacity(material, uv, r) : r;
}

}  // namespace detail

inline LobeId chooseLobe(std::span<const Bsdf> bsdfs, const Material& material, const Vec2f& uv,
                         const Vec3f& wi, float u0, float u1, float choice) {
  LobeId id;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, wi.z, id.back);
  if (material.opacity) {
    const float p = detail::opacityProbability(evaluate<float>(*material.opacity, uv));
    if (choice >= p) {
      id.null = true;
      return id;
    }
    choice = toUnitInterval(double(choice) / p);
  }
  if (material.blend) [[unlikely]] {
    const bool second = detail::chooseSecond(*material.blend, uv, choice);
    const Material& part = second ? *material.blend->second : *material.blend->first;
    id = chooseLobe(bsdfs, part, uv, wi, u0, u1, choice);
    id.part = static_cast<std::uint8_t>(id.part << 1 | (second ? 1 : 0));
    return id;
  }
  if (bsdf)
    id.lobe = static_cast<std::uint8_t>(std::visit(
        [&](const auto& b) {
          return b.chooseLobe(uv, detail::facing(wi, id.back), u0, u1, choice);
        },
        *bsdf));
  return id;
}

// True for the lobes that sampleDelta answers for, false for those of sampleMaterial.
inline bool isDelta(std::span<const Bsdf> bsdfs, const Material& material, LobeId lobe) {
  if (lobe.null) return true;
  const Bsdf* const bsdf = detail::ofLobe(bsdfs, material, lobe);
  return bsdf && std::visit([&](const auto& b) { return b.isDelta(lobe.lobe); }, *bsdf);
}

// The lobe's share of evaluateMaterial().pdf; zero for delta lobes.
template <class T>
T lobePdf(std::span<const Bsdf> bsdfs, const Material& material, const Vec2<T>& uv,
          const Vec3<T>& wi, const Vec3<T>& wo, LobeId lobe) {
  bool back;
  const Material& part = detail::partOf(material, lobe);
  const Bsdf* const bsdf = detail::seen(bsdfs, part, value(wi.z), back);
  if (!bsdf || lobe.null || lobe.back != back) return T(0);
  T pdf = std::visit(
      [&](const auto& b) {
        return b.template lobePdf<T>(uv, detail::facing(wi, back), detail::facing(wo, back),
                                     lobe.lobe);
      },
      *bsdf);
  if (material.blend) [[unlikely]]
    pdf = pdf * detail::partProbability<T>(material, uv, lobe);
  if (!material.opacity) return pdf;
  return pdf * detail::opacityProbability(evaluate<T>(*material.opacity, uv));
}

template <class T>
Vec3<T> sampleMaterial(std::span<const Bsdf> bsdfs, const Material& material, const Vec2<T>& uv,
                       const Vec3<T>& wi, LobeId lobe, const T& u0, const T& u1) {
  const Bsdf* const bsdf = lobe.null ? nullptr : detail::ofLobe(bsdfs, material, lobe);
  if (!bsdf) return noDirection<T>();
  const auto inner = [&](const Vec3<T>& i) {
    return std::visit([&](const auto& b) { return b.template sample<T>(uv, i, lobe.lobe, u0, u1); },
                      *bsdf);
  };
  const Vec3<T> wo = lobe.back ? flipped(inner(flipped(wi))) : inner(wi);
  // Where a part of a blend draws what it does not scatter to, another part's density must not take it for its own.
  if constexpr (!ad::isDual<T>)
    if (material.blend && !(lobePdf<T>(bsdfs, material, uv, wi, wo, lobe) > 0)) [[unlikely]]
      return noDirection<T>();
  return wo;
}

// (u0, u1) with sampleMaterial(..., u0, u1) == wo; false when the lobe cannot draw wo.
inline bool invertLobe(std::span<const Bsdf> bsdfs, const Material& material, const Vec2f& uv,
                       const Vec3f& wi, const Vec3f& wo, LobeId lobe, Vec2f& u) {
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, detail::partOf(material, lobe), wi.z, back);
  if (!bsdf || lobe.null || lobe.back != back) return false;
  return std::visit(
      [&](const auto& b) {
        return b.invert(uv, detail::facing(wi, back), detail::facing(wo, back), lobe.lobe, u);
      },
      *bsdf);
}

// What passes straight on through the surface, over the probability of that (1 - opacity's luminance, left in
// `probability` if that is not null): both zero where nothing does.
template <class T>
Rgb<T> passingShare(const Material& material, const Vec2<T>& uv, T* probability = nullptr) {
  using S = Scalar<T>;
  T passing(S(0));
  Rgb<T> opacity(passing);
  if (material.opacity) {
    opacity = evaluate<T>(*material.opacity, uv);
    passing = S(1) - detail::opacityProbability(opacity);
  }
  if (probability) *probability = passing;
  if (!(value(passing) > 0)) return Rgb<T>(T(S(0)));
  const T inverse = S(1) / passing;
  return {(S(1) - opacity.x) * inverse, (S(1) - opacity.y) * inverse, (S(1) - opacity.z) * inverse};
}

template <class T>
DeltaSample<T> sampleDelta(std::span<const Bsdf> bsdfs, const Material& material, const Vec2<T>& uv,
                           const Vec3<T>& wi, LobeId lobe) {
  if (lobe.null) {
    T probability;
    const Rgb<T> passed = passingShare<T>(material, uv, &probability);
    if (!(value(probability) > 0)) return DeltaSample<T>::none();
    return {-wi, passed, passed, value(probability)};
  }
  const Bsdf* const bsdf = detail::ofLobe(bsdfs, material, lobe);
  if (!bsdf) return DeltaSample<T>::none();
  DeltaSample<T> r = std::visit(
      [&](const auto& b) {
        return b.template sampleDelta<T>(uv, detail::facing(wi, lobe.back), lobe.lobe);
      },
      *bsdf);
  if (lobe.back) r.wo = flipped(r.wo);
  if (material.blend) [[unlikely]] {
    // The part's share over its probability is the blend's scale.
    const T scale(Scalar<T>(detail::scaleOf(material, lobe)));
    r.radiance = r.radiance * scale;
    r.importance = r.importance * scale;
    r.probability = r.probability * detail::partProbability<Scalar<T>>(material, value2(uv), lobe);
    if (!(r.probability > 0)) return DeltaSample<T>::none();
  }
  if (material.opacity) {
    const Rgb<T> opacity = evaluate<T>(*material.opacity, uv);
    const T p = detail::opacityProbability(opacity);
    if (!(value(p) > 0)) return DeltaSample<T>::none();
    const Rgb<T> share = opacity * T(Scalar<T>(1) / p);
    r.radiance = r.radiance * share;
    r.importance = r.importance * share;
    r.probability = r.probability * value(p);
  }
  return r;
}

// Whether evaluateMaterial() can be non-zero for directions on this side (z = +-1): connections are
// worth it.
inline bool hasNonDelta(std::span<const Bsdf> bsdfs, const Material& material, float z = 1) {
  if (const Blend* blend = material.blend.get())
    return hasNonDelta(bsdfs, *blend->first, z) || hasNonDelta(bsdfs, *blend->second, z);
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, z, back);
  return bsdf && std::visit([](const auto& b) { return b.hasNonDelta(); }, *bsdf);
}

// Whether light can go on to the other side.
inline bool transmits(std::span<const Bsdf> bsdfs, const Material& material) {
  if (material.opacity) return true;
  if (const Blend* blend = material.blend.get())
    return transmits(bsdfs, *blend->first) || transmits(bsdfs, *blend->second);
  return material.front >= 0 &&
         std::visit([](const auto& b) { return b.transmits(); }, bsdfs[at(material.front)]);
}

// Width of the lobe in radians; 0 for delta lobes.
inline float lobeWidth(std::span<const Bsdf> bsdfs, const Material& material, LobeId lobe) {
  const Bsdf* const bsdf = lobe.null ? nullptr : detail::ofLobe(bsdfs, material, lobe);
  return bsdf ? std::visit([&](const auto& b) { return b.width(lobe.lobe); }, *bsdf) : 0;
}

}  // namespace h2mc
