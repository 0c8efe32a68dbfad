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
        factors_(w_.samples),
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
      if (sent != spectrum_slot_) spectrum_ = symbols_.spectrum(seeds_, sent), spectrum_slot_ = sent;
      for (uint32_t t = 0; t < w_.transmitters; ++t) {
        if (w_.loop() > 1 && t != sent % w_.transmitters) continue;
        const std::complex<double> amplitude = std::conj(echo.amplitude) *
                                               std::sqrt(config_.transmit_power_w / w_.samples) *
                                               unit_phasor(w_.band_turns(t, sent));
        for (size_t r = 0; r < receive_leads.size(); r += Fft::lanes)
          add(amplitude, at.delay_s - transmit_leads[t], std::span(receive_leads).subspan(r), at.rate,
              double(before) * w_.interval_s, r, signal);
      }
    }
  }

 private:
  /// Adds what one transmitter sent `earlier_s` before the slot to four receivers, or as many as there are.
  void add(std::complex<double> amplitude, double delay_s, std::span<const double> leads, double rate,
           double earlier_s, size_t first_receiver, std::span<std::complex<float>> signal) {
    const uint32_t count = w_.samples, middle = w_.middle_sample();
    const size_t used = std::min<size_t>(Fft::lanes, leads.size());
    for (size_t lane = 0; lane < used; ++lane) {
      const double own_s = delay_s - leads[lane];
      // The lines turn by the delay from the symbol's own samples, from line to line by as much.
      const double step = fraction_of_turn((own_s - earlier_s) / w_.sampled_s());
      const std::complex<double> turn = unit_phasor(step);
      std::complex<double> phasor =
          amplitude * unit_phasor(turns_of(w_.carrier_hz, own_s) - fraction_of_turn(step * middle));
      for (uint32_t n = 0; n < count; ++n, phasor = plain_product(phasor, turn)) {
        const std::complex<double> line =
            plain_product(phasor, std::conj(std::complex<double>(spectrum_[n])));
        Fft::Value& value = lines_[(n + count - middle) % count];
        Four re = value.real(), im = value.imag();
        re.lane[lane] = static_cast<float>(line.real()), im.lane[lane] = static_cast<float>(line.imag());
        value = {re, im};
      }
    }
    transform_.transform(lines_.data(), samples_.data());
    for (size_t lane = 0; lane < used; ++lane) {
      set_factors(delay_s - leads[lane] - earlier_s, rate);
      std::complex<float>* const row =
          signal.data() + size_t{w_.row(static_cast<uint32_t>(first_receiver + lane), slot_)} * w_.samples;
      for (uint32_t i = 0; i < count; ++i)
        row[i] += plain_product(
            std::complex<float>(samples_[i].real().lane[lane], samples_[i].imag().lane[lane]), factors_[i]);
    }
  }

  /// Sets the share of each sample that a symbol has which begins `offset_s` after the slot's own, with the
  /// Doppler shift within the slot.
  void set_factors(double offset_s, double rate) {
    const double prefix_s = w_.latest_delay_s(), period_s = w_.sampled_s();
    const double middle_s = 0.5 * (w_.averages - 1) * period_s + w_.middle_sample() / w_.sample_rate_hz;
    const double doppler_hz = w_.carrier_hz * rate;
    const std::complex<double> turn = unit_phasor(fraction_of_turn(doppler_hz / w_.sample_rate_hz));
    std::fill(factors_.begin(), factors_.end(), std::complex<float>(0.0f));
    for (uint32_t a = 0; a < w_.averages; ++a) {
      std::complex<double> phasor =
          unit_phasor(fraction_of_turn(doppler_hz * (a * period_s - middle_s))) / double(w_.averages);
      for (uint32_t i = 0; i < w_.samples; ++i, phasor = plain_product(phasor, turn)) {
        const double sent_s = i / w_.sample_rate_hz + a * period_s - offset_s;
        // Outside, another slot is on its way, or silence.
        if (sent_s >= -prefix_s && sent_s < w_.chirp_s - prefix_s) factors_[i] += std::complex<float>(phasor);
      }
    }
  }

  const RadarSignalConfig& config_;
  const RadarWaveform& w_;
  const Symbols& symbols_;
  const Fft& transform_;
  const RadarSeeds& seeds_;
  const uint32_t slot_;
  uint32_t spectrum_slot_ = ~0u;  ///< slot of spectrum_
  std::vector<std::complex<float>> spectrum_, factors_;
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
  const Fft transform(config.waveform.samples, Fft::Direction::forward, Fft::Others::chirp);
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
