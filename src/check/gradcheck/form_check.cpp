// SPDX-License-Identifier: MIT
#include "check/gradcheck/form_check.h"

#include <algorithm>
#include <cmath>

#include "render/core/index.h"
#include "render/core/random.h"
#include "render/core/unit_interval.h"
#include "render/path/replay_double.h"

namespace h2mc {
namespace {

// Neighbouring paths that tell rounding from mistakes, and how far they lie away: this share of the
// length on which the target varies, but some units of the coordinates' last place.
constexpr int kNeighbours = 16;
constexpr double kDistance = 0x1p-6, kShortest = 0x1p-22;
// Nearer ones, that tell what a few of these units make of a derivative; a unit, of a coordinate near 1;
// and how many times kShortest they may lie away where float's points are coarse.
constexpr int kNearer = 128;
constexpr double kUnit = 0x1p-24, kMostMagnified = 0x1p6;
// How much more than the value's a derivative's relative error may be, when both are rounding.
constexpr double kMagnified = 10;
// Where the target traced in float is off by so much, its path and the one in double have parted.
constexpr double kAnotherPath = 0.5;
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
  const auto row = at((std::sqrt(8.0 * static_cast<double>(k) + 1) - 1) / 2);
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

// How many times larger than their own the rounding of points, and of coordinates on a primitive, is as that
// of directions between them: how far from the origin they are and how large the primitive is, over what
// they are apart, where that is most.
double magnification(const Scene& scene, const Path& path) {
  double most = 1;
  const auto size = [&](const TracedVertex& v) {
    const double area = primitiveArea(scene.shapes[v.id.shape], v.id.primitive);
    return std::max(double(glm::length(v.vertex.point.p)), std::sqrt(area));
  };
  const auto look = [&](const TracedVertex& a, const TracedVertex& b) {
    const double apart = glm::distance(a.vertex.point.p, b.vertex.point.p);
    if (apart > 0) most = std::max(most, std::max(size(a), size(b)) / apart);
  };
  const auto [s, t] = path.technique;
  const int last = path.escaped ? t - 2 : t - 1;
  if (last >= 1) {
    const TracedVertex& first = path.camera[1];
    const Vec3f& eye = first.vertex.line.origin;
    most = std::max(most, size(first) / glm::distance(eye, first.vertex.point.p));
  }
  for (int i = 1; i < last; ++i) look(path.camera[at(i)], path.camera[at(i) + 1]);
  for (int i = 1; i < s - 1; ++i) look(path.light[at(i)], path.light[at(i) + 1]);
  return std::min(most, kMostMagnified);
}

// How far the derivatives in double of paths nearby are from those of the path, at most.
struct Spread {
  double value = 0, gradient = 0, hessian = 0;
  bool atBorder = false;  // some of them carry no light

  void add(const ad::DerivativeValues& there, const ad::DerivativeValues& here) {
    value = std::max(value, std::abs(there.value - here.value));
    gradient = std::max(gradient, distance(there.gradient, here.gradient, false));
    hessian = std::max(hessian, distance(there.hessian, here.hessian, true));
  }
};

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

// Moves `near` by up to reach[i] along each coordinate. False if no light comes that way, or the derivative
// in double is not finite there; its topology may be another: it is a path all the same.
bool neighbour(const Scene& scene, const std::vector<double>& reach,
               const GradcheckSettings& settings, Random& random, Path& near,
               ad::DerivativeValues& there) {
  const auto own = at(near.technique.dimension());
  const bool moving = near.moving;
  double u[kMaxCoordinates];
  pathCoordinates(near, u);
  float shared[kMostShared];
  for (std::size_t i = 0; i < reach.size(); ++i) {
    const double moved = u[i] + reach[i] * (2 * random.uniformDouble() - 1);
    (i < own ? near.sample.u[i] : shared[i - own]) = toUnitInterval(moved);
  }
  setShared(near.shared(), shared, near.sample);
  if (!tracePath(scene, near) || near.moving != moving) return false;
  pathCoordinates(near, u);
  there = settings.exact ? settings.exact(scene, near, u) : differentiateInDouble(scene, near, u);
  return there.finite();
}

// What a form's errors are on neighbours some way off, kNeighbours of them at most.
struct Neighbourhood {
  explicit Neighbourhood(std::size_t n) : value(1), gradient(n), hessian(n * (n + 1) / 2) {}
  Scatter value;  // of the target as it is traced in float
  Scatter gradient, hessian;
  int count = 0;

  bool enough() const { return count >= kNeighbours / 2; }
  double valueError() const { return std::sqrt(value.squares[0] / std::max(count, 1)); }
};
Neighbourhood neighbourhoodOf(const Scene& scene, const Path& path,
                              const ad::DerivativeValues& exact, const DerivativeForm& form,
                              const GradcheckSettings& settings, Random& random) {
  std::vector<double> reach = ad::coordinateScales(exact);
  for (double& r : reach) r = std::max(kShortest, kDistance / r);
  Neighbourhood result(reach.size());
  for (int k = 0; k < kNeighbours; ++k) {
    Path near = path;
    ad::DerivativeValues there, inFloat;
    if (!neighbour(scene, reach, settings, random, near, there)) continue;
    if (!form.differentiate(scene, near, inFloat) || !inFloat.finite()) continue;
    ++result.count;
    result.value.add({std::log(double(near.target))}, {there.value});
    result.gradient.add(inFloat.gradient, there.gradient);
    result.hessian.add(inFloat.hessian, there.hessian);
  }
  return result;
}

// Of paths that float can't tell from this one: from one unit of the last place of coordinates near 1 on.
Spread spreadAround(const Scene& scene, const Path& path, const ad::DerivativeValues& exact,
                    const GradcheckSettings& settings, Random& random) {
  const double furthest = kShortest * magnification(scene, path);
  Spread result;
  for (int k = 0; k < kNearer; ++k) {
    const double reach = kUnit * std::pow(furthest / kUnit, double(k) / (kNearer - 1));
    Path near = path;
    ad::DerivativeValues there;
    if (neighbour(scene, std::vector<double>(exact.gradient.size(), reach), settings, random, near,
                  there))
      result.add(there, exact);
    else
      result.atBorder = true;
  }
  return result;
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

  Random random(settings.seed, kStream, 0);
  const Neighbourhood around = neighbourhoodOf(scene, path, exact, form, settings, random);
  const Spread spread = spreadAround(scene, path, exact, settings, random);
  // By how much the target is off as it is traced in float: no business of the derivative's.
  const double off = std::abs(std::log(double(path.target)) - exact.value);
  const double own = tolerance + kMagnified * std::max(off, double(result.value));
  const double allowed = tolerance + kMagnified * std::max(off, around.valueError());
  const auto explained = [&](double error, double furthest, const Scatter& scatter, double scale,
                             bool triangle) {
    return error <= own || error <= tolerance + furthest / scale ||
           (around.enough() && isRounding(scatter, around.count, allowed * scale, triangle));
  };
  const bool rounding =
      path.target < kSmallestTarget || off > kAnotherPath || spread.atBorder ||
      ((valueRight || result.value <= tolerance + spread.value) &&
       explained(result.gradient, spread.gradient, around.gradient, gradientScale, false) &&
       explained(result.hessian, spread.hessian, around.hessian, hessianScale, true));
  result.verdict = rounding ? FormVerdict::kRounding : FormVerdict::kWrong;
  return result;
}

}  // namespace h2mc
