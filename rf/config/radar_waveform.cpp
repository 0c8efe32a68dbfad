// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/config/radar_waveform.h"

#include <bit>

namespace greatx::rf {
namespace {

/// Returns a waveform whose N samples stand for N lines over `bandwidth_hz`, taken at `rate_hz`.
RadarWaveform lines(double carrier_hz, double bandwidth_hz, uint32_t samples, double rate_hz) {
  RadarWaveform w;
  w.carrier_hz = carrier_hz;
  w.samples = samples;
  w.sample_rate_hz = rate_hz;
  w.slope_hz_per_s = bandwidth_hz * rate_hz / samples;
  w.transmitters = 1;
  return w;
}

void set_time(RadarWaveform& w, double signal_s, double interval_s) {
  w.chirp_s = signal_s;
  w.interval_s = interval_s == 0.0 ? signal_s : interval_s;
}

bool odd_prime(uint32_t value) {
  if (value < 3 || value % 2 == 0) return false;
  for (uint32_t factor = 3; factor * factor <= value; factor += 2)
    if (value % factor == 0) return false;
  return true;
}

}  // namespace

RadarWaveform waveform_of(const SteppedFrequency& s) {
  RadarWaveform w = lines(s.carrier_hz, s.step_hz * s.steps, s.steps, 1.0 / s.step_s);
  w.modulation = RadarModulation::stepped;
  w.integration_s = s.step_s - s.settle_s;
  w.adc_start_s = 0.5 * (s.step_s + s.settle_s);
  set_time(w, s.steps * s.step_s, s.interval_s);
  return w;
}

RadarWaveform waveform_of(const OfdmSymbols& o) {
  const double bandwidth_hz = o.spacing_hz * o.subcarriers;
  RadarWaveform w = lines(o.carrier_hz, bandwidth_hz, o.subcarriers, bandwidth_hz);
  w.modulation = RadarModulation::ofdm;
  w.adc_start_s = o.prefix_s;
  set_time(w, o.prefix_s + 1.0 / o.spacing_hz, o.interval_s);
  return w;
}

RadarWaveform waveform_of(const PhaseCode& c) {
  RadarWaveform w = lines(c.carrier_hz, c.chip_rate_hz, c.chips, c.chip_rate_hz);
  w.modulation = RadarModulation::pmcw;
  w.code = c.code;
  w.averages = c.averages;
  const double period_s = c.chips / c.chip_rate_hz;
  w.adc_start_s = period_s * (1.0 + 0.5 * (c.averages - 1.0));
  set_time(w, period_s * (1.0 + c.averages), c.interval_s);
  return w;
}

bool code_exists(RadarCode code, uint32_t chips) {
  if (chips < 16 || chips > 65536) return false;
  if (code == RadarCode::m_sequence) return std::has_single_bit(chips + 1);
  return chips % 2 == 0 && odd_prime(chips / 2 - 1);
}

}  // namespace greatx::rf
