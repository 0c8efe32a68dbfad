// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// Walks the default scene's nodes: fills Model::instances (`mesh` is the file's index), Model::lights and
/// notes. Throws UserError naming the node: index out of range, a node reached twice (a cycle), a transform
/// that is not finite, singular or of the wrong length, an unknown "greatx_class".
void read_nodes(const GltfFile& file, Model& model);

}  // namespace greatx::scene
