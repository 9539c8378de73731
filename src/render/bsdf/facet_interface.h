// SPDX-License-Identifier: MIT
// Scattering by facets that are an interface between two dielectrics [Walter et al. 2007, "Microfacet Models for
// Refraction through Rough Surfaces"]. `in` has z > 0 here; `relative` is the far side's index over the near side's.
#pragma once

#include "render/bsdf/fresnel.h"
#include "render/bsdf/microfacet.h"

namespace h2mc {

// Where `in` goes that meets a facet of unit normal m, mirrored or refracted; noDirection() where it can't.
template <class T>
Vec3<T> leaveFacet(const Vec3<T>& in, const Vec3<T>& m, bool reflects, Scalar<T> relative) {
  using S = Scalar<T>;
  const T c = ad::dot(in, m);
  if (!(value(c) > 0)) return noDirection<T>();
  if (reflects) {
    const Vec3<T> out = m * (c * S(2)) - in;
    return value(out.z) > 0 ? out : noDirection<T>();
  }
  const S inverse = S(1) / relative;
  const T cosFar2 = (c * c - S(1)) * (inverse * inverse) + S(1);
  if (!(value(cosFar2) > 0)) return noDirection<T>();
  const Vec3<T> out = m * (c * inverse - ad::sqrt(cosFar2)) - in * inverse;
  return value(out.z) < 0 ? out : noDirection<T>();
}

// The facet's normal (of any length, z > 0) by which leaveFacet() goes from `in` to `out`; false if there is none.
inline bool facetBetween(const Vec3<double>& in, const Vec3<double>& out, bool reflects,
                         double relative, Vec3<double>& h) {
  h = reflects ? in + out : in + out * relative;
  if (reflects) return true;
  if (h.z < 0) h = -h;
  return ad::dot(in, h) > 0 && ad::dot(out, h) < 0;
}

// Refraction by facets of which each lets through what its Fresnel term does.
template <class T>
struct FacetTransmission {
  T weight;           // BTDF times |cos(out)|, of radiance, over pdf
  T pdf, pdfReverse;  // of out given in, of in given out, the facet's transmittance included
  static FacetTransmission none() { return {T(0), T(0), T(0)}; }
};

// F: Facets or AnisotropicFacets; factor: of the weight; in.z > 0 > out.z. With h = in + eta out, along the facet's
// normal m, the Jacobian's (in.m + eta out.m)^2 [Walter et al., eq. 17] is |h|^2.
template <class T, class F>
FacetTransmission<T> transmitFacets(const F& surface, const Vec3<T>& in, const Vec3<T>& out,
                                    Scalar<T> relative, Scalar<T> factor) {
  using S = Scalar<T>;
  Vec3<T> h = in + out * relative;
  if (value(h.z) < 0) h = -h;
  const T h2 = ad::length2(h);
  if (!(value(h2) > Microfacet::kSmallestHalf2 && value(h.z) > 0))
    return FacetTransmission<T>::none();
  const T inverse = ad::rsqrt(h2);
  const T ci = ad::dot(in, h) * inverse, co = ad::dot(out, h) * -inverse;
  if (!(value(ci) > 0 && value(co) > 0)) return FacetTransmission<T>::none();
  const T d = surface.density(h, h2);
  if (!(value(d) > 0)) return FacetTransmission<T>::none();
  const Vec3<T> down = flipped(out);
  const T shared = d * transmitDielectric(ci, co, relative) / h2;
  const S relative2 = relative * relative;
  FacetTransmission<T> r;
  // Radiance is divided by relative^2 as it enters the denser side, which eq. 21 multiplies by.
  r.weight = surface.masking(down) * (factor / relative2);
  if (surface.distribution == FacetDistribution::kGgx) {
    const T seen = shared * ci * co;
    r.pdf = seen * surface.maskingOverCos(in) * relative2;
    r.pdfReverse = seen * surface.maskingOverCos(down);
  } else {
    const T tilt = h.z * inverse;
    const T drawn = shared * tilt;
    r.weight = r.weight * surface.maskingOverCos(in) * ci / tilt;
    r.pdf = drawn * co * relative2;
    r.pdfReverse = drawn * ci;
  }
  return r;
}

}  // namespace h2mc
