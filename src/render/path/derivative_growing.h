// SPDX-License-Identifier: MIT
// The plain whole-path derivative, growing along the path. Instantiated once for each number of
// coordinates (derivative_instance.cpp.in), so that no file takes long to compile.
#pragma once

#include "ad/dual.h"
#include "render/path/derivative.h"
#include "render/path/replay.h"

namespace h2mc::growing {

template <int N>
using Dual = ad::Dual2<float, N>;

// Coordinates [0, M) of a dual become [Offset, Offset + M) of N.
template <int N, int Offset, int M>
Dual<N> lift(const Dual<M>& a) {
  return Dual<N>::template lift<Offset>(a);
}
template <int N, int Offset, int M>
Vec3<Dual<N>> lift(const Vec3<Dual<M>>& a) {
  return {lift<N, Offset>(a.x), lift<N, Offset>(a.y), lift<N, Offset>(a.z)};
}
template <int N, int Offset, int M>
Frame<Dual<N>> lift(const Frame<Dual<M>>& a) {
  if (!a.constant) return {lift<N, Offset>(a.s), lift<N, Offset>(a.t), lift<N, Offset>(a.n)};
  Frame<Dual<N>> b;
  b.assign(Frame<float>{value3(a.s), value3(a.t), value3(a.n)});
  return b;
}
template <int N, int Offset, int M>
PathVertex<Dual<N>> lift(const PathVertex<Dual<M>>& a) {
  PathVertex<Dual<N>> b;
  b.point.p = lift<N, Offset>(a.point.p);
  b.point.ng = lift<N, Offset>(a.point.ng);
  b.point.shading = lift<N, Offset>(a.point.shading);
  b.point.flat = a.point.flat;
  b.point.constantNormal = a.point.constantNormal;
  b.point.bend = a.point.bend;
  b.point.unbent = a.point.unbent;
  b.point.uv = {lift<N, Offset>(a.point.uv.x), lift<N, Offset>(a.point.uv.y)};
  b.wi = lift<N, Offset>(a.wi);
  b.cosIn = lift<N, Offset>(a.cosIn);
  b.throughput = lift<N, Offset>(a.throughput);
  b.vcm = lift<N, Offset>(a.vcm);
  b.vc = lift<N, Offset>(a.vc);
  return b;
}
template <int N, int Offset, int M>
PathRay<Dual<N>> lift(const PathRay<Dual<M>>& a) {
  PathRay<Dual<N>> b;
  b.origin = lift<N, Offset>(a.origin);
  b.direction = lift<N, Offset>(a.direction);
  b.throughput = lift<N, Offset>(a.throughput);
  b.vcm = lift<N, Offset>(a.vcm);
  b.vc = lift<N, Offset>(a.vc);
  b.fromInfinity = a.fromInfinity;
  return b;
}

// The ray that leaves the vertex `index`, where `arrived` arrives: two more coordinates make it.
template <int A, int Arrived>
PathRay<Dual<A>> scattered(const Scene& scene, const Path& path, Side side, int index,
                           const PathRay<Dual<Arrived>>& arrived, const Dual<A>& u0,
                           const Dual<A>& u1) {
  const TracedVertex& traced = (side == Side::kCamera ? path.camera : path.light)[at(index)];
  const auto vertex = arriveAt<Dual<Arrived>>(scene, arrived, traced.id);
  if (traced.lobe.null) return lift<A, 0>(passThrough(scene, arrived, vertex.point, traced.id));
  return scatterFrom<Dual<A>>(scene, lift<A, 0>(vertex), traced.id, traced.lobe, u0, u1, side);
}

// The camera subpath's ray that A coordinates have made: towards vertex A / 2.
template <int A>
struct CameraSubpath {
  static PathRay<Dual<A>> ray(const Scene& scene, const Path& path);
};

template <int A>
PathRay<Dual<A>> CameraSubpath<A>::ray(const Scene& scene, const Path& path) {
  const float* u = path.sample.u.data();
  const Dual<A> u0 = Dual<A>::variable(u[A - 2], A - 2), u1 = Dual<A>::variable(u[A - 1], A - 1);
  if constexpr (A == 2) {
    return startCamera<Dual<A>>(scene, u0, u1);
  } else {
    return scattered<A>(scene, path, Side::kCamera, A / 2 - 1,
                        CameraSubpath<A - 2>::ray(scene, path), u0, u1);
  }
}

// The light subpath's ray that A coordinates have made: towards vertex A / 2 - 1 after the light (A >= 4).
template <int A>
struct LightSubpath {
  static PathRay<Dual<A>> ray(const Scene& scene, const Path& path);
};

template <int A>
PathRay<Dual<A>> LightSubpath<A>::ray(const Scene& scene, const Path& path) {
  const float* u = path.sample.u.data() + path.technique.lightOffset();
  const Dual<A> u0 = Dual<A>::variable(u[A - 2], A - 2), u1 = Dual<A>::variable(u[A - 1], A - 1);
  if constexpr (A == 4) {
    return startLight<Dual<A>>(scene, path.lightIndex, path.lightPrimitive,
                               Dual<A>::variable(u[0], 0), Dual<A>::variable(u[1], 1), u0, u1);
  } else {
    return scattered<A>(scene, path, Side::kLight, A / 2 - 2, LightSubpath<A - 2>::ray(scene, path),
                        u0, u1);
  }
}

template <int N>
struct LogTarget {
  // The log target of a path with N coordinates.
  static Dual<N> evaluate(const Scene& scene, const Path& path);
  static Dual<N> join(const Scene& scene, const Path& path, const PathRay<Dual<N>>& cameraRay,
                      const PathVertex<Dual<N>>& camera, const PathVertex<Dual<N>>& light);
};

template <int N>
Dual<N> LogTarget<N>::join(const Scene& scene, const Path& path, const PathRay<Dual<N>>& cameraRay,
                           const PathVertex<Dual<N>>& camera, const PathVertex<Dual<N>>& light) {
  const float* u = path.sample.u.data();
  const Dual<N> direct[2] = {Dual<N>::variable(u[N - 2], N - 2),
                             Dual<N>::variable(u[N - 1], N - 1)};
  return joinedLogTarget<Dual<N>>(scene, path, cameraRay, camera, light, direct);
}

// The technique with 2 * C camera coordinates, C from 0 to N / 2, found by recursion over C.
template <int N, int C>
Dual<N> evaluateTechnique(const Scene& scene, const Path& path) {
  if (path.technique.lightOffset() != 2 * C) {
    if constexpr (C < N / 2)
      return evaluateTechnique<N, C + 1>(scene, path);
    else
      return Dual<N>(0);  // not reached: the offsets are 0, 2, .., N
  }
  constexpr int kCamera = 2 * C, kLight = N - kCamera;
  PathRay<Dual<N>> ray{};
  PathVertex<Dual<N>> camera{}, light{};
  if constexpr (kCamera > 0) {
    const PathRay<Dual<kCamera>> r = CameraSubpath<kCamera>::ray(scene, path);
    if (path.technique.s == 0) ray = lift<N, 0>(r);
    if (!path.escaped) camera = lift<N, 0>(arriveAt<Dual<kCamera>>(scene, r, path.camera[C].id));
  }
  if constexpr (kLight >= 4) {
    if (path.technique.s >= 2)
      light = lift<N, kCamera>(arriveAt<Dual<kLight>>(scene, LightSubpath<kLight>::ray(scene, path),
                                                      path.light[kLight / 2 - 1].id));
  }
  return LogTarget<N>::join(scene, path, ray, camera, light);
}

template <int N>
Dual<N> LogTarget<N>::evaluate(const Scene& scene, const Path& path) {
  return evaluateTechnique<N, 0>(scene, path);
}

}  // namespace h2mc::growing
