// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/dispersion.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "rf/atmosphere/fog.h"
#include "rf/atmosphere/gas.h"
#include "rf/atmosphere/rain.h"
#include "rf/targets/echo_path.h"

namespace greatx::rf {
namespace {

constexpr size_t many_paths = 256;

}  // namespace

Dispersion::Dispersion(const scene::Scene& scene, const FieldModel& carrier, const Weather& weather,
                       const ChannelGrid& grid)
    : carrier_(carrier) {
  GREATX_CHECK(carrier.world != nullptr && carrier.world->facet_count() == scene.facets.size(),
               "the field model is of another scene");
  const FieldEffects& on = carrier.effects;
  // As in the carrier's model (RadioModel::field_model), a channel outside an effect's range goes without.
  const double hz = grid.carrier_hz;
  const WeatherEffects effects{on.gas && gas_model_covers(hz), on.rain && rain_model_covers(hz),
                               on.fog && fog_model_covers(hz)};
  subcarriers_.reserve(grid.subcarriers);
  for (uint32_t k = 0; k < grid.subcarriers; ++k) {
    const double frequency_hz = grid.carrier_hz + grid.subcarrier_number(k) * grid.subcarrier_spacing_hz;
    if (frequency_hz <= 0.0)
      throw_user_error("subcarrier {} of {}: expected a frequency above 0 Hz, found {}", k, grid.subcarriers,
                       frequency_hz);
    subcarriers_.push_back(
        {RadioSurfaces(scene, frequency_hz), path_attenuation(weather, frequency_hz, effects)});
  }
}

/// Returns the spectrum of an echo: those of its legs, with the carrier's scattering matrix between them.
TransferSpectrum Dispersion::echo_spectrum(const TargetEcho& echo, const FacetWorld& world) const {
  TransferSpectrum out = spectrum(echo.out, world);
  const TransferSpectrum home = spectrum(echo.home, world);
  ScatterMatrix s;
  std::copy_n(echo.scatter, 4, s.begin());
  for (size_t k = 0; k < out.size(); ++k) {
    Complex of_out[4], of_home[4], product[4];
    std::copy_n(out[k].begin(), 4, of_out);
    std::copy_n(home[k].begin(), 4, of_home);
    join(of_out, s, of_home, product);
    std::copy_n(product, 4, out[k].begin());
  }
  return out;
}

TransferSpectrum Dispersion::spectrum(const Path& path, const FacetWorld& world) const {
  if (path.echo && path.echo->has_legs()) return echo_spectrum(*path.echo, world);
  TransferSpectrum spectrum(subcarriers_.size());
  // The line of sight in air that attenuates nothing is the same at every frequency. An echo of surfaces
  // keeps the carrier's values.
  if (path.echo || (path.interactions.empty() && path.foliage_m == 0.0 && carrier_.attenuation.none())) {
    for (auto& transfer : spectrum) std::copy_n(path.transfer, 4, transfer.begin());
    return spectrum;
  }
  FieldModel model = carrier_;
  model.world = &world;
  for (size_t k = 0; k < subcarriers_.size(); ++k) {
    model.surfaces = &subcarriers_[k].surfaces;
    model.attenuation = subcarriers_[k].attenuation;
    Complex transfer[4];
    path_transfer(path, model, transfer);
    std::copy_n(transfer, 4, spectrum[k].begin());
  }
  return spectrum;
}

std::vector<TransferSpectrum> Dispersion::spectra(std::span<const Path> paths,
                                                  const FacetWorld& world) const {
  std::vector<TransferSpectrum> result(paths.size());
  // The caller distributes links over threads; a link with many paths has work for all of them by itself.
  const uint32_t threads = paths.size() < many_paths ? 1 : 0;
  parallel_for(paths.size(), threads, [&](size_t i) { result[i] = spectrum(paths[i], world); });
  return result;
}

}  // namespace greatx::rf
