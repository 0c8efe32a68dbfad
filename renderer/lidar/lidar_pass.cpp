// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/lidar/lidar_pass.h"

#include <cmath>
#include <limits>

#include "renderer/lidar/pane.h"
#include "renderer/lidar/scan/footprint.h"

namespace greatx::render {

namespace {

void check(const LidarDesc& desc) {
  GREATX_CHECK(desc.min_range_m >= 0.0 && desc.max_range_m > desc.min_range_m, "ranges {} to {} m",
               desc.min_range_m, desc.max_range_m);
  GREATX_CHECK(desc.wavelength_nm == 905 || desc.wavelength_nm == 1550, "wavelength of {} nm",
               desc.wavelength_nm);
  GREATX_CHECK(desc.pattern.size() > 0, "a pattern without shots");
  GREATX_CHECK(desc.returns.resolution_m > 0.0 && desc.returns.most >= 1, "resolution of {} m, {} returns",
               desc.returns.resolution_m, desc.returns.most);
  const Receiver& receiver = desc.receiver;
  GREATX_CHECK(receiver.detection || (receiver.rise_m == 0.0 && receiver.backscatter_per_m_sr == 0.0),
               "a pulse of {} m and backscattering of {} without a detector's noise", receiver.rise_m,
               receiver.backscatter_per_m_sr);
}

/// Returns the rows of local_from_sensor, which stay in fp64 until the last moment.
shared::GpuBody rows_of(const Pose& pose) {
  const dmat3 r = glm::mat3_cast(pose.orientation);
  const auto row = [&](int i) { return vec4(dvec4(r[0][i], r[1][i], r[2][i], pose.position[i])); };
  return {row(0), row(1), row(2)};
}

std::vector<shared::LidarBeam> gpu_beams(const ScanPattern& pattern) {
  std::vector<shared::LidarBeam> beams(pattern.size());
  for (size_t i = 0; i < beams.size(); ++i) beams[i] = {vec3(pattern.directions[i]), pattern.instants[i]};
  return beams;
}

std::vector<shared::LidarPane> panes_of(const scene::Scene& scene, uint32_t wavelength_nm) {
  std::vector<shared::LidarPane> panes;
  for (const scene::Material& material : scene.materials)
    panes.push_back(pane_of(material, wavelength_nm).value_or(shared::LidarPane{0.0f, 0.0f, 0.0f}));
  return panes;
}

ReturnModel model_of(const LidarDesc& desc) {
  ReturnModel model;
  for (const SubRay& ray : sub_rays(desc.divergence, desc.rings)) model.weights.push_back(ray.weight);
  model.receiver = desc.receiver;
  model.choice = desc.returns;
  model.min_range_m = desc.min_range_m;
  model.max_range_m = desc.max_range_m;
  return model;
}

constexpr uint32_t groups(uint32_t count, uint32_t size) { return (count + size - 1) / size; }

template <typename T>
gpu::Buffer upload(gpu::Device& device, const std::vector<T>& values, const std::string& name) {
  return gpu::upload_buffer(device, std::as_bytes(std::span(values)), name);
}

}  // namespace

LidarPass::LidarPass(scene::GpuScene& scene, const LidarDesc& desc, std::string_view name)
    : scene_(&scene), desc_(desc), name_(name), pattern_(std::make_shared<ScanPattern>(desc.pattern)) {
  check(desc_);
  model_ = model_of(desc_);
  slots_ = desc_.glass ? shared::lidar_glass_slots : 1u;
  refractive_index_ = static_cast<float>(glass_index(desc_.wavelength_nm));
  gpu::Device& device = scene.device();
  beams_ = upload(device, gpu_beams(*pattern_), name_ + " beams");
  if (desc_.rings > 0) {
    std::vector<vec2> offsets;
    for (const SubRay& ray : sub_rays(desc_.divergence, desc_.rings)) offsets.push_back(ray.offset);
    offsets_ = upload(device, offsets, name_ + " sub-rays");
  }
  if (desc_.glass) panes_ = upload(device, panes_of(scene.scene(), desc_.wavelength_nm), name_ + " panes");

  const uint64_t echoes = uint64_t{pattern_->size()} * model_.weights.size() * slots_,
                 most = device.limits().maxStorageBufferRange / sizeof(shared::LidarEcho);
  if (echoes > most)
    throw_user_error(
        "LiDAR {}: expected at most {} echoes a sweep on '{}', found {} shots x {} rays x {} echoes a ray",
        name_, most, device.info().name, pattern_->size(), model_.weights.size(), slots_);
  echoes_ = gpu::Buffer(device, sizeof(shared::LidarEcho) * echoes, gpu::Memory::device, name_ + " echoes");
  pipeline_ = build_pipeline();
}

gpu::ComputePipeline LidarPass::build_pipeline() const {
  const bool textured = desc_.alpha_mask || desc_.textured_reflectance;
  gpu::ComputeDesc compute;
  compute.specialization = {desc_.excluded_body.has_value(), desc_.rings > 0, desc_.glass,
                            desc_.target_motion};
  if (textured)
    compute.specialization.insert(compute.specialization.end(),
                                  {desc_.alpha_mask, desc_.textured_reflectance,
                                   scene_->textures().arrays_of(&scene::MaterialTextures::base_color)});
  if (textured) compute.textures = &scene_->textures().table();
  scene_->prepare_tracing(compute, textured ? "lidar/sweep_textured.comp" : "lidar/sweep.comp");
  for (uint32_t slot = shared::lidar_beams_binding; slot <= shared::lidar_motions_binding; ++slot)
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::LidarConstants);
  return gpu::ComputePipeline(scene_->device(), compute, name_);
}

