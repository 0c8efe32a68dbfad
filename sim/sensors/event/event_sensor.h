// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "renderer/camera/camera.h"
#include "renderer/event/event_pass.h"
#include "sim/scenario/clock.h"
#include "sim/sensors/event/pixel_paths.h"
#include "sim/sensors/sensor.h"
#include "sim/world/posed_scene.h"

namespace greatx::sim {

class CameraSensor;

/// An event camera on a node. At each of its samples it delivers the events since the sample before
/// (docs/events.md). The pictures at the instants in between are rendered in the command buffer of the same
/// tick, with everything in its pose at the instant. With EventCameraConfig::camera, the pictures at the
/// samples are those of that camera, which are recorded just before.
class EventSensor : public Sensor {
 public:
  /// `node` and `sensor` are indices into the scenario. `shared` is the camera whose pixels it shares, or
  /// null. `posed` and the camera outlive this.
  EventSensor(PosedScene& posed, CameraSensor* shared, const Scenario& scenario, uint32_t node,
              uint32_t sensor);

  const SensorSpec& spec() const override { return spec_; }
  bool remembers() const override { return true; }
  bool draws_pictures() const override { return true; }
  void start(const TickContext& context) override;
  void record(gpu::TickSlot& slot, const TickContext& context) override;
  std::vector<Array> collect(const gpu::TickSlot& slot) override;
  void count(std::map<std::string, uint64_t>& counters) const override;
  void warn(std::vector<std::string>& warnings) const override;

 private:
  void describe();
  /// Returns the pass that has the picture of an instant; `sample`: the instant is a sample.
  render::CameraPass& picture_at(bool sample);
  void take_picture(gpu::TickSlot& slot, const TickContext& context, Instants& at, uint32_t index,
                    double time_s);
  void find_paths(const TickContext& context, double from_s, double to_s);
  std::vector<shared::EventMotion> motions(const TickContext& context, double time_s) const;

  PosedScene& posed_;
  const World& world_;
  EventCameraConfig config_;
  uint32_t node_;
  Pose mount_;
  Clock clock_;
  CameraSensor* shared_;
  std::optional<render::CameraPass> camera_;  ///< for the pictures that `shared_` does not take
  render::EventPass events_;
  render::PixelPaths paths_;  ///< by_pixel: of the step that is being recorded
  double picture_s_ = 0.0;    ///< by_pixel: time of the picture before
  SensorSpec spec_;
  std::optional<int64_t> last_ns_;  ///< time of the sample recorded last
  int64_t sample_ = 0;              ///< number of the next sample
  std::array<int64_t, slots_in_flight> begin_ns_{};
  uint64_t event_count_ = 0, dropped_ = 0, pictures_ = 0, coarse_ = 0;
};

}  // namespace greatx::sim
