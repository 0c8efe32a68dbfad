// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "rf/radar/echoes/echo_finder.h"
#include "rf/radar/signal/radar_processor.h"
#include "sim/experiment/experiment.h"
#include "sim/sensors/radar/radar_neighbours.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

/// A radar on a node, with a transmitter of its own or the antenna of another node. A frame begins at the
/// tick. Its rays are traced in the command buffer of the tick, RadarConfig::updates times, each time with
/// everything in its pose at that time.
class RadarSensor : public Sensor {
 public:
  /// Throws UserError if a target is not an instance of the scene, or if a material is unknown at the
  /// carrier. `survey`: null, or one of the scene's edges, which spares work.
  RadarSensor(scene::GpuScene& gpu_scene, const Experiment& experiment, uint32_t node, uint32_t sensor,
              const scene::EdgeSurvey* survey = nullptr);

  const SensorSpec& spec() const override { return spec_; }
  void record(gpu::TickSlot& slot, const TickContext& context) override;
  std::vector<Array> collect(const gpu::TickSlot& slot) override;
  Evidence evidence() const override;
  void count(std::map<std::string, uint64_t>& counters) const override;
  void warn(std::vector<std::string>& warnings) const override;
  void note(std::vector<std::pair<std::string, std::string>>& notes) const override;

  /// Holds the echoes of a frame over time; collect() makes a record of them.
  struct Echoes {
    std::vector<rf::EchoList> lists;
    std::vector<rf::RadarAttitude> attitudes;
    rf::RadarSeeds seeds;
    dvec3 baseline_m{0.0};
    std::vector<rf::Interferer> interferers;
  };
  /// The two halves of collect(), for callers that measure the cost of each.
  Echoes find_echoes(const gpu::TickSlot& slot);
  std::vector<Array> process(const Echoes& echoes);

  /// Returns the frame collected last.
  const rf::RadarFrame& frame() const { return frame_; }

 private:
  /// Describes the mount of an end.
  struct Carrier {
    uint32_t node = 0, body = 0;
    Pose mount;
  };
  /// Holds one tracing of the scene, and the motion until the next one.
  struct Update {
    rf::EchoFinder::Pending rays;
    rf::EchoMotion motion;
    rf::RadarAttitude attitude;
    std::vector<RadarNeighbours::Sent> sent;
  };
  struct Frame {
    std::vector<Update> updates;
    rf::RadarSeeds seeds;
    dvec3 baseline_m{0.0};
  };
  Carrier transmitter_of(const Scenario& scenario) const;
  /// Returns an end with the slant of its single polarization.
  rf::EchoEnd end_of(const AntennaConfig& antenna, uint32_t own_body) const;
  rf::EchoEnd transmit_end() const { return end_of(config_.transmit, transmitter_.body); }
  rf::EchoEnd receive_end() const { return end_of(config_.receive, receiver_.body); }
  rf::EchoOptions echo_options(const Experiment& experiment) const;
  rf::EchoMotion motion(const TickContext& context, uint32_t update) const;
  void describe(const SensorConfig& sensor);
  void watch_spans(const rf::EchoList& list);

  scene::GpuScene& gpu_scene_;
  const World& world_;
  RadarConfig config_;
  std::string name_;
  uint32_t node_;
  uint64_t seed_;
  Pose mount_;
  Carrier transmitter_, receiver_;
  rf::EchoFinder finder_;
  RadarNeighbours neighbours_;
  rf::RadarProcessor processor_;
  SensorSpec spec_;
  std::array<Frame, slots_in_flight> frames_;
  rf::RadarFrame frame_;
  uint64_t frames_done_ = 0, tubes_ = 0, beams_ = 0, echoes_ = 0, echoes_left_out_ = 0, patches_ = 0;
  uint64_t detections_ = 0, saturated_ = 0, late_echoes_ = 0;
  uint64_t echoes_beyond_span_ = 0, echoes_beyond_speed_ = 0;
  double longest_range_m_ = 0.0, fastest_m_s_ = 0.0;
};

}  // namespace greatx::sim
