// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/dispersion.h"

#include <algorithm>

#include "core/error.h"

namespace greatx::rf {

Dispersion::Dispersion(const scene::Scene& scene, const FieldModel& carrier, const Weather& weather,
                       const ChannelGrid& grid)
    : carrier_(carrier) {
  GREATX_CHECK(carrier.world != nullptr && carrier.world->facet_count() == scene.facets.size(),
               "the field model is of another scene");
  const FieldEffects& on = carrier.effects;
  subcarriers_.reserve(grid.subcarriers);
  for (uint32_t k = 0; k < grid.subcarriers; ++k) {
    const double frequency_hz = grid.carrier_hz + grid.subcarrier_number(k) * grid.subcarrier_spacing_hz;
    if (frequency_hz <= 0.0)
      throw_user_error("subcarrier {} of {}: expected a frequency above 0 Hz, found {}", k, grid.subcarriers,
                       frequency_hz);
    subcarriers_.push_back(
        {RadioSurfaces(scene, frequency_hz),
         path_attenuation(weather, frequency_hz, {.gas = on.gas, .rain = on.rain, .fog = on.fog})});
  }
}

TransferSpectrum Dispersion::spectrum(const Path& path, const FacetWorld& world) const {
  const GeometricPath geometry{path.interactions,  path.vertices,       path.length_m,     path.foliage_m,
                               path.patch_area_m2, path.edges_diffract, path.from_receiver};
  TransferSpectrum spectrum(subcarriers_.size());
  FieldModel model = carrier_;
  model.world = &world;
  for (size_t k = 0; k < subcarriers_.size(); ++k) {
    model.surfaces = &subcarriers_[k].surfaces;
    model.attenuation = subcarriers_[k].attenuation;
    Complex transfer[4];
    path_transfer(geometry, model, transfer);
    std::copy_n(transfer, 4, spectrum[k].begin());
  }
  return spectrum;
}

std::vector<TransferSpectrum> Dispersion::spectra(std::span<const Path> paths,
                                                  const FacetWorld& world) const {
  std::vector<TransferSpectrum> result;
  result.reserve(paths.size());
  for (const Path& path : paths) result.push_back(spectrum(path, world));
  return result;
}

}  // namespace greatx::rf
