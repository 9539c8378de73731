// SPDX-License-Identifier: MIT
// What a path meets on its way.
#pragma once

#include "render/path/path.h"
#include "render/scene/scene.h"

namespace h2mc {

// The BSDF that the vertex shows to where the path came from; null if nothing scatters there. Of a blend
// the part that the path goes on through.
inline const Bsdf* bsdfSeen(const Scene& scene, const TracedVertex& vertex) {
  bool back;
  const Material& material = detail::partOf(materialAt(scene, vertex.id), vertex.lobe);
  return detail::seen(std::span(scene.bsdfs), material, vertex.vertex.wi.z, back);
}

}  // namespace h2mc
