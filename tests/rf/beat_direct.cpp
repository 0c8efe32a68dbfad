// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/rf/beat_direct.h"

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/phase.h"
#include "rf/radar/signal/delay.h"
#include "rf/radar/signal/symbols.h"

namespace greatx::rf::testing {

void beat_direct(const RadarSignalConfig& config, const EchoList& list, const RadarAttitude& attitude,
                 uint32_t threads, std::span<std::complex<double>> cube) {
  const RadarWaveform& w = config.waveform;
  const size_t receivers = config.arrays.receive_m.size();
  GREATX_CHECK(cube.size() == receivers * w.slots * w.samples, "{} samples", cube.size());
  struct Leads {
    std::vector<double> transmitter, receiver;
  };
  std::vector<Leads> echo_leads;
  for (const Echo& echo : list.echoes)
    echo_leads.push_back(
        {transmitter_leads(config.arrays, attitude, echo), receiver_leads(config.arrays, attitude, echo)});
  parallel_for(list.slots, threads, [&](size_t index) {
    const uint32_t slot = list.first_slot + static_cast<uint32_t>(index);
    for (uint32_t t = 0; t < w.transmitters; ++t) {
      if (w.loop() > 1 && t != slot % w.transmitters) continue;
      for (size_t e = 0; e < list.echoes.size(); ++e) {
        const std::complex<double> amplitude =
            std::conj(list.echoes[e].amplitude) * std::sqrt(config.transmit_power_w);
        for (uint32_t n = 0; n < w.samples; ++n) {
          const double u = (double(n) - w.middle_sample()) / w.sample_rate_hz;
          const double tau =
              delay_at(list, list.echoes[e].delay, w.interval_s, w.slot_middle_s(slot) + u).delay_s;
          for (uint32_t r = 0; r < receivers; ++r) {
            const double delay = tau - echo_leads[e].transmitter[t] - echo_leads[e].receiver[r];
            const double turns = turns_of(w.carrier_hz, delay) + w.slope_hz_per_s * delay * u -
                                 0.5 * w.squared_slope() * delay * delay + w.band_turns(t, slot);
            cube[size_t{w.row(r, slot)} * w.samples + n] += amplitude * unit_phasor(fraction_of_turn(turns));
          }
        }
      }
    }
  });
}

namespace {

/// Returns the conjugate of what a receiver takes in at `time_s`, times sqrt(N).
std::complex<double> coded_sample(const RadarSignalConfig& config, const EchoList& list,
                                  const Symbols& symbols, const RadarSeeds& seeds, uint32_t receiver,
                                  double time_s) {
  const RadarWaveform& w = config.waveform;
  const double spacing = 1.0 / w.sampled_s();
  std::complex<double> sum = 0.0;
  for (const Echo& echo : list.echoes)
    for (uint32_t t = 0; t < w.transmitters; ++t) {
      const double delay = delay_at(list, echo.delay, w.interval_s, time_s).delay_s -
                           transmitter_leads(config.arrays, {}, echo)[t] -
                           receiver_leads(config.arrays, {}, echo)[receiver];
      const double left = time_s - delay;  // when it left the transmitter
      const int64_t slot = static_cast<int64_t>(std::floor(left / w.interval_s));
      if (slot < 0 || slot >= w.slots) continue;
      if (w.loop() > 1 && t != slot % w.transmitters) continue;
      // The time after the first sample of the first repetition, and whether the slot still sends then.
      const double within = left - double(slot) * w.interval_s;
      if (within >= w.chirp_s) continue;
      const double symbol_s = within - w.latest_delay_s();
      const auto spectrum = symbols.spectrum(seeds, static_cast<uint32_t>(slot));
      std::complex<double> value = 0.0;
      for (uint32_t n = 0; n < w.samples; ++n)
        value += std::complex<double>(spectrum[n]) *
                 unit_phasor(fraction_of_turn((double(n) - w.middle_sample()) * spacing * symbol_s));
      value *= echo.amplitude * std::sqrt(config.transmit_power_w) *
               unit_phasor(-turns_of(w.carrier_hz, delay) - w.band_turns(t, static_cast<uint32_t>(slot)));
      sum += std::conj(value);
    }
  return sum;
}

}  // namespace

std::vector<std::complex<double>> coded_direct(const RadarSignalConfig& config, const EchoList& list,
                                               const RadarSeeds& seeds) {
  const RadarWaveform& w = config.waveform;
  const uint32_t receivers = static_cast<uint32_t>(config.arrays.receive_m.size()), count = w.samples;
  const Symbols symbols(w);
  std::vector<std::complex<double>> cube(size_t{receivers} * w.slots * count);
  parallel_for(w.slots, 0, [&](size_t index) {
    const uint32_t slot = static_cast<uint32_t>(index);
    const auto spectrum = symbols.spectrum(seeds, slot);
    for (uint32_t r = 0; r < receivers; ++r) {
      std::vector<std::complex<double>> signal(count);
      for (uint32_t i = 0; i < count; ++i)
        for (uint32_t repetition = 0; repetition < w.averages; ++repetition)
          signal[i] += coded_sample(config, list, symbols, seeds, r,
                                    w.slot_start_s(slot) + w.latest_delay_s() + repetition * w.sampled_s() +
                                        i / w.sample_rate_hz) /
                       double(w.averages);
      for (uint32_t n = 0; n < count; ++n) {
        std::complex<double> line = 0.0;
        for (uint32_t i = 0; i < count; ++i)
          line += signal[i] * unit_phasor(fraction_of_turn((double(n) - w.middle_sample()) * i / count));
        cube[size_t{w.row(r, slot)} * count + n] = line * std::complex<double>(spectrum[n]) / double(count);
      }
    }
  });
  return cube;
}

}  // namespace greatx::rf::testing
