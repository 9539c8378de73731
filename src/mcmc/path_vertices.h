// What a path meets on its way.
#pragma once

#include "render/path/path.h"
#include "render/scene/scene.h"

namespace h2mc {

// The BSDF that the vertex shows to where the path came from; null if nothing scatters there.
inline const Bsdf* bsdfSeen(const Scene& scene, const TracedVertex& vertex) {
  bool back;
  return detail::seen(std::span(scene.bsdfs), materialAt(scene, vertex.id), vertex.vertex.wi.z,
                      back);
}

}  // namespace h2mc
