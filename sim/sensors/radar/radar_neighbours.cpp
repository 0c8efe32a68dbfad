// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/radar/radar_neighbours.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/hash.h"
#include "core/random.h"
#include "core/units.h"
#include "sim/world/posed_scene.h"

namespace greatx::sim {

RadarNeighbours::RadarNeighbours(const Experiment& experiment, const RadarConfig& config,
                                 const std::string& name)
    : world_(*experiment.world), name_(name), seed_(experiment.scenario.seed) {
  for (const std::string& other : config.interferers) {
    const SensorPlace place = sensor_place(experiment.scenario, other);
    const SensorConfig& sensor = experiment.scenario.nodes[place.node].sensors[place.sensor];
    const RadarConfig& radar = std::get<RadarConfig>(sensor.config);
    const double slant = array_of(radar.transmit, radar.signal.waveform.carrier_hz).slant(0);
    others_.push_back({other, place.node, mount_pose(sensor.mount), 1.0 / sensor.rate_hz.value(),
                       rf::EchoEnd{radar.transmit.pattern, slant,
                                   radar.see_own_body ? 0 : world_.body_of_node[place.node], other},
                       radar.signal});
  }
}

double RadarNeighbours::offset_s(const Other& other, int64_t frame, double& phase_turns) const {
  RandomStream random(seed_, fnv1a32(name_ + "<" + other.name), static_cast<uint32_t>(frame));
  phase_turns = random.uniform();
  return random.uniform(0.0, other.signal.waveform.repetition_s());
}

std::vector<RadarNeighbours::Sent> RadarNeighbours::record(const TickContext& context,
                                                           const rf::EchoMotion& motion) const {
  std::vector<Sent> all;
  const double begin_s = motion.slot_start_s.front(), end_s = begin_s + motion.frame_s();
  for (uint32_t index = 0; index < others_.size(); ++index) {
    const Other& other = others_[index];
    const rf::RadarWaveform& w = other.signal.waveform;
    const auto pose_at = [&](double time_s) {
      return world_.scene.to_local(context.motion_at(other.node, context.time_s + time_s).pose) * other.mount;
    };
    const Pose traced = pose_at(motion.traced_s);
    const dvec3 arm = motion.receiver(motion.traced_s).position - traced.position;
    const auto length_at = [&](double time_s) {
      return glm::distance(motion.receiver(time_s).position, pose_at(time_s).position);
    };
    const double first_m = length_at(begin_s), last_m = length_at(end_s), length_m = glm::length(arm);
    if (length_m <= 0.0) continue;  // two radars in one place: leakage, not interference
    const double frame_s = w.slots * w.interval_s + w.repetition_s();
    const auto first = static_cast<int64_t>(
        std::max(0.0, std::ceil((context.time_s + begin_s - frame_s) / other.period_s - 1e-9)));
    const auto last = static_cast<int64_t>(std::floor((context.time_s + end_s) / other.period_s + 1e-9));
    for (int64_t frame = first; frame <= last; ++frame) {
      rf::Interferer one;
      one.radar = index;
      one.waveform = w;
      one.arrays = other.signal.arrays;
      one.orientation = traced.orientation;
      one.power_w = other.signal.transmit_power_w;
      one.departure = arm / length_m;
      one.arrival = -one.departure;
      one.mid_s = 0.5 * (begin_s + end_s);
      one.delay_s = 0.5 * (first_m + last_m) / speed_of_light;
      one.rate = (last_m - first_m) / (speed_of_light * motion.frame_s());
      one.start_s = double(frame) * other.period_s + offset_s(other, frame, one.phase_turns) - context.time_s;
      one.first_slot = motion.first_slot;
      one.slots = static_cast<uint32_t>(motion.slot_start_s.size());
      all.push_back({index, traced, one});
    }
  }
  return all;
}

std::vector<rf::Interferer> RadarNeighbours::arrive(std::span<const Sent> sent, rf::EchoFinder& finder,
                                                    const rf::EchoFinder::Pending& rays) {
  std::vector<rf::Interferer> seen;
  for (const Sent& one : sent) {
    Other& other = others_[one.other];
    ++other.frames;
    rf::Interferer interferer = one.interferer;
    interferer.amplitude = finder.direct(rays, other.end, one.pose);
    const double power_w = interferer.power_w * std::norm(interferer.amplitude);
    if (power_w == 0.0) {
      ++other.hidden;
      continue;
    }
    other.strongest_w = std::max(other.strongest_w, power_w);
    seen.push_back(std::move(interferer));
  }
  return seen;
}

void RadarNeighbours::count(std::span<const rf::Interferer> interferers,
                            std::span<const rf::InterferenceReport> reports, uint64_t samples) {
  for (size_t i = 0; i < interferers.size(); ++i) others_[interferers[i].radar].samples += reports[i].samples;
  all_samples_ += samples;
}

void RadarNeighbours::note(const std::string& radar,
                           std::vector<std::pair<std::string, std::string>>& notes) const {
  for (const Other& other : others_) {
    const std::string what =
        other.frames == other.hidden
            ? std::string("never in sight while both send")
            : fmt::format(
                  "at most {:.1f} dBm at the receiver, {} of {} frames in sight, {:.3g} % of the samples",
                  10.0 * std::log10(other.strongest_w) + 30.0, other.frames - other.hidden, other.frames,
                  100.0 * double(other.samples) / double(std::max<uint64_t>(1, all_samples_)));
    notes.emplace_back(radar + " interference of " + other.name, what);
  }
}

}  // namespace greatx::sim
