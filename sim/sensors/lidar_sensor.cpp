// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/lidar_sensor.h"

#include "core/units.h"
#include "sim/plan/light_plan.h"
#include "sim/sensors/sensor_metadata.h"

namespace greatx::sim {

namespace {

render::LidarDesc lidar_desc(const SensorConfig& sensor, const EffectPlan& plan,
                             const Environment& environment, uint32_t body) {
  const auto& config = std::get<LidarConfig>(sensor.config);
  render::LidarDesc desc;
  desc.elevations = config.elevations;
  desc.azimuth_steps = config.azimuth_steps;
  desc.azimuth_start = config.azimuth_start;
  desc.azimuth_span = config.azimuth_span;
  desc.sweep_s = config.sweep_s;
  desc.min_range_m = config.min_range_m;
  desc.max_range_m = config.max_range_m;
  desc.wavelength_nm = static_cast<uint32_t>(config.wavelength_nm);
  if (body != 0 && !config.see_own_body) desc.excluded_body = body;
  desc.alpha_mask = plan.lidar_alpha_mask.on;
  desc.textured_reflectance = plan.lidar_textures.on;
  if (plan.lidar_haze.on) desc.extinction_per_m = haze_extinction(environment);
  return desc;
}

}  // namespace

LidarSensor::LidarSensor(scene::GpuScene& gpu_scene, const EffectPlan& plan, const Scenario& scenario,
                         const World& world, uint32_t node, uint32_t sensor)
    : world_(world),
      node_(node),
      mount_(mount_pose(scenario.nodes[node].sensors[sensor].mount)),
      per_shot_(plan.lidar_sweep_motion.on &&
                std::get<LidarConfig>(scenario.nodes[node].sensors[sensor].config).sweep_s > 0.0),
      pass_(gpu_scene,
            lidar_desc(scenario.nodes[node].sensors[sensor], plan, scenario.environment,
                       world.body_of_node[node]),
            scenario.nodes[node].name + "/" + scenario.nodes[node].sensors[sensor].name) {
  spec_.name = scenario.nodes[node].name + "/" + scenario.nodes[node].sensors[sensor].name;
  spec_.kind = "lidar";
  spec_.rate = scenario.nodes[node].sensors[sensor].rate_hz.str();
  describe();
}

void LidarSensor::describe() {
  spec_.arrays = {
      {"points",
       DType::f32,
       {-1, 4},
       "m",
       "[return, x y z intensity] in the sensor frame at the shot's own time"},
      {"ring", DType::u16, {-1}, "1", "[return] channel"},
      {"time_offset", DType::f32, {-1}, "s", "[return] of the shot after the tick"},
      {"range", DType::f32, {-1}, "m", "[return] along the beam"},
      {"power", DType::f32, {-1}, "1", "[return] received over transmitted power"},
      {"instance", DType::u32, {-1}, "1", "[return] index into instances + 1"},
      {"material", DType::u32, {-1}, "1", "[return] index into materials + 1"},
  };
  std::vector<std::string> all;
  for (const ArraySpec& array : spec_.arrays) all.push_back(array.name);
  spec_.outputs = {{"points", FileFormat::npy_frame, {"points"}}, {"cloud", FileFormat::ply, all}};

  const render::LidarDesc& desc = pass_.desc();
  nlohmann::json metadata;
  for (const double elevation : desc.elevations) metadata["elevations_deg"].push_back(degrees(elevation));
  metadata["azimuth_steps"] = desc.azimuth_steps;
  metadata["azimuth_start_deg"] = degrees(desc.azimuth_start);
  metadata["azimuth_span_deg"] = degrees(desc.azimuth_span);
  metadata["sweep_s"] = desc.sweep_s;
  metadata["min_range_m"] = desc.min_range_m;
  metadata["max_range_m"] = desc.max_range_m;
  metadata["wavelength_nm"] = desc.wavelength_nm;
  metadata["extinction_per_m"] = desc.extinction_per_m;
  metadata["frame"] = "x forward, y left, z up";
  metadata["body_from_sensor"] = json_of(mount_);
  spec_.metadata_json = metadata.dump();
}

void LidarSensor::record(gpu::TickSlot& slot, const TickContext& context) {
  std::vector<Pose> poses;
  if (per_shot_) {
    poses.reserve(pass_.desc().azimuth_steps);
    for (uint32_t step = 0; step < pass_.desc().azimuth_steps; ++step)
      poses.push_back(
          world_.scene.to_local(context.motion_at(node_, context.time_s + pass_.time_offset_s(step)).pose) *
          mount_);
  } else {
    poses.push_back(world_.scene.to_local(context.nodes[node_].pose) * mount_);
  }
  pending_[slot.index] = pass_.record(slot, poses);
}

std::vector<Array> LidarSensor::collect(const gpu::TickSlot& slot) {
  scan_ = pass_.collect(pending_[slot.index]);
  const auto count = static_cast<int64_t>(scan_.size());
  std::vector<Array> arrays;
  arrays.push_back(
      Array::of<float>({count, 4}, std::span(count > 0 ? &scan_.points[0].x : nullptr, scan_.size() * 4)));
  arrays.push_back(Array::of<uint16_t>({count}, scan_.ring));
  arrays.push_back(Array::of<float>({count}, scan_.time_offset_s));
  arrays.push_back(Array::of<float>({count}, scan_.range_m));
  arrays.push_back(Array::of<float>({count}, scan_.power));
  arrays.push_back(Array::of<uint32_t>({count}, scan_.instance));
  arrays.push_back(Array::of<uint32_t>({count}, scan_.material));
  return arrays;
}

}  // namespace greatx::sim
