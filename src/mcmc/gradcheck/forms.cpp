// The float forms of the derivative that gradcheck knows.
#include "mcmc/gradcheck/gradcheck.h"
#include "render/path/derivative.h"

namespace h2mc {
namespace {

bool plain(const Scene& scene, const Path& path, ad::DerivativeValues& result) {
  Derivative d;
  if (!differentiate(scene, path, d)) return false;
  const int n = d.dimension;
  result.value = d.logTarget;
  result.gradient.assign(d.gradient, d.gradient + n);
  result.hessian.assign(d.hessian, d.hessian + n * (n + 1) / 2);
  return true;
}

constexpr DerivativeForm kForms[] = {
    {"plain", "whole-path Dual2, growing along the path", plain},
};
static_assert(std::size(kForms) <= kMostForms);

}  // namespace

std::span<const DerivativeForm> derivativeForms() { return kForms; }

}  // namespace h2mc
