// SPDX-License-Identifier: MIT
// What BSDFs return.
#pragma once

#include "render/core/types.h"

namespace h2mc {

template <class T>
struct BsdfValue {
  Rgb<T> value;  // f(wi, wo) |cos(wo)|
  T pdf;         // solid angle density of wo given wi
  T pdfReverse;  // solid angle density of wi given wo
  static BsdfValue zero() { return {Rgb<T>(T(0)), T(0), T(0)}; }
};

// What becomes of light in a direction wo that was drawn for wi. The weight is in closed form: numerator
// and density have factors in common (a cosine, a Fresnel term, the distribution of facets) whose
// second derivatives may be 1e5 times those of the quotient, more than float's digits can cancel.
template <class T>
struct SampledBsdf {
  Rgb<T> weight;  // f(wi, wo) |cos(wo)| / pdf, of radiance
  T pdf;          // as BsdfValue's
  T pdfReverse;
  Scalar<T> importance = 1;  // the weight of importance is so many times that of radiance
  static SampledBsdf zero() { return {Rgb<T>(T(0)), T(0), T(0)}; }
};

// first / pdf and second / pdf where pdf = pa first + pb second > 0 and neither is negative, such that what
// the larger one does by itself cancels.
template <class T>
struct MixtureShares {
  T first, second;

  template <class P, class Q>
  MixtureShares(const T& a, const T& b, const P& pa, const Q& pb) {
    using S = Scalar<T>;
    if (value(a) > value(b)) {
      const T ratio = b / a;
      first = S(1) / T(ratio * pb + pa);
      second = ratio * first;
    } else {
      const T ratio = a / b;
      second = S(1) / T(ratio * pa + pb);
      first = ratio * second;
    }
  }
};

// The choice coordinates in [begin, end) draw a lobe.
struct ChoiceInterval {
  float begin = 0, end = 0;
};

template <class T>
struct DeltaSample {
  Vec3<T> wo;
  Rgb<T> radiance;  // coefficient of radiance from wo to wi, over the lobe's probability
  // The same of importance, i.e. of light that travels wi -> wo.
  Rgb<T> importance;
  Scalar<T> probability;  // of the lobe being chosen for wi; the same for wo in reverse

  // Nothing is scattered: zero coefficients and a direction in the surface.
  static DeltaSample none() { return {{T(1), T(0), T(0)}, Rgb<T>(T(0)), Rgb<T>(T(0)), 1}; }
};

}  // namespace h2mc
