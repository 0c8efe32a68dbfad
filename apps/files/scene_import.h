// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From an imported scene to the files that greatx loads.
#pragma once

#include <string>

#include "io/files/file.h"
#include "scene/import/imported.h"

namespace greatx::apps {

/// glTF binary: each object a node of its name with its triangles in world coordinates; each material with
/// GREATX_radio_material. The same scene gives the same bytes.
io::Bytes imported_glb(const scene::ImportedScene& scene, const std::string& name);

/// The materials' radio fields as a sidecar (docs/materials.md), to be edited.
std::string imported_sidecar(const scene::ImportedScene& scene, const std::string& source);

}  // namespace greatx::apps
