// SPDX-License-Identifier: MIT
#include "render/bsdf/rough_transmittance.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>

#include "render/bsdf/fresnel.h"
#include "render/bsdf/quadrature.h"
#include "render/core/index.h"
#include "render/core/parallel.h"

namespace h2mc {

namespace {

using Vec = Vec3<double>;

// 1 - F, times the far side's masking, for one facet m (any length).
double throughFacet(const Microfacet& facets, double eta, const Vec& wi, const Vec& facet) {
  const Vec m = glm::normalize(facet);
  const double c = dot(wi, m);
  const double cosFar2 = 1 - (1 - c * c) / (eta * eta);
  if (!(c > 0 && cosFar2 > 0)) return 0;
  const double down = (wi.z - c * m.z) / eta + std::sqrt(cosFar2) * m.z;  // -wo.z
  if (!(down > 0)) return 0;
  return transmitDielectric(c, eta) * facets.maskingOverCos(down) * down;
}

// F times the masking of what is reflected by one facet m (any length).
double reflectedByFacet(const Microfacet& facets, double eta, const Vec& wi, const Vec& facet) {
  const Vec m = glm::normalize(facet);
  const double c = dot(wi, m), up = 2 * c * m.z - wi.z;
  if (!(c > 0 && up > 0)) return 0;
  return fresnelDielectric(c, eta) * facets.maskingOverCos(up) * up;
}

// The density of slopes over that of GGX, where 1 + p^2 + q^2 = 1 / c^2 in units of alpha.
double overGgx(const Microfacet& facets, double c) {
  if (facets.distribution == FacetDistribution::kGgx) return 1;
  // Phong: alpha^2 (e + 2) / (2 pi) cos^(e + 4) dp dq.
  const double a2 = double(facets.alpha) * double(facets.alpha), c2 = c * c;
  const double e = std::max(2 / a2 - 2, 0.0), cos2 = c2 / (c2 + a2 * (1 - c2));
  return a2 * (e + 2) / 2 * std::pow(cos2, e / 2 + 2) / (c2 * c2);
}

// Diffuse light that goes through, 2 int_0^1 T(c) c dc. The flux of diffuse light of one radiance through an interface
// that is reciprocal is the same both ways, per square of the index: the share from inside is that from outside over
// eta^2. Each is computed from the side that has no total reflection, whose border quadratures resolve badly.

// From outside, exactly that of the spline, whose pieces are cubics in sqrt(c).
template <class Pieces>
double splineMean(const Pieces& pieces) {
  static const auto nodes = gaussLegendre(4);  // exact up to degree 7
  double sum = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& p = pieces[i];
    for (const auto& [t, weight] : nodes) {
      const double x = static_cast<double>(i) + t;
      sum += weight * (((t * p.c3 + p.c2) * t + p.c1) * t + p.c0) * x * x * x;
    }
  }
  return sum * 4 / std::pow(static_cast<double>(pieces.size()), 4);
}

// From inside, for an outside of the higher index.
double meanFromInside(const Microfacet& facets, double eta) {
  double through = 0;
  for (const auto& [s, weight] : gaussLegendre(48))
    through += weight * 4 * s * s * s * RoughTransmittance::integrate(facets, 1 / eta, s * s);
  return through;
}

// E over visible facets of f(m). With facet slopes (p, q) / alpha = their unit version,
// p along wi, the visible normals have density G1(wi) / cos(wi) P22(p, q) (cos(wi) + alpha p sin(wi)).
template <class F>
double overVisibleFacets(const Microfacet& facets, double eta, double cosine, F&& f) {
  // Total reflection cuts the integrand off with a root: more nodes there.
  static const auto few = gaussLegendre(48), half = gaussLegendre(24), many = gaussLegendre(96);
  const auto &nodes = eta < 1 ? many : few, &halfNodes = eta < 1 ? few : half;
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)), a = facets.alpha;
  const Vec wi(sine, 0, cosine);
  double sum = 0;
  if (facets.distribution != FacetDistribution::kBeckmann) {
    // p = tan(t), q = tan(s) / cos(t): P22 dp dq = cos(t) cos(s)^2 / pi dt ds.
    const double quarter = std::numbers::pi / 2, start = -std::atan2(cosine, a * sine);
    for (const auto& [x, wx] : nodes) {
      const double t = start + (quarter - start) * x;
      const double visible = std::cos(t) * cosine + a * std::sin(t) * sine;
      double inner = 0;
      for (const auto& [y, wy] : halfNodes) {
        const double s = quarter * y, cs = std::cos(s);
        inner += wy * cs * cs * overGgx(facets, std::cos(t) * cs) *
                 f(facets, eta, wi, Vec(a * std::sin(t) * cs, a * std::sin(s), std::cos(t) * cs));
      }
      sum += wx * (quarter - start) * visible * inner * 2 * quarter * std::numbers::inv_pi;
    }
  } else {
    // P22 = exp(-p^2 - q^2) / pi, cut off where it is below 1e-15.
    const double cut = 5.9, start = std::max(-cut, sine > 0 ? -cosine / (a * sine) : -cut);
    for (const auto& [x, wx] : nodes) {
      const double p = start + (cut - start) * x;
      const double visible = cosine + a * p * sine;
      double inner = 0;
      for (const auto& [y, wy] : halfNodes) {
        const double q = cut * y;
        inner += wy * std::exp(-q * q) * f(facets, eta, wi, Vec(a * p, a * q, 1));
      }
      sum +=
          wx * (cut - start) * visible * std::exp(-p * p) * inner * 2 * cut * std::numbers::inv_pi;
    }
  }
  return sum * facets.maskingOverCos(cosine);
}

}  // namespace

