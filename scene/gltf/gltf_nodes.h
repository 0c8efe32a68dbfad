// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// Walks the nodes of the default scene and fills Model::nodes, Model::instances (`mesh` is the file's
/// index), Model::lights and the notes. Throws UserError, which names the node, for an index out of range, a
/// node that is reached twice (a cycle), a transform that is singular, not finite or of the wrong length, and
/// an unknown "greatx_class".
void read_nodes(const GltfFile& file, Model& model);

}  // namespace greatx::scene
