// SPDX-License-Identifier: MIT
#include "render/path/derivative.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/core/index.h"
#include "render/path/derivative_growing.h"
#include "render/path/local_form.h"

namespace h2mc {

namespace growing {
extern template struct LogTarget<2>;
extern template struct LogTarget<4>;
extern template struct LogTarget<6>;
extern template struct LogTarget<8>;
#if H2MC_DERIVATIVE_EDGES > 4
extern template struct LogTarget<10>;
extern template struct LogTarget<12>;
extern template struct LogTarget<14>;
extern template struct LogTarget<16>;
#endif
}  // namespace growing

namespace {

// Above this many coordinates the local form is faster (docs/measurements.md, what the parts cost).
constexpr int kMostForPlain = 8;
static_assert(kMostForPlain <= kMaxPlainDimension);

// What a path asks of float: the second derivatives of log |cos| are 1 / cos^2 and more where light grazes a
// surface, and before and after something perfectly smooth they all but cancel, near glass' critical angle too.
struct Demands {
  bool smooth = false;  // the path meets something perfectly smooth
  // The sum of 1 / cos^2 over the directions before and after such vertices, and of a part of it over those
  // in which the path arrives at others.
  float curvature = 0;
};
constexpr float kPartOfOthers = 1.f / 64;

Demands demandsOf(const Scene& scene, const Path& path) {
  Demands demands;
  // Of the vertices after the eye or the light, up to number `last`.
  const auto add = [&](const std::vector<TracedVertex>& subpath, int last, int scatterings) {
    for (int i = 1; i <= last; ++i) {
      const TracedVertex& v = subpath[at(i)];
      // Straight on: no derivative knows the angle.
      if (i <= scatterings && v.lobe.null) continue;
      const float before = 1 / squared(v.vertex.wi.z);
      if (i > scatterings || !isDelta(scene.bsdfs, materialAt(scene, v.id), v.lobe)) {
        demands.curvature += kPartOfOthers * before;
        continue;
      }
      const SurfacePoint<float>& point = v.vertex.point;
      const Vec3f onwards = i < last ? glm::normalize(subpath[at(i) + 1].vertex.point.p - point.p)
                                     : path.lastRay.direction;
      demands.smooth = true;
      demands.curvature += before + 1 / squared(glm::dot(point.shading.n, onwards));
    }
  };
  const auto [s, t] = path.technique;
  add(path.camera, path.escaped ? t - 2 : t - 1, path.technique.cameraScatterings());
  add(path.light, s - 1, path.technique.lightScatterings());
  return demands;
}

// By how much a Hessian's rounding may be magnified, and how large those derivatives may be, before it is
// worth the time to do it in double.
constexpr float kMostMagnified = 32, kMostCurvature = 24;

void noDerivatives(Derivative& result) {
  result.logTarget = -std::numeric_limits<float>::infinity();
  std::fill_n(result.gradient, result.dimension, 0.f);
  std::fill_n(result.hessian, result.dimension * (result.dimension + 1) / 2, 0.f);
}

// False where a factor has underflowed: no derivatives.
bool differentiateInFloat(const Scene& scene, const Path& path, Derivative& result,
                          float& magnified) {
  float u[kMaxCoordinates];
  pathCoordinates(path, u);
  magnified = composeDerivatives(scene, path, u, result.logTarget, result.gradient, result.hessian);
  return magnified >= 0;
}
bool differentiateByDouble(const Scene& scene, const Path& path, Derivative& result) {
  constexpr int kEntries = kMaxCoordinates * (kMaxCoordinates + 1) / 2;
  double u[kMaxCoordinates], value, gradient[kMaxCoordinates], hessian[kEntries];
  pathCoordinates(path, u);
  if (composeDerivatives(scene, path, u, value, gradient, hessian) < 0) return false;
  const auto toFloat = [](double x) { return static_cast<float>(x); };
  const int n = result.dimension;
  result.logTarget = toFloat(value);
  std::transform(gradient, gradient + n, result.gradient, toFloat);
  std::transform(hessian, hessian + n * (n + 1) / 2, result.hessian, toFloat);
  return true;
}

template <int N>
bool dispatch(const Scene& scene, const Path& path, Derivative& result) {
  if constexpr (N > kMaxPlainDimension) {
    return false;
  } else {
    if (result.dimension != N) return dispatch<N + 2>(scene, path, result);
    const ad::Dual2<float, N> value = growing::LogTarget<N>::evaluate(scene, path);
    result.logTarget = value.v;
    for (int i = 0, k = 0; i < N; ++i) {
      result.gradient[i] = value.gradient(i);
      for (int j = 0; j <= i; ++j, ++k) result.hessian[k] = value.hessian(i, j);
    }
    return true;
  }
}

bool plainly(const Scene& scene, const Path& path, const Demands& demands, Derivative& result) {
  result.dimension = path.dimension();
  result.inDouble = false;
  return result.dimension <= kMaxPlainDimension && path.shared().count() == 0 && !demands.smooth &&
         demands.curvature <= kMostCurvature && dispatch<2>(scene, path, result);
}

void locally(const Scene& scene, const Path& path, const Demands& demands, Derivative& result) {
  result.dimension = path.dimension();
  float magnified = std::numeric_limits<float>::infinity();
  bool found = true;
  if (demands.curvature <= kMostCurvature)
    found = differentiateInFloat(scene, path, result, magnified);
  result.inDouble = found && magnified > kMostMagnified;
  if (result.inDouble) found = differentiateByDouble(scene, path, result);
  if (!found) noDerivatives(result);
}

}  // namespace

bool Derivative::finite() const {
  // A sum is finite only if all of its terms are (up to overflow, which is no use either).
  float sum = std::abs(logTarget);
  for (int i = 0; i < dimension; ++i) sum += std::abs(gradient[i]);
  for (int i = 0; i < dimension * (dimension + 1) / 2; ++i) sum += std::abs(hessian[i]);
  return sum <= std::numeric_limits<float>::max();
}

bool differentiatePlainly(const Scene& scene, const Path& path, Derivative& result) {
  return plainly(scene, path, demandsOf(scene, path), result);
}

void differentiateLocally(const Scene& scene, const Path& path, Derivative& result) {
  locally(scene, path, demandsOf(scene, path), result);
}

void differentiate(const Scene& scene, const Path& path, Derivative& result) {
  const Demands demands = demandsOf(scene, path);
  if (path.dimension() > kMostForPlain || !plainly(scene, path, demands, result))
    locally(scene, path, demands, result);
}

}  // namespace h2mc
