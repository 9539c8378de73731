// SPDX-License-Identifier: MIT
// Checks the derivatives of the log target on paths of a scene: `h2mc gradcheck`.
//
// Two comparisons for each path:
//
//  - The AD type in double with finite differences of the same contribution in double
//    (ad/derivative_check.h: how entries are judged and what errors are relative to).
//  - Each form of the float derivatives (the plain one, the fast one) with the AD type in double, at the
//    same coordinates. Errors: the value's absolute (of a logarithm), the Hessian's relative to
//    max(1, |H|) in the Frobenius norm, the gradient's to max(|g|, root of the same). A path may
//    magnify float's rounding, of its vertices for instance, beyond any tolerance without any mistake
//    in the derivative. So where the tolerance is exceeded, float minus double is looked at on
//    neighbouring paths too: rounding changes from one to the next, a mistake doesn't. It was rounding
//    if the mean of these differences is within the tolerance, three of its standard errors and ten
//    times the neighbours' relative error of the target itself, as traced in float (what a derivative
//    has no part in); or if the target lies below 1e-36, at the end of float's range. A form's value
//    need only agree with either the double's or the traced one.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <span>

#include "ad/derivative_check.h"
#include "check/gradcheck/path_source.h"
#include "render/path/path.h"

namespace h2mc {

// A way to compute the derivatives in float.
struct DerivativeForm {
  const char* name;
  const char* description;
  // False where the form does not go so far (number of coordinates).
  bool (*differentiate)(const Scene& scene, const Path& path, ad::DerivativeValues& result);
};

// Those there are. A further form is a line in the list behind this.
std::span<const DerivativeForm> derivativeForms();
inline constexpr std::size_t kMostForms = 4;

struct GradcheckSettings {
  int paths = 1000;  // half of them from bidirectional samples, half from chains
  int maxLength = 8;
  std::uint64_t seed = 0;
  int threads = 0;               // 0: one a core
  double tolerance = 1e-6;       // double against differences
  double floatTolerance = 1e-3;  // float forms against double
  const std::atomic<bool>* stop = nullptr;
  std::function<void(long long done, long long total)> progress;  // from any thread; may be empty

  // What is checked; tests put wrong ones here.
  std::function<ad::DerivativeValues(const Scene&, const Path&, const double* u)> exact;
  std::span<const DerivativeForm> forms = derivativeForms();
};

// A float form's errors on one path.
enum class FormVerdict : std::uint8_t { kAgrees, kRounding, kNotFinite, kUnsupported, kWrong };
struct FormCheck {
  FormVerdict verdict = FormVerdict::kUnsupported;
  float value = 0, gradient = 0, hessian = 0;
};

// Where a path goes, for the tables.
struct PathTraits {
  std::uint32_t bsdfs = 0;  // kinds at the vertices that scatter, bits by index in bsdfKinds()
  int light = 0;            // kind, index in lightKinds()
  bool moving = false;      // it depends on time
};
PathTraits traitsOf(const Scene& scene, const Path& path);

struct PathCheck {
  SampledPath path;
  PathTraits traits;
  bool traced = false;  // it was a path when traced again
  bool finite = false;  // double derivatives and the value
  ad::Verdict verdict = ad::Verdict::kAgrees;
  int agree = 0, noisy = 0, kinked = 0, wrong = 0;  // entries
  double valueError = 0, gradientError = 0, hessianError = 0;
  std::array<FormCheck, kMostForms> forms{};

  bool failed() const;  // out of tolerance, in double or in a form
};

struct GradcheckResult {
  std::vector<PathCheck> paths;  // in the order of sampling
  bool interrupted = false;      // fewer than asked for
  long long failures() const;
};

// Samples the paths and checks them. Throws what the bootstrap throws.
GradcheckResult gradcheck(const Scene& scene, const GradcheckSettings& settings);

// Checks one path. `details`, if not null, gets the entries.
PathCheck checkPath(const Scene& scene, const SampledPath& sampled,
                    const GradcheckSettings& settings, ad::DerivativeCheck* details = nullptr);

// How far each coordinate may be moved without leaving the primary space: angles anywhere.
std::vector<double> largestSteps(const Path& path);

}  // namespace h2mc
