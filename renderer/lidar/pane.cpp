// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/lidar/pane.h"

#include <algorithm>

namespace greatx::render {

namespace {

bool is_clear_medium(const scene::RadioMedium& medium) {
  return medium.source.ends_with(", glass") || medium.source.ends_with(", clear_acrylic");
}
bool is_air(const scene::RadioMedium& medium) {
  return std::all_of(medium.rows.begin(), medium.rows.end(),
                     [](const scene::RadioRow& row) { return row.a == 1.0 && row.b == 0.0 && row.c == 0.0; });
}

/// Returns the number of sheets of glass, or 0 if the material has other layers or no end.
uint32_t sheets_of(const scene::RadioMaterial& radio) {
  if (radio.foliage) return 0;
  uint32_t sheets = 0;
  for (const scene::RadioLayer& layer : radio.layers) {
    if (!(layer.thickness_m > 0.0)) return 0;
    if (is_clear_medium(layer.medium))
      ++sheets;
    else if (!is_air(layer.medium))
      return 0;
  }
  return sheets;
}

}  // namespace

double glass_index(double wavelength_nm) {
  const double w = wavelength_nm * 1e-3;
  return 1.5130 - 0.003169 * w * w + 0.003962 / (w * w);
}

std::optional<shared::LidarPane> pane_of(const scene::Material& material, uint32_t wavelength_nm) {
  const scene::PbrMaterial& pbr = material.pbr;
  const uint32_t sheets = material.radio ? sheets_of(*material.radio) : 0;
  const bool plain = pbr.base_color_texture < 0 && pbr.emissive == vec3(0.0f);
  shared::LidarPane pane{static_cast<float>(std::max(1u, sheets)), 1.0f, 0.0f};
  if (pbr.transmission > 0.0f)
    pane.clearness = pbr.transmission;
  else if (sheets == 0 || !plain)
    return std::nullopt;
  pane.scattering =
      (wavelength_nm == 905 ? material.reflectance_905nm : material.reflectance_1550nm).value_or(0.0f);
  return pane;
}

}  // namespace greatx::render