LidarPass::Pending LidarPass::record(gpu::TickSlot& slot, std::span<const Pose> local_from_sensor,
                                     const LidarTargets& targets,
                                     std::shared_ptr<const ScanPattern> pattern) {
  GREATX_CHECK(targets.apart ? desc_.target_motion : targets.bodies.empty(),
               "{} targets of a LiDAR that sees them at the tick", targets.bodies.size());
  if (pattern == nullptr) pattern = pattern_;
  GREATX_CHECK(pattern->columns == pattern_->columns && pattern->rows == pattern_->rows,
               "{} x {} shots after {} x {}", pattern->columns, pattern->rows, pattern_->columns,
               pattern_->rows);
  const size_t instants = pattern->times_s.size();
  GREATX_CHECK(local_from_sensor.size() == 1 || local_from_sensor.size() == instants,
               "{} poses for {} instants", local_from_sensor.size(), instants);
  const gpu::Slice poses = slot.upload.allocate_for<shared::GpuBody>(local_from_sensor.size());
  for (size_t i = 0; i < local_from_sensor.size(); ++i)
    poses.as<shared::GpuBody>()[i] = rows_of(local_from_sensor[i]);

  std::vector<shared::LidarTarget> bodies;
  std::vector<shared::GpuBody> motions;
  for (const LidarTarget& target : targets.bodies) {
    GREATX_CHECK(target.motions.empty() || target.motions.size() == instants, "{} motions for {} instants",
                 target.motions.size(), instants);
    bodies.push_back({target.body,
                      target.motions.empty() ? shared::lidar_still : static_cast<uint32_t>(motions.size()),
                      vec4(vec3(target.center), static_cast<float>(target.radius_m))});
    for (const Pose& motion : target.motions) motions.push_back(rows_of(motion));
  }

  shared::LidarConstants constants{};
  constants.columns = pattern->columns;
  constants.rows = pattern->rows;
  constants.sub_rays = static_cast<uint32_t>(model_.weights.size());
  constants.pose_count = static_cast<uint32_t>(local_from_sensor.size());
  constants.excluded_body = desc_.excluded_body.value_or(~0u);
  constants.apart = targets.apart ? 1u : 0u;
  constants.targets = static_cast<uint32_t>(bodies.size());
  constants.wavelength_nm = desc_.wavelength_nm;
  constants.min_range = static_cast<float>(desc_.min_range_m);
  constants.max_range = static_cast<float>(desc_.max_range_m);
  constants.refractive_index = refractive_index_;
  constants.half_divergence = static_cast<float>(0.5 * desc_.divergence);

  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(name_);
  cmd.barrier(gpu::sync::transfer_read, gpu::sync::compute_write);  // waits for the copy of the sweep before
  cmd.bind(pipeline_);
  // Bindings that this pipeline does not use get some buffer.
  const auto some = [&](const gpu::Buffer& buffer) {
    return buffer.size() > 0 ? buffer.slice() : beams_.slice();
  };
  const auto put = [&](const auto& values) {
    return values.empty() ? beams_.slice() : slot.upload.put(std::span(std::as_const(values)));
  };
  std::vector<gpu::Descriptor> descriptors = scene_->descriptors();
  const auto bind = [&](uint32_t binding, const gpu::Slice& slice) {
    descriptors.push_back(gpu::Descriptor::buffer(binding, slice));
  };
  bind(shared::lidar_beams_binding, beams_of(slot, *pattern));
  bind(shared::lidar_poses_binding, poses);
  bind(shared::lidar_echoes_binding, echoes_.slice());
  bind(shared::lidar_sub_rays_binding, some(offsets_));
  bind(shared::lidar_panes_binding, some(panes_));
  bind(shared::lidar_targets_binding, put(bodies));
  bind(shared::lidar_motions_binding, put(motions));
  cmd.push(descriptors);
  cmd.constants(constants);
  cmd.dispatch(groups(constants.columns, shared::lidar_patch_columns),
               groups(constants.rows, shared::lidar_patch_rows), constants.sub_rays);
  cmd.barrier(gpu::sync::compute_write, gpu::sync::transfer_read);
  const gpu::Slice target = slot.readback.allocate(echoes_.size());
  cmd.copy(echoes_.slice(), target);
  return {target, std::move(pattern)};
}

gpu::Slice LidarPass::beams_of(gpu::TickSlot& slot, const ScanPattern& pattern) const {
  if (&pattern == pattern_.get()) return beams_.slice();
  const std::vector<shared::LidarBeam> beams = gpu_beams(pattern);
  return slot.upload.put(std::span<const shared::LidarBeam>(beams));
}

LidarScan LidarPass::collect(const Pending& pending, const ShotNoise& noise) const {
  const EchoView echoes{pending.echoes.as<shared::LidarEcho>(),
                        static_cast<uint32_t>(pending.pattern->size()),
                        static_cast<uint32_t>(model_.weights.size()), slots_};
  return make_scan(*pending.pattern, echoes, model_, noise);
}

}  // namespace greatx::render
