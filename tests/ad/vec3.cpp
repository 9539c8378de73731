// SPDX-License-Identifier: MIT
// Vectors of duals: GLM's type takes them, our overloads win over GLM's, and both agree.

#include "ad/vec3.h"

#include <glm/glm.hpp>

#include "ad_support.h"

namespace h2mc::ad {
namespace {

using namespace test;

template <class D>
struct Operands {
  using T = Scalar<D>;
  std::mt19937 random{1};
  static constexpr int N = dimension<D>;
  Vec3<D> a{make(T(0.5)), make(T(-1.25)), make(T(2))};
  Vec3<D> b{make(T(1.5)), make(T(0.75)), make(T(-0.5))};
  D s = make(T(1.75));
  Vec3<T> p{T(0.3), T(-0.6), T(1.1)};
  D make(T v) { return randomDual<T, N>(v, random); }
};

template <class D>
void expectSame(const Vec3<D>& got, const Vec3<D>& want, const char* what) {
  expectNear(got.x, expand(want.x), 32, what);
  expectNear(got.y, expand(want.y), 32, what);
  expectNear(got.z, expand(want.z), 32, what);
}

template <class D>
void checkVectors() {
  Operands<D> o;
  using T = typename Operands<D>::T;
  const auto &a = o.a, &b = o.b;
  const auto& p = o.p;
  const D& s = o.s;
  const Vec3<D> q(D(p.x), D(p.y), D(p.z));  // p as constants

  expectSame(a + b, Vec3<D>(a.x + b.x, a.y + b.y, a.z + b.z), "a + b");
  expectSame(a - b, Vec3<D>(a.x - b.x, a.y - b.y, a.z - b.z), "a - b");
  expectSame(a * b, Vec3<D>(a.x * b.x, a.y * b.y, a.z * b.z), "a * b");
  expectSame(-a, Vec3<D>(-a.x, -a.y, -a.z), "-a");
  expectSame(a * s, Vec3<D>(a.x * s, a.y * s, a.z * s), "a * s");
  expectSame(s * a, a * s, "s * a");
  expectSame(a / s, Vec3<D>(a.x / s, a.y / s, a.z / s), "a / s");
  expectSame(a + p, a + q, "a + p");
  expectSame(p + a, q + a, "p + a");
  expectSame(a - p, a - q, "a - p");
  expectSame(p - a, q - a, "p - a");
  expectSame(a * p, a * q, "a * p");
  expectSame(p * a, q * a, "p * a");
  expectSame(p * s, q * s, "p * s");
  expectSame(s * p, q * s, "s * p");
  expectSame(a * T(3), a * D(3), "a * plain");
  expectSame(T(3) * a, a * D(3), "plain * a");
  expectSame(a * 3, a * D(3), "a * int");
  expectSame(a / T(3), a / D(3), "a / plain");
  Vec3<D> c = a;
  c += b;
  expectSame(c, a + b, "+=");
  c -= b * s;
  expectSame(c, a + b - b * s, "-=");
  c = a;
  c *= s;
  expectSame(c, a * s, "*=");

  expectNear(dot(a, b), expand(a.x * b.x + a.y * b.y + a.z * b.z), 32, "dot");
  expectNear(dot(a, p), expand(dot(a, q)), 32, "dot(a, p)");
  expectNear(dot(p, a), expand(dot(q, a)), 32, "dot(p, a)");
  expectSame(cross(a, b), glm::cross(a, b), "cross");
  expectSame(cross(a, p), cross(a, q), "cross(a, p)");
  expectSame(cross(p, a), cross(q, a), "cross(p, a)");
  expectNear(length2(a), expand(dot(a, a)), 32, "length2");
  expectNear(length(a), expand(sqrt(dot(a, a))), 32, "length");
  expectNear(length2(Vec2<D>(a.x, a.y)), expand(a.x * a.x + a.y * a.y), 32, "length2");
  expectSame(normalize(a), a / length(a), "normalize");
  expectNear(distance2(a, b), expand(dot(a - b, a - b)), 64, "distance2");
  expectNear(distance2(a, p), expand(dot(a - q, a - q)), 64, "distance2(a, p)");
  expectNear(distance2(p, a), expand(dot(q - a, q - a)), 64, "distance2(p, a)");
  expectSame(combine(a.x, p, a.y, p + p, s, p * p), a.x * q + a.y * (q + q) + s * (q * q),
             "combine");
  EXPECT_EQ(value(a), Vec3<T>(T(0.5), T(-1.25), T(2)));
  EXPECT_TRUE(isFinite(a));
  EXPECT_FALSE(isFinite(Vec3<D>(a.x, a.y / 0, a.z)));
}

TEST(AdVec3, OperationsOfDuals) {
  checkVectors<Dual2<float, 6>>();
  checkVectors<Dual2<double, 7>>();
}

// With both namespaces open, ours are chosen without ambiguity.
TEST(AdVec3, OverloadsBesideGlm) {
  using namespace glm;
  using ad::Vec3;
  const Vec3<float> p(1, 2, 3), q(-1, 0.5f, 2);
  EXPECT_EQ(dot(p, q), 6);
  EXPECT_EQ(ad::dot(p, q), glm::dot(p, q));
  EXPECT_EQ(cross(p, q), glm::cross(p, q));
  EXPECT_EQ(ad::cross(p, q), glm::cross(p, q));
  EXPECT_FLOAT_EQ(length(p), std::sqrt(14.f));
  EXPECT_FLOAT_EQ(dot(normalize(p), ad::normalize(p)), 1);
  EXPECT_EQ(ad::length2(p), 14);
  EXPECT_EQ(ad::distance2(p, q), 4 + 2.25f + 1);
  using D = Dual2<float, 6>;
  const Vec3<D> a(D::variable(1, 0), D(2), D(3));
  EXPECT_EQ(dot(a, p).gradient(0), 1);
  EXPECT_EQ(dot(a, a).gradient(0), 2);
  EXPECT_FLOAT_EQ(length(a).gradient(0), 1 / std::sqrt(14.f));
  EXPECT_EQ(normalize(a).y.v, normalize(p).y);
  EXPECT_EQ(cross(a, p).z.gradient(0), 2);
  EXPECT_EQ((a * 2.f + p).x.v, 3);
}

}  // namespace
}  // namespace h2mc::ad
