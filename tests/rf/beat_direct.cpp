// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/rf/beat_direct.h"

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/phase.h"
#include "rf/radar/signal/delay.h"

namespace greatx::rf::testing {

void beat_direct(const RadarSignalConfig& config, const EchoList& list, const RadarAttitude& attitude,
                 uint32_t threads, std::span<std::complex<double>> cube) {
  const RadarWaveform& w = config.waveform;
  const size_t receivers = config.arrays.receive_m.size(), chirps = w.chirps();
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
    const uint32_t transmitter = slot % w.transmitters, chirp = slot / w.transmitters;
    for (size_t e = 0; e < list.echoes.size(); ++e) {
      const std::complex<double> amplitude =
          std::conj(list.echoes[e].amplitude) * std::sqrt(config.transmit_power_w);
      for (uint32_t n = 0; n < w.samples; ++n) {
        const double u = (double(n) - w.middle_sample()) / w.sample_rate_hz;
        const double tau =
            delay_at(list, list.echoes[e].delay, w.interval_s, w.slot_middle_s(slot) + u).delay_s;
        for (size_t r = 0; r < receivers; ++r) {
          const double delay = tau - echo_leads[e].transmitter[transmitter] - echo_leads[e].receiver[r];
          const double turns = turns_of(w.carrier_hz, delay) + w.slope_hz_per_s * delay * (u - 0.5 * delay);
          cube[((r * w.transmitters + transmitter) * chirps + chirp) * w.samples + n] +=
              amplitude * unit_phasor(fraction_of_turn(turns));
        }
      }
    }
  });
}

}  // namespace greatx::rf::testing
