// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/lidar.h"

#include <cmath>
#include <limits>

namespace greatx::render {

namespace {

constexpr uint32_t max_index = std::numeric_limits<uint16_t>::max();

void check(const LidarDesc& desc) {
  GREATX_CHECK(!desc.elevations.empty() && desc.elevations.size() <= max_index, "{} channels",
               desc.elevations.size());
  GREATX_CHECK(desc.azimuth_steps >= 1 && desc.azimuth_steps <= max_index, "{} azimuth steps",
               desc.azimuth_steps);
  GREATX_CHECK(desc.min_range_m >= 0.0 && desc.max_range_m > desc.min_range_m, "ranges {} to {} m",
               desc.min_range_m, desc.max_range_m);
  GREATX_CHECK(desc.wavelength_nm == 905 || desc.wavelength_nm == 1550, "wavelength of {} nm",
               desc.wavelength_nm);
  GREATX_CHECK(desc.sweep_s >= 0.0, "sweep of {} s", desc.sweep_s);
}

vec2 cosine_and_sine(double angle) {
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

std::vector<vec2> beam_angles(const LidarDesc& desc) {
  std::vector<vec2> angles;
  for (const double elevation : desc.elevations) angles.push_back(cosine_and_sine(elevation));
  for (uint32_t step = 0; step < desc.azimuth_steps; ++step)
    angles.push_back(cosine_and_sine(desc.azimuth_start + step * desc.azimuth_span / desc.azimuth_steps));
  return angles;
}

/// Rows of local_from_sensor, fp64 until the last moment.
shared::GpuBody rows_of(const Pose& pose) {
  const dmat3 r = glm::mat3_cast(pose.orientation);
  const auto row = [&](int i) { return vec4(dvec4(r[0][i], r[1][i], r[2][i], pose.position[i])); };
  return {row(0), row(1), row(2)};
}

constexpr uint32_t groups(uint32_t count, uint32_t size) { return (count + size - 1) / size; }

}  // namespace

LidarPass::LidarPass(scene::GpuScene& scene, const LidarDesc& desc, std::string_view name)
    : scene_(&scene), desc_(desc), name_(name) {
  check(desc_);
  angles_ = beam_angles(desc_);
  gpu::Device& device = scene.device();
  angles_buffer_ = gpu::upload_buffer(device, std::as_bytes(std::span(angles_)), name_ + " angles");
  returns_ = gpu::Buffer(device, sizeof(shared::LidarReturn) * channels() * desc_.azimuth_steps,
                         gpu::Memory::device, name_ + " returns");

  const bool textured = desc_.alpha_mask || desc_.textured_reflectance;
  gpu::ComputeDesc compute;
  compute.shader = textured ? "lidar/sweep_textured.comp" : "lidar/sweep.comp";
  compute.bindings = scene::GpuScene::bindings(true);
  for (const uint32_t slot :
       {shared::lidar_angles_binding, shared::lidar_poses_binding, shared::lidar_returns_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::LidarConstants);
  compute.specialization = {desc_.excluded_body.has_value()};
  if (textured) {
    compute.specialization.insert(compute.specialization.end(),
                                  {desc_.alpha_mask, desc_.textured_reflectance,
                                   scene.textures().arrays_of(&scene::MaterialTextures::base_color)});
    compute.textures = &scene.textures().table();
  }
  pipeline_ = gpu::ComputePipeline(device, compute, name_);
}

LidarPass::Pending LidarPass::record(gpu::TickSlot& slot, std::span<const Pose> local_from_sensor) {
  GREATX_CHECK(local_from_sensor.size() == 1 || local_from_sensor.size() == desc_.azimuth_steps,
               "{} poses for {} azimuth steps", local_from_sensor.size(), desc_.azimuth_steps);
  const gpu::Slice poses = slot.upload.allocate_for<shared::GpuBody>(local_from_sensor.size());
  for (size_t i = 0; i < local_from_sensor.size(); ++i)
    poses.as<shared::GpuBody>()[i] = rows_of(local_from_sensor[i]);

  shared::LidarConstants constants{};
  constants.channels = channels();
  constants.azimuth_steps = desc_.azimuth_steps;
  constants.pose_count = static_cast<uint32_t>(local_from_sensor.size());
  constants.excluded_body = desc_.excluded_body.value_or(~0u);
  constants.min_range = static_cast<float>(desc_.min_range_m);
  constants.max_range = static_cast<float>(desc_.max_range_m);
  constants.wavelength_nm = desc_.wavelength_nm;

  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(name_);
  cmd.barrier(gpu::sync::transfer_read, gpu::sync::compute_write);  // the copy of the sweep before
  cmd.bind(pipeline_);
  std::vector<gpu::Descriptor> descriptors = scene_->descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(shared::lidar_angles_binding, angles_buffer_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::lidar_poses_binding, poses));
  descriptors.push_back(gpu::Descriptor::buffer(shared::lidar_returns_binding, returns_));
  cmd.push(descriptors);
  cmd.constants(constants);
  cmd.dispatch(groups(desc_.azimuth_steps, shared::lidar_patch_azimuths),
               groups(channels(), shared::lidar_patch_channels));
  cmd.barrier(gpu::sync::compute_write, gpu::sync::transfer_read);
  const gpu::Slice target = slot.readback.allocate(returns_.size());
  cmd.copy(returns_.slice(), target);
  return {target};
}

vec3 LidarPass::beam(uint32_t step, uint32_t channel) const {
  const vec2 elevation = angles_[channel], azimuth = angles_[channels() + step];
  return {elevation.x * azimuth.x, elevation.x * azimuth.y, elevation.y};
}

LidarScan LidarPass::collect(const Pending& pending) const {
  const std::span<const shared::LidarReturn> returns = pending.returns.as<shared::LidarReturn>();
  LidarScan scan;
  const double aperture =
      desc_.aperture_diameter_m * desc_.aperture_diameter_m * desc_.system_efficiency / 4.0;
  for (uint32_t step = 0; step < desc_.azimuth_steps; ++step) {
    for (uint32_t channel = 0; channel < channels(); ++channel) {
      const shared::LidarReturn& shot = returns[size_t{step} * channels() + channel];
      if (shot.instance == shared::lidar_no_object) continue;
      const double range = shot.range;
      scan.points.push_back(vec4(shot.range * beam(step, channel), shot.intensity));
      scan.ring.push_back(static_cast<uint16_t>(channel));
      scan.azimuth_step.push_back(static_cast<uint16_t>(step));
      scan.time_offset_s.push_back(static_cast<float>(time_offset_s(step)));
      scan.range_m.push_back(shot.range);
      scan.power.push_back(static_cast<float>(shot.intensity * aperture / (range * range) *
                                              std::exp(-2.0 * desc_.extinction_per_m * range)));
      scan.instance.push_back(shot.instance);
      scan.material.push_back(shot.material);
    }
  }
  return scan;
}

std::vector<float> LidarPass::collect_ranges(const Pending& pending) const {
  const std::span<const shared::LidarReturn> returns = pending.returns.as<shared::LidarReturn>();
  std::vector<float> image(size_t{channels()} * desc_.azimuth_steps);
  for (uint32_t channel = 0; channel < channels(); ++channel)
    for (uint32_t step = 0; step < desc_.azimuth_steps; ++step)
      image[size_t{channel} * desc_.azimuth_steps + step] =
          returns[size_t{step} * channels() + channel].range;
  return image;
}

}  // namespace greatx::render
