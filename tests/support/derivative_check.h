// SPDX-License-Identifier: MIT
// Holds the derivatives of templated functions against finite differences.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "ad/finite_difference.h"
#include "render/core/index.h"
#include "render/geometry/surface_point.h"

namespace h2mc::test {

template <class T>
void append(std::vector<T>& to, const T& x) {
  to.push_back(x);
}
template <class T>
void append(std::vector<T>& to, const Vec2<T>& x) {
  to.insert(to.end(), {x.x, x.y});
}
template <class T>
void append(std::vector<T>& to, const Vec3<T>& x) {
  to.insert(to.end(), {x.x, x.y, x.z});
}
// Everything that depends on where the point is; frames by what they do.
template <class T>
void append(std::vector<T>& to, const SurfacePoint<T>& s) {
  append(to, s.p);
  append(to, s.ng);
  const T one(1), zero(0);
  append(to, s.shading.toWorld({one, zero, zero}));
  append(to, s.shading.toWorld({zero, one, zero}));
  append(to, s.shading.toWorld({zero, zero, one}));
  append(to, s.shading.toLocal({one, zero, zero}));
  append(to, s.cosine({one, zero, one}));
  append(to, s.uv);
}
template <class T>
std::vector<T> outputs(const SurfacePoint<T>& s) {
  std::vector<T> r;
  append(r, s);
  return r;
}

// f.template operator()<T>(const std::array<T, N>&) returns a std::vector<T>, always of one length.
// Expects its gradients and Hessians at x to agree with finite differences in double, where those
// can be had (f may have kinks), and its float ones with the double ones up to `floatTolerance`,
// relative to each output's largest derivative. Returns the share of entries that could be compared.
template <int N, class F>
double expectDerivatives(const F& f, const std::array<double, N>& x, double step = 1e-3,
                         double floatTolerance = 2e-2) {
  using D = ad::Dual2<double, N>;
  using E = ad::Dual2<float, N>;
  std::array<D, N> xd;
  std::array<E, N> xf;
  for (int i = 0; i < N; ++i) {
    xd[i] = D::variable(x[i], i);
    xf[i] = E::variable(static_cast<float>(x[i]), i);
  }
  const std::vector<double> plain = f.template operator()<double>(x);
  const std::vector<D> dual = f.template operator()<D>(xd);
  const std::vector<E> coarse = f.template operator()<E>(xf);
  int compared = 0, all = 0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    EXPECT_TRUE(isFinite(dual[k])) << "output " << k;
    EXPECT_TRUE(isFinite(coarse[k])) << "output " << k << " in float";
    EXPECT_NEAR(dual[k].v, plain[k], 1e-12 * (1 + std::abs(plain[k]))) << "output " << k;
    std::array<double, N> moved;
    const auto differences = ad::finiteDifferences<double>(
        [&](const double* p) {
          std::copy(p, p + N, moved.begin());
          return f.template operator()<double>(moved)[k];
        },
        x.data(), N, step, 8);
    double size1 = std::abs(plain[k]), size2 = std::abs(plain[k]);
    for (int i = 0; i < N; ++i) {
      size1 = std::max(size1, std::abs(dual[k].gradient(i)));
      for (int j = 0; j <= i; ++j) size2 = std::max(size2, std::abs(dual[k].hessian(i, j)));
    }
    size2 = std::max(size1, size2);
    const auto compare = [&](double exact, const ad::Estimate<double>& estimate, float inFloat,
                             double size, const std::string& what) {
      ++all;
      EXPECT_NEAR(inFloat, exact, floatTolerance * (size + 1e-30)) << what << " in float";
      if (!(estimate.error < 1e-4 * (size + 1e-12))) return;
      ++compared;
      EXPECT_NEAR(exact, estimate.value, 20 * estimate.error + 1e-6 * size + 1e-12) << what;
    };
    for (int i = 0; i < N; ++i) {
      const std::string name = "output " + std::to_string(k) + " by " + std::to_string(i);
      compare(dual[k].gradient(i), differences.gradient[at(i)], coarse[k].gradient(i), size1, name);
      for (int j = 0; j <= i; ++j)
        compare(dual[k].hessian(i, j), differences.hessian[at(i * N + j)], coarse[k].hessian(i, j),
                size2, name + " and " + std::to_string(j));
    }
  }
  return all ? static_cast<double>(compared) / all : 1;
}

}  // namespace h2mc::test
