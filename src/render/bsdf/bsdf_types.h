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

template <class T>
struct DeltaSample {
  Vec3<T> wo;
  Rgb<T> radiance;  // coefficient of radiance from wo to wi
  Rgb<T>
      importance;  // coefficient of importance from wo to wi, i.e. of light that travels wi -> wo
  T probability;   // of the lobe being chosen for wi; the same for wo in reverse

  // Nothing is scattered: zero coefficients, a direction in the surface and a probability that it
  // is safe to divide by.
  static DeltaSample none() { return {{T(1), T(0), T(0)}, Rgb<T>(T(0)), Rgb<T>(T(0)), T(1)}; }
};

}  // namespace h2mc
