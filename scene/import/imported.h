// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the content of another program's scene, before it is written as glTF (apps/files/scene_import.h).
#pragma once

#include <string>
#include <vector>

#include "core/vec.h"

namespace greatx::scene {

struct ImportedMaterial {
  std::string name;
  vec3 base_color{0.5f};  ///< linear Rec. 709
  float metallic = 0.0f;
  std::string radio_json;  ///< one JSON object: the fields of GREATX_radio_material (docs/materials.md)
};

/// Holds triangles of one material, in world coordinates (z up, metres).
struct ImportedObject {
  std::string name;
  int material = 0;             ///< index into ImportedScene::materials
  std::vector<vec3> positions;  ///< exactly the file's where it has no transform
  std::vector<vec3> normals;    ///< unit, [positions]; empty: flat faces
  std::vector<uint32_t> indices;
};

struct ImportedScene {
  std::vector<ImportedMaterial> materials;
  std::vector<ImportedObject> objects;
  std::vector<std::string> notes;  ///< the parts that were ignored, and the choices made

  size_t triangle_count() const {
    size_t corners = 0;
    for (const ImportedObject& object : objects) corners += object.indices.size();
    return corners / 3;
  }
};

}  // namespace greatx::scene
