// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/channel_sensing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/budget.h"
#include "core/hash.h"
#include "core/units.h"
#include "rf/channel/statistics.h"

namespace greatx::sim {

namespace {

/// Returns dBm, which are finite for any power.
double dbm_of(double power_w) { return 10.0 * std::log10(std::max(power_w, 1e-300)) + 30.0; }

std::vector<dvec3> places_of(const rf::AntennaArray& array) {
  std::vector<dvec3> places;
  for (uint32_t port = 0; port < array.port_count(); port += array.polarization_count())
    places.push_back(array.element_position(port));
  return places;
}

/// Describes a quantity of every detection.
struct DetectionColumn {
  const char *name, *unit, *text;
  double (*value)(const rf::SensingDetection&);
};

constexpr DetectionColumn detection_columns[] = {
    {"detection_range", "m", "[detection] half the way from transmitter over target to receiver, at the tick",
     [](const rf::SensingDetection& d) { return d.range_m; }},
    {"detection_velocity", "m/s", "[detection] rate of the range, positive receding, in [-v_max, v_max)",
     [](const rf::SensingDetection& d) { return d.velocity_m_s; }},
    {"detection_azimuth", "rad", "[detection] from x towards y of the receiving antenna",
     [](const rf::SensingDetection& d) { return d.azimuth; }},
    {"detection_elevation", "rad", "[detection] above the x-y plane of the receiving antenna",
     [](const rf::SensingDetection& d) { return d.elevation; }},
    {"detection_snr", "dB", "[detection] signal to noise in its cell of the map",
     [](const rf::SensingDetection& d) { return decibels(std::max(d.snr, 1e-300)); }},
    {"detection_power", "dBm", "[detection] received by a pair of ports, mean",
     [](const rf::SensingDetection& d) { return dbm_of(d.power_w); }},
};

}  // namespace

/// Holds what is true of a target on a link.
struct ChannelSensing::Truth {
  double range_m = 0.0, velocity_m_s = 0.0, azimuth = 0.0, elevation = 0.0;
  double power_dbm = -std::numeric_limits<double>::infinity(), snr_db = power_dbm;
  bool detected = false;
};

namespace {

struct TruthColumn {
  const char *name, *unit, *text;
};
constexpr TruthColumn truth_columns[] = {
    {"target_range", "m", "[rx, tx, target] half the straight way over the target's centre, from the poses"},
    {"target_velocity", "m/s", "[rx, tx, target] its rate, positive receding, not wrapped"},
    {"target_azimuth", "rad", "[rx, tx, target] of the centre, from x towards y of the receiving antenna"},
    {"target_elevation", "rad", "[rx, tx, target] above the x-y plane of the receiving antenna"},
    {"target_power", "dBm", "[rx, tx, target] of its echoes, a pair of ports, mean; -inf: none"},
    {"target_snr", "dB",
     "[rx, tx, target] of the same power in the middle of a cell; -inf: none; inf: no noise"},
};

}  // namespace

ChannelSensing::ChannelSensing(const Experiment& experiment, const ChannelConfig& config,
                               const rf::ChannelGrid& grid, std::span<const rf::AntennaArray> transmitters,
                               std::span<const rf::AntennaArray> receivers, size_t targets)
    : name_(config.name),
      config_(*config.sensing),
      carrier_hz_(config.carrier_hz),
      seed_(experiment.scenario.seed),
      transmitters_(transmitters.size()),
      receivers_(receivers.size()),
      targets_(targets) {
  if (!experiment.plan.sensing_noise.on) config_.noise_figure_db.reset();
  if (!experiment.plan.sensing_quantisation.on) config_.adc.reset();
  if (!experiment.plan.sensing_leakage.on) config_.leakage_db.reset();
  const rf::SensingWaveform waveform{grid.carrier_hz, grid.subcarrier_spacing_hz, grid.subcarriers,
                                     config.time_spacing_s, grid.time_samples};
  uint64_t tables = 0;
  for (size_t r = 0; r < receivers_; ++r)
    for (size_t t = 0; t < transmitters_; ++t) {
      const rf::SensingArrays arrays{places_of(transmitters[t]), places_of(receivers[r]),
                                     transmitters[t].polarization_count(), receivers[r].polarization_count(),
                                     config.transmitters[t] == config.receivers[r]};
      try {
        links_.push_back(std::make_unique<rf::OfdmSensing>(config.name, config_, waveform, arrays));
      } catch (const UserError& error) {
        throw_user_error_at(config.where, "{}", error.what());
      }
      tables += links_.back()->table_bytes();
      require_within(fmt::format("channel '{}': tables of range_azimuth", name_), tables,
                     budget::channel_record);
    }
}

void ChannelSensing::describe(SensorSpec& spec) const {
  const auto add = [&](ArraySpec array, FileFormat format) {
    spec.outputs.push_back({"sensing/" + array.name, format, {array.name}});
    spec.arrays.push_back(std::move(array));
  };
  const rf::RadarAxes& axes = links_[0]->axes();
  const auto rx = static_cast<int64_t>(receivers_), tx = static_cast<int64_t>(transmitters_);
  const auto add_map = [&](const char* name, size_t columns, const char* text) {
    require_within(
        fmt::format("channel '{}': {}", name_, name),
        saturating_product({receivers_, transmitters_, axes.range_m.size(), columns, sizeof(float)}),
        budget::channel_record);
    add({name, DType::f32, {rx, tx, std::ssize(axes.range_m), static_cast<int64_t>(columns)}, "W", text},
        FileFormat::npy_stack);
  };
  if (config_.range_doppler)
    add_map("range_doppler", axes.velocity_m_s.size(),
            "[rx, tx, range, velocity] mean power of the pairs of ports");
  if (config_.range_azimuth)
    add_map("range_azimuth", axes.azimuth.size(),
            "[rx, tx, range, azimuth] power of the beam at elevation 0, summed over velocities");
  if (config_.detections) {
    add({"detection_rx", DType::i32, {-1}, "1", "[detection] receiver"}, FileFormat::npy_ragged);
    add({"detection_tx", DType::i32, {-1}, "1", "[detection] transmitter"}, FileFormat::npy_ragged);
    for (const DetectionColumn& column : detection_columns)
      add({column.name, DType::f32, {-1}, column.unit, column.text}, FileFormat::npy_ragged);
    add({"detection_position", DType::f32, {-1, 3}, "m", "[detection, xyz] in the receiving antenna's frame"},
        FileFormat::npy_ragged);
    add({"detection_instance",
         DType::u32,
         {-1},
         "1",
         "[detection] index into instances + 1 of the target; 0: none accounts for it"},
        FileFormat::npy_ragged);
  }
  if (targets_ == 0) return;
  for (const TruthColumn& column : truth_columns)
    add({column.name, DType::f64, {rx, tx, static_cast<int64_t>(targets_)}, column.unit, column.text},
        FileFormat::npy_stack);
  if (config_.detections)
    add({"target_detected",
         DType::u8,
         {rx, tx, static_cast<int64_t>(targets_)},
         "1",
         "[rx, tx, target] 1: a detection belongs to it"},
        FileFormat::npy_stack);
}

void ChannelSensing::describe(nlohmann::json& metadata) const {
  const rf::OfdmSensing& sensing = *links_[0];
  const rf::SensingWaveform& w = sensing.waveform();
  nlohmann::json json{{"power_dbm", dbm_of(config_.power_w)},
                      {"symbols", w.symbols},
                      {"symbol_interval_s", w.interval_s},
                      {"bandwidth_hz", w.bandwidth_hz()},
                      {"range_bin_m", w.range_bin_m()},
                      {"range_span_m", w.range_span_m()},
                      {"velocity_bin_m_s", w.velocity_bin_m_s()},
                      {"velocity_min_m_s", sensing.axes().velocity_m_s.front()},
                      {"noise_w", sensing.noise_w()},
                      {"clutter_removal", config_.remove_static ? "static_mean" : "none"},
                      {"sign", "velocities are rates of range, positive receding"},
                      {"frame", "x forward, y left, z up"}};
  if (config_.range_azimuth) {
    json["azimuth_min_rad"] = sensing.axes().azimuth.front();
    json["azimuth_max_rad"] = sensing.axes().azimuth.back();
  }
  if (config_.leakage_db)
    json["leakage"] = {{"level_db", *config_.leakage_db}, {"delay_s", config_.leakage_delay_s}};
  metadata["sensing"] = std::move(json);
  if (targets_ > 0) {
    metadata["non_finite"].push_back("target_power");
    metadata["non_finite"].push_back("target_snr");
  }
}

ChannelSensing::Truth ChannelSensing::truth_of(const rf::OfdmSensing& sensing, const SensedLink& link,
                                               const TargetState& target,
                                               std::span<const rf::SensingTone> tones,
                                               std::span<const rf::SensingDetection> found) const {
  const rf::EndState &tx = link.transmitter_state, &rx = link.receiver_state;
  const dvec3 out = target.centre.position - tx.position, home = target.centre.position - rx.position;
  Truth truth;
  truth.range_m = 0.5 * (glm::length(out) + glm::length(home));
  truth.velocity_m_s = 0.5 * (glm::dot(target.centre.velocity - tx.velocity, glm::normalize(out)) +
                              glm::dot(target.centre.velocity - rx.velocity, glm::normalize(home)));
  const dvec3 seen = glm::conjugate(rx.orientation) * home;
  truth.azimuth = std::atan2(seen.y, seen.x);
  truth.elevation = std::atan2(seen.z, std::hypot(seen.x, seen.y));
  double gain = 0.0;
  for (const rf::SensingTone& tone : tones)
    if (tone.instance == target.instance + 1) gain += tone.gain;
  if (gain > 0.0) {
    truth.power_dbm = dbm_of(config_.power_w * gain);
    truth.snr_db = decibels(sensing.cell_snr(gain));
  }
  truth.detected = std::ranges::any_of(
      found, [&](const rf::SensingDetection& d) { return d.instance == target.instance + 1; });
  return truth;
}

void ChannelSensing::note_aliases(const rf::OfdmSensing& sensing, std::span<const rf::SensingTone> tones) {
  const rf::SensingWaveform& w = sensing.waveform();
  for (const rf::SensingTone& tone : tones) {
    if (tone.instance == 0) continue;
    const double range_m = 0.5 * speed_of_light * tone.delay_s,
                 velocity_m_s = 0.5 * w.wavelength_m() * std::abs(tone.doppler_hz);
    if (range_m < w.range_span_m() && velocity_m_s < 0.5 * w.velocity_span_m_s()) continue;
    ++aliased_;
    longest_range_m_ = std::max(longest_range_m_, range_m);
    fastest_m_s_ = std::max(fastest_m_s_, velocity_m_s);
  }
}

struct ChannelSensing::Sensed {
  std::vector<float> range_doppler, range_azimuth;  ///< [rx, tx, range, velocity or azimuth]
  std::vector<Truth> truths;
  std::vector<rf::SensingDetection> detections;
  std::vector<int32_t> rx, tx;  ///< [detections]
};

std::vector<rf::SensingTone> ChannelSensing::tones_of(const SensedLink& link) const {
  const std::vector<double> gains = rf::path_powers(link.paths, link.transmitter, link.receiver, carrier_hz_);
  std::vector<rf::SensingTone> tones;
  for (size_t i = 0; i < link.paths.size(); ++i) {
    const rf::Path& path = link.paths[i];
    uint32_t instance = 0;
    for (const rf::Interaction& interaction : path.interactions)
      if (interaction.type == rf::InteractionType::target) instance = interaction.element + 1;
    tones.push_back({instance, path.delay_s, path.doppler_hz, gains[i]});
  }
  return tones;
}

void ChannelSensing::sense(size_t index, const SensedLink& link, std::span<const TargetState> targets,
                           uint32_t sequence, int64_t tick, Sensed& sensed) {
  const size_t r = index / transmitters_, t = index % transmitters_;
  const rf::OfdmSensing& sensing = of_link(r, t);
  const std::vector<rf::SensingTone> tones = tones_of(link);
  note_aliases(sensing, tones);
  const rf::RadarSeeds seeds{seed_, fnv1a32(fmt::format("{}#{}.{}.{}", name_, sequence, r, t)),
                             static_cast<uint32_t>(tick)};
  const rf::SensingFrame frame =
      sensing.process({link.h, tones, seeds, link.receiver_state.orientation,
                       link.transmitter_state.position - link.receiver_state.position});
  ++bursts_;
  saturated_ += frame.saturated_samples;
  detections_ += frame.detections.size();
  sensed.range_doppler.insert(sensed.range_doppler.end(), frame.range_doppler.begin(),
                              frame.range_doppler.end());
  sensed.range_azimuth.insert(sensed.range_azimuth.end(), frame.range_azimuth.begin(),
                              frame.range_azimuth.end());
  for (const TargetState& target : targets)
    sensed.truths.push_back(truth_of(sensing, link, target, tones, frame.detections));
  for (const rf::SensingDetection& detection : frame.detections) {
    sensed.detections.push_back(detection);
    sensed.rx.push_back(static_cast<int32_t>(r)), sensed.tx.push_back(static_cast<int32_t>(t));
  }
}

void ChannelSensing::add_detections(const Sensed& sensed, std::vector<Array>& arrays) const {
  const int64_t count = std::ssize(sensed.detections);
  arrays.push_back(Array::of<int32_t>({count}, std::span<const int32_t>(sensed.rx)));
  arrays.push_back(Array::of<int32_t>({count}, std::span<const int32_t>(sensed.tx)));
  for (const DetectionColumn& column : detection_columns) {
    std::vector<float> values;
    for (const rf::SensingDetection& d : sensed.detections)
      values.push_back(static_cast<float>(column.value(d)));
    arrays.push_back(Array::of<float>({count}, std::span<const float>(values)));
  }
  std::vector<float> places;
  std::vector<uint32_t> instances;
  for (const rf::SensingDetection& d : sensed.detections) {
    for (int c = 0; c < 3; ++c) places.push_back(static_cast<float>(d.position_m[c]));
    instances.push_back(d.instance);
  }
  arrays.push_back(Array::of<float>({count, 3}, std::span<const float>(places)));
  arrays.push_back(Array::of<uint32_t>({count}, std::span<const uint32_t>(instances)));
}

void ChannelSensing::add_truth(const Sensed& sensed, std::vector<Array>& arrays) const {
  const std::vector<int64_t> shape{static_cast<int64_t>(receivers_), static_cast<int64_t>(transmitters_),
                                   static_cast<int64_t>(targets_)};
  for (double Truth::*member : {&Truth::range_m, &Truth::velocity_m_s, &Truth::azimuth, &Truth::elevation,
                                &Truth::power_dbm, &Truth::snr_db}) {
    std::vector<double> values;
    for (const Truth& truth : sensed.truths) values.push_back(truth.*member);
    arrays.push_back(Array::of<double>(shape, std::span<const double>(values)));
  }
  if (!config_.detections) return;
  std::vector<uint8_t> values;
  for (const Truth& truth : sensed.truths) values.push_back(truth.detected);
  arrays.push_back(Array::of<uint8_t>(shape, std::span<const uint8_t>(values)));
}

std::vector<Array> ChannelSensing::arrays_of(std::span<const SensedLink> links,
                                             std::span<const TargetState> targets, uint32_t sequence,
                                             int64_t tick) {
  Sensed sensed;
  for (size_t index = 0; index < links.size(); ++index)
    sense(index, links[index], targets, sequence, tick, sensed);
  const rf::RadarAxes& axes = links_[0]->axes();
  std::vector<Array> arrays;
  const auto add_map = [&](int64_t columns, const std::vector<float>& maps) {
    arrays.push_back(Array::of<float>({static_cast<int64_t>(receivers_), static_cast<int64_t>(transmitters_),
                                       std::ssize(axes.range_m), columns},
                                      std::span<const float>(maps)));
  };
  if (config_.range_doppler) add_map(std::ssize(axes.velocity_m_s), sensed.range_doppler);
  if (config_.range_azimuth) add_map(std::ssize(axes.azimuth), sensed.range_azimuth);
  if (config_.detections) add_detections(sensed, arrays);
  if (targets_ > 0) add_truth(sensed, arrays);
  return arrays;
}

void ChannelSensing::count(std::map<std::string, uint64_t>& counters) const {
  counters["bursts"] = bursts_;
  counters["detections"] = detections_;
  if (saturated_ > 0) counters["saturated_samples"] = saturated_;
  if (aliased_ > 0) counters["aliased_echoes"] = aliased_;
}

void ChannelSensing::warn(std::vector<std::string>& warnings) const {
  if (aliased_ == 0) return;
  const rf::SensingWaveform& w = links_[0]->waveform();
  warnings.push_back(fmt::format(
      "channel '{}': {} echoes of targets alias: the farthest of them is at {:.1f} m and the fastest has "
      "{:.2f} "
      "m/s, but ranges are known up to multiples of {:.1f} m (c/(2 subcarrier_spacing_hz)) and velocities of "
      "{:.2f} m/s (wavelength/(2 time_spacing_s))",
      name_, aliased_, longest_range_m_, fastest_m_s_, w.range_span_m(), w.velocity_span_m_s()));
}

}  // namespace greatx::sim
