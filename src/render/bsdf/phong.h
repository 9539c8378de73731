// SPDX-License-Identifier: MIT
// The modified Phong model [Lafortune and Willems 1994, "Using the Modified Phong Reflectance Model
// for Physically Based Rendering"].
#pragma once

#include "render/bsdf/lobe_kinds.h"
#include "render/bsdf/unary.h"
#include "render/core/frame.h"
#include "render/core/hemisphere.h"
#include "render/texture/texture.h"

namespace h2mc {

struct Phong : NonDeltaLobes {
  static constexpr int kLobes = 2;
  static constexpr int kSpecular = 0, kDiffuse = 1;
  TexturePtr diffuse, specular;
  float exponent = 30;
  float scale = 1;           // of both reflectances, to conserve energy
  float specularWeight = 0;  // probability of the specular lobe

  bool transmits() const { return false; }

  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return BsdfValue<T>::zero();
    const S invPi = kInvPiOf<T>, n = exponent, ws = specularWeight, wd = S(1) - ws;
    const T lobe = cosinePower(wi, wo);
    BsdfValue<T> r;
    r.value = modulate<T>(*diffuse, uv, wo.z * (invPi * S(scale))) +
              modulate<T>(*specular, uv, lobe * wo.z * ((n + S(2)) * S(0.5) * invPi * S(scale)));
    const T shared = lobe * (ws * (n + S(1)) * S(0.5) * invPi);
    r.pdf = shared + wo.z * (wd * invPi);
    r.pdfReverse = shared + wi.z * (wd * invPi);
    return r;
  }
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return SampledBsdf<T>::zero();
    const S n = exponent, ws = specularWeight, wd = S(1) - ws;
    const T base = wo.z * kInvPiOf<T>;
    const T lobe = cosinePower(wi, wo) * (S(0.5) * kInvPiOf<T>);
    const S drawn = ws * (n + S(1));
    const T shared = lobe * drawn;
    SampledBsdf<T> r;
    r.pdf = shared + base * wd;
    r.pdfReverse = shared + wi.z * (wd * kInvPiOf<T>);
    if (!(value(r.pdf) > 0)) return SampledBsdf<T>::zero();
    const MixtureShares<T> shares(base, lobe, wd, drawn);
    r.weight = modulate<T>(*diffuse, uv, shares.first * S(scale)) +
               modulate<T>(*specular, uv, shares.second * wo.z * ((n + S(2)) * S(scale)));
    return r;
  }
  float lobeSplit(const Vec2f&, const Vec3f&, float, float) const { return specularWeight; }
  int chooseLobe(const Vec2f&, const Vec3f&, float, float, float choice) const {
    return choice < specularWeight ? kSpecular : kDiffuse;
  }
  template <class T>
  Vec3<T> sample(const Vec2<T>&, const Vec3<T>& wi, int lobe, const T& u0, const T& u1) const {
    using S = Scalar<T>;
    if (lobe == kDiffuse) return sampleCosine(u0, u1);
    if (!(value(wi.z) > 0)) return noDirection<T>();
    // cos^(n + 1) of the angle to the mirror direction is 1 - u0.
    const T x = ad::log1p(T(-awayFromPole(u0))) * (S(1) / (S(exponent) + S(1)));
    const T sin2 = -ad::expm1(T(x * S(2)));
    const Vec3<T> local = fromPolar<T>(ad::sqrt(sin2), ad::exp(x), u1);
    return Frame<T>::fromNormal(mirrored(wi)).toWorld(local);
  }
  template <class T>
  T lobePdf(const Vec2<T>&, const Vec3<T>& wi, const Vec3<T>& wo, int lobe) const {
    using S = Scalar<T>;
    if (!(value(wi.z) > 0 && value(wo.z) > 0)) return T(0);
    const S invPi = kInvPiOf<T>, ws = specularWeight;
    if (lobe == kDiffuse) return wo.z * ((S(1) - ws) * invPi);
    return cosinePower(wi, wo) * (ws * (S(exponent) + S(1)) * S(0.5) * invPi);
  }
  bool invert(const Vec2f&, const Vec3f& wi, const Vec3f& wo, int lobe, Vec2f& u) const {
    if (!(wi.z > 0)) return false;
    if (lobe == kDiffuse) return invertCosine(wo, u);
    const auto frame = Frame<double>::fromNormal(glm::normalize(Vec3<double>(-wi.x, -wi.y, wi.z)));
    const Vec3<double> local = frame.toLocal(glm::normalize(Vec3<double>(wo)));
    if (!(local.z > 0) || !(wo.z > 0)) return false;
    const double sin2 = local.x * local.x + local.y * local.y;
    const double remainder = -std::expm1(0.5 * (exponent + 1.0) * std::log1p(-std::min(sin2, 1.0)));
    if (!(remainder < 1)) return false;
    u = {toUnitInterval(remainder), invertAzimuth(local.x, local.y)};
    return true;
  }
  float width(int lobe) const {
    return lobe == kDiffuse ? kPi / 2 : std::min(kPi / 2, std::sqrt(2 / (exponent + 2)));
  }
  Rgbf albedo() const { return (average(*diffuse) + average(*specular)) * scale; }

 private:
  // cos^n of the angle between wo and the mirror direction of wi, 0 from a right angle on. Near the
  // mirror direction from their distance d, cos = 1 - d^2 / 2: the exponent multiplies what the
  // cosine itself would have lost to rounding.
  template <class T>
  T cosinePower(const Vec3<T>& wi, const Vec3<T>& wo) const {
    using S = Scalar<T>;
    const S n = exponent;
    const Vec3<T> d(wo.x + wi.x, wo.y + wi.y, wo.z - wi.z);
    const T half = ad::length2(d) * S(-0.5);
    if (!(value(half) > S(-1))) return T(0);
    return ofOne(half, [n](const auto& h) {
      using U = std::remove_cvref_t<decltype(h)>;
      const U log = ad::log1p(h) * n;
      return value(log) > S(-80) ? U(ad::exp(log)) : U(S(0));
    });
  }
};

}  // namespace h2mc
