// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/config/radar_config.h"

#include <cmath>

#include <fmt/format.h>

namespace greatx::rf {
namespace {

using Fault = std::optional<RadarFault>;

/// Sums and quotients of a scenario's decimal numbers may miss equality by rounding errors.
constexpr double rounding = 1.0 + 1e-12;

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

Fault check_positive(const char* field, double value) {
  if (positive(value)) return {};
  return RadarFault{field, fmt::format("expected a number above 0, found {}", value)};
}

/// Holds the names of a waveform's fields that several waveforms share under their own names.
struct FieldNames {
  const char *slope, *rate, *samples, *slots;
};
FieldNames names_of(const RadarWaveform& w) {
  switch (w.modulation) {
    case RadarModulation::fmcw:
      return {"waveform.slope_hz_per_s", "waveform.sample_rate_hz", "waveform.samples", "waveform.chirps"};
    case RadarModulation::stepped:
      return {"waveform.step_hz", "waveform.step_s", "waveform.steps", "waveform.sweeps"};
    case RadarModulation::ofdm:
      return {"waveform.spacing_hz", "waveform.spacing_hz", "waveform.subcarriers", "waveform.symbols"};
    case RadarModulation::pmcw:
      break;
  }
  return {"waveform.chip_rate_hz", "waveform.chip_rate_hz", "waveform.chips", "waveform.blocks"};
}

/// Checks that the signal of a slot fits the slot.
Fault check_times(const RadarWaveform& w, const FieldNames& names) {
  const bool ramps = w.modulation == RadarModulation::fmcw;
  if (!ramps && w.chirp_s > w.interval_s * rounding)
    return RadarFault{
        "waveform.interval_s",
        fmt::format("expected at least the {} s that a slot takes, found {} s", w.chirp_s, w.interval_s)};
  if (w.chirp_s > w.interval_s * rounding)
    return RadarFault{
        "waveform.chirp_s",
        fmt::format("expected a chirp no longer than the interval from one to the next, {} s; found {} s",
                    w.interval_s, w.chirp_s)};
  if (ramps && w.adc_start_s + w.sampled_s() > w.chirp_s * rounding)
    return RadarFault{
        names.samples,
        fmt::format(
            "expected samples that fit the chirp of {} s; {} samples at {} Hz from {} s on end at {} s",
            w.chirp_s, w.samples, w.sample_rate_hz, w.adc_start_s, w.adc_start_s + w.sampled_s())};
  if (w.modulation == RadarModulation::stepped && !positive(w.integration_s))
    return RadarFault{"waveform.settle_s",
                      fmt::format("expected less than the {} s of a step, found {} s left to integrate",
                                  1.0 / w.sample_rate_hz, w.integration_s)};
  return {};
}

Fault check_slots(const RadarWaveform& w, const FieldNames& names) {
  if (w.multiplexing == RadarMultiplexing::doppler) {
    if (w.empty_bands == 0 || w.empty_bands > 64)
      return RadarFault{"waveform.empty_bands",
                        fmt::format("expected 1 to 64 empty Doppler bands, found {}", w.empty_bands)};
    if (w.transmitters < 2)
      return RadarFault{"waveform.multiplexing",
                        fmt::format("expected two or more transmitters for ddm, found {}", w.transmitters)};
    if (w.slots % w.bands() != 0 || w.slots / w.bands() < 4)
      return RadarFault{
          names.slots, fmt::format("expected a multiple of the {} Doppler bands ({} transmitters, {} empty), "
                                   "4 times or more; found {}",
                                   w.bands(), w.transmitters, w.empty_bands, w.slots)};
  } else if (w.transmitters > w.slots) {
    return RadarFault{
        names.slots,
        fmt::format(
            "expected at least one slot for each of {} transmitters, which send one at a time; found {}",
            w.transmitters, w.slots)};
  } else if (w.slots % w.transmitters != 0) {
    return RadarFault{names.slots, fmt::format("expected a multiple of the {} transmitters, found {}",
                                               w.transmitters, w.slots)};
  }
  if (w.slots > 1u << 20)
    return RadarFault{names.slots, fmt::format("expected at most {} slots, found {}", 1u << 20, w.slots)};
  return {};
}

Fault check_code(const RadarWaveform& w) {
  if (w.modulation != RadarModulation::pmcw) return {};
  if (w.averages == 0 || w.averages > 65536)
    return RadarFault{"waveform.averages", fmt::format("expected 1 to 65536 averages, found {}", w.averages)};
  if (!code_exists(w.code, w.samples))
    return RadarFault{
        "waveform.chips",
        fmt::format("expected {}; found {}",
                    w.code == RadarCode::m_sequence
                        ? "2^k - 1 chips of an m_sequence, k from 5 to 16"
                        : "2 (p + 1) chips of an apas code, p an odd prime, 16 to 65536 in all (16, 28, 64, "
                          "124, 256, 1000, 1020, 2044 are some)",
                    w.samples)};
  return {};
}

Fault check_waveform(const RadarWaveform& w) {
  const FieldNames names = names_of(w);
  for (const auto& [field, value] : {std::pair{"waveform.carrier_hz", w.carrier_hz},
                                     {names.slope, w.slope_hz_per_s},
                                     {"waveform.chirp_s", w.chirp_s},
                                     {"waveform.interval_s", w.interval_s},
                                     {names.rate, w.sample_rate_hz}})
    if (Fault fault = check_positive(field, value)) return fault;
  if (!std::isfinite(w.adc_start_s) || w.adc_start_s < 0.0)
    return RadarFault{"waveform.adc_start_s", fmt::format("expected 0 or more, found {} s", w.adc_start_s)};
  if (w.samples < 16 || w.samples > 65536)
    return RadarFault{names.samples, fmt::format("expected 16 to 65536 {}, found {}",
                                                 w.modulation == RadarModulation::fmcw ? "samples a chirp"
                                                                                       : names.samples + 9,
                                                 w.samples)};
  if (w.transmitters == 0)
    return RadarFault{"arrays.transmit_m", "expected at least one transmitter, found none"};
  if (Fault fault = check_times(w, names)) return fault;
  // Beyond these bounds, bins and noise exceed the range of the numbers in files.
  constexpr double least_bandwidth_hz = 1e-3, most_sample_rate_hz = 1e12;
  if (w.sample_rate_hz > most_sample_rate_hz)
    return RadarFault{names.rate, fmt::format("expected at most {:g} Hz, found {} Hz", most_sample_rate_hz,
                                              w.sample_rate_hz)};
  if (w.bandwidth_hz() < least_bandwidth_hz)
    return RadarFault{
        names.slope,
        fmt::format("expected a {} that covers {:g} Hz at least while it is sampled, found {} Hz",
                    w.modulation == RadarModulation::fmcw ? "ramp" : "slot", least_bandwidth_hz,
                    w.bandwidth_hz())};
  if (w.bandwidth_hz() >= 2.0 * w.carrier_hz)
    return RadarFault{
        names.slope,
        fmt::format("expected a {} that stays above 0 Hz; it covers {} Hz about {} Hz",
                    w.modulation == RadarModulation::fmcw ? "ramp" : "band", w.bandwidth_hz(), w.carrier_hz)};
  if (Fault fault = check_code(w)) return fault;
  return check_slots(w, names);
}

Fault check_arrays(const RadarSignalConfig& config) {
  if (config.arrays.transmit_m.size() != config.waveform.transmitters)
    return RadarFault{"arrays.transmit_m",
                      fmt::format("expected the waveform's {} transmitters, found {} positions",
                                  config.waveform.transmitters, config.arrays.transmit_m.size())};
  if (config.arrays.receive_m.empty())
    return RadarFault{"arrays.receive_m", "expected at least one receiver, found none"};
  for (const auto& [field, positions] : {std::pair{"arrays.transmit_m", &config.arrays.transmit_m},
                                         {"arrays.receive_m", &config.arrays.receive_m}})
    for (const dvec3& p : *positions)
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        return RadarFault{field,
                          fmt::format("expected positions in metres, found ({}, {}, {})", p.x, p.y, p.z)};
  const uint64_t antennas = uint64_t{config.waveform.transmitters} * config.arrays.receive_m.size();
  if (antennas > 4096)
    return RadarFault{"arrays.receive_m",
                      fmt::format("expected at most 4096 virtual antennas, found {}", antennas)};
  return {};
}

Fault check_receiver(const RadarReceiver& receiver, const RadarWaveform& waveform) {
  const double sample_rate_hz = waveform.sample_rate_hz;
  if (receiver.phase_noise && waveform.modulation != RadarModulation::fmcw)
    return RadarFault{"receiver.phase_noise",
                      "expected none: phase noise is modelled for waveform.type fmcw alone"};
  if (receiver.adc && waveform.averages > 1)
    return RadarFault{
        "receiver.adc",
        "expected none with waveform.averages above 1: the steps of a converter act before the mean"};
  if (receiver.leakage) {
    if (!(receiver.leakage->level_db >= -300.0 && receiver.leakage->level_db <= 0.0))
      return RadarFault{"receiver.leakage.level_db",
                        fmt::format("expected -300 to 0 dB, found {}", receiver.leakage->level_db)};
    if (!(receiver.leakage->length_m >= 0.0 && receiver.leakage->length_m <= 1e6))
      return RadarFault{"receiver.leakage.length_m",
                        fmt::format("expected 0 to 1e6 m, found {}", receiver.leakage->length_m)};
  }
  if (receiver.noise_figure_db && !(*receiver.noise_figure_db >= 0.0 && *receiver.noise_figure_db <= 200.0))
    return RadarFault{"receiver.noise_figure_db",
                      fmt::format("expected 0 to 200 dB, found {}", *receiver.noise_figure_db)};
  if (receiver.phase_noise) {
    if (!(receiver.phase_noise->level_dbc_hz >= -300.0 && receiver.phase_noise->level_dbc_hz <= 0.0))
      return RadarFault{
          "receiver.phase_noise.level_dbc_hz",
          fmt::format("expected -300 to 0 dBc/Hz, found {}", receiver.phase_noise->level_dbc_hz)};
    if (Fault fault = check_positive("receiver.phase_noise.pole_hz", receiver.phase_noise->pole_hz))
      return fault;
    if (receiver.phase_noise->pole_hz > 50.0 * sample_rate_hz)
      return RadarFault{"receiver.phase_noise.pole_hz",
                        fmt::format("expected at most 50 times the sample rate, found {} Hz",
                                    receiver.phase_noise->pole_hz)};
  }
  if (receiver.adc) {
    if (receiver.adc->bits < 2 || receiver.adc->bits > 24)
      return RadarFault{"receiver.adc.bits",
                        fmt::format("expected 2 to 24 bits, found {}", receiver.adc->bits)};
    if (!(std::abs(receiver.adc->full_scale_dbm) <= 200.0))
      return RadarFault{"receiver.adc.full_scale_dbm",
                        fmt::format("expected -200 to 200 dBm, found {}", receiver.adc->full_scale_dbm)};
  }
  return {};
}

Fault check_processing(const RadarSignalConfig& config) {
  const RadarProcessing& p = config.processing;
  if (p.azimuths < 2 || p.azimuths > 4096)
    return RadarFault{"processing.azimuths",
                      fmt::format("expected 2 to 4096 azimuths, found {}", p.azimuths)};
  if (!positive(p.azimuth_limit) || p.azimuth_limit > pi)
    return RadarFault{
        "processing.azimuth_limit",
        fmt::format("expected above 0 and at most 180 degrees, found {}", degrees(p.azimuth_limit))};
  if (!p.detections) return {};
  const RadarCfar& c = p.cfar;
  if (!(c.false_alarm > 0.0 && c.false_alarm <= 0.1))
    return RadarFault{"processing.cfar.false_alarm",
                      fmt::format("expected above 0 and at most 0.1, found {}", c.false_alarm)};
  if (!(c.rank > 0.0 && c.rank <= 1.0))
    return RadarFault{"processing.cfar.rank",
                      fmt::format("expected above 0 and at most 1, found {}", c.rank)};
  if (c.train_range == 0)
    return RadarFault{"processing.cfar.train_range", "expected at least one training cell in range, found 0"};
  const uint64_t range_reach = uint64_t{c.guard_range} + c.train_range;
  const uint64_t doppler_reach = uint64_t{c.guard_doppler} + c.train_doppler;
  if (range_reach >= config.waveform.samples)
    return RadarFault{
        "processing.cfar.train_range",
        fmt::format("expected guard and training cells within {} range bins, found {} on each side",
                    config.waveform.samples, range_reach)};
  const uint32_t bins = config.waveform.chirps() / config.waveform.bands();
  if (2 * doppler_reach + 1 > bins)
    return RadarFault{
        "processing.cfar.train_doppler",
        fmt::format("expected guard and training cells within {} Doppler bins, found {} on each side", bins,
                    doppler_reach)};
  return {};
}

}  // namespace

std::optional<RadarFault> check(const RadarSignalConfig& config) {
  if (Fault fault = check_waveform(config.waveform)) return fault;
  if (Fault fault = check_arrays(config)) return fault;
  if (Fault fault = check_positive("transmit_power_w", config.transmit_power_w)) return fault;
  if (Fault fault = check_receiver(config.receiver, config.waveform)) return fault;
  return check_processing(config);
}

}  // namespace greatx::rf
