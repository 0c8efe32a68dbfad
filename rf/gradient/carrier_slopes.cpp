// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/gradient/carrier_slopes.h"

#include <string>

#include "rf/surface/roughness.h"
#include "scene/material/material.h"

namespace greatx::rf {
namespace {

std::vector<Complex> eta_slopes(const std::vector<scene::RadioLayer>& layers, double carrier_hz,
                                const std::string& material_name) {
  std::vector<Complex> slopes;
  for (const scene::RadioLayer& layer : layers) {
    const scene::RadioRow& row = scene::row_at(layer.medium, carrier_hz, material_name);
    const Complex eta = scene::relative_permittivity(layer.medium, carrier_hz, material_name);
    slopes.emplace_back(row.b * eta.real() / carrier_hz, (row.d - 1.0) * eta.imag() / carrier_hz);
  }
  return slopes;
}

}  // namespace

CarrierSlopes carrier_slopes(const scene::Scene& scene, const Weather& weather, const WeatherEffects& effects,
                             double carrier_hz) {
  CarrierSlopes slopes;
  slopes.materials.resize(scene.materials.size());
  for (const scene::Facet& facet : scene.facets) {
    CarrierSlopes::Layers& layers = slopes.materials[facet.material];
    const scene::Material& material = scene.materials[facet.material];
    if (!layers.wall.empty() || !material.radio || material.radio->foliage) continue;
    layers.wall = eta_slopes(material.radio->layers, carrier_hz, material.name);
    layers.scattering = material.radio->scattering_coefficient *
                        scattered_share_slope(material.radio->deviation_m, carrier_hz);
    if (material.radio->windows && material.radio->windows->share > 0.0)
      layers.windows = eta_slopes(material.radio->windows->layers, carrier_hz, material.name + " (windows)");
  }
  Dual frequency = carrier_hz;
  frequency.set_slope(0, 1.0);
  slopes.attenuation = path_attenuation<Dual>(weather, frequency, effects);
  return slopes;
}

}  // namespace greatx::rf
