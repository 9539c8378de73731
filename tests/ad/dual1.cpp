// SPDX-License-Identifier: MIT
// Dual1 against Dual2: the same value and gradient, whatever is done.
#include <cmath>

#include "ad/vec3.h"
#include "ad_support.h"

namespace h2mc::ad {
namespace {

using namespace test;

template <class T, int N>
Dual1<T, N> first(const Dual2<T, N>& a) {
  Dual1<T, N> r(a.v);
  for (int i = 0; i < N; ++i) r.setGradient(i, a.gradient(i));
  return r;
}

// Everything that there is, in terms of two numbers in (0, 1).
template <class D>
std::vector<D> everything(const D& a, const D& b) {
  using T = Scalar<D>;
  D sine, cosine;
  sincos(a, sine, cosine);
  const Vec3<D> v(a, b, a * b), w(b, b / a, a - b);
  const Vec3<T> plain(T(0.3), T(-0.2), T(1.5));
  return {a + b,
          a - b,
          -a,
          a * b,
          a / b,
          a + 2,
          2 - a,
          a * T(3),
          a / T(3),
          1 / a,
          sqrt(a),
          rsqrt(a),
          exp(a),
          expm1(a),
          log(a),
          log(D(a * T(1e-38))),
          log1p(a),
          sine,
          cosine,
          sin(a),
          cos(a),
          tan(a),
          asin(a),
          acos(a),
          atan(a),
          erf(a),
          square(a),
          abs(D(-a)),
          atan2(a, b),
          hypot(a, b),
          pow(a, T(2.5)),
          pow(T(2.5), a),
          pow(a, b),
          min(a, b),
          max(a, T(0.5)),
          clamp(a, T(0.1), T(0.2)),
          dot2(a, b, b, a),
          differenceOfProducts(a, b, b, b),
          dot3(a, b, a, a, b, b),
          sumOfSquares3(a, b, b),
          linear2(a, T(2), b, T(3)),
          linear3(a, T(2), b, T(3), a, T(4)),
          dot(v, w),
          dot(v, plain),
          cross(v, w).y,
          cross(plain, w).x,
          normalize(v).z,
          distance2(v, w)};
}

template <class T, int N>
void compare() {
  std::mt19937 random(7);
  const auto a = randomDual<T, N>(T(0.375), random), b = randomDual<T, N>(T(0.75), random);
  const auto two = everything(a, b);
  const auto one = everything(first(a), first(b));
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].v, two[k].v) << k;
    for (int i = 0; i < N; ++i) {
      const T expected = two[k].gradient(i);
      // Compilers may fuse one and not the other.
      EXPECT_NEAR(one[k].gradient(i), expected,
                  16 * std::numeric_limits<T>::epsilon() * (1 + std::abs(expected)))
          << k << " by " << i << " of " << N;
    }
    EXPECT_TRUE(isFinite(one[k]));
  }
}

TEST(AdDual1, IsTheFirstHalfOfDual2) {
  compare<float, 1>();
  compare<float, 3>();
  compare<float, 8>();
  compare<float, 13>();
  compare<float, 16>();
  compare<float, 33>();
  compare<double, 2>();
  compare<double, 9>();
  compare<double, 16>();
}

// Where a derivative is infinite, coordinates that the argument does not depend on stay at zero, and a second
// derivative that is infinite alone does no harm.
TEST(AdDual1, AtSingularities) {
  using D = Dual1<float, 3>;
  const D root = sqrt(D::variable(0.f, 1));
  EXPECT_EQ(root.gradient(0), 0);
  EXPECT_TRUE(std::isinf(root.gradient(1)));
  EXPECT_FALSE(isFinite(root));
  const D steep = pow(D::variable(0.f, 1), 1.5f);
  EXPECT_EQ(steep.gradient(1), 0);
  EXPECT_TRUE(isFinite(steep));
}

TEST(AdDual1, Lifts) {
  const auto a = Dual1<float, 2>::variable(0.5f, 1);
  const auto b = Dual1<float, 5>::lift<3>(a);
  EXPECT_EQ(b.v, 0.5f);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(b.gradient(i), i == 4 ? 1 : 0);
}

}  // namespace
}  // namespace h2mc::ad
