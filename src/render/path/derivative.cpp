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
  return !path.moving && dispatch<2>(scene, path, result);
}

void differentiateLocally(const Scene& scene, const Path& path, Derivative& result) {
  static thread_local ad::Composition<float> composition;
  result.dimension = path.dimension();
  float u[kMaxDerivativeDimension];
  std::copy_n(path.sample.u.begin(), path.technique.dimension(), u);
  if (path.moving) u[path.technique.dimension()] = path.sample.time;
  const int target = path.moving ? LocalForm<float, true>(scene, path, composition).logTarget(u)
                                 : LocalForm<float, false>(scene, path, composition).logTarget(u);
  if (target < 0) {
    // A factor has underflowed: no derivatives.
    result.logTarget = -std::numeric_limits<float>::infinity();
    std::fill_n(result.gradient, result.dimension, 0.f);
    std::fill_n(result.hessian, result.dimension * (result.dimension + 1) / 2, 0.f);
    return;
  }
  result.logTarget = composition.value(target);
  composition.differentiate(target, result.gradient, result.hessian);
}

void differentiate(const Scene& scene, const Path& path, Derivative& result) {
  if (path.dimension() > kMostForPlain || !differentiatePlainly(scene, path, result))
    differentiateLocally(scene, path, result);
}

}  // namespace h2mc
