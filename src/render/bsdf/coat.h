// SPDX-License-Identifier: MIT
// A layer of dielectric over another BSDF, as in [Weidlich and Wilkie 2007, "Arbitrarily Layered Micro-Facet
// Surfaces"], in Mitsuba 0.6's form: what the interface reflects, and, by Snell's law into the layer and out of
// it, what is below. Light is absorbed on its two ways through the layer and not reflected back inside:
//
//   f(wi, wo) |cos o| = specular + T(i) T(o) exp(-sigma d (1/cos i' + 1/cos o')) f'(wi', wo') |cos o'|
//                                  cos o / (eta^2 cos o')
//
// where i', o' are inside, and the last factor is d omega(wo') / d omega(wo), as well of the densities.
#pragma once

#include <memory>

#include "render/bsdf/bsdf_types.h"
#include "render/bsdf/fresnel.h"
#include "render/bsdf/microfacet.h"
#include "render/bsdf/rough_transmittance.h"

namespace h2mc {

struct SmoothInterface {
  static constexpr bool kRough = false;
  float eta = 1.5f;  // of the layer over the outside

  template <class T>
  T transmitted(const T& cosine) const {
    return transmitDielectric(cosine, Scalar<T>(eta));
  }
  template <class T>
  T reflected(const T& cosine) const {
    return fresnelDielectric(cosine, Scalar<T>(eta));
  }
};

struct RoughInterface {
  static constexpr bool kRough = true;
  float eta = 1.5f;
  Microfacet facets;
  std::shared_ptr<const RoughTransmittance> transmittance;

  template <class T>
  T transmitted(const T& cosine) const {
    return transmittance->evaluate(cosine);
  }
  template <class T>
  T reflected(const T& cosine) const {
    return Scalar<T>(1) - transmitted(cosine);
  }
};

struct CoatedBsdf;  // what is below (bsdf.h)

// Lobe 0 is the interface's, 1 + k the lobe k below. Those are drawn as they are inside and refracted, which
// loses what is reflected totally; but a cosine lobe is drawn outside, since that one, without what it would
// lose, is a cosine lobe there too.
template <class Interface>
struct Coat {
  static constexpr int kLobes = 5;
  static constexpr int kSpecular = 0, kFirstBelow = 1;
  Interface interface;
  std::shared_ptr<const CoatedBsdf> below;  // reflects only; its delta lobes are mirrors
  TexturePtr absorption;                    // sigma, per unit of length; null: none
  float thickness = 1;                      // d
  TexturePtr specular;
  float specularScale = 1;   // of the specular reflectance, to conserve energy
  float specularWeight = 0;  // below 1: share of the interface's lobe where it reflects half

  int lobes() const;  // that there are
  bool isDelta(int lobe) const;
  bool hasNonDelta() const;
  bool transmits() const { return false; }
  int chooseLobe(const Vec2f& uv, const Vec3f& wi, float u0, float u1, float choice) const;
  ChoiceInterval choiceInterval(const Vec2f& uv, const Vec3f& wi, float u0, float u1,
                                int lobe) const;
  bool invert(const Vec2f& uv, const Vec3f& wi, const Vec3f& wo, int lobe, Vec2f& u) const;
  float width(int lobe) const;
  Rgbf albedo() const;

  // Below: coat_inl.h.
  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const;
  template <class T>
  SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo) const;
  template <class T>
  Vec3<T> sample(const Vec2<T>& uv, const Vec3<T>& wi, int lobe, const T& u0, const T& u1) const;
  template <class T>
  T lobePdf(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo, int lobe) const;
  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>& uv, const Vec3<T>& wi, int lobe) const;

 private:
  // w inside the layer; false where it is reflected totally. w.z > 0.
  template <class T>
  bool refractIn(const Vec3<T>& w, Vec3<T>& inside) const;
  // And outside, noDirection() where that is.
  template <class T>
  Vec3<T> refractOut(const Vec3<T>& inside) const;
  // Probability of the lobes below, where refractIn() is true.
  template <class T>
  T belowProbability(const T& cosine) const;
  // The same for any direction, with what is inside.
  float belowShare(const Vec3f& wi, Vec3f& inside) const;
  // transmitted() over belowProbability().
  template <class T>
  T entering(const T& cosine) const;
  // What is left of it after the ways through the layer at both cosines.
  template <class T>
  Rgb<T> absorbed(const Rgb<T>& amount, const Vec2<T>& uv, const T& cosIn, const T& cosOut) const;
  bool drawnOutside(int lobe) const;
  // eta^2 - 1 where there is such a lobe: its density inside, but for the Jacobian, is to grow by so much of itself.
  template <class S>
  S gain() const;
};

using SmoothCoat = Coat<SmoothInterface>;
using RoughCoat = Coat<RoughInterface>;

}  // namespace h2mc
