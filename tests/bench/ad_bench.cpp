// SPDX-License-Identifier: MIT
// What second-order derivatives cost: one expression of the kind a path vertex evaluates (points on
// two triangles, a rough reflection between them), with plain numbers and with duals of N
// coordinates. The counter "x plain" is the time as a multiple of the plain evaluation's.

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <random>

#include "ad/functions.h"
#include "ad/symmetric_eigen.h"
#include "ad/vec3.h"

namespace h2mc::ad {
namespace {

template <class T>
struct Triangle {
  Vec3<T> a, b, c, na, nb, nc;
};

template <class T>
struct Scene {
  Triangle<T> t0{{0, 0, 0}, {1, 0, .1f}, {0, 1, .2f}, {0, .1f, 1}, {.1f, 0, 1}, {0, -.1f, 1}};
  Triangle<T> t1{{0, 0, 2}, {1, .1f, 2}, {.1f, 1, 2.2f}, {0, .1f, -1}, {.1f, 0, -1}, {0, 0, -1}};
  Vec3<T> eye{.3f, -2, 1.5f};
};

/// The log of (visibility-free) reflected radiance eye <- point on t0 <- point on t1.
template <class D>
[[gnu::noinline]] D evaluate(const Scene<Scalar<D>>& scene, const D* x) {
  using S = Scalar<D>;
  const D u0 = sqrt(x[0]), v0 = u0 * x[1], u1 = sqrt(x[2]), v1 = u1 * x[3];
  const auto& p = scene.t0;
  const auto& q = scene.t1;
  const Vec3<D> position = combine(S(1) - u0, p.a, u0 - v0, p.b, v0, p.c);
  const Vec3<D> normal = normalize(combine(S(1) - u0, p.na, u0 - v0, p.nb, v0, p.nc));
  const Vec3<D> light = combine(S(1) - u1, q.a, u1 - v1, q.b, v1, q.c);
  const Vec3<D> lightNormal = normalize(combine(S(1) - u1, q.na, u1 - v1, q.nb, v1, q.nc));
  const Vec3<D> toLight = light - position;
  const D d2 = length2(toLight);
  const Vec3<D> wi = toLight * rsqrt(d2), wo = normalize(scene.eye - position);
  const Vec3<D> half = normalize(wi + wo);
  const S alpha2 = S(.04);
  const D cosI = abs(dot(normal, wi)), cosO = abs(dot(normal, wo)), cosH = dot(normal, half);
  const D s = square(cosH) * (alpha2 - S(1)) + S(1);
  const D distribution = alpha2 / (S(3.14159265) * square(s));
  const D lambda = sqrt(alpha2 / square(cosI) + S(1)) + sqrt(alpha2 / square(cosO) + S(1));
  const D m = S(1) - dot(wi, half), m2 = square(m);
  const D fresnel = S(.04) + S(.96) * square(m2) * m;
  const D specular = distribution * fresnel / (cosO * cosI * lambda);
  const D geometry = cosI * abs(dot(lightNormal, wi)) / d2;
  return log((specular + S(.2)) * geometry) + log(exp(-d2) + S(.1));
}

float inputs[4] = {.3f, .4f, .5f, .6f};

template <class D>
double nanoseconds(int repetitions) {
  using S = Scalar<D>;
  static const Scene<S> scene;
  const auto begin = std::chrono::steady_clock::now();
  for (int r = 0; r < repetitions; ++r) {
    D x[4];
    benchmark::DoNotOptimize(inputs);
    for (int i = 0; i < 4; ++i) {
      x[i] = D(inputs[i]);
      if constexpr (isDual<D>) x[i] = D::variable(S(inputs[i]), i * dimension<D> / 4);
    }
    D y = evaluate(scene, x);
    benchmark::DoNotOptimize(y);
  }
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
  return time.count() / repetitions;
}

template <class D>
void expression(benchmark::State& state) {
  double plain = 1e30, mine = 1e30;
  for (auto _ : state) {
    // The fastest of the chunks: what other processes do in between does not count.
    plain = std::fmin(plain, nanoseconds<Scalar<D>>(200));
    mine = std::fmin(mine, nanoseconds<D>(200));
  }
  state.counters["ns"] = mine;
  state.counters["x plain"] = mine / plain;
}
#define H2MC_BENCH(T, N) BENCHMARK(expression<Dual2<T, N>>)->Iterations(500)
BENCHMARK(expression<float>)->Iterations(500);
H2MC_BENCH(float, 2);
H2MC_BENCH(float, 4);
H2MC_BENCH(float, 6);
H2MC_BENCH(float, 7);
H2MC_BENCH(float, 12);
H2MC_BENCH(float, 16);
BENCHMARK(expression<double>)->Iterations(500);
H2MC_BENCH(double, 2);
H2MC_BENCH(double, 4);
H2MC_BENCH(double, 6);
H2MC_BENCH(double, 7);
H2MC_BENCH(double, 12);
H2MC_BENCH(double, 16);
#undef H2MC_BENCH

void eigen(benchmark::State& state) {
  const int n = int(state.range(0));
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double a[34 * 34];
  for (double& x : a) x = normal(random);
  SymmetricEigen<34> solver;
  for (auto _ : state) {
    benchmark::DoNotOptimize(a);
    benchmark::DoNotOptimize(solver.compute(a, n, n));
  }
}
BENCHMARK(eigen)->Arg(2)->Arg(4)->Arg(6)->Arg(8)->Arg(12)->Arg(13)->Arg(16)->Arg(24)->Arg(34);

}  // namespace
}  // namespace h2mc::ad

BENCHMARK_MAIN();