double RoughTransmittance::integrate(const Microfacet& facets, double eta, double cosine) {
  return overVisibleFacets(facets, eta, cosine, throughFacet);
}

double RoughTransmittance::reflected(const Microfacet& facets, double eta, double cosine) {
  return overVisibleFacets(facets, eta, cosine, reflectedByFacet);
}

double RoughTransmittance::facetsInternalReflectance(const Microfacet& facets, double eta) {
  using Key = std::tuple<FacetDistribution, float, double>;
  static std::mutex mutex;
  static std::map<Key, double> known;
  const std::scoped_lock lock(mutex);
  const auto [entry, isNew] = known.try_emplace({facets.distribution, facets.alpha, eta}, 0);
  if (!isNew) return entry->second;
  constexpr int kCosines = 64;
  std::vector<double> shares(kCosines);
  parallelFor(0, kCosines, [&](int i) {
    const double c = std::max(1e-6, i / (kCosines - 1.0));
    shares[at(i)] = reflected(facets, 1 / eta, c) * c;
  });
  double sum = 0;
  for (const double share : shares) sum += share;
  return entry->second = 2 * sum / kCosines;
}

RoughTransmittance::RoughTransmittance(const Microfacet& facets, double eta) {
  constexpr int n = kIntervals;
  std::vector<double> f(n + 1), m(n + 1), diagonal(n + 1), right(n + 1);
  parallelFor(0, n + 1,
              [&](int i) { f[at(i)] = integrate(facets, eta, double(i) * i / (double(n) * n)); });
  // Slopes m per interval of a spline with m[0] = 0 (the function is smooth in c, so even in
  // sqrt(c)) and a one-sided difference at the other end: m[i-1] + 4 m[i] + m[i+1] = 3 (f[i+1] -
  // f[i-1]).
  m[0] = 0;
  m[n] = (11 * f[n] - 18 * f[n - 1] + 9 * f[n - 2] - 2 * f[n - 3]) / 6;
  diagonal[0] = 1;
  right[0] = 0;
  for (int i = 1; i < n; ++i) {
    const double below = i == 1 ? 0 : 1 / diagonal[i - 1];
    diagonal[i] = 4 - below;
    right[i] = 3 * (f[i + 1] - f[i - 1]) - (i == n - 1 ? m[n] : 0) - below * right[i - 1];
  }
  for (int i = n - 1; i >= 1; --i) m[i] = (right[i] - (i == n - 1 ? 0 : m[i + 1])) / diagonal[i];
  // Where total reflection begins the function has a corner, around which the spline would swing below zero: slopes
  // with which each piece is monotonic [Fritsch and Carlson 1980].
  if (eta < 1) {
    for (int i = 0; i <= n; ++i) {
      const double before = i > 0 ? f[at(i)] - f[at(i) - 1] : f[1] - f[0];
      const double after = i < n ? f[at(i) + 1] - f[at(i)] : before;
      if (before * after > 0)
        m[at(i)] = std::copysign(
            std::min(std::abs(m[at(i)]), 3 * std::min(std::abs(before), std::abs(after))), after);
      else
        m[at(i)] = 0;
    }
  }
  pieces_.resize(n);
  for (int i = 0; i < n; ++i) {
    const double rise = f[i + 1] - f[i];
    pieces_[at(i)] = {f[i], m[i], 3 * rise - 2 * m[i] - m[i + 1], m[i] + m[i + 1] - 2 * rise};
  }

  internalReflectance_ =
      1 - (eta > 1 ? splineMean(pieces_) / (eta * eta) : meanFromInside(facets, eta));
}

std::shared_ptr<const RoughTransmittance> RoughTransmittance::shared(const Microfacet& facets,
                                                                     double eta) {
  using Key = std::tuple<FacetDistribution, float, double>;
  static std::mutex mutex;
  static std::map<Key, std::weak_ptr<const RoughTransmittance>> known;
  const std::scoped_lock lock(mutex);
  auto& entry = known[{facets.distribution, facets.alpha, eta}];
  if (auto made = entry.lock()) return made;
  auto made = std::make_shared<const RoughTransmittance>(facets, eta);
  entry = made;
  return made;
}

}  // namespace h2mc
