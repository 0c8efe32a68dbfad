// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/gltf/gltf_accessor.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// Returns the name that messages give a mesh: its own, or "mesh N".
std::string mesh_name(const GltfFile& file, size_t mesh);

/// Reads the triangles of mesh `mesh` and checks them: every index is in range, every number is finite.
/// Exactly degenerate triangles, points and lines are skipped with a note. `ModelPrimitive::material` is the
/// file's material index, or `no_material`. Throws UserError, which names file, mesh and primitive.
/// With GltfFile::keep_faults degenerate triangles and vertices that are not finite are kept.
ModelMesh read_mesh(const GltfFile& file, size_t mesh, std::vector<std::string>& notes,
                    GeometryMemory& memory);

inline constexpr uint32_t no_material = 0xFFFFFFFFu;

}  // namespace greatx::scene
