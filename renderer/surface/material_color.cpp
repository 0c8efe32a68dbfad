// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/surface/material_color.h"

#include <algorithm>

#include "core/srgb.h"
#include "renderer/surface/pane_color.h"

namespace greatx::render {

dvec3 mean_color(const scene::Scene& scene, uint32_t material) {
  const scene::PbrMaterial& pbr = scene.materials[material].pbr;
  const dvec3 factor(solid_color(pbr));
  if (pbr.base_color_texture < 0) return factor;
  const scene::Texture& texture = scene.textures[static_cast<size_t>(pbr.base_color_texture)];
  // A prime number of texels does not fall into step with the width.
  const size_t texels = size_t{texture.width} * texture.height, stride = std::max<size_t>(texels / 1021, 1);
  dvec3 sum(0.0);
  size_t count = 0;
  for (size_t i = 0; i < texels; i += stride, ++count)
    for (int c = 0; c < 3; ++c)
      sum[c] += linear_from_srgb(texture.rgba[4 * i + static_cast<size_t>(c)] / 255.0);
  return count == 0 ? factor : factor * (sum / double(count));
}

}  // namespace greatx::render
