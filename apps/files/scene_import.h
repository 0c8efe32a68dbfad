// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts an imported scene to the files that greatx loads.
#pragma once

#include <string>

#include "io/files/file.h"
#include "scene/import/imported.h"

namespace greatx::apps {

/// Returns a glTF binary. Each object is a node with its name and its triangles in world coordinates. Each
/// material has the extension GREATX_radio_material. The same scene gives the same bytes.
io::Bytes imported_glb(const scene::ImportedScene& scene, const std::string& name);

/// Returns the radio properties of the materials as a sidecar file (docs/materials.md) for editing.
std::string imported_sidecar(const scene::ImportedScene& scene, const std::string& source);

}  // namespace greatx::apps
