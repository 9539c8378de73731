// SPDX-License-Identifier: MIT
// What a loader of meshes promises, and what is done with its mesh next.
#pragma once

#include "render/geometry/mesh_data.h"

namespace h2mc::fuzz {

// Throws Finding where the mesh is not as mesh_data.h says, UserError where it can't be used.
void checkMesh(const MeshData& data);

}  // namespace h2mc::fuzz
