// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/interference.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/phase.h"

namespace greatx::rf {
namespace {

/// Samples [first, last) of a slot.
struct SampleRun {
  int64_t first = 0, last = 0;
};

/// Adds one ramp of the other radar to the slots of a receiver.
class RampMixer {
 public:
  RampMixer(const RadarSignalConfig& config, const Interferer& other, const RadarAttitude& attitude)
      : w_(config.waveform),
        other_(other),
        transmit_(element_leads(other.arrays.transmit_m, other.orientation, other.departure)),
        receive_(element_leads(config.arrays.receive_m, attitude.receiver, other.arrival)),
        amplitude_(std::conj(other.amplitude) * std::sqrt(other.power_w)) {}

  size_t receivers() const { return receive_.size(); }

  /// Returns the ramps that may arrive during a slot.
  std::pair<int64_t, int64_t> ramps(uint32_t slot) const {
    const RadarWaveform& o = other_.waveform;
    const double begin_s = w_.slot_start_s(slot) + w_.adc_start_s, end_s = begin_s + w_.sampled_s();
    const double sent_s = begin_s - other_.start_s - delay_at(begin_s),
                 last_s = end_s - other_.start_s - delay_at(end_s);
    return {std::max<int64_t>(0, static_cast<int64_t>(std::floor(sent_s / o.interval_s)) - 1),
            std::min<int64_t>(o.slots, static_cast<int64_t>(std::floor(last_s / o.interval_s)) + 2)};
  }

  /// Returns the samples of `slot` during which a ramp is there and within the band.
  SampleRun run_of(uint32_t slot, uint32_t ramp, double lead_s) const {
    const RadarWaveform& o = other_.waveform;
    const double first_s = w_.slot_start_s(slot) + w_.adc_start_s, scale = 1.0 - other_.rate;
    // The time on the other radar's clock is scale t + shift.
    const double shift = other_.rate * other_.mid_s - other_.delay_s + lead_s - other_.start_s;
    double low = (o.slot_start_s(ramp) - shift) / scale,
           high = (o.slot_start_s(ramp) + o.chirp_s - shift) / scale;
    // f - f_i = difference at t = 0, plus slope t.
    const double slope = w_.slope_hz_per_s - o.slope_hz_per_s * scale;
    const double difference = w_.carrier_hz - w_.slope_hz_per_s * w_.slot_middle_s(slot) - o.carrier_hz -
                              o.slope_hz_per_s * (shift - o.slot_middle_s(ramp));
    const double half = 0.5 * w_.sample_rate_hz;
    if (slope != 0.0) {
      const double a = (-half - difference) / slope, b = (half - difference) / slope;
      low = std::max(low, std::min(a, b));
      high = std::min(high, std::max(a, b));
    } else if (std::abs(difference) >= half) {
      return {};
    }
    const auto sample = [&](double time_s) {
      return static_cast<int64_t>(
          std::ceil(std::clamp((time_s - first_s) * w_.sample_rate_hz, 0.0, double(w_.samples))));
    };
    const SampleRun run{sample(low), sample(high)};
    return run.last > run.first ? run : SampleRun{};
  }

  std::complex<float> sample(uint32_t slot, uint32_t ramp, int64_t n, double lead_s, double band) const {
    const RadarWaveform& o = other_.waveform;
    const double u = (double(n) - w_.middle_sample()) / w_.sample_rate_hz;
    const double time_s = w_.slot_middle_s(slot) + u;
    const double v = time_s - delay_at(time_s) + lead_s - other_.start_s - o.slot_middle_s(ramp);
    const double turns = fraction_of_turn(turns_of(w_.carrier_hz, u) + 0.5 * w_.slope_hz_per_s * u * u -
                                          turns_of(o.carrier_hz, v) - 0.5 * o.slope_hz_per_s * v * v) +
                         other_.phase_turns + band;
    return std::complex<float>(amplitude_ * unit_phasor(turns));
  }

  InterferenceReport add(uint32_t slot, std::span<std::complex<float>> cube) const {
    const RadarWaveform& o = other_.waveform;
    InterferenceReport report;
    const auto [first, last] = ramps(slot);
    for (int64_t index = first; index < last; ++index) {
      const uint32_t ramp = static_cast<uint32_t>(index);
      for (uint32_t t = 0; t < o.transmitters; ++t) {
        if (o.loop() > 1 && t != ramp % o.transmitters) continue;
        const double band = o.band_turns(t, ramp);
        for (uint32_t r = 0; r < receive_.size(); ++r) {
          const double lead_s = transmit_[t] + receive_[r];
          const SampleRun run = run_of(slot, ramp, lead_s);
          std::complex<float>* const row = cube.data() + size_t{w_.row(r, slot)} * w_.samples;
          for (int64_t n = run.first; n < run.last; ++n) row[n] += sample(slot, ramp, n, lead_s, band);
          report.samples += static_cast<uint64_t>(run.last - run.first);
        }
      }
    }
    report.energy_w_s =
        double(report.samples) * std::norm(amplitude_) / (w_.sample_rate_hz * double(receive_.size()));
    return report;
  }

 private:
  double delay_at(double time_s) const { return other_.delay_s + other_.rate * (time_s - other_.mid_s); }

  const RadarWaveform& w_;
  const Interferer& other_;
  std::vector<double> transmit_, receive_;  ///< leads, s
  std::complex<double> amplitude_;
};

}  // namespace

InterferenceReport add_interference(const RadarSignalConfig& config, const Interferer& interferer,
                                    const RadarAttitude& attitude, uint32_t threads,
                                    std::span<std::complex<float>> cube) {
  const RampMixer mixer(config, interferer, attitude);
  std::vector<InterferenceReport> reports(interferer.slots);
  parallel_for(interferer.slots, threads, [&](size_t i) {
    reports[i] = mixer.add(interferer.first_slot + static_cast<uint32_t>(i), cube);
  });
  InterferenceReport sum;
  for (const InterferenceReport& report : reports) {
    sum.samples += report.samples;
    sum.energy_w_s += report.energy_w_s;
  }
  return sum;
}

}  // namespace greatx::rf
