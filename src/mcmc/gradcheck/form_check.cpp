#include "mcmc/gradcheck/form_check.h"

#include <algorithm>
#include <cmath>

#include "render/core/random.h"
#include "render/path/replay_double.h"

namespace h2mc {
namespace {

// Neighbouring paths that tell rounding from mistakes, and how far they lie away: this share of the
// length on which the target varies, but some units of the coordinates' last place.
constexpr int kNeighbours = 16;
constexpr double kDistance = 0x1p-6, kShortest = 0x1p-22;
// How much more than the value's a derivative's relative error may be, when both are rounding.
constexpr double kMagnified = 10;
// Where float's range ends, a target has no more digits.
constexpr float kSmallestTarget = 1e-36f;
constexpr std::uint64_t kStream = 0x677267;

// Sums over the neighbours of float minus double, entry by entry.
struct Scatter {
  explicit Scatter(std::size_t entries) : sum(entries), squares(entries) {}
  std::vector<double> sum, squares;

  void add(const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t k = 0; k < sum.size(); ++k) {
      const double e = a[k] - b[k];
      sum[k] += e;
      squares[k] += e * e;
    }
  }
};

double weightOf(std::size_t k, bool triangle) {
  // Off the diagonal an entry stands twice in the matrix.
  if (!triangle) return 1;
  const auto row = static_cast<std::size_t>((std::sqrt(8.0 * static_cast<double>(k) + 1) - 1) / 2);
  return k == row * (row + 3) / 2 ? 1 : 2;
}

double norm(const std::vector<double>& a, bool triangle) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += weightOf(k, triangle) * a[k] * a[k];
  return std::sqrt(sum);
}

double distance(const std::vector<double>& a, const std::vector<double>& b, bool triangle) {
  std::vector<double> difference(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) difference[k] = a[k] - b[k];
  return norm(difference, triangle);
}

// Whether the mean of `count` differences is no more than `allowed` and three standard errors.
bool isRounding(const Scatter& scatter, int count, double allowed, bool triangle) {
  double variance = 0;
  std::vector<double> mean(scatter.sum.size());
  for (std::size_t k = 0; k < mean.size(); ++k) {
    mean[k] = scatter.sum[k] / count;
    const double spread = scatter.squares[k] / count - mean[k] * mean[k];
    variance += weightOf(k, triangle) * std::max(spread, 0.0) / (count - 1);
  }
  return norm(mean, triangle) <= allowed + 3 * std::sqrt(variance);
}

// What the errors of a gradient and of a Hessian are relative to.
struct Scales {
  double gradient, hessian;
};
Scales scalesOf(const ad::DerivativeValues& exact) {
  const double hessian = std::max(1.0, norm(exact.hessian, true));
  return {std::max(std::sqrt(hessian), norm(exact.gradient, false)), hessian};
}

}  // namespace

FormCheck formErrors(const ad::DerivativeValues& found, const ad::DerivativeValues& exact) {
  FormCheck result;
  if (!found.finite()) {
    result.verdict = FormVerdict::kNotFinite;
    return result;
  }
  const Scales scales = scalesOf(exact);
  result.verdict = FormVerdict::kAgrees;
  result.value = static_cast<float>(std::abs(found.value - exact.value));
  result.gradient =
      static_cast<float>(distance(found.gradient, exact.gradient, false) / scales.gradient);
  result.hessian =
      static_cast<float>(distance(found.hessian, exact.hessian, true) / scales.hessian);
  return result;
}

FormCheck checkForm(const Scene& scene, const Path& path, const ad::DerivativeValues& exact,
                    const DerivativeForm& form, const GradcheckSettings& settings) {
  ad::DerivativeValues found;
  if (!form.differentiate(scene, path, found)) return {};
  FormCheck result = formErrors(found, exact);
  if (result.verdict == FormVerdict::kNotFinite) return result;
  const auto [gradientScale, hessianScale] = scalesOf(exact);
  const double tolerance = settings.floatTolerance;
  const auto within = [&](double error) { return error <= tolerance; };
  // The value of the float path itself is no business of the derivative's.
  const bool valueRight =
      within(result.value) || within(std::abs(found.value - std::log(double(path.target))));
  if (valueRight && within(result.gradient) && within(result.hessian)) {
    result.verdict = FormVerdict::kAgrees;
    return result;
  }

  const int n = path.dimension(), own = path.technique.dimension();
  double here[kMostCoordinates];
  pathCoordinates(path, here);
  const std::vector<double> scales = ad::coordinateScales(exact);
  Scatter value(1), gradient(exact.gradient.size()), hessian(exact.hessian.size());
  Random random(settings.seed, kStream, 0);
  Path near = path;
  int count = 0;
  for (int k = 0; k < kNeighbours; ++k) {
    for (int i = 0; i < n; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const double reach = std::max(kShortest, kDistance / scales[index]);
      const double moved = here[index] + reach * (2 * random.uniformDouble() - 1);
      (i < own ? near.sample.u[index] : near.sample.time) =
          std::clamp(static_cast<float>(moved), 0.0f, 0x1.fffffep-1f);
    }
    // Its topology may be another: it is a path all the same.
    if (!tracePath(scene, near) || near.moving != path.moving) continue;
    double u[kMostCoordinates];
    pathCoordinates(near, u);
    const ad::DerivativeValues there =
        settings.exact ? settings.exact(scene, near, u) : differentiateInDouble(scene, near, u);
    ad::DerivativeValues inFloat;
    if (!there.finite() || !form.differentiate(scene, near, inFloat) || !inFloat.finite()) continue;
    ++count;
    value.add({std::log(double(near.target))}, {there.value});
    gradient.add(inFloat.gradient, there.gradient);
    hessian.add(inFloat.hessian, there.hessian);
  }
  const double allowed = tolerance + kMagnified * std::sqrt(value.squares[0] / std::max(count, 1));
  const bool rounding =
      path.target < kSmallestTarget ||
      (valueRight && count >= kNeighbours / 2 &&
       (within(result.gradient) || isRounding(gradient, count, allowed * gradientScale, false)) &&
       (within(result.hessian) || isRounding(hessian, count, allowed * hessianScale, true)));
  result.verdict = rounding ? FormVerdict::kRounding : FormVerdict::kWrong;
  return result;
}

}  // namespace h2mc
