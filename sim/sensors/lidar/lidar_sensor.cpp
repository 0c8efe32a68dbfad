// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/lidar/lidar_sensor.h"

#include "core/hash.h"
#include "core/units.h"
#include "sim/plan/light_plan.h"
#include "sim/sensors/lidar/lidar_metadata.h"
#include "sim/sensors/lidar/lidar_targets.h"

namespace greatx::sim {

namespace {

render::LidarDesc lidar_desc(const LidarConfig& config, const EffectPlan& plan,
                             const Environment& environment, uint32_t unseen_body) {
  render::LidarDesc desc;
  desc.pattern = render::scan_pattern(config.scan);
  desc.min_range_m = config.min_range_m;
  desc.max_range_m = config.max_range_m;
  desc.wavelength_nm = static_cast<uint32_t>(config.wavelength_nm);
  if (unseen_body != 0) desc.excluded_body = unseen_body;
  desc.divergence = config.divergence;
  if (plan.lidar_divergence.on) desc.rings = config.rings;
  desc.returns = config.returns;
  desc.receiver = config.receiver;
  if (!plan.lidar_range_noise.on) desc.receiver.range_std_m = desc.receiver.rise_m = 0.0;
  if (!plan.lidar_detection.on) desc.receiver.detection.reset();
  if (!desc.receiver.detection) desc.receiver.rise_m = 0.0;
  const double extinction = haze_extinction(environment);
  if (plan.lidar_haze.on) desc.receiver.extinction_per_m = extinction;
  if (plan.lidar_backscatter.on && desc.receiver.detection)
    desc.receiver.backscatter_per_m_sr = extinction / render::lidar_ratio_sr;
  desc.alpha_mask = plan.lidar_alpha_mask.on;
  desc.textured_reflectance = plan.lidar_textures.on;
  desc.glass = plan.lidar_glass.on;
  desc.target_motion = plan.lidar_target_motion.on && render::duration_s(config.scan) > 0.0;
  return desc;
}

std::string name_of(const NodeConfig& node, uint32_t sensor) {
  return node.name + "/" + node.sensors[sensor].name;
}

}  // namespace

LidarSensor::LidarSensor(scene::GpuScene& gpu_scene, const Experiment& experiment, uint32_t node,
                         uint32_t sensor)
    : world_(*experiment.world),
      config_(std::get<LidarConfig>(experiment.scenario.nodes[node].sensors[sensor].config)),
      node_(node),
      seed_(experiment.scenario.seed),
      mount_(mount_pose(experiment.scenario.nodes[node].sensors[sensor].mount)),
      per_shot_(experiment.plan.lidar_sweep_motion.on && render::duration_s(config_.scan) > 0.0),
      unseen_body_(config_.see_own_body ? 0 : world_.body_of_node[node]),
      pass_(gpu_scene, lidar_desc(config_, experiment.plan, experiment.scenario.environment, unseen_body_),
            name_of(experiment.scenario.nodes[node], sensor)) {
  describe(experiment.scenario.nodes[node].sensors[sensor]);
}

void LidarSensor::describe(const SensorConfig& sensor) {
  spec_.name = pass_.name();
  spec_.kind = "lidar";
  spec_.rate = sensor.rate_hz.str();
  spec_.arrays = lidar_arrays(config_);
  std::vector<std::string> all;
  for (const ArraySpec& array : spec_.arrays) all.push_back(array.name);
  const LidarConfig::Outputs& outputs = config_.outputs;
  if (outputs.points) spec_.outputs.push_back({"points", FileFormat::npy_frame, {"points"}});
  if (outputs.ply) spec_.outputs.push_back({"cloud", FileFormat::ply, all});
  if (outputs.pcd) spec_.outputs.push_back({"pcd", FileFormat::pcd, all});
  if (outputs.kitti) spec_.outputs.push_back({"velodyne", FileFormat::kitti, {"points"}});
  if (outputs.arrays)
    for (const std::string& name : all) spec_.outputs.push_back({name, FileFormat::npy_frame, {name}});
  nlohmann::json metadata = lidar_metadata(config_, pass_.desc());
  metadata["body_from_sensor"] = json_of(mount_);
  spec_.metadata_json = metadata.dump();
}

bool LidarSensor::exact() const {
  return !per_shot_ && !pass_.desc().target_motion && pass_.desc().rings == 0;
}

Evidence LidarSensor::evidence() const {
  Evidence evidence;
  if (!exact()) return evidence;
  const std::span<const float> xyzi(scan_.size() > 0 ? &scan_.points[0].x : nullptr, 4 * scan_.size());
  const render::Receiver& receiver = pass_.desc().receiver;
  const RangeNoise noise{receiver.range_std_m, receiver.rise_m,
                         receiver.detection ? receiver.detection->noise_equivalent_power : 0.0};
  const bool noisy = noise.std_m > 0.0 || noise.rise_m > 0.0;
  evidence.returns = {node_,          mount_,
                      xyzi,           scan_.instance,
                      scan_.material, point_error_m(config_),
                      noise,          noisy ? std::span<const float>(scan_.power) : std::span<const float>()};
  return evidence;
}

std::vector<Pose> LidarSensor::poses(const TickContext& context, const render::ScanPattern& pattern) const {
  std::vector<Pose> poses;
  if (!per_shot_) return {world_.scene.to_local(context.nodes[node_].pose) * mount_};
  poses.reserve(pattern.times_s.size());
  for (const double time_s : pattern.times_s)
    poses.push_back(world_.scene.to_local(context.motion_at(node_, context.time_s + time_s).pose) * mount_);
  return poses;
}

render::ShotNoise LidarSensor::noise_of(const TickContext& context) const {
  return {seed_, fnv1a32(spec_.name), context.sequence, context.tick};
}

void LidarSensor::record(gpu::TickSlot& slot, const TickContext& context) {
  std::shared_ptr<const render::ScanPattern> pattern;
  if (!render::repeats(config_.scan))
    pattern = std::make_shared<render::ScanPattern>(render::scan_pattern(config_.scan, context.time_s));
  const render::ScanPattern& shots = pattern ? *pattern : pass_.pattern();
  const std::vector<Pose> local_from_sensor = poses(context, shots);
  render::LidarTargets targets;
  if (pass_.desc().target_motion)
    targets =
        lidar_targets(world_, context, {unseen_body_, shots.times_s, local_from_sensor, config_.max_range_m});
  sweeps_[slot.index] = {pass_.record(slot, local_from_sensor, targets, pattern), noise_of(context)};
}

std::vector<Array> LidarSensor::collect(const gpu::TickSlot& slot) {
  const Sweep& sweep = sweeps_[slot.index];
  scan_ = pass_.collect(sweep.pending, sweep.noise);
  if (config_.point_step_m > 0.0) round_points(scan_, config_.point_step_m);
  return arrays_of(scan_, config_.outputs);
}

}  // namespace greatx::sim
