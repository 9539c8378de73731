// SPDX-License-Identifier: MIT
// The float forms of the derivative that gradcheck knows.
#include "check/gradcheck/form_check.h"

namespace h2mc {

void copyDerivative(const Derivative& d, ad::DerivativeValues& result) {
  const int n = d.dimension;
  result.value = d.logTarget;
  result.gradient.assign(d.gradient, d.gradient + n);
  result.hessian.assign(d.hessian, d.hessian + n * (n + 1) / 2);
}

namespace {

bool local(const Scene& scene, const Path& path, ad::DerivativeValues& result) {
  Derivative d;
  differentiateLocally(scene, path, d);
  copyDerivative(d, result);
  return true;
}

bool plain(const Scene& scene, const Path& path, ad::DerivativeValues& result) {
  Derivative d;
  if (!differentiatePlainly(scene, path, d)) return false;
  copyDerivative(d, result);
  return true;
}

constexpr DerivativeForm kForms[] = {
    {"local", "vertex by vertex, composed along the path", local},
    {"plain", "whole-path Dual2, growing along the path", plain},
};
static_assert(std::size(kForms) <= kMostForms);

}  // namespace

std::span<const DerivativeForm> derivativeForms() { return kForms; }

}  // namespace h2mc
