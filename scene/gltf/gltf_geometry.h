// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scene/gltf/gltf_accessor.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// The name that messages give a mesh: its own, or "mesh N".
std::string mesh_name(const GltfFile& file, size_t mesh);

/// The triangles of mesh `mesh`, checked: every index in range, every number finite, exactly degenerate
/// triangles dropped with a note. `ModelPrimitive::material` is the file's material index, or `no_material`.
/// Throws UserError naming file, mesh and primitive. Points and lines are skipped with a note.
ModelMesh read_mesh(const GltfFile& file, size_t mesh, std::vector<std::string>& notes,
                    GeometryMemory& memory);

inline constexpr uint32_t no_material = 0xFFFFFFFFu;

}  // namespace greatx::scene
