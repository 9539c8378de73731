// SPDX-License-Identifier: MIT
// The members of Coat that are templates. They need Bsdf to be complete, so bsdf.h includes this.
#pragma once

namespace h2mc {
namespace detail {

// `gain`: of the density of the cosine lobe (Coat::gain).
template <class T>
[[gnu::noinline]] BsdfValue<T> evaluateBelow(const CoatedBsdf& below, Scalar<T> gain,
                                             const Vec2<T>& uv, const Vec3<T>& wi,
                                             const Vec3<T>& wo) {
  return std::visit(
      [&](const auto& b) -> BsdfValue<T> {
        BsdfValue<T> r = b.template evaluate<T>(uv, wi, wo);
        if (gain > 0) {
          r.pdf = r.pdf + b.template lobePdf<T>(uv, wi, wo, below.cosineLobe) * gain;
          r.pdfReverse = r.pdfReverse + b.template lobePdf<T>(uv, wo, wi, below.cosineLobe) * gain;
        }
        return r;
      },
      below.bsdf);
}

template <class T>
[[gnu::noinline]] SampledBsdf<T> sampledBelow(const CoatedBsdf& below, Scalar<T> gain,
                                              const Vec2<T>& uv, const Vec3<T>& wi,
                                              const Vec3<T>& wo) {
  using S = Scalar<T>;
  return std::visit(
      [&](const auto& b) -> SampledBsdf<T> {
        SampledBsdf<T> r = SampledBsdf<T>::zero();
        if constexpr (requires { b.template sampled<T>(uv, wi, wo); })  // the others are all delta
          r = b.template sampled<T>(uv, wi, wo);
        if (gain > 0 && value(r.pdf) > 0) {
          // Both densities are of the same sort, and one is part of the other.
          const T more = b.template lobePdf<T>(uv, wi, wo, below.cosineLobe) * gain;
          r.weight = r.weight * T(S(1) / (S(1) + more / r.pdf));
          r.pdf = r.pdf + more;
          r.pdfReverse = r.pdfReverse + b.template lobePdf<T>(uv, wo, wi, below.cosineLobe) * gain;
        }
        return r;
      },
      below.bsdf);
}

}  // namespace detail

template <class Interface>
bool Coat<Interface>::drawnOutside(int lobe) const {
  return interface.eta > 1 && lobe == kFirstBelow + below->cosineLobe && lobe != kSpecular;
}

template <class Interface>
template <class S>
S Coat<Interface>::gain() const {
  return below->cosineLobe >= 0 && interface.eta > 1
             ? (S(interface.eta) - S(1)) * (S(interface.eta) + S(1))
             : S(0);
}

template <class Interface>
template <class T>
bool Coat<Interface>::refractIn(const Vec3<T>& w, Vec3<T>& inside) const {
  using S = Scalar<T>;
  const S eta = interface.eta;
  if (eta == S(1)) {
    inside = w;
    return true;
  }
  // cos' = sqrt(eta^2 - 1 + cos^2) / eta
  const S inverse = S(1) / eta, difference = (eta - S(1)) * (eta + S(1));
  const T cosine = ofOne(w.z, [&](const auto& c) {
    using U = std::remove_cvref_t<decltype(c)>;
    const U q2 = c * c + difference;
    return value(q2) > 0 ? U(ad::sqrt(q2) * inverse) : U(S(0));
  });
  inside = {w.x * inverse, w.y * inverse, cosine};
  return value(cosine) > 0;
}

template <class Interface>
template <class T>
Vec3<T> Coat<Interface>::refractOut(const Vec3<T>& inside) const {
  using S = Scalar<T>;
  using ad::dot2;
  const S eta = interface.eta;
  if (!(value(inside.z) > 0)) return noDirection<T>();
  if (eta == S(1)) return inside;
  const T x = inside.x * eta, y = inside.y * eta;
  const T cos2 = S(1) - T(dot2(x, x, y, y));
  if (!(value(cos2) > 0)) return noDirection<T>();
  return {x, y, ad::sqrt(cos2)};
}

template <class Interface>
template <class T>
T Coat<Interface>::belowProbability(const T& cosine) const {
  using S = Scalar<T>;
  const S ws = specularWeight;
  if (!(ws > 0)) return T(S(1));
  return ofOne(cosine, [&](const auto& c) {
    using U = std::remove_cvref_t<decltype(c)>;
    const U t = interface.transmitted(c) * (S(1) - ws), f = interface.reflected(c) * ws;
    return U(t / (t + f));
  });
}

template <class Interface>
template <class T>
T Coat<Interface>::entering(const T& cosine) const {
  using S = Scalar<T>;
  return ofOne(cosine, [&, odds = S(specularWeight) / (S(1) - S(specularWeight))](const auto& c) {
    using U = std::remove_cvref_t<decltype(c)>;
    return U(interface.transmitted(c) + interface.reflected(c) * odds);
  });
}

template <class Interface>
template <class T>
Rgb<T> Coat<Interface>::absorbed(const Rgb<T>& amount, const Vec2<T>& uv, const T& cosIn,
                                 const T& cosOut) const {
  using S = Scalar<T>;
  if (!absorption) return amount;
  const T way = (S(1) / cosIn + S(1) / cosOut) * S(thickness);
  const Rgb<T> depth = modulate<T>(*absorption, uv, way);
  // Beyond, derivatives would be zero times what may leave float's range.
  const auto left = [](const T& x) { return value(x) < S(80) ? T(ad::exp(T(-x))) : T(S(0)); };
  return {amount.x * left(depth.x), amount.y * left(depth.y), amount.z * left(depth.z)};
}

template <class Interface>
template <class T>
[[gnu::noinline]] BsdfValue<T> Coat<Interface>::evaluate(const Vec2<T>& uv, const Vec3<T>& wi,
                                                         const Vec3<T>& wo) const {
  using S = Scalar<T>;
  BsdfValue<T> r = BsdfValue<T>::zero();
  if (!(value(wi.z) > 0 && value(wo.z) > 0)) return r;
  Vec3<T> in, out;
  const bool entersI = refractIn(wi, in), entersO = refractIn(wo, out);
  const T bi = entersI ? belowProbability(wi.z) : T(S(0));
  const T bo = entersO ? belowProbability(wo.z) : T(S(0));
  if (entersI && entersO) {
    const S eta = interface.eta, inverseEta2 = S(1) / (eta * eta);
    const BsdfValue<T> e = detail::evaluateBelow<T>(*below, gain<S>(), uv, in, out);
    const T jacobian = wo.z * inverseEta2 / out.z;
    const T share = interface.transmitted(wi.z) * interface.transmitted(wo.z) * jacobian;
    r.value = absorbed<T>(e.value * share, uv, in.z, out.z);
    r.pdf = bi * e.pdf * jacobian;
    r.pdfReverse = bo * e.pdfReverse * T(wi.z * inverseEta2 / in.z);
  }
  if constexpr (Interface::kRough) {
    const FacetReflection<T> coat = interface.facets.reflect(wi, wo);
    if (value(coat.pdf) > 0) {
      const T f = fresnelDielectric(coat.cosHalf, S(interface.eta));
      r.value = r.value + modulate<T>(*specular, uv, coat.pdf * coat.weight * f * S(specularScale));
      r.pdf = r.pdf + coat.pdf * (S(1) - bi);
      r.pdfReverse = r.pdfReverse + coat.pdfReverse * (S(1) - bo);
    }
  }
  return r;
}

template <class Interface>
template <class T>
[[gnu::noinline]] SampledBsdf<T> Coat<Interface>::sampled(const Vec2<T>& uv, const Vec3<T>& wi,
                                                          const Vec3<T>& wo) const {
  using S = Scalar<T>;
  SampledBsdf<T> r = SampledBsdf<T>::zero();
  if (!(value(wi.z) > 0 && value(wo.z) > 0)) return r;
  Vec3<T> in, out;
  const bool entersI = refractIn(wi, in), entersO = refractIn(wo, out);
  const T bi = entersI ? belowProbability(wi.z) : T(S(0));
  SampledBsdf<T> e = SampledBsdf<T>::zero();
  if (entersI && entersO) {
    const S eta = interface.eta, inverseEta2 = S(1) / (eta * eta);
    e = detail::sampledBelow<T>(*below, gain<S>(), uv, in, out);
    e.pdf = e.pdf * T(wo.z * inverseEta2 / out.z);
    e.pdfReverse = e.pdfReverse * T(wi.z * inverseEta2 / in.z);
    // The weight's Jacobian and that of the density are the same.
    e.weight = absorbed<T>(e.weight * interface.transmitted(wo.z), uv, in.z, out.z);
  }
  const T bo = entersO ? belowProbability(wo.z) : T(S(0));
  if constexpr (Interface::kRough) {
    const FacetReflection<T> coat = interface.facets.reflect(wi, wo);
    const T si = S(1) - bi;
    r.pdf = bi * e.pdf + coat.pdf * si;
    if (!(value(r.pdf) > 0)) return r;
    r.pdfReverse = bo * e.pdfReverse + coat.pdfReverse * (S(1) - bo);
    const MixtureShares<T> shares(e.pdf, coat.pdf, bi, si);
    if (value(e.pdf) > 0) r.weight = e.weight * T(interface.transmitted(wi.z) * shares.first);
    if (value(coat.pdf) > 0) {
      const T f = fresnelDielectric(coat.cosHalf, S(interface.eta));
      r.weight =
          r.weight + modulate<T>(*specular, uv, coat.weight * f * shares.second * S(specularScale));
    }
  } else {
    if (!(value(e.pdf) > 0 && value(bi) > 0)) return r;
    r.pdf = bi * e.pdf;
    r.pdfReverse = bo * e.pdfReverse;
    r.weight = e.weight * entering(wi.z);
  }
  return r;
}

template <class Interface>
template <class T>
[[gnu::noinline]] Vec3<T> Coat<Interface>::sample(const Vec2<T>& uv, const Vec3<T>& wi, int lobe,
                                                  const T& u0, const T& u1) const {
  if (drawnOutside(lobe)) return sampleCosine(u0, u1);
  if (!(value(wi.z) > 0)) return noDirection<T>();
  if (lobe == kSpecular) {
    if constexpr (Interface::kRough) {
      const Vec3<T> m = interface.facets.sample(wi, u0, u1);
      return m * (ad::dot(wi, m) * Scalar<T>(2)) - wi;
    }
    return noDirection<T>();
  }
  Vec3<T> in;
  if (!refractIn(wi, in)) return noDirection<T>();
  return refractOut(std::visit(
      [&](const auto& b) -> Vec3<T> {
        return b.template sample<T>(uv, in, lobe - kFirstBelow, u0, u1);
      },
      below->bsdf));
}

template <class Interface>
template <class T>
[[gnu::noinline]] T Coat<Interface>::lobePdf(const Vec2<T>& uv, const Vec3<T>& wi,
                                             const Vec3<T>& wo, int lobe) const {
  using S = Scalar<T>;
  if (!(value(wi.z) > 0 && value(wo.z) > 0) || lobe >= lobes()) return T(S(0));
  Vec3<T> in, out;
  const bool enters = refractIn(wi, in);
  const T bi = enters ? belowProbability(wi.z) : T(S(0));
  if (lobe == kSpecular) {
    if constexpr (Interface::kRough) return interface.facets.reflect(wi, wo).pdf * (S(1) - bi);
    return T(S(0));
  }
  if (!(enters && refractIn(wo, out))) return T(S(0));
  const S eta = interface.eta;
  const T inner = std::visit(
      [&](const auto& b) -> T { return b.template lobePdf<T>(uv, in, out, lobe - kFirstBelow); },
      below->bsdf);
  return bi * inner * T(wo.z / out.z * (drawnOutside(lobe) ? S(1) : S(1) / (eta * eta)));
}

template <class Interface>
template <class T>
[[gnu::noinline]] DeltaSample<T> Coat<Interface>::sampleDelta(const Vec2<T>& uv, const Vec3<T>& wi,
                                                              int lobe) const {
  using S = Scalar<T>;
  if (!(value(wi.z) > 0) || !isDelta(lobe)) return DeltaSample<T>::none();
  Vec3<T> in;
  const bool enters = refractIn(wi, in);
  const S probability = enters ? belowProbability(value(wi.z)) : S(0);
  if (lobe == kSpecular) {
    if (!(probability < S(1))) return DeltaSample<T>::none();
    // Reflectance over 1 - probability.
    const S odds = (S(1) - S(specularWeight)) / S(specularWeight);
    const T weight =
        enters ? T(interface.reflected(wi.z) + interface.transmitted(wi.z) * odds) : T(S(1));
    const Rgb<T> r = modulate<T>(*specular, uv, weight * S(specularScale));
    return {mirrored(wi), r, r, S(1) - probability};
  }
  if (!(probability > 0)) return DeltaSample<T>::none();
  DeltaSample<T> d = std::visit(
      [&](const auto& b) -> DeltaSample<T> {
        return b.template sampleDelta<T>(uv, in, lobe - kFirstBelow);
      },
      below->bsdf);
  // A mirror inside is one outside, and has no Jacobian.
  d.wo = mirrored(wi);
  d.radiance =
      absorbed<T>(d.radiance * T(entering(wi.z) * interface.transmitted(wi.z)), uv, in.z, in.z);
  d.importance = d.radiance;
  d.probability = d.probability * probability;
  return d;
}

}  // namespace h2mc
