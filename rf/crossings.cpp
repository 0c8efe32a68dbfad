// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/visibility.h"

#include <cmath>

#include "core/error.h"

namespace greatx::rf {

namespace {

shared::GpuFacetPlane plane_of(const scene::Scene& scene, const scene::Facet& facet) {
  GREATX_CHECK(facet.triangle_count > 0, "facet of instance {} without triangles", facet.instance);
  const dvec3 corner = scene.facet_triangles[facet.first_triangle].corners[0];
  const dvec3 foot = corner - (glm::dot(facet.normal, corner) - facet.offset) * facet.normal;
  return {vec3(facet.normal), vec3(foot)};
}

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

VisibilityPass::VisibilityPass(scene::GpuScene& scene) : scene_(&scene) {
  std::vector<shared::GpuFacetPlane> planes;
  for (const scene::Facet& facet : scene.scene().facets) planes.push_back(plane_of(scene.scene(), facet));
  gpu::Device& device = scene.device();
  planes_ = gpu::upload_buffer(device, std::as_bytes(std::span(planes)), "facet planes");

  gpu::ComputeDesc compute;
  compute.shader = "rf/visibility.comp";
  compute.bindings = scene::GpuScene::bindings(true);
  for (const uint32_t slot : {shared::visibility_segments_binding, shared::visibility_planes_binding,
                              shared::visibility_results_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::VisibilityConstants);
  pipeline_ = gpu::ComputePipeline(device, compute, "visibility");
}

VisibilityPass::Pending VisibilityPass::record(gpu::TickSlot& slot, std::span<const Segment> segments) {
  if (segments.empty()) return {};
  const gpu::Slice upload = slot.upload.allocate_for<shared::GpuSegment>(segments.size());
  const std::span<shared::GpuSegment> rows = upload.as<shared::GpuSegment>();
  for (size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    GREATX_CHECK(finite(s.a) && finite(s.b), "segment {} from ({}, {}, {}) to ({}, {}, {})", i, s.a.x, s.a.y,
                 s.a.z, s.b.x, s.b.y, s.b.z);
    rows[i] = {vec3(s.a), vec3(s.b), s.facet_a, s.facet_b, s.body_a, s.body_b};
  }

  const uint32_t count = static_cast<uint32_t>(segments.size());
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope("visibility");
  // A few bytes a segment, each written once: straight into the memory that the host reads.
  const gpu::Slice results = slot.readback.allocate_for<uint32_t>(count);
  cmd.bind(pipeline_);
  std::vector<gpu::Descriptor> descriptors = scene_->descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(shared::visibility_segments_binding, upload));
  descriptors.push_back(gpu::Descriptor::buffer(shared::visibility_planes_binding, planes_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::visibility_results_binding, results));
  cmd.push(descriptors);
  cmd.constants(shared::VisibilityConstants{count});
  cmd.dispatch((count + shared::visibility_group - 1) / shared::visibility_group);
  return {results, count};
}

std::vector<uint8_t> VisibilityPass::collect(const Pending& pending) const {
  if (pending.count == 0) return {};
  const std::span<const uint32_t> results = pending.results.as<const uint32_t>().first(pending.count);
  return {results.begin(), results.end()};
}

}  // namespace greatx::rf
