// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/radar_processor.h"

#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "rf/radar/signal/delay.h"
#include "rf/radar/signal/demultiplex.h"
#include "rf/radar/signal/late_echoes.h"

namespace greatx::rf {
namespace {

const RadarSignalConfig& checked(const std::string& name, const RadarSignalConfig& config) {
  const auto fault = check(config);
  GREATX_CHECK(!fault, "radar '{}': {}: {}", name, fault->field, fault->message);
  return config;
}

uint64_t late_echoes(const EchoList& list, const RadarWaveform& w) {
  uint64_t count = 0;
  for (const Echo& echo : list.echoes)
    count += delay_at(list, echo.delay, w.interval_s, w.slot_middle_s(list.first_slot)).delay_s >
             w.latest_delay_s();
  return count;
}

/// Returns the echo of what each receiver takes from each transmitter without the scene. It has no direction,
/// so that no element leads another one.
EchoList leakage_of(const RadarLeakage& leakage, const RadarWaveform& w) {
  Echo echo;
  echo.amplitude = std::sqrt(from_decibels(leakage.level_db));
  echo.delay.coefficients[0] = leakage.length_m / speed_of_light;
  EchoList list;
  list.slots = w.slots;
  list.echoes.push_back(echo);
  return list;
}

/// Returns the detector of noise. With Doppler multiplexing it works on the folded map, whose cells are the
/// largest of as many as there are bands: one of them exceeds a threshold at most that many times as often.
Cfar detector_of(const RadarSignalConfig& config, const RadarMaps& maps) {
  const uint32_t antennas =
      static_cast<uint32_t>(config.arrays.receive_m.size()) * config.waveform.transmitters;
  const uint32_t bands = config.waveform.bands();
  if (bands == 1) return {config.processing.cfar, maps.range_window(), maps.doppler_window(), antennas};
  RadarCfar cfar = config.processing.cfar;
  cfar.false_alarm /= bands;
  return {cfar, maps.range_window(),
          Window(config.processing.doppler_window, config.waveform.chirps() / bands), antennas,
          noise_rise(config.waveform, config.arrays.receive_m.size())};
}

}  // namespace

RadarProcessor::RadarProcessor(std::string name, const RadarSignalConfig& config, RadarGain transmit_gain,
                               RadarGain receive_gain)
    : name_(std::move(name)),
      config_(checked(name_, config)),
      synthesizer_(config_),
      patches_(config_),
      maps_(config_) {
  if (config_.waveform.coded()) symbols_.emplace(config_.waveform);
  if (!config_.processing.detections) return;
  cfar_.emplace(detector_of(config_, maps_));
  maker_.emplace(config_, maps_, std::move(transmit_gain), std::move(receive_gain));
}

void RadarProcessor::add_echoes(const RadarFrameInput& input, std::span<const EchoList> timely,
                                const PhaseWalk* walk, uint32_t term, uint32_t threads,
                                std::span<std::complex<float>> cube, BeatReport& report) const {
  const auto add = [&](const EchoList& list, const RadarAttitude& attitude) {
    const BeatReport added = synthesizer_.add(list, attitude, walk, threads, cube, term);
    report.tones += added.tones;
    report.bent_tones += added.bent_tones;
  };
  for (size_t i = 0; i < input.lists.size(); ++i) {
    const EchoList& list = input.lists[i];
    const RadarAttitude& attitude = input.attitude(i);
    add(timely[i], attitude);
    patches_.add(list.patches, list.first_slot, list.slots, attitude, walk, threads, cube, term);
  }
  // Leakage does not move, so that it has the first term alone.
  if (config_.receiver.leakage && term == 0)
    add(leakage_of(*config_.receiver.leakage, config_.waveform), input.attitudes[0]);
}

RadarCube RadarProcessor::received(const RadarFrameInput& input, uint32_t threads,
                                   RadarReport& report) const {
  const RadarWaveform& w = config_.waveform;
  RadarCube cube(config_.arrays.receive_m.size() * w.slots * w.samples);
  if (!symbols_) {
    std::optional<PhaseWalk> walk;
    if (config_.receiver.phase_noise) walk.emplace(*config_.receiver.phase_noise, w, input.seeds);
    add_echoes(input, input.lists, walk ? &*walk : nullptr, 0, threads, cube, report.beat);
    for (const Interferer& one : input.interferers)
      report.interference.push_back(add_interference(config_, one, input.attitudes[0], threads, cube));
    return cube;
  }
  report.terms = symbols_->terms(input.lists, name_);
  std::vector<EchoList> timely, late;
  for (const EchoList& list : input.lists) {
    timely.push_back({list.first_slot, list.slots, {}, list.tables, {}});
    late.push_back(timely.back());
    for (const Echo& echo : list.echoes)
      (is_late(list, echo, w) ? late : timely).back().echoes.push_back(echo);
  }
  RadarCube lines;
  for (uint32_t term = 0; term < report.terms; ++term) {
    lines.assign(cube.size(), {});
    add_echoes(input, timely, nullptr, term, threads, lines, report.beat);
    symbols_->send(input.seeds, term, threads, lines, cube);
  }
  for (size_t i = 0; i < late.size(); ++i)
    add_late_echoes(config_, *symbols_, late[i], input.attitude(i), input.seeds, threads, cube);
  return cube;
}

void RadarProcessor::detect(const RadarFrameInput& input, std::span<const std::complex<float>> spectrum,
                            uint32_t threads, RadarFrame& frame) const {
  const RadarWaveform& w = config_.waveform;
  std::vector<CfarPeak> peaks;
  if (w.bands() == 1) {
    peaks = cfar_->peaks(frame.range_doppler, threads);
  } else {
    peaks = cfar_->peaks(folded_map(w, frame.range_doppler), threads);
    unfold(w, frame.range_doppler, peaks);
  }
  frame.report.sidelobes = maker_->drop_sidelobes(peaks, frame.range_doppler);
  const RadarGeometry geometry{input.attitude(input.lists.size() / 2), input.baseline_m};
  frame.detections = maker_->make(peaks, frame.range_doppler, spectrum, input.lists, geometry, threads);
}

RadarFrame RadarProcessor::process(const RadarFrameInput& input, uint32_t threads) const {
  const RadarWaveform& w = config_.waveform;
  const RadarProcessing& p = config_.processing;
  GREATX_CHECK(
      input.attitudes.size() == 1 || (input.attitudes.size() == input.lists.size() && !input.lists.empty()),
      "{} attitudes for {} lists", input.attitudes.size(), input.lists.size());
  RadarFrame frame;
  uint32_t next_slot = 0;
  for (const EchoList& list : input.lists) {
    GREATX_CHECK(list.first_slot >= next_slot, "echoes of slot {} after those of slot {}", list.first_slot,
                 next_slot);
    next_slot = list.first_slot + list.slots;
    check_echoes(list, config_, name_);
    frame.report.echoes += list.echoes.size();
    frame.report.patches += list.patches.size();
    frame.report.late_echoes += late_echoes(list, w);
  }
  frame.cube = received(input, threads, frame.report);
  if (config_.receiver.noise_figure_db)
    add_noise(input.seeds, noise_power_w(w.noise_bandwidth_hz(), *config_.receiver.noise_figure_db), threads,
              frame.cube);
  if (config_.receiver.adc)
    frame.report.saturated_samples = digitize(*config_.receiver.adc, threads, frame.cube);
  if (symbols_) symbols_->receive(input.seeds, threads, frame.cube);
  if (!p.range_doppler && !p.range_azimuth && !p.detections) return frame;

  const auto spectrum = maps_.spectrum(frame.cube, threads);
  if (p.range_azimuth) frame.range_azimuth = maps_.range_azimuth(spectrum, threads);
  if (!p.range_doppler && !p.detections) return frame;
  frame.range_doppler = maps_.range_doppler(spectrum, threads);
  if (p.detections) detect(input, spectrum, threads, frame);
  if (!p.range_doppler) frame.range_doppler.clear();
  return frame;
}

}  // namespace greatx::rf
