// SPDX-License-Identifier: MIT
// A traced path evaluated again on its frozen topology, over any scalar type: no rays, no choices.
#pragma once

#include "render/core/index.h"
#include "render/path/path.h"

namespace h2mc {

// The log of the target (luminance of the MIS-weighted contribution over its density) as a function
// of all of the path's primary coordinates `u`, in the scalar T, of time (which may be null if
// !path.moving) and of the aperture's two (if !path.aperture). The oracle for derivatives: T = double and
// finite differences, or a dual with every coordinate active from the start.
template <class T>
T replayLogTarget(const Scene& scene, const Path& path, const T* u,
                  const std::type_identity_t<T>* time = nullptr,
                  const std::type_identity_t<T>* aperture = nullptr);

// The ray that leaves the subpath's vertex `index`, where the ray `arrived` has arrived.
template <class T>
PathRay<T> replayScatter(const Scene& scene, const Path& path, Side side, int index,
                         const PathRay<T>& arrived, const PathVertex<T>& vertex, const T& u0,
                         const T& u1) {
  const TracedVertex& traced = (side == Side::kCamera ? path.camera : path.light)[at(index)];
  if (traced.lobe.null) return passThrough(scene, arrived, vertex.point, traced.id);
  return scatterFrom<T>(scene, vertex, traced.id, traced.lobe, u0, u1, side);
}

// The technique's last step: joins what the subpaths have arrived at. `u` are the light's two direct
// coordinates where s = 1. Vertices that the technique lacks are not looked at.
template <class T>
T joinedLogTarget(const Scene& scene, const Path& path, const PathRay<T>& cameraRay,
                  const PathVertex<T>& camera, const PathVertex<T>& light, const T* u,
                  const std::type_identity_t<T>* time = nullptr,
                  const std::type_identity_t<T>* aperture = nullptr) {
  const auto [s, t] = path.technique;
  const PrimitiveId cameraId = path.camera[at(t) - 1].id;
  const PrimitiveId lightId = s >= 2 ? path.light[at(s) - 1].id : PrimitiveId{};
  constexpr auto kBoth = Techniques::kBidirectional;
  Contribution<T> c;
  if (s == 0) {
    c = path.escaped ? hitEnvironment<T>(scene, cameraRay, t, kBoth)
                     : hitAreaLight<T>(scene, camera, cameraRay.direction, path.lightIndex, t,
                                       kBoth, cameraId, time);
  } else if (s == 1) {
    DirectLight<T> direct;
    c = connectToLight<T>(scene, camera, cameraId, path.lightIndex, path.lightPrimitive, u[0], u[1],
                          kBoth, direct, time);
  } else if (t == 1) {
    c = connectToCamera<T>(scene, light, lightId, time, aperture);
  } else {
    c = connectVertices<T>(scene, camera, cameraId, light, lightId);
  }
  return log(luminance(c.value) * c.weight);
}

template <class T>
T replayLogTarget(const Scene& scene, const Path& path, const T* u,
                  const std::type_identity_t<T>* time, const std::type_identity_t<T>* aperture) {
  const Technique& technique = path.technique;
  PathRay<T> ray{};
  PathVertex<T> camera{}, light{};
  if (technique.t >= 2) {
    ray = startCamera<T>(scene, u[0], u[1], time, aperture);
    for (int i = 1; i < technique.t; ++i) {
      if (i > 1) {
        const T* v = u + technique.cameraCoordinate(i - 1);
        ray = replayScatter<T>(scene, path, Side::kCamera, i - 1, ray, camera, v[0], v[1]);
      }
      if (i == technique.t - 1 && path.escaped) break;
      camera = arriveAt<T>(scene, ray, path.camera[at(i)].id, time);
    }
  }
  const T* lightU = u + technique.lightOffset();
  if (technique.s >= 2) {
    PathRay<T> emitted = startLight<T>(scene, path.lightIndex, path.lightPrimitive, lightU[0],
                                       lightU[1], lightU[2], lightU[3], time);
    for (int i = 1; i < technique.s; ++i) {
      if (i > 1) {
        const T* v = u + technique.lightCoordinate(i - 1);
        emitted = replayScatter<T>(scene, path, Side::kLight, i - 1, emitted, light, v[0], v[1]);
      }
      light = arriveAt<T>(scene, emitted, path.light[at(i)].id, time);
    }
  }
  return joinedLogTarget<T>(scene, path, ray, camera, light, lightU, time, aperture);
}

// The same of path.dimension() coordinates.
template <class T>
T replayAt(const Scene& scene, const Path& path, const T* u) {
  return replayLogTarget<T>(scene, path, u, path.moving ? u + path.timeCoordinate() : nullptr,
                            path.aperture ? u + path.apertureCoordinate() : nullptr);
}

}  // namespace h2mc
