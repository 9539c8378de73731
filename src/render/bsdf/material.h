// Materials: what a surface point scatters with, after sides and opacity are sorted out. The same
// questions as to a BSDF, with a lobe that names the BSDF too.
#pragma once

#include "render/bsdf/bsdf.h"
#include "render/core/hemisphere.h"

namespace h2mc {

// A discrete choice of scattering at a vertex: part of a path's topology.
struct LobeId {
  std::uint8_t lobe = 0;  // of the BSDF
  bool back = false;      // the BSDF on the back, with both directions flipped
  bool null = false;      // straight on through the surface, where it is not opaque
  bool operator==(const LobeId&) const = default;
};

namespace detail {

// The BSDF that sees a direction with this z (the back's sees it flipped), null if none scatters.
template <class S>
const Bsdf* seen(std::span<const Bsdf> bsdfs, const Material& material, S z, bool& back) {
  back = z < 0 && (material.twosided || material.back >= 0);
  const int index = back ? material.back : material.front;
  return index < 0 ? nullptr : &bsdfs[static_cast<std::size_t>(index)];
}
inline const Bsdf* ofLobe(std::span<const Bsdf> bsdfs, const Material& material, LobeId lobe) {
  const int index = lobe.back ? material.back : material.front;
  return index < 0 ? nullptr : &bsdfs[static_cast<std::size_t>(index)];
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

}  // namespace detail

template <class T>
BsdfValue<T> evaluateMaterial(std::span<const Bsdf> bsdfs, const Material& material,
                              const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) {
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, value(wi.z), back);
  if (!bsdf) return BsdfValue<T>::zero();
  const auto inner = [&](const Vec3<T>& i, const Vec3<T>& o) {
    return std::visit([&](const auto& b) { return b.template evaluate<T>(uv, i, o); }, *bsdf);
  };
  if (!material.opacity) return back ? inner(flipped(wi), flipped(wo)) : inner(wi, wo);
  const BsdfValue<T> r = back ? inner(flipped(wi), flipped(wo)) : inner(wi, wo);
  const Rgb<T> opacity = evaluate<T>(*material.opacity, uv);
  const T p = detail::opacityProbability(opacity);
  return {r.value * opacity, r.pdf * p, r.pdfReverse * p};
}

// Where wo was drawn for wi. A BSDF without a formula of its own for this has that of evaluate().
template <class T>
SampledBsdf<T> sampledMaterial(std::span<const Bsdf> bsdfs, const Material& material,
                               const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) {
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
  SampledBsdf<T> r = back ? inner(flipped(wi), flipped(wo)) : inner(wi, wo);
  const Rgb<T> opacity = evaluate<T>(*material.opacity, uv);
  const T p = detail::opacityProbability(opacity);
  if (!(value(p) > 0)) return SampledBsdf<T>::zero();
  r.weight = r.weight * opacity * T(Scalar<T>(1) / p);
  r.pdf = r.pdf * p;
  r.pdfReverse = r.pdfReverse * p;
  return r;
}

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

template <class T>
Vec3<T> sampleMaterial(std::span<const Bsdf> bsdfs, const Material& material, const Vec2<T>& uv,
                       const Vec3<T>& wi, LobeId lobe, const T& u0, const T& u1) {
  const Bsdf* const bsdf = lobe.null ? nullptr : detail::ofLobe(bsdfs, material, lobe);
  if (!bsdf) return noDirection<T>();
  const auto inner = [&](const Vec3<T>& i) {
    return std::visit([&](const auto& b) { return b.template sample<T>(uv, i, lobe.lobe, u0, u1); },
                      *bsdf);
  };
  return lobe.back ? flipped(inner(flipped(wi))) : inner(wi);
}

// The lobe's share of evaluateMaterial().pdf; zero for delta lobes.
template <class T>
T lobePdf(std::span<const Bsdf> bsdfs, const Material& material, const Vec2<T>& uv,
          const Vec3<T>& wi, const Vec3<T>& wo, LobeId lobe) {
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, value(wi.z), back);
  if (!bsdf || lobe.null || lobe.back != back) return T(0);
  const T pdf = std::visit(
      [&](const auto& b) {
        return b.template lobePdf<T>(uv, detail::facing(wi, back), detail::facing(wo, back),
                                     lobe.lobe);
      },
      *bsdf);
  if (!material.opacity) return pdf;
  return pdf * detail::opacityProbability(evaluate<T>(*material.opacity, uv));
}

// (u0, u1) with sampleMaterial(..., u0, u1) == wo; false when the lobe cannot draw wo.
inline bool invertLobe(std::span<const Bsdf> bsdfs, const Material& material, const Vec2f& uv,
                       const Vec3f& wi, const Vec3f& wo, LobeId lobe, Vec2f& u) {
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, wi.z, back);
  if (!bsdf || lobe.null || lobe.back != back) return false;
  return std::visit(
      [&](const auto& b) {
        return b.invert(uv, detail::facing(wi, back), detail::facing(wo, back), lobe.lobe, u);
      },
      *bsdf);
}

template <class T>
DeltaSample<T> sampleDelta(std::span<const Bsdf> bsdfs, const Material& material, const Vec2<T>& uv,
                           const Vec3<T>& wi, LobeId lobe) {
  if (lobe.null) {
    if (!material.opacity) return DeltaSample<T>::none();
    const Rgb<T> opacity = evaluate<T>(*material.opacity, uv);
    const T probability = Scalar<T>(1) - detail::opacityProbability(opacity);
    if (!(value(probability) > 0)) return DeltaSample<T>::none();
    const T inverse = Scalar<T>(1) / probability;
    const Rgb<T> passed((Scalar<T>(1) - opacity.x) * inverse, (Scalar<T>(1) - opacity.y) * inverse,
                        (Scalar<T>(1) - opacity.z) * inverse);
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
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, z, back);
  return bsdf && std::visit([](const auto& b) { return b.hasNonDelta(); }, *bsdf);
}

// Whether light can go on to the other side.
inline bool transmits(std::span<const Bsdf> bsdfs, const Material& material) {
  if (material.opacity) return true;
  return material.front >= 0 && std::visit([](const auto& b) { return b.transmits(); },
                                           bsdfs[static_cast<std::size_t>(material.front)]);
}

// Width of the lobe in radians; 0 for delta lobes.
inline float lobeWidth(std::span<const Bsdf> bsdfs, const Material& material, LobeId lobe) {
  const Bsdf* const bsdf = lobe.null ? nullptr : detail::ofLobe(bsdfs, material, lobe);
  return bsdf ? std::visit([&](const auto& b) { return b.width(lobe.lobe); }, *bsdf) : 0;
}

}  // namespace h2mc
