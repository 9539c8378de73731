// SPDX-License-Identifier: MIT
// A target with a known distribution over several techniques: for tests of chains.
#pragma once

#include <algorithm>
#include <cmath>

#include "ad/dual.h"
#include "mcmc/targets/target.h"
#include "render/core/index.h"

namespace h2mc::test {

// Three techniques of two lengths. In (u0, u1) each has a narrow slanted ridge on a floor; further
// coordinates are independent: even ones not periodic, odd ones angles that wrap. A choice
// coordinate switches the brightness. `cut` removes a corner, as an edge of visibility would.
class ToyTarget final : public Target {
 public:
  static constexpr Technique kTechniques[] = {{0, 2}, {0, 3}, {2, 1}};

  int maxLength() const override { return 2; }

  // The factors, so that tests can integrate one at a time.
  static float brightness(const Technique& t) {
    return t == kTechniques[0] || t == kTechniques[1] || t == kTechniques[2]
               ? static_cast<float>(1 + 2 * t.s + t.t)
               : 0.f;
  }
  template <class T>
  static T plane(const T& u0, const T& u1) {
    using S = Scalar<T>;
    // Dark beyond an edge that no derivative sees.
    if (value(u0) > S(0.8) && value(u1) > S(0.6)) return T(S(0));
    const T across = (u0 - u1 * S(0.5) - S(0.3)) * S(1 / 0.04);
    return (ad::exp(T(across * across * S(-0.5))) + S(0.05)) * (u1 * S(0.7) + S(0.3));
  }
  template <class T>
  static T even(const T& u) {
    return u * u + Scalar<T>(0.2);
  }
  template <class T>
  static T angle(const T& u) {
    using S = Scalar<T>;
    return ad::cos(T(u * S(2 * std::numbers::pi) + S(0.6))) * S(0.9) + S(1);
  }
  static float chosen(float choice) { return choice < 0.3f ? 1.f : 0.25f; }

  // `dimension` is the technique's, given so that it may be a constant.
  template <class T>
  static T density(const Technique& technique, int dimension, const T* u, const float* choice) {
    using S = Scalar<T>;
    T f = plane(u[0], u[1]) * S(brightness(technique));
    for (int i = 2; i < dimension; i += 2) f = f * even(u[i]) * angle(u[i + 1]);
    return technique.choices() > 0 ? T(f * S(chosen(choice[0]))) : f;
  }

  bool evaluate(Path& path) const override {
    path.wraps = 0;
    for (int i = 3; i < path.technique.dimension(); i += 2) path.wraps |= CoordinateMask(1) << i;
    path.finite = true;
    path.target = density(path.technique, path.technique.dimension(), path.sample.u.data(),
                          path.sample.choice.data());
    path.contribution = Rgbf(path.target);
    path.filmX = path.sample.u[0];
    path.filmY = path.sample.u[1];
    return path.target > 0;
  }

  void differentiateOnce(const Path& path, Gradient& result) const override {
    Derivative derivative;
    differentiate(path, derivative);
    result.dimension = derivative.dimension;
    result.logTarget = derivative.logTarget;
    std::copy_n(derivative.gradient, derivative.dimension, result.gradient);
  }
  void differentiate(const Path& path, Derivative& result) const override {
    if (path.technique.dimension() == 2)
      derive<2>(path, result);
    else
      derive<4>(path, result);
  }

 private:
  template <int N>
  static void derive(const Path& path, Derivative& result) {
    using D = ad::Dual2<float, N>;
    D u[N];
    for (int i = 0; i < N; ++i) u[i] = D::variable(path.sample.u[at(i)], i);
    const D f = ad::log(density(path.technique, N, u, path.sample.choice.data()));
    result.dimension = N;
    result.logTarget = f.v;
    for (int i = 0, k = 0; i < N; ++i) {
      result.gradient[i] = f.gradient(i);
      for (int j = 0; j <= i; ++j, ++k) result.hessian[k] = f.hessian(i, j);
    }
  }
};

}  // namespace h2mc::test
