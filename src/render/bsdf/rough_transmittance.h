// SPDX-License-Identifier: MIT
// How much light passes a rough dielectric interface.
#pragma once

#include <memory>
#include <vector>

#include "render/bsdf/microfacet.h"
#include "render/core/index.h"

namespace h2mc {

// The share of the light arriving at cosine c that a rough interface sends to its other side
// (Fresnel transmittance over all visible facets, less what masking on the far side keeps), as a
// function with two continuous derivatives for c in (0, 1].
//
// A cubic spline in sqrt(c): near grazing incidence the function varies over c ~ alpha.
class RoughTransmittance {
 public:
  // eta: the inside's index over the outside's. Takes some 30 ms.
  RoughTransmittance(const Microfacet& facets, double eta);

  // The same, computed once while anyone holds it.
  static std::shared_ptr<const RoughTransmittance> shared(const Microfacet& facets, double eta);

  // From outside.
  template <class T>
  T evaluate(const T& cosine) const {
    return ofOne(cosine, [this](const auto& c) {
      using U = std::remove_cvref_t<decltype(c)>;
      using S = Scalar<U>;
      const U x = ad::sqrt(c) * S(kIntervals);
      const int i = std::clamp(static_cast<int>(value(x)), 0, kIntervals - 1);
      const Piece& p = pieces_[at(i)];
      const U t = x - S(i);
      return U(((t * S(p.c3) + S(p.c2)) * t + S(p.c1)) * t + S(p.c0));
    });
  }
  // Share of diffuse light that does not leave the inside.
  double internalReflectance() const { return internalReflectance_; }

  // The integral itself, from the side with relative index eta of the far medium; and that of the share that its facets
  // reflect and no other one masks.
  static double integrate(const Microfacet& facets, double eta, double cosine);
  static double reflected(const Microfacet& facets, double eta, double cosine);

  // Share of diffuse light that the inside's facets reflect, without what masking takes of it: what Mitsuba 2 and 3
  // take for internalReflectance(). Theirs is the mean over 64 cosines from 0 to 1, which differs from the integral by
  // 2 % where the interface is smooth. Computed once for all that ask for the same.
  static double facetsInternalReflectance(const Microfacet& facets, double eta);

 private:
  static constexpr int kIntervals = 128;
  struct Piece {
    double c0, c1, c2, c3;  // double: rounded, the pieces would no longer meet
  };
  std::vector<Piece> pieces_;
  double internalReflectance_ = 0;
};

}  // namespace h2mc
