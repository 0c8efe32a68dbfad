// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/echo_pass.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scene/material/lossless.h"

namespace greatx::rf {
namespace {

bool finite(const dvec3& v) { return std::isfinite(v.x + v.y + v.z); }

}  // namespace

EchoPass::EchoPass(scene::GpuScene& scene, uint32_t max_bounces, bool monostatic, bool own_body)
    : scene_(&scene), max_bounces_(max_bounces) {
  gpu::ComputeDesc compute;
  const bool leaves = std::ranges::any_of(
      scene.scene().materials, [](const scene::Material& material) { return scene::is_lossless(material); });
  compute.specialization = {monostatic ? 1u : 0u, own_body ? 1u : 0u, leaves ? 1u : 0u};
  scene.prepare_tracing(compute, "radar/echoes.comp");
  for (const uint32_t slot : {shared::radar_directions_binding, shared::radar_hits_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::EchoConstants);
  pipeline_ = gpu::ComputePipeline(scene.device(), compute, "radar echoes");
}

EchoPass::Pending EchoPass::record(gpu::TickSlot& slot, const EchoRays& rays,
                                   std::span<const vec3> directions) {
  GREATX_CHECK(finite(rays.source) && finite(rays.receiver), "source ({}, {}, {}), receiver ({}, {}, {})",
               rays.source.x, rays.source.y, rays.source.z, rays.receiver.x, rays.receiver.y,
               rays.receiver.z);
  GREATX_CHECK(!directions.empty(), "no rays");
  const gpu::Device& device = scene_->device();
  const uint64_t most =
      device.limits().maxStorageBufferRange / std::max(sizeof(vec3), sizeof(uint32_t) * max_bounces_) - 1;
  if (directions.size() > most)
    throw_user_error("radar echoes: tubes: expected at most {} rays of {} bounces on '{}', found {}", most,
                     max_bounces_, device.info().name, directions.size());
  const auto body = [](uint32_t index) { return index == 0 ? ~0u : index; };
  const uint32_t count = static_cast<uint32_t>(directions.size());
  const shared::EchoConstants constants{vec3(rays.source), vec3(rays.receiver),    count,
                                        max_bounces_,      body(rays.source_body), body(rays.receiver_body)};
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope("radar echoes");
  const gpu::Slice upload = slot.upload.put(directions);
  // Each ray writes a few words once, directly into the memory that the host reads.
  const gpu::Slice hits = slot.readback.allocate_for<uint32_t>(size_t{count} * max_bounces_ + 1);
  cmd.bind(pipeline_);
  std::vector<gpu::Descriptor> descriptors = scene_->descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(shared::radar_directions_binding, upload));
  descriptors.push_back(gpu::Descriptor::buffer(shared::radar_hits_binding, hits));
  cmd.push(descriptors);
  cmd.constants(constants);
  cmd.dispatch_linear(count, shared::radar_group);
  return {hits, count};
}

std::span<const uint32_t> EchoPass::collect(const Pending& pending) const {
  return pending.hits.as<const uint32_t>().first(size_t{pending.rays} * max_bounces_);
}

bool EchoPass::direct(const Pending& pending) const {
  return pending.hits.as<const uint32_t>()[size_t{pending.rays} * max_bounces_] != 0;
}

}  // namespace greatx::rf
