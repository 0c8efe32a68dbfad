// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/truth.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/error.h"
#include "renderer/lens/lens_rays.h"

namespace greatx::render {

namespace {

/// The axes right, down, forward of a sensor.
dmat3 local_from_optical(const Pose& local_from_sensor) {
  return {local_from_sensor.rotate({0.0, -1.0, 0.0}), local_from_sensor.rotate({0.0, 0.0, -1.0}),
          local_from_sensor.rotate({1.0, 0.0, 0.0})};
}

std::vector<float> copied(const gpu::Slice& slice, size_t count) {
  if (slice.buffer == VK_NULL_HANDLE) return {};
  const std::span<float> values = slice.as<float>();
  return {values.begin(), values.begin() + static_cast<ptrdiff_t>(count)};
}

}  // namespace

shared::GpuBodyMotion body_motion(const Pose& local_from_sensor, const Pose& local_from_body,
                                  const Pose& next_local_from_sensor, const Pose& next_local_from_body) {
  const dmat3 now = local_from_optical(local_from_sensor),
              next_optical_from_local = glm::transpose(local_from_optical(next_local_from_sensor));
  const dmat3 turn = glm::mat3_cast(next_local_from_body.orientation) *
                     glm::transpose(glm::mat3_cast(local_from_body.orientation));
  const dmat3 change = next_optical_from_local * turn * now - dmat3(1.0);
  // The shift goes from the eye now to the body, turns with it, and goes back from its next origin to the
  // next eye. Differences of positions come first, so that large coordinates cancel exactly.
  const dvec3 to_eye = local_from_sensor.position - local_from_body.position;
  const dvec3 shift = next_optical_from_local *
                      (turn * to_eye + (next_local_from_body.position - next_local_from_sensor.position));
  const glm::dmat3 rows = glm::transpose(change);
  return {vec4(dvec4(rows[0], shift.x)), vec4(dvec4(rows[1], shift.y)), vec4(dvec4(rows[2], shift.z))};
}

TruthPass::TruthPass(const SceneLighting& lighting, const CameraDesc& desc, const TruthOutputs& outputs)
    : lighting_(&lighting), desc_(desc), outputs_(outputs), scope_(desc.name + " truth") {
  GREATX_CHECK(outputs.any() && desc.outputs.seen,
               "camera {}: no truth is wanted, or nothing keeps what is seen", desc.name);
  gpu::ComputeDesc truth;
  truth.shader = "camera/truth.comp";
  truth.bindings = scene::GpuScene::raster_bindings();
  truth.bindings.push_back({shared::truth_seen_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  truth.bindings.push_back({shared::truth_triangle_primitives_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  truth.push_constant_bytes = sizeof(shared::TruthConstants);
  const Distortion& lens = desc.distortion;
  const auto bits = [](double value) { return std::bit_cast<uint32_t>(static_cast<float>(value)); };
  // The radius is a little within the fold, where the picture would turn back. It is finite, since shaders
  // need not support infinities.
  const double fold = std::min(lens.fold_radius(), 1e15);
  truth.specialization.resize(shared::truth_spec_count);
  truth.specialization[shared::truth_spec_normals] = outputs.normals;
  truth.specialization[shared::truth_spec_depth_ray] = outputs.depth_ray;
  truth.specialization[shared::truth_spec_flow] = outputs.flow;
  truth.specialization[shared::truth_spec_moving] = lighting.scene().scene().bodies.size() > 1;
  truth.specialization[shared::truth_spec_distorted] = lens.any();
  truth.specialization[shared::truth_spec_k1] = bits(lens.k1);
  truth.specialization[shared::truth_spec_k2] = bits(lens.k2);
  truth.specialization[shared::truth_spec_p1] = bits(lens.p1);
  truth.specialization[shared::truth_spec_p2] = bits(lens.p2);
  truth.specialization[shared::truth_spec_k3] = bits(lens.k3);
  truth.specialization[shared::truth_spec_fold_squared] = bits(fold * fold);
  if (const WideLens& wide = desc.wide; wide.any()) {
    truth.specialization[shared::truth_spec_wide] =
        wide.fisheye() ? shared::truth_lens_fisheye : shared::truth_lens_equirectangular;
    truth.specialization[shared::truth_spec_k1] = bits(wide.k1);
    truth.specialization[shared::truth_spec_k2] = bits(wide.k2);
    truth.specialization[shared::truth_spec_k3] = bits(wide.k3);
    truth.specialization[shared::truth_spec_k4] = bits(wide.k4);
    truth.specialization[shared::truth_spec_half_angle] = bits(std::min(wide.half_angle, wide.fold_angle()));
  }
  pipeline_ = gpu::ComputePipeline(lighting_->scene().device(), truth, desc_.name + " truth");
  if (lens.any() || desc.wide.any()) upload_lens();
}

void TruthPass::upload_lens() {
  if (desc_.wide.any()) {
    const std::vector<dvec3> exact = LensRays(lens_geometry(desc_)).centers();
    const std::vector<vec3> directions(exact.begin(), exact.end());
    lens_ = gpu::upload_buffer(lighting_->scene().device(), std::as_bytes(std::span(directions)),
                               desc_.name + " lens");
    return;
  }
  const std::vector<dvec2> centers =
      Lens(lens_geometry(desc_)).centers({desc_.fx, desc_.fy}, {desc_.cx, desc_.cy});
  const std::vector<vec2> pinhole(centers.begin(), centers.end());
  lens_ = gpu::upload_buffer(lighting_->scene().device(), std::as_bytes(std::span(pinhole)),
                             desc_.name + " lens");
}

void TruthPass::record(gpu::TickSlot& slot, const gpu::Buffer& seen, const TruthInstant& now,
                       const TruthInstant& next) {
  const size_t pixels = size_t{desc_.width} * desc_.height;
  const auto floats = [&](bool wanted, size_t per_pixel) {
    return wanted ? slot.readback.allocate(sizeof(float) * per_pixel * pixels) : gpu::Slice{};
  };
  Readback readback;
  readback.normals = floats(outputs_.normals, 3);
  readback.depth_ray = floats(outputs_.depth_ray, 1);
  readback.flow = floats(outputs_.flow, 2);
  if (readbacks_.size() <= slot.index) readbacks_.resize(slot.index + 1);
  readbacks_[slot.index] = readback;

  const Pose& pose = now.local_from_sensor;
  const dmat3 axes = local_from_optical(pose);
  shared::TruthConstants constants{};
  constants.normals = readback.normals.address;
  constants.depth_ray = readback.depth_ray.address;
  constants.flow = readback.flow.address;
  if (outputs_.flow) {
    GREATX_CHECK(now.bodies.size() == next.bodies.size() && !now.bodies.empty(), "{} and {} bodies",
                 now.bodies.size(), next.bodies.size());
    std::vector<shared::GpuBodyMotion> motions;
    for (size_t body = 0; body < now.bodies.size(); ++body)
      motions.push_back(body == 0
                            ? body_motion(pose, {}, next.local_from_sensor, {})
                            : body_motion(pose, now.bodies[body], next.local_from_sensor, next.bodies[body]));
    constants.motions = slot.upload.put(std::span<const shared::GpuBodyMotion>(motions)).address;
  }
  if (desc_.distortion.any() || desc_.wide.any()) constants.lens = lens_.address();
  constants.eye_high = vec3(pose.position);
  constants.eye_low = vec3(pose.position - dvec3(constants.eye_high));
  constants.ray_x = vec3(axes[0] / desc_.fx);
  constants.ray_y = vec3(axes[1] / desc_.fy);
  constants.ray_0 = vec3(axes[2] - axes[0] * (desc_.cx / desc_.fx) - axes[1] * (desc_.cy / desc_.fy));
  if (desc_.wide.any()) {  // the table has directions
    constants.ray_x = vec3(axes[0]);
    constants.ray_y = vec3(axes[1]);
    constants.ray_0 = vec3(axes[2]);
  }
  constants.focal = vec2(dvec2(desc_.fx, desc_.fy));
  constants.principal = vec2(dvec2(desc_.cx, desc_.cy));
  constants.width = desc_.width;
  constants.height = desc_.height;
  constants.near_m = static_cast<float>(desc_.near_m);

  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(scope_);
  cmd.barrier(gpu::sync::compute_write, gpu::sync::compute_read);
  cmd.bind(pipeline_);
  std::vector<gpu::Descriptor> descriptors = lighting_->scene().raster_descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(shared::truth_seen_binding, seen));
  descriptors.push_back(gpu::Descriptor::buffer(shared::truth_triangle_primitives_binding,
                                                lighting_->surfaces().triangle_primitives()));
  cmd.push(descriptors);
  cmd.constants(constants);
  cmd.dispatch_linear(pixels, shared::truth_group_size);
}

TruthImages TruthPass::collect(const gpu::TickSlot& slot) const {
  GREATX_CHECK(slot.index < readbacks_.size(), "camera {}: no truth was recorded into slot {}", desc_.name,
               slot.index);
  const Readback& from = readbacks_[slot.index];
  const size_t pixels = size_t{desc_.width} * desc_.height;
  return {copied(from.normals, 3 * pixels), copied(from.depth_ray, pixels), copied(from.flow, 2 * pixels)};
}

}  // namespace greatx::render
