// SPDX-License-Identifier: MIT
#include "ad/derivative_check.h"

#include <algorithm>
#include <cmath>

namespace h2mc::ad {
namespace {

// A difference's estimated error is trusted up to this factor.
constexpr double kTrust = 10;
// An error of which rounding makes this share is rounding's: it kept the steps from being smaller.
constexpr double kNoiseShare = 0.01;
// Where the exact derivatives say that f varies on a length, steps begin at so many of it.
constexpr double kLengths = 1;
// Sweeps that look at a disagreement: each begins at smaller steps than the last one, and between
// those of the first.
constexpr std::size_t kSweeps = 8;
constexpr double kSmaller = 0.125, kStretch = 0.75;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

class Check {
 public:
  Check(const PlainFunction& f, const double* x, int n, const double* largestStep,
        const DerivativeValues& exact, double tolerance)
      : f_(f),
        x_(x),
        n_(n),
        largestStep_(largestStep, largestStep + n),
        exact_(exact),
        tolerance_(tolerance) {}

  DerivativeCheck run() {
    DerivativeCheck result;
    result.value = f_(x_);
    result.finite = std::isfinite(result.value) && exact_.finite();
    if (!result.finite) return result;
    const std::vector<double> scales = coordinateScales(exact_);
    for (int i = 0; i < n_; ++i)
      largestStep_[index(i)] = std::min(largestStep_[index(i)], kLengths / scales[index(i)]);
    sweep_ = differenceSweep(f_, x_, n_, largestStep_.data());
    result.noise = sweep_.noise;
    result.valueError = std::abs(exact_.value - result.value);
    result.wrong += !(result.valueError <= tolerance_);
    for (int i = 0; i < n_; ++i) {
      const double exact = exact_.gradient[index(i)];
      const double scale = std::max(std::abs(exact), scales[index(i)]);
      result.gradient.push_back(judge(exact, scale, i, -1));
    }
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j <= i; ++j) {
        const double exact = exact_.hessian[index(triangleIndex(i, j))];
        const double scale = std::max(std::abs(exact), scales[index(i)] * scales[index(j)]);
        result.hessian.push_back(judge(exact, scale, i, j));
      }
    excuse(result.hessian);
    for (const EntryCheck& entry : result.gradient) count(entry, result, result.gradientError);
    for (const EntryCheck& entry : result.hessian) count(entry, result, result.hessianError);
    return result;
  }

 private:
  // What spoils one second difference, a kink across its coordinates or noise, spoils those beside it,
  // and not each of them shows that by itself. A mixed one is not judged where one of its coordinates
  // alone meets a kink, since both together reach further; nor where that by each of its coordinates twice
  // is not, or most of those beside it are not. Zeros that depend on nothing say nothing.
  void excuse(std::vector<EntryCheck>& hessian) const {
    const std::vector<EntryCheck> found = hessian;
    const auto at = [&](int i, int j) -> const EntryCheck& {
      return found[index(triangleIndex(i, j))];
    };
    const auto unjudged = [](const EntryCheck& e) {
      return e.verdict == Verdict::kKink || e.verdict == Verdict::kNoise;
    };
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j <= i; ++j) {
        if (at(i, j).verdict != Verdict::kWrong) continue;
        int bent = 0, noisy = 0, judged = 0;
        const auto look = [&](const EntryCheck& e) {
          if (&e == &at(i, j) || (e.exact == 0 && e.difference == 0)) return;
          bent += e.verdict == Verdict::kKink;
          noisy += e.verdict == Verdict::kNoise;
          judged += !unjudged(e);
        };
        for (int k = 0; k < n_; ++k)
          for (const int own : {i, j}) look(at(own, k));
        const bool across =
            i != j && (at(i, i).verdict == Verdict::kKink || at(j, j).verdict == Verdict::kKink);
        const bool both = i != j && unjudged(at(i, i)) && unjudged(at(j, j));
        if (across || both || bent + noisy > judged)
          hessian[index(triangleIndex(i, j))].verdict =
              across || bent > noisy ? Verdict::kKink : Verdict::kNoise;
      }
  }

  static void count(const EntryCheck& entry, DerivativeCheck& result, double& largest) {
    switch (entry.verdict) {
      case Verdict::kAgrees:
        ++result.agree;
        break;
      case Verdict::kNoise:
        ++result.noisy;
        return;
      case Verdict::kKink:
        ++result.kinked;
        return;
      case Verdict::kWrong:
        ++result.wrong;
        break;
    }
    largest = std::max(largest, entry.relative);
  }

  static const Difference& entryOf(const DifferenceSweep& sweep, int i, int j) {
    return j < 0 ? sweep.gradient[index(i)] : sweep.hessian[index(triangleIndex(i, j))];
  }

  // The derivative by i (j < 0) or by i and j.
  EntryCheck judge(double exact, double scale, int i, int j) {
    const Difference& d = entryOf(sweep_, i, j);
    EntryCheck entry{exact,           d.value, d.error, scale, std::abs(exact - d.value) / scale,
                     Verdict::kAgrees};
    const double allowed = tolerance_ * scale, apart = std::abs(exact - d.value);
    if (!std::isfinite(d.value)) {
      entry.verdict = Verdict::kNoise;
    } else if (apart > allowed + kTrust * d.error) {
      investigate(exact, allowed, i, j, entry);
    } else {
      entry.verdict = unresolved(exact, allowed, d);
    }
    return entry;
  }

