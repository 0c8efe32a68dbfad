// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/radar_processor.h"

#include "core/error.h"
#include "rf/radar/signal/delay.h"

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
    count +=
        delay_at(list, echo.delay, w.interval_s, w.slot_middle_s(list.first_slot)).delay_s > w.adc_start_s;
  return count;
}

}  // namespace

RadarProcessor::RadarProcessor(std::string name, const RadarSignalConfig& config, RadarGain transmit_gain,
                               RadarGain receive_gain)
    : name_(std::move(name)),
      config_(checked(name_, config)),
      synthesizer_(config_),
      patches_(config_),
      maps_(config_) {
  if (!config_.processing.detections) return;
  const uint32_t antennas =
      static_cast<uint32_t>(config_.arrays.receive_m.size()) * config_.waveform.transmitters;
  cfar_.emplace(config_.processing.cfar, maps_.range_window(), maps_.doppler_window(), antennas);
  maker_.emplace(config_, maps_, std::move(transmit_gain), std::move(receive_gain));
}

RadarFrame RadarProcessor::process(const RadarFrameInput& input, uint32_t threads) const {
  const RadarWaveform& w = config_.waveform;
  const RadarProcessing& p = config_.processing;
  GREATX_CHECK(
      input.attitudes.size() == 1 || (input.attitudes.size() == input.lists.size() && !input.lists.empty()),
      "{} attitudes for {} lists", input.attitudes.size(), input.lists.size());
  const auto attitude = [&](size_t i) { return input.attitudes[input.attitudes.size() == 1 ? 0 : i]; };
  RadarFrame frame;
  frame.cube.resize(config_.arrays.receive_m.size() * w.slots * w.samples);
  std::optional<PhaseWalk> walk;
  if (config_.receiver.phase_noise) walk.emplace(*config_.receiver.phase_noise, w, input.seeds);
  uint32_t next_slot = 0;
  for (size_t i = 0; i < input.lists.size(); ++i) {
    const EchoList& list = input.lists[i];
    GREATX_CHECK(list.first_slot >= next_slot, "echoes of slot {} after those of slot {}", list.first_slot,
                 next_slot);
    next_slot = list.first_slot + list.slots;
    check_echoes(list, config_, name_);
    const BeatReport report =
        synthesizer_.add(list, attitude(i), walk ? &*walk : nullptr, threads, frame.cube);
    patches_.add(list.patches, list.first_slot, list.slots, attitude(i), walk ? &*walk : nullptr, threads,
                 frame.cube);
    frame.report.echoes += list.echoes.size();
    frame.report.patches += list.patches.size();
    frame.report.beat.tones += report.tones;
    frame.report.beat.bent_tones += report.bent_tones;
    frame.report.late_echoes += late_echoes(list, w);
  }
  if (config_.receiver.noise_figure_db)
    add_noise(input.seeds, noise_power_w(w.sample_rate_hz, *config_.receiver.noise_figure_db), threads,
              frame.cube);
  if (config_.receiver.adc)
    frame.report.saturated_samples = digitize(*config_.receiver.adc, threads, frame.cube);
  if (!p.range_doppler && !p.range_azimuth && !p.detections) return frame;

  const auto spectrum = maps_.spectrum(frame.cube, threads);
  if (p.range_azimuth) frame.range_azimuth = maps_.range_azimuth(spectrum, threads);
  if (!p.range_doppler && !p.detections) return frame;
  frame.range_doppler = maps_.range_doppler(spectrum, threads);
  if (p.detections) {
    auto peaks = cfar_->peaks(frame.range_doppler, threads);
    frame.report.sidelobes = maker_->drop_sidelobes(peaks, frame.range_doppler);
    const RadarGeometry geometry{attitude(input.lists.size() / 2), input.baseline_m};
    frame.detections = maker_->make(peaks, frame.range_doppler, spectrum, input.lists, geometry, threads);
  }
  if (!p.range_doppler) frame.range_doppler.clear();
  return frame;
}

}  // namespace greatx::rf
