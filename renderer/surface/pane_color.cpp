// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/surface/pane_color.h"

#include "shaders/shared/pane.h"

namespace greatx::render {

std::optional<vec3> pane_color(const scene::PbrMaterial& material) {
  const bool plain = material.base_color_texture < 0 && material.metallic_roughness_texture < 0 &&
                     material.normal_texture < 0 && material.alpha_mode == scene::AlphaMode::opaque;
  if (!(material.transmission > 0.0f) || material.metallic > 0.0f || !plain ||
      material.roughness > shared::pane_most_roughness)
    return std::nullopt;
  const bool by_alpha = material.base_color.a < 1.0f;
  return material.transmission * (by_alpha ? vec3(1.0f) : vec3(material.base_color));
}

vec3 solid_color(const scene::PbrMaterial& material) {
  return vec3(material.base_color) * (pane_color(material) ? 1.0f - material.transmission : 1.0f);
}

bool is_lit_pane(const scene::Material& material) {
  return material.name.starts_with("lit_pane") && pane_color(material.pbr).has_value();
}

std::vector<bool> pane_materials(const scene::Scene& scene, bool wanted) {
  std::vector<bool> panes;
  panes.reserve(scene.materials.size());
  for (const scene::Material& material : scene.materials)
    panes.push_back(wanted && pane_color(material.pbr).has_value());
  return panes;
}

}  // namespace greatx::render
