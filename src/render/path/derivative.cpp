#include "render/path/derivative.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// Above this many coordinates the local form is faster (README, Speed).
constexpr int kMostForPlain = 8;
static_assert(kMostForPlain <= kMaxPlainDimension);

// Where light grazes something perfectly smooth, and near glass' critical angle, the second derivatives of
// the cosines on both sides are large, and all but cancel. How large they are: the sum of 1 / cos^2 over the
// directions before and after all such vertices; 0 if the path meets nothing of the kind.
float smoothCurvature(const Scene& scene, const Path& path) {
  float sum = 0;
  const auto add = [&](const std::vector<TracedVertex>& subpath, int scatterings, int vertices) {
    for (int i = 1; i <= scatterings; ++i) {
      const TracedVertex& v = subpath[static_cast<std::size_t>(i)];
      if (v.lobe.null || !isDelta(scene.bsdfs, materialAt(scene, v.id), v.lobe)) continue;
      const SurfacePoint<float>& point = v.vertex.point;
      const Vec3f onwards =
          i + 1 < vertices
              ? glm::normalize(subpath[static_cast<std::size_t>(i) + 1].vertex.point.p - point.p)
              : path.lastRay.direction;
      sum += 1 / squared(v.vertex.wi.z) + 1 / squared(glm::dot(point.shading.n, onwards));
    }
  };
  const auto [s, t] = path.technique;
  add(path.camera, path.technique.cameraScatterings(), path.escaped ? t - 1 : t);
  add(path.light, path.technique.lightScatterings(), s);
  return sum;
}

// By how much a Hessian's rounding may be magnified, and how large those derivatives may be, before it is
// worth the time to do it in double.
constexpr float kMostMagnified = 16, kMostCurvature = 64;

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

}  // namespace

bool Derivative::finite() const {
  // A sum is finite only if all of its terms are (up to overflow, which is no use either).
  float sum = std::abs(logTarget);
  for (int i = 0; i < dimension; ++i) sum += std::abs(gradient[i]);
  for (int i = 0; i < dimension * (dimension + 1) / 2; ++i) sum += std::abs(hessian[i]);
  return sum <= std::numeric_limits<float>::max();
}

bool differentiatePlainly(const Scene& scene, const Path& path, Derivative& result) {
  result.dimension = path.dimension();
  return result.dimension <= kMaxPlainDimension && !path.moving &&
         smoothCurvature(scene, path) == 0 && dispatch<2>(scene, path, result);
}

void differentiateLocally(const Scene& scene, const Path& path, Derivative& result) {
  result.dimension = path.dimension();
  float magnified = std::numeric_limits<float>::infinity();
  if (smoothCurvature(scene, path) <= kMostCurvature &&
      !differentiateInFloat(scene, path, result, magnified))
    return noDerivatives(result);
  if (magnified > kMostMagnified && !differentiateByDouble(scene, path, result))
    noDerivatives(result);
}

void differentiate(const Scene& scene, const Path& path, Derivative& result) {
  if (path.dimension() > kMostForPlain || !differentiatePlainly(scene, path, result))
    differentiateLocally(scene, path, result);
}

}  // namespace h2mc
