// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Provides radars of every waveform for tests.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/rf/radar_support.h"

namespace greatx::rf::testing {

/// Gives a radar another waveform with `chirps` slots of each transmitter, or of all of them for Doppler
/// multiplexing.
inline RadarSignalConfig radar_of(RadarWaveform waveform, uint32_t transmitters, uint32_t receivers,
                                  uint32_t chirps, uint32_t empty_bands = 0) {
  RadarSignalConfig config;
  config.waveform = waveform;
  config.waveform.transmitters = transmitters;
  if (empty_bands > 0) {
    config.waveform.multiplexing = RadarMultiplexing::doppler;
    config.waveform.empty_bands = empty_bands;
  }
  config.waveform.slots = chirps * config.waveform.loop();
  set_row(config, transmitters, receivers);
  config.processing.cfar.train_doppler = 3;
  return config;
}

/// 100 MHz over 64 samples: 1.5 m a bin, 96 m in all.
inline RadarWaveform small_ramps() {
  RadarWaveform w;
  w.samples = 64;
  w.sample_rate_hz = 6.4e6;
  w.slope_hz_per_s = 1e13;
  w.chirp_s = w.interval_s = 20e-6;
  return w;
}
inline RadarWaveform small_steps() {
  return waveform_of(SteppedFrequency{77e9, 100e6 / 64, 1.2e-6, 0.7e-6, 64, 80e-6});
}
inline RadarWaveform small_symbols() { return waveform_of(OfdmSymbols{77e9, 100e6 / 64, 64, 0.3e-6, 10e-6}); }
inline RadarWaveform small_code(RadarCode code = RadarCode::m_sequence, uint32_t averages = 1,
                                uint32_t chips = 63) {
  return waveform_of(PhaseCode{77e9, 100e6, code, code == RadarCode::m_sequence ? chips : 64, averages, 0.0});
}

struct NamedRadar {
  std::string name;
  RadarSignalConfig config;
};

/// Every waveform with one transmitter, with two in turn, and with two at once. `chips` is the length of the
/// m-sequences.
inline std::vector<NamedRadar> all_radars(uint32_t chirps, uint32_t chips = 63) {
  const std::pair<const char*, RadarWaveform> waveforms[] = {
      {"fmcw", small_ramps()},
      {"stepped", small_steps()},
      {"ofdm", small_symbols()},
      {"m_sequence", small_code(RadarCode::m_sequence, 1, chips)},
      {"apas", small_code(RadarCode::apas)},
      {"averages", small_code(RadarCode::m_sequence, 5, chips)},
  };
  std::vector<NamedRadar> radars;
  for (const auto& [name, waveform] : waveforms) {
    radars.push_back({std::string(name), radar_of(waveform, 1, 2, chirps)});
    radars.push_back({std::string(name) + " tdm", radar_of(waveform, 2, 2, chirps)});
    radars.push_back({std::string(name) + " ddm", radar_of(waveform, 2, 3, 3 * chirps, 1)});
  }
  return radars;
}

inline const RadarDetection& strongest(const RadarFrame& frame) {
  return *std::max_element(frame.detections.begin(), frame.detections.end(),
                           [](const auto& a, const auto& b) { return a.power_w < b.power_w; });
}

}  // namespace greatx::rf::testing