  // The sweep number k, of ever smaller steps; 0 is the first one.
  const DifferenceSweep& sweep(std::size_t k) {
    if (k == 0) return sweep_;
    while (smaller_.size() < k) {
      std::vector<double> steps = largestStep_;
      for (double& step : steps) step *= std::pow(kSmaller, double(smaller_.size() + 1));
      smaller_.push_back(differenceSweep(f_, x_, n_, steps.data(), kStretch));
    }
    return smaller_[k - 1];
  }

  // What a disagreement is. What a sweep of smaller steps finds goes before what larger ones found.
  void investigate(double exact, double allowed, int i, int j, EntryCheck& entry) {
    const double first = entry.difference, apart = std::abs(exact - first);
    if (sweep_.noise > tolerance_) {
      entry.verdict = Verdict::kNoise;  // f itself is no better
      return;
    }
    bool stable = true, confirmed = false;
    for (std::size_t k = 1; k <= kSweeps; ++k) {
      const Difference& d = entryOf(sweep(k), i, j);
      if (!std::isfinite(d.value) || 2 * d.noise > apart) break;
      confirmed = true;
      stable = stable && std::abs(d.value - first) <= allowed + kTrust * (d.error + entry.error);
      // Quotients that stop converging where rounding would not keep them from it.
      if (d.error > 0.2 * apart && d.error > kTrust * d.noise) stable = false;
      if (std::abs(exact - d.value) > allowed + kTrust * d.error) continue;
      if (std::abs(first - d.value) <= allowed + kTrust * d.error) {
        // It contradicts neither; but it may know better than the first.
        stable = stable && std::abs(exact - d.value) > 0.5 * std::abs(first - d.value);
        continue;
      }
      entry.difference = d.value;
      entry.error = d.error;
      entry.relative = std::abs(exact - d.value) / entry.scale;
      entry.verdict = unresolved(exact, allowed, d);
      return;
    }
    if (!confirmed)
      entry.verdict = Verdict::kNoise;  // or a kink so near that it looks like noise
    else
      entry.verdict = stable && !kinked(apart, i, j) ? Verdict::kWrong : Verdict::kKink;
  }

  // The verdict on a difference that does not contradict.
  static Verdict unresolved(double exact, double allowed, const Difference& d) {
    if (d.error <= allowed && std::abs(exact - d.value) <= allowed) return Verdict::kAgrees;
    return d.noise > kNoiseShare * d.error ? Verdict::kNoise : Verdict::kKink;
  }

  // Whether a kink at x explains the disagreement: along the axes, and between them.
  bool kinked(double apart, int i, int j) {
    const double hi = largestStep_[index(i)] / 4, hj = j < 0 ? 1 : largestStep_[index(j)] / 4;
    const auto along = [&](double a, double b) {
      std::vector<double> direction(index(n_));
      direction[index(i)] = a * hi;
      if (j >= 0 && j != i) direction[index(j)] = b * hj;
      return kinkAt(f_, x_, n_, direction.data(), sweep_.noise, 0.5 * apart * hi * hj);
    };
    return along(1, 0) || (j >= 0 && j != i && (along(0, 1) || along(1, 1) || along(1, -1)));
  }

  const PlainFunction& f_;
  const double* x_;
  int n_;
  std::vector<double> largestStep_;
  const DerivativeValues& exact_;
  double tolerance_;
  DifferenceSweep sweep_;
  std::vector<DifferenceSweep> smaller_;
};

}  // namespace

bool DerivativeValues::finite() const {
  const auto isFinite = [](double v) { return std::isfinite(v); };
  return isFinite(value) && std::all_of(gradient.begin(), gradient.end(), isFinite) &&
         std::all_of(hessian.begin(), hessian.end(), isFinite);
}

Verdict DerivativeCheck::verdict() const {
  if (wrong > 0) return Verdict::kWrong;
  if (kinked > 0) return Verdict::kKink;
  return noisy > 0 ? Verdict::kNoise : Verdict::kAgrees;
}

DerivativeCheck checkDerivative(const PlainFunction& f, const double* x, int n,
                                const double* largestStep, const DerivativeValues& exact,
                                double tolerance) {
  return Check(f, x, n, largestStep, exact, tolerance).run();
}

std::vector<double> coordinateScales(const DerivativeValues& exact) {
  constexpr int kIterations = 12;  // each halves the logarithm of what is missing
  const auto n = static_cast<int>(exact.gradient.size());
  std::vector<double> scales(exact.gradient.size(), 1.0), rows(exact.gradient.size());
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (int i = 0; i < n; ++i) {
      rows[index(i)] = 0;
      for (int j = 0; j < n; ++j)
        rows[index(i)] = std::max(
            rows[index(i)], std::abs(exact.hessian[index(triangleIndex(i, j))]) / scales[index(j)]);
    }
    for (int i = 0; i < n; ++i)
      scales[index(i)] = std::max(1.0, std::sqrt(rows[index(i)] * scales[index(i)]));
  }
  return scales;
}

}  // namespace h2mc::ad
