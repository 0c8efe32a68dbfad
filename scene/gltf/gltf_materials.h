// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// Reads the materials that the model's meshes use (their `material` is the file's index or `no_material` and
/// becomes an index into Model::materials), with textures and radio properties. Throws one UserError that
/// lists every used material without radio properties, unless `options.optical_only`.
void read_materials(const GltfFile& file, const LoadOptions& options, Model& model);

}  // namespace greatx::scene
