// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/registry/registry.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "sim/channel/channel_sensor.h"
#include "sim/scenario/sensor_kinds.h"
#include "sim/sensors/camera/camera_sensor.h"
#include "sim/sensors/event/event_sensor.h"
#include "sim/sensors/lidar/lidar_sensor.h"
#include "sim/sensors/located.h"
#include "sim/sensors/navigation/air_sensors.h"
#include "sim/sensors/navigation/gnss_sensor.h"
#include "sim/sensors/navigation/imu_sensor.h"
#include "sim/sensors/pose/pose_sensor.h"
#include "sim/sensors/radar/radar_sensor.h"

namespace greatx::sim {

namespace {

/// Holds the parts, and the cameras made so far, since later sensors may share their pixels.
struct Workshop {
  const SensorParts& parts;
  std::map<std::string, CameraSensor*> cameras;  ///< by "node/sensor"
};

std::unique_ptr<Sensor> make_camera(Workshop& shop, SensorPlace at) {
  const SensorParts& p = shop.parts;
  auto camera = std::make_unique<CameraSensor>(*p.passes.posed, p.passes.probe.get(), p.experiment.scenario,
                                               at.node, at.sensor);
  shop.cameras[camera->spec().name] = camera.get();
  return camera;
}

/// Makes an event camera. It may share the pixels of a camera of its node; the parser has checked that this
/// camera is listed before it.
std::unique_ptr<Sensor> make_event_camera(Workshop& shop, SensorPlace at) {
  const SensorParts& p = shop.parts;
  const NodeConfig& node = p.experiment.scenario.nodes[at.node];
  const std::string& camera = std::get<EventCameraConfig>(node.sensors[at.sensor].config).camera;
  CameraSensor* shared = nullptr;
  if (!camera.empty()) {
    const auto found = shop.cameras.find(node.name + "/" + camera);
    GREATX_CHECK(found != shop.cameras.end(), "{}: no camera '{}'", node.name, camera);
    shared = found->second;
  }
  return std::make_unique<EventSensor>(*p.passes.posed, shared, p.experiment.scenario, at.node, at.sensor);
}

std::unique_ptr<Sensor> make_lidar(Workshop& shop, SensorPlace at) {
  const SensorParts& p = shop.parts;
  return std::make_unique<LidarSensor>(p.gpu_scene, p.experiment, at.node, at.sensor);
}

std::unique_ptr<Sensor> make_radar(Workshop& shop, SensorPlace at) {
  const SensorParts& p = shop.parts;
  if (std::unique_ptr<Sensor> made = p.radio.radar(at)) return made;
  return std::make_unique<RadarSensor>(p.gpu_scene, p.experiment, at.node, at.sensor, p.radio.survey());
}

/// Makes a sensor that measures on the host.
template <typename Made>
std::unique_ptr<Sensor> make_on_host(Workshop& shop, SensorPlace at) {
  return std::make_unique<Made>(shop.parts.experiment, at.node, at.sensor);
}

std::unique_ptr<Sensor> make_channel(const SensorParts& p, uint32_t channel) {
  return std::make_unique<ChannelSensor>(p.gpu_scene, *p.passes.crossings, p.experiment, channel,
                                         p.radio.world(channel));
}

/// A row of the table of kinds.
struct Maker {
  size_t kind = 0;  ///< index into sensor_kinds
  std::unique_ptr<Sensor> (*make)(Workshop&, SensorPlace) = nullptr;
};

/// The kinds of sensors of nodes. A new kind needs a row here.
constexpr Maker makers[] = {
    {sensor_kind_index<CameraConfig>(), make_camera},
    {sensor_kind_index<EventCameraConfig>(), make_event_camera},
    {sensor_kind_index<LidarConfig>(), make_lidar},
    {sensor_kind_index<RadarConfig>(), make_radar},
    {sensor_kind_index<ImuConfig>(), make_on_host<ImuSensor>},
    {sensor_kind_index<GnssConfig>(), make_on_host<GnssSensor>},
    {sensor_kind_index<BarometerConfig>(), make_on_host<BarometerSensor>},
    {sensor_kind_index<MagnetometerConfig>(), make_on_host<MagnetometerSensor>},
};

/// Returns the maker of a kind; null: the kind does not fire.
constexpr const Maker* maker_of(size_t kind) {
  for (const Maker& maker : makers)
    if (maker.kind == kind) return &maker;
  return nullptr;
}

constexpr bool every_kind_that_fires_has_a_maker() {
  for (size_t kind = 0; kind < sensor_kind_count; ++kind)
    if ((maker_of(kind) != nullptr) != sensor_kinds[kind].fires) return false;
  return true;
}
static_assert(every_kind_that_fires_has_a_maker());

}  // namespace

std::vector<RunSensor> make_sensors(const SensorParts& parts) {
  std::vector<RunSensor> sensors;
  sensors.push_back(
      {std::make_unique<PoseSensor>(parts.experiment.scenario, parts.experiment.scene()), {}, {}});
  Workshop shop{parts, {}};
  const std::vector<NodeConfig>& nodes = parts.experiment.scenario.nodes;
  for (uint32_t node = 0; node < nodes.size(); ++node)
    for (uint32_t i = 0; i < nodes[node].sensors.size(); ++i) {
      const SensorConfig& config = nodes[node].sensors[i];
      const Maker* const maker = maker_of(config.config.index());
      if (maker == nullptr) continue;
      auto sensor = located(config.where, [&] { return maker->make(shop, {node, i}); });
      sensors.push_back({std::move(sensor), config.rate_hz, config.where});
    }
  for (uint32_t i = 0; i < parts.experiment.scenario.channels.size(); ++i) {
    const ChannelConfig& config = parts.experiment.scenario.channels[i];
    auto sensor = located(config.where, [&] { return make_channel(parts, i); });
    sensors.push_back({std::move(sensor), config.rate_hz, config.where});
  }
  return sensors;
}

}  // namespace greatx::sim
