// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// Reads the materials that the model's meshes use, with textures and radio properties. Before the call
/// `ModelPrimitive::material` is the file's index or `no_material`; the call replaces it by an index into
/// Model::materials. Unless `options.optical_only`, throws one UserError that lists every used material
/// without radio properties.
void read_materials(const GltfFile& file, const LoadOptions& options, Model& model);

}  // namespace greatx::scene
