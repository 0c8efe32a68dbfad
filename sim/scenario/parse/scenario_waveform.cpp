// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the waveform of a radar.
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

constexpr uint32_t most_chirps = 65536;
constexpr double most_rate_hz = 1e12;
const Keys shared_waveform_keys{"type", "multiplexing", "empty_bands", "carrier_hz", "interval_s"};

rf::RadarWaveform parse_ramps(const Field& field, uint32_t& chirps) {
  const FieldMap map(field,
                     shared_waveform_keys + Keys{"bandwidth_hz", "slope_hz_per_s", "chirp_s", "adc_start_s",
                                                 "sample_rate_hz", "samples", "chirps"});
  map.exclude("bandwidth_hz", "slope_hz_per_s");
  rf::RadarWaveform waveform;
  if (const auto f = map.find("carrier_hz")) waveform.carrier_hz = f->positive();
  if (const auto f = map.find("slope_hz_per_s")) waveform.slope_hz_per_s = f->positive();
  if (const auto f = map.find("chirp_s")) waveform.chirp_s = f->positive();
  if (const auto f = map.find("interval_s")) waveform.interval_s = f->positive();
  if (const auto f = map.find("adc_start_s")) waveform.adc_start_s = f->non_negative();
  if (const auto f = map.find("sample_rate_hz")) waveform.sample_rate_hz = f->positive();
  if (const auto f = map.find("samples")) waveform.samples = f->integer32(4, 65536);
  if (const auto f = map.find("chirps")) chirps = f->integer32(1, most_chirps);
  if (const auto f = map.find("bandwidth_hz")) waveform.slope_hz_per_s = f->positive() / waveform.sampled_s();
  return waveform;
}

rf::RadarWaveform parse_steps(const Field& field, uint32_t& chirps) {
  const FieldMap map(
      field, shared_waveform_keys + Keys{"bandwidth_hz", "step_hz", "step_s", "settle_s", "steps", "sweeps"});
  map.exclude("bandwidth_hz", "step_hz");
  rf::SteppedFrequency steps;
  if (const auto f = map.find("carrier_hz")) steps.carrier_hz = f->positive();
  if (const auto f = map.find("step_hz")) steps.step_hz = f->positive();
  if (const auto f = map.find("step_s")) {
    steps.step_s = f->positive();
    steps.settle_s = 0.5 * steps.step_s;
  }
  if (const auto f = map.find("settle_s")) steps.settle_s = f->non_negative();
  if (const auto f = map.find("steps")) steps.steps = f->integer32(16, 65536);
  if (const auto f = map.find("interval_s")) steps.interval_s = f->positive();
  if (const auto f = map.find("sweeps")) chirps = f->integer32(1, most_chirps);
  if (const auto f = map.find("bandwidth_hz")) steps.step_hz = f->positive() / steps.steps;
  return waveform_of(steps);
}

rf::RadarWaveform parse_symbols(const Field& field, uint32_t& chirps) {
  const FieldMap map(field, shared_waveform_keys + Keys{"spacing_hz", "subcarriers", "prefix_s", "symbols"});
  rf::OfdmSymbols symbols;
  if (const auto f = map.find("carrier_hz")) symbols.carrier_hz = f->positive();
  if (const auto f = map.find("spacing_hz")) symbols.spacing_hz = f->positive();
  if (const auto f = map.find("subcarriers")) symbols.subcarriers = f->integer32(16, 65536);
  if (const auto f = map.find("prefix_s")) symbols.prefix_s = f->non_negative();
  if (const auto f = map.find("interval_s")) symbols.interval_s = f->positive();
  if (const auto f = map.find("symbols")) chirps = f->integer32(1, most_chirps);
  return waveform_of(symbols);
}

rf::RadarWaveform parse_code(const Field& field, uint32_t& chirps) {
  const FieldMap map(field,
                     shared_waveform_keys + Keys{"chip_rate_hz", "code", "chips", "averages", "blocks"});
  rf::PhaseCode code;
  if (const auto f = map.find("carrier_hz")) code.carrier_hz = f->positive();
  if (const auto f = map.find("chip_rate_hz")) code.chip_rate_hz = f->positive(least_number, most_rate_hz);
  if (const auto f = map.find("code"))
    code.code = f->choice({"m_sequence", "apas"}) == 0 ? rf::RadarCode::m_sequence : rf::RadarCode::apas;
  if (code.code == rf::RadarCode::apas) code.chips = 1000;
  if (const auto f = map.find("chips")) code.chips = f->integer32(16, 65536);
  if (const auto f = map.find("averages")) code.averages = f->integer32(1, 65536);
  if (const auto f = map.find("interval_s")) code.interval_s = f->positive();
  if (const auto f = map.find("blocks")) chirps = f->integer32(1, most_chirps);
  return waveform_of(code);
}

/// Parses how the transmitters share the waveform. The keys of the map are known to be good.
void parse_multiplexing(const Field& field, rf::RadarWaveform& waveform) {
  for (const auto& [key, value] : field.entries())
    if (key == "multiplexing" && value.choice({"tdm", "ddm"}) == 1)
      waveform.multiplexing = rf::RadarMultiplexing::doppler;
  for (const auto& [key, value] : field.entries()) {
    if (key != "empty_bands") continue;
    if (waveform.multiplexing != rf::RadarMultiplexing::doppler) value.refuse("only with multiplexing: ddm");
    waveform.empty_bands = value.integer32(1, 64);
  }
}

}  // namespace

rf::RadarWaveform parse_waveform(const Field& field, uint32_t& chirps) {
  constexpr rf::RadarWaveform (*parsers[])(const Field&, uint32_t&) = {parse_ramps, parse_steps,
                                                                       parse_symbols, parse_code};
  size_t type = 0;
  for (const auto& [key, value] : field.entries())
    if (key == "type") type = value.choice({"fmcw", "stepped", "ofdm", "pmcw"});
  rf::RadarWaveform waveform = parsers[type](field, chirps);
  parse_multiplexing(field, waveform);
  return waveform;
}

}  // namespace greatx::sim
