// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/blocks.h"

namespace greatx::sim {

namespace {

PortBlock response_block(const char* name, const char* description, const rf::ChannelGrid& grid,
                         const rf::Dispersion* dispersion, rf::PathSelection selection) {
  return {name, description, grid.time_samples, grid.subcarriers,
          [=](std::span<const rf::Path> paths, const rf::FacetWorld& world, const rf::ArrayPose& transmitter,
              const rf::ArrayPose& receiver, std::span<std::complex<float>> out, uint32_t threads) {
            std::vector<rf::TransferSpectrum> spectra;
            if (dispersion) spectra = dispersion->spectra(paths, world);
            rf::frequency_response_into(paths, spectra, transmitter, receiver, grid, out, selection, threads);
          }};
}

}  // namespace

rf::ChannelGrid channel_grid(const ChannelConfig& config, const EffectPlan& plan) {
  return {config.carrier_hz, config.subcarrier_spacing_hz, config.subcarriers, config.time_samples,
          plan.doppler.on ? config.time_spacing_s : 0.0};
}

rf::TapGrid tap_grid(const ChannelConfig& config, const rf::ChannelGrid& grid) {
  const ChannelConfig::Taps& taps = config.taps.value();
  return {grid.carrier_hz, taps.bandwidth_hz, taps.first, taps.count, grid.time_samples, grid.time_spacing_s};
}

PortBlock cfr_block(const rf::ChannelGrid& grid, const rf::Dispersion* dispersion) {
  return response_block(
      "cfr", "[rx, rx_ant, tx, tx_ant, time, subcarrier] H(f) at carrier + (k - floor(N/2)) * spacing", grid,
      dispersion, rf::PathSelection::all);
}

std::vector<PortBlock> port_blocks(const ChannelConfig& config, const rf::ChannelGrid& grid,
                                   const rf::Dispersion* dispersion) {
  std::vector<PortBlock> blocks;
  if (config.outputs.cfr) blocks.push_back(cfr_block(grid, dispersion));
  if (config.outputs.cfr_parts) {
    blocks.push_back(response_block("cfr_line_of_sight", "as cfr, of the line of sight alone", grid,
                                    dispersion, rf::PathSelection::line_of_sight));
    blocks.push_back(response_block("cfr_others", "as cfr, of all other paths", grid, dispersion,
                                    rf::PathSelection::others));
  }
  if (config.taps) {
    const rf::TapGrid window = tap_grid(config, grid);
    blocks.push_back(
        {"taps",
         "[rx, rx_ant, tx, tx_ant, time, tap] h[l], tap l at the absolute delay (first + l) / bandwidth",
         grid.time_samples, window.taps,
         [window](std::span<const rf::Path> paths, const rf::FacetWorld&, const rf::ArrayPose& transmitter,
                  const rf::ArrayPose& receiver, std::span<std::complex<float>> out, uint32_t threads) {
           rf::channel_taps_into(paths, transmitter, receiver, window, out, threads);
         }});
  }
  return blocks;
}

}  // namespace greatx::sim
