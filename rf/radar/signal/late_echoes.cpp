// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/late_echoes.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/phase.h"
#include "rf/radar/signal/delay.h"
#include "rf/radar/signal/fft.h"

namespace greatx::rf {
namespace {

/// Adds the late echoes of one slot. A task has one object for its slot.
class LateSlot {
 public:
  LateSlot(const RadarSignalConfig& config, const Symbols& symbols, const Fft& transform,
           const RadarSeeds& seeds, uint32_t slot)
      : config_(config),
        w_(config.waveform),
        symbols_(symbols),
        transform_(transform),
        seeds_(seeds),
        slot_(slot),
        lines_(w_.samples),
        samples_(w_.samples) {}

  /// Adds what an echo brings of every slot that is on its way.
  void add(const EchoList& list, const Echo& echo, const std::vector<double>& transmit_leads,
           const std::vector<double>& receive_leads, std::span<std::complex<float>> signal) {
    const DelayAt at = delay_at(list, echo.delay, w_.interval_s, w_.slot_middle_s(slot_));
    const double window_s = w_.averages * w_.sampled_s(), prefix_s = w_.latest_delay_s();
    const int64_t first =
        static_cast<int64_t>(std::max(0.0, std::floor((at.delay_s - prefix_s - window_s) / w_.interval_s)));
    for (int64_t before = first; before <= slot_ && double(before) * w_.interval_s < at.delay_s + window_s;
         ++before) {
      const uint32_t sent = slot_ - static_cast<uint32_t>(before);
      spectrum_ = symbols_.spectrum(seeds_, sent);
      for (uint32_t t = 0; t < w_.transmitters; ++t) {
        if (w_.loop() > 1 && t != sent % w_.transmitters) continue;
        for (size_t r = 0; r < receive_leads.size(); ++r)
          add(echo, at.delay_s - transmit_leads[t] - receive_leads[r], at.rate, static_cast<double>(before),
              w_.band_turns(t, sent), row_of(r, signal));
      }
    }
  }

 private:
  std::span<std::complex<float>> row_of(size_t receiver, std::span<std::complex<float>> signal) const {
    return signal.subspan(size_t{w_.row(static_cast<uint32_t>(receiver), slot_)} * w_.samples, w_.samples);
  }

  /// Adds what one transmitter sent `before` slots ago.
  void add(const Echo& echo, double delay_s, double rate, double before, double band_turns,
           std::span<std::complex<float>> row) {
    const uint32_t count = w_.samples, middle = w_.middle_sample();
    const double period_s = w_.sampled_s(), prefix_s = w_.latest_delay_s();
    const double offset_s = delay_s - before * w_.interval_s;  // of the samples from the symbol's own
    const std::complex<double> amplitude = std::conj(echo.amplitude) *
                                           std::sqrt(config_.transmit_power_w / count) *
                                           unit_phasor(turns_of(w_.carrier_hz, delay_s) + band_turns);
    for (uint32_t q = 0; q < count; ++q) {
      const uint32_t n = (q + middle) % count;
      const std::complex<double> line =
          amplitude * unit_phasor(fraction_of_turn((double(n) - middle) / period_s * offset_s)) *
          std::conj(std::complex<double>(spectrum_[n]));
      lines_[q] = {Four(static_cast<float>(line.real())), Four(static_cast<float>(line.imag()))};
    }
    transform_.transform(lines_.data(), samples_.data());
    const double middle_s = 0.5 * (w_.averages - 1) * period_s + middle / w_.sample_rate_hz;
    for (uint32_t i = 0; i < count; ++i) {
      std::complex<double> factor = 0.0;
      for (uint32_t a = 0; a < w_.averages; ++a) {
        const double at_s = i / w_.sample_rate_hz + a * period_s, sent_s = at_s - offset_s;
        if (sent_s < -prefix_s || sent_s >= w_.chirp_s - prefix_s) continue;  // another slot, or silence
        factor += unit_phasor(fraction_of_turn(w_.carrier_hz * rate * (at_s - middle_s)));
      }
      row[i] += plain_product(std::complex<float>(samples_[i].real().lane[0], samples_[i].imag().lane[0]),
                              std::complex<float>(factor / double(w_.averages)));
    }
  }

  const RadarSignalConfig& config_;
  const RadarWaveform& w_;
  const Symbols& symbols_;
  const Fft& transform_;
  const RadarSeeds& seeds_;
  const uint32_t slot_;
  std::vector<std::complex<float>> spectrum_;
  std::vector<Fft::Value> lines_, samples_;
};

}  // namespace

bool is_late(const EchoList& list, const Echo& echo, const RadarWaveform& w) {
  const double middle_s =
      0.5 * (w.slot_middle_s(list.first_slot) + w.slot_middle_s(list.first_slot + list.slots - 1));
  return delay_at(list, echo.delay, w.interval_s, middle_s).delay_s > w.latest_delay_s();
}

void add_late_echoes(const RadarSignalConfig& config, const Symbols& symbols, const EchoList& list,
                     const RadarAttitude& attitude, const RadarSeeds& seeds, uint32_t threads,
                     std::span<std::complex<float>> signal) {
  if (list.echoes.empty()) return;
  const Fft transform(config.waveform.samples, Fft::Direction::forward);
  std::vector<std::vector<double>> transmit, receive;
  for (const Echo& echo : list.echoes) {
    transmit.push_back(transmitter_leads(config.arrays, attitude, echo));
    receive.push_back(receiver_leads(config.arrays, attitude, echo));
  }
  parallel_for(list.slots, threads, [&](size_t index) {
    LateSlot slot(config, symbols, transform, seeds, list.first_slot + static_cast<uint32_t>(index));
    for (size_t e = 0; e < list.echoes.size(); ++e)
      slot.add(list, list.echoes[e], transmit[e], receive[e], signal);
  });
}

}  // namespace greatx::rf
