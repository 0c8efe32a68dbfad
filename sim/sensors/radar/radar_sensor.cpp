// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/radar/radar_sensor.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/hash.h"
#include "core/units.h"
#include "rf/radar/signal/delay.h"
#include "sim/plan/radar_plan.h"
#include "sim/sensors/radar/radar_arrays.h"
#include "sim/sensors/sensor_metadata.h"
#include "sim/world/posed_scene.h"

namespace greatx::sim {

namespace {

/// Returns the configuration without the imperfections that the plan leaves out.
RadarConfig planned(RadarConfig config, const EffectPlan& plan) {
  rf::RadarReceiver& receiver = config.signal.receiver;
  if (!plan.radar_noise.on) receiver.noise_figure_db.reset();
  if (!plan.radar_phase_noise.on) receiver.phase_noise.reset();
  if (!plan.radar_quantisation.on) receiver.adc.reset();
  if (!plan.radar_leakage.on) receiver.leakage.reset();
  if (!plan.radar_interference.on) config.interferers.clear();
  return config;
}

bool same_element(const rf::EchoEnd& a, const rf::EchoEnd& b) {
  return a.pattern.shape == b.pattern.shape && a.pattern.model == b.pattern.model &&
         a.pattern.table == b.pattern.table && a.slant == b.slant;
}

rf::RadarGain gain_of(const rf::EchoEnd& end) {
  return [pattern = end.pattern, slant = end.slant](const dvec3& direction) {
    const rf::Jones field = rf::element_field(pattern, slant, direction);
    return std::norm(field.theta) + std::norm(field.phi);
  };
}

/// Returns the largest gain of an element to within some thousandths.
double largest_gain(const rf::RadarGain& gain) {
  constexpr int steps = 180;
  double largest = 0.0;
  for (int i = 0; i <= steps; ++i)
    for (int k = 0; k < 2 * steps; ++k) {
      const double zenith = pi * i / steps, azimuth = pi * k / steps;
      largest = std::max(largest, gain({std::sin(zenith) * std::cos(azimuth),
                                        std::sin(zenith) * std::sin(azimuth), std::cos(zenith)}));
    }
  return largest;
}

/// Returns the beam width of the virtual array, rad; at most 0.5, as for one antenna.
double beam_of(const rf::RadarSignalConfig& signal) {
  double reach = 0.0;
  for (const auto* elements : {&signal.arrays.transmit_m, &signal.arrays.receive_m}) {
    double widest = 0.0;
    for (const dvec3& a : *elements)
      for (const dvec3& b : *elements) widest = std::max(widest, glm::length(a - b));
    reach += widest;
  }
  return std::min(signal.waveform.wavelength_m() / std::max(reach, 1e-9), 0.5);
}

uint32_t instance_called(const scene::Scene& scene, const std::string& radar, const std::string& name) {
  for (uint32_t i = 0; i < scene.instances.size(); ++i)
    if (scene.instances[i].name == name) return i;
  throw_user_error("radar '{}': echoes.targets: expected the name of an instance of the scene, found '{}'",
                   radar, name);
}

}  // namespace

RadarSensor::RadarSensor(scene::GpuScene& gpu_scene, const Experiment& experiment, uint32_t node,
                         uint32_t sensor, const scene::EdgeSurvey* survey)
    : gpu_scene_(gpu_scene),
      world_(*experiment.world),
      config_(planned(std::get<RadarConfig>(experiment.scenario.nodes[node].sensors[sensor].config),
                      experiment.plan)),
      name_(experiment.scenario.nodes[node].name + "/" +
            experiment.scenario.nodes[node].sensors[sensor].name),
      node_(node),
      seed_(experiment.scenario.seed),
      mount_(mount_pose(experiment.scenario.nodes[node].sensors[sensor].mount)),
      transmitter_(transmitter_of(experiment.scenario)),
      receiver_{node, config_.see_own_body ? 0 : world_.body_of_node[node], mount_},
      finder_(gpu_scene, rf::RadioSurfaces(world_.scene, config_.signal.waveform.carrier_hz), transmit_end(),
              config_.signal.bistatic || !same_element(transmit_end(), receive_end())
                  ? std::optional(receive_end())
                  : std::nullopt,
              echo_options(experiment), survey),
      neighbours_(experiment, config_, name_),
      processor_(name_, config_.signal, gain_of(transmit_end()), gain_of(receive_end())) {
  describe(experiment.scenario.nodes[node].sensors[sensor]);
}

RadarSensor::Carrier RadarSensor::transmitter_of(const Scenario& scenario) const {
  const auto body = [&](uint32_t node) { return config_.see_own_body ? 0 : world_.body_of_node[node]; };
  if (!config_.signal.bistatic) return {node_, body(node_), mount_};
  const SensorPlace place = sensor_place(scenario, config_.illuminator);
  return {place.node, body(place.node), mount_pose(scenario.nodes[place.node].sensors[place.sensor].mount)};
}

rf::EchoEnd RadarSensor::end_of(const AntennaConfig& antenna, uint32_t own_body) const {
  const double slant = array_of(antenna, config_.signal.waveform.carrier_hz).slant(0);
  return {antenna.pattern, slant, own_body, name_};
}

rf::EchoOptions RadarSensor::echo_options(const Experiment& experiment) const {
  rf::EchoOptions options = config_.echoes;
  options.roughness = experiment.plan.radar_roughness.on;
  options.diffuse = experiment.plan.radar_clutter.on;
  options.edges = experiment.plan.radar_edges.on;
  options.transmission = experiment.plan.radar_transmission.on;
  if (experiment.plan.radar_air.on)
    options.air_db_per_km =
        radar_air_db_per_km(experiment.scenario.environment, config_.signal.waveform.carrier_hz);
  options.seed = experiment.scenario.seed;
  options.waveform = config_.signal.waveform;
  options.bandwidth_hz = config_.signal.waveform.bandwidth_hz();
  options.beam_rad = beam_of(config_.signal);
  options.hidden_ratio = rf::hidden_ratio(config_.signal);
  if (experiment.plan.radar_rain.on && !config_.signal.bistatic)
    options.rain = radar_rain(experiment.scenario.environment, config_.signal.waveform.carrier_hz);
  if (config_.signal.receiver.noise_figure_db)
    options.hidden_floor_m2 = rf::hidden_section_m2(config_.signal, largest_gain(gain_of(transmit_end())),
                                                    largest_gain(gain_of(receive_end())));
  for (const std::string& target : config_.targets)
    options.targets.push_back(instance_called(world_.scene, name_, target));
  return options;
}

void RadarSensor::describe(const SensorConfig& sensor) {
  spec_.name = name_;
  spec_.kind = "radar";
  spec_.rate = sensor.rate_hz.str();
  describe_radar(config_, processor_, spec_);
  nlohmann::json metadata = radar_metadata(config_, processor_);
  metadata["body_from_sensor"] = json_of(mount_);
  if (config_.signal.bistatic) {
    metadata["illuminator"] = config_.illuminator;
    metadata["body_from_illuminator"] = json_of(transmitter_.mount);
  }
  spec_.metadata_json = metadata.dump();
}

/// Returns the motion over the slots from one tracing to the next. The chirps of one loop over the
/// transmitters stay together.
rf::EchoMotion RadarSensor::motion(const TickContext& context, uint32_t update) const {
  const rf::RadarWaveform& waveform = config_.signal.waveform;
  const auto first_slot = [&](uint32_t u) {
    return waveform.loop() * static_cast<uint32_t>(uint64_t{waveform.chirps()} * u / config_.updates);
  };
  rf::EchoMotion motion;
  // These functions outlive the context.
  const auto end = [&](const Carrier& carrier) {
    return [&world = world_, at = context.motion_at, start_s = context.time_s, carrier](double time_s) {
      return world.scene.to_local(at(carrier.node, start_s + time_s).pose) * carrier.mount;
    };
  };
  motion.transmitter = end(transmitter_);
  motion.receiver = end(receiver_);
  motion.body = [at = context.body_motion_at, start_s = context.time_s](uint32_t body, double time_s) {
    return at(body, start_s + time_s).pose;
  };
  motion.first_slot = first_slot(update);
  for (uint32_t slot = motion.first_slot; slot < first_slot(update + 1); ++slot)
    motion.slot_start_s.push_back(waveform.slot_start_s(slot));
  motion.slot_s = waveform.interval_s;
  motion.frame = static_cast<uint64_t>(context.tick);
  motion.traced_s = motion.slot_start_s.front();
  return motion;
}

void RadarSensor::record(gpu::TickSlot& slot, const TickContext& context) {
  Frame& frame = frames_[slot.index];
  frame.updates.clear();
  frame.seeds = {seed_, fnv1a32(name_ + fmt::format("#{}", context.sequence)),
                 static_cast<uint32_t>(context.tick)};
  at_traced_instants(gpu_scene_, slot, context, [&](TracedInstants& instants) {
    for (uint32_t u = 0; u < config_.updates; ++u) {
      Update update;
      update.motion = motion(context, u);
      const double at_s = update.motion.traced_s;
      const std::vector<Pose> bodies = instants.move_to(context.time_s + at_s);
      const Pose transmitter = update.motion.transmitter(at_s), receiver = update.motion.receiver(at_s);
      update.attitude = {transmitter.orientation, receiver.orientation};
      update.rays = finder_.record(slot, transmitter, receiver, bodies);
      update.sent = neighbours_.record(context, update.motion);
      if (u == config_.updates / 2) frame.baseline_m = transmitter.position - receiver.position;
      frame.updates.push_back(std::move(update));
    }
  });
}

std::vector<Array> RadarSensor::collect(const gpu::TickSlot& slot) { return process(find_echoes(slot)); }

RadarSensor::Echoes RadarSensor::find_echoes(const gpu::TickSlot& slot) {
  Frame& frame = frames_[slot.index];
  Echoes echoes{{}, {}, frame.seeds, frame.baseline_m, {}};
  for (const Update& update : frame.updates) {
    rf::EchoStatistics statistics;
    echoes.lists.push_back(finder_.collect(update.rays, update.motion, &statistics));
    echoes.attitudes.push_back(update.attitude);
    tubes_ += statistics.tubes;
    beams_ += statistics.facets + statistics.images;
    echoes_ += echoes.lists.back().echoes.size();
    watch_spans(echoes.lists.back());
    for (const rf::Interferer& one : neighbours_.arrive(update.sent, finder_, update.rays))
      echoes.interferers.push_back(one);
    echoes_left_out_ += statistics.left_out;
    patches_ += statistics.patches;
  }
  frame.updates.clear();
  return echoes;
}

/// Notes which echoes lie beyond the spans of range and velocity.
void RadarSensor::watch_spans(const rf::EchoList& list) {
  const rf::RadarWaveform& w = config_.signal.waveform;
  const double at_s = w.slot_middle_s(list.first_slot + list.slots / 2);
  for (const rf::Echo& echo : list.echoes) {
    const rf::DelayAt delay = rf::delay_at(list, echo.delay, w.interval_s, at_s);
    const double range_m = 0.5 * speed_of_light * delay.delay_s,
                 speed_m_s = 0.5 * speed_of_light * std::abs(delay.rate);
    if (range_m > w.range_span_m()) ++echoes_beyond_span_;
    if (speed_m_s > 0.5 * w.velocity_span_m_s()) ++echoes_beyond_speed_;
    longest_range_m_ = std::max(longest_range_m_, range_m);
    fastest_m_s_ = std::max(fastest_m_s_, speed_m_s);
  }
}

void RadarSensor::warn(std::vector<std::string>& warnings) const {
  const rf::RadarWaveform& w = config_.signal.waveform;
  if (echoes_beyond_span_ > 0)
    warnings.push_back(fmt::format(
        "radar '{}': {} of {} echoes alias in range: the farthest is at {:.1f} m, and the range span of its "
        "waveform is {:.1f} m",
        name_, echoes_beyond_span_, echoes_, longest_range_m_, w.range_span_m()));
  if (echoes_beyond_speed_ > 0)
    warnings.push_back(
        fmt::format("radar '{}': {} of {} echoes alias in velocity: the fastest has {:.2f} m/s, and v_max of "
                    "its waveform "
                    "is {:.2f} m/s",
                    name_, echoes_beyond_speed_, echoes_, fastest_m_s_, 0.5 * w.velocity_span_m_s()));
}

void RadarSensor::note(std::vector<std::pair<std::string, std::string>>& notes) const {
  neighbours_.note(name_, notes);
}

std::vector<Array> RadarSensor::process(const Echoes& echoes) {
  frame_ = processor_.process(
      {echoes.lists, echoes.attitudes, echoes.baseline_m, echoes.seeds, echoes.interferers});
  if (!neighbours_.empty())
    neighbours_.count(echoes.interferers, frame_.report.interference, frame_.cube.size());
  ++frames_done_;
  detections_ += frame_.detections.size();
  saturated_ += frame_.report.saturated_samples;
  late_echoes_ += frame_.report.late_echoes;
  return radar_arrays(config_, processor_, frame_);
}

Evidence RadarSensor::evidence() const {
  Evidence evidence;
  evidence.detections = config_.outputs.detections;
  return evidence;
}

void RadarSensor::count(std::map<std::string, uint64_t>& counters) const {
  counters[name_ + " frames"] = frames_done_;
  counters[name_ + " ray tubes"] = tubes_;
  counters[name_ + " beams on small facets"] = beams_;
  counters[name_ + " echoes"] = echoes_;
  if (patches_ > 0) counters[name_ + " patches"] = patches_;
  counters[name_ + " detections"] = detections_;
  if (echoes_left_out_ > 0) counters[name_ + " echoes left out"] = echoes_left_out_;
  if (saturated_ > 0) counters[name_ + " saturated samples"] = saturated_;
  if (late_echoes_ > 0) counters[name_ + " echoes later than the first sample"] = late_echoes_;
}

}  // namespace greatx::sim
