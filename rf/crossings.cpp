// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/crossings.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace greatx::rf {

namespace {

static_assert(static_cast<uint32_t>(FacetKind::wall) == shared::facet_kind_wall);
static_assert(static_cast<uint32_t>(FacetKind::foliage) == shared::facet_kind_foliage);
static_assert(static_cast<uint32_t>(FacetKind::absent) == shared::facet_kind_absent);

shared::GpuFacetPlane plane_of(const scene::Scene& scene, const scene::Facet& facet, FacetKind kind) {
  GREATX_CHECK(facet.triangle_count > 0, "facet of instance {} without triangles", facet.instance);
  const dvec3 corner = scene.facet_triangles[facet.first_triangle].corners[0];
  const dvec3 foot = corner - (glm::dot(facet.normal, corner) - facet.offset) * facet.normal;
  return {vec3(facet.normal), vec3(foot), static_cast<uint32_t>(kind), facet.body};
}

/// One box for each body that has foliage. Wider than its foliage by far more than fp32 rounds, since a line is to begin
/// and end outside.
std::vector<shared::GpuFoliageBox> foliage_boxes(const scene::Scene& scene, const FacetKinds& kinds) {
  std::vector<scene::Bounds> bounds(scene.bodies.size());
  for (size_t i = 0; i < scene.facets.size(); ++i) {
    const scene::Facet& facet = scene.facets[i];
    if (kinds[i] != FacetKind::foliage) continue;
    for (uint32_t t = 0; t < facet.triangle_count; ++t)
      for (const dvec3& corner : scene.facet_triangles[facet.first_triangle + t].corners)
        bounds[facet.body].add(corner);
  }
  std::vector<shared::GpuFoliageBox> boxes;
  for (uint32_t body = 0; body < bounds.size(); ++body) {
    if (bounds[body].empty()) continue;
    const dvec3 magnitude = glm::max(glm::abs(bounds[body].min), glm::abs(bounds[body].max));
    const dvec3 room(0.1 + 1e-5 * std::max({magnitude.x, magnitude.y, magnitude.z}));
    boxes.push_back(
        {vec3(bounds[body].min - room), vec3(bounds[body].max + room), body, scene.owner_of(body)});
  }
  return boxes;
}

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

shared::GpuSegment gpu_segment(const Segment& s, size_t index, const FoliageVolumes& foliage) {
  GREATX_CHECK(finite(s.a) && finite(s.b), "segment {} from ({}, {}, {}) to ({}, {}, {})", index, s.a.x,
               s.a.y, s.a.z, s.b.x, s.b.y, s.b.z);
  GREATX_CHECK(s.walls <= shared::crossings_max, "segment {} may pass {} walls, expected at most {}", index,
               s.walls, shared::crossings_max);
  const bool inside = foliage.may_contain(s.a) || foliage.may_contain(s.b);
  return {vec3(s.a),      vec3(s.b), s.facet_a,
          s.facet_b,      s.body_a,  s.body_b,
          s.other_a,      s.other_b, s.walls | (inside ? shared::crossings_end_in_foliage : 0),
          shared::rf_none};
}

/// In which order segments are traced: first those that hang on none, in their order, then the others by the one that they
/// hang on, so that what is not looked at lies together.
struct Rows {
  std::vector<uint32_t> of;        ///< [segments]
  std::vector<uint32_t> segments;  ///< [rows]
  uint32_t first_hanging = 0;
};

Rows rows_of(std::span<const Segment> segments) {
  Rows rows;
  rows.of.assign(segments.size(), shared::rf_none);
  const auto leader = [&](uint32_t i) {
    const uint32_t of = segments[i].only_if;
    GREATX_CHECK(of < segments.size() && segments[of].only_if == shared::rf_none,
                 "segment {} hangs on segment {} of {}, which hangs on another", i, of, segments.size());
    return segments[of].same_as == shared::rf_none ? of : segments[of].same_as;
  };
  std::vector<uint32_t> hanging;
  for (uint32_t i = 0; i < segments.size(); ++i) {
    if (segments[i].same_as != shared::rf_none) continue;
    if (segments[i].only_if != shared::rf_none) {
      hanging.push_back(i);
      continue;
    }
    rows.of[i] = static_cast<uint32_t>(rows.segments.size());
    rows.segments.push_back(i);
  }
  rows.first_hanging = static_cast<uint32_t>(rows.segments.size());
  std::vector<uint32_t> next(rows.segments.size() + 1, 0);  // a counting sort by the leader's row
  for (const uint32_t i : hanging) ++next[rows.of[leader(i)] + 1];
  for (size_t row = 1; row < next.size(); ++row) next[row] += next[row - 1];
  rows.segments.resize(rows.segments.size() + hanging.size());
  for (const uint32_t i : hanging) {
    rows.of[i] = rows.first_hanging + next[rows.of[leader(i)]]++;
    rows.segments[rows.of[i]] = i;
  }
  for (uint32_t i = 0; i < segments.size(); ++i) {
    const uint32_t same = segments[i].same_as;
    if (same == shared::rf_none) continue;
    GREATX_CHECK(same < i && segments[same].same_as == shared::rf_none,
                 "segment {} is the same as segment {}, which is the same as another", i, same);
    rows.of[i] = rows.of[same];
  }
  return rows;
}

}  // namespace

CrossingPass::CrossingPass(scene::GpuScene& scene, const FacetKinds& kinds)
    : scene_(&scene), static_foliage_(scene.scene(), kinds) {
  const std::vector<scene::Facet>& facets = scene.scene().facets;
  GREATX_CHECK(kinds.size() == facets.size(), "kinds of {} facets, the scene has {}", kinds.size(),
               facets.size());
  std::vector<shared::GpuFacetPlane> planes;
  for (size_t i = 0; i < facets.size(); ++i) planes.push_back(plane_of(scene.scene(), facets[i], kinds[i]));
  const std::vector<shared::GpuFoliageBox> boxes = foliage_boxes(scene.scene(), kinds);
  foliage_boxes_ = static_cast<uint32_t>(boxes.size());
  walls_ = std::find(kinds.begin(), kinds.end(), FacetKind::wall) != kinds.end();
  gpu::Device& device = scene.device();
  planes_ = gpu::upload_buffer(device, std::as_bytes(std::span(planes)), "facet planes");
  foliage_ = gpu::upload_buffer(device, std::as_bytes(std::span(boxes)), "foliage boxes");

  gpu::ComputeDesc compute;
  compute.shader = "rf/crossings.comp";
  compute.bindings = scene::GpuScene::bindings(true);
  for (const uint32_t slot : {shared::crossings_segments_binding, shared::crossings_planes_binding,
                              shared::crossings_foliage_binding, shared::crossings_results_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::CrossingConstants);
  compute.specialization = {walls_ ? 1u : 0u, foliage_boxes_ > 0 ? 1u : 0u};
  pipeline_ = gpu::ComputePipeline(device, compute, "crossings");
}

CrossingPass::Pending CrossingPass::record(gpu::TickSlot& slot, std::span<const Segment> segments) {
  if (segments.empty()) return {};
  Rows rows = rows_of(segments);
  const gpu::Slice upload = slot.upload.allocate_for<shared::GpuSegment>(rows.segments.size());
  const std::span<shared::GpuSegment> input = upload.as<shared::GpuSegment>();
  uint32_t most_walls = 0;
  for (size_t row = 0; row < rows.segments.size(); ++row) {
    const Segment& segment = segments[rows.segments[row]];
    input[row] = gpu_segment(segment, rows.segments[row], static_foliage_);
    if (segment.only_if != shared::rf_none) input[row].only_if = rows.of[segment.only_if];
    most_walls = std::max(most_walls, segment.walls);
  }

  const uint32_t count = static_cast<uint32_t>(rows.segments.size());
  const uint32_t row_words = 1 + (foliage_boxes_ > 0 ? 1 : 0) + (walls_ ? most_walls : 0);
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope("crossings");
  // A few bytes a segment, each written once: straight into the memory that the host reads.
  const gpu::Slice results = slot.readback.allocate_for<uint32_t>(size_t{count} * row_words);
  cmd.bind(pipeline_);
  std::vector<gpu::Descriptor> descriptors = scene_->descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(shared::crossings_segments_binding, upload));
  descriptors.push_back(gpu::Descriptor::buffer(shared::crossings_planes_binding, planes_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::crossings_foliage_binding, foliage_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::crossings_results_binding, results));
  cmd.push(descriptors);
  dispatch(cmd, 0, rows.first_hanging, row_words);
  if (count > rows.first_hanging) {
    cmd.barrier(gpu::sync::compute_write, gpu::sync::compute_read);
    dispatch(cmd, rows.first_hanging, count - rows.first_hanging, row_words);
  }
  return {results, row_words, std::move(rows.of)};
}

void CrossingPass::dispatch(gpu::Cmd& cmd, uint32_t first, uint32_t count, uint32_t row_words) {
  cmd.constants(shared::CrossingConstants{first, count, row_words, foliage_boxes_});
  cmd.dispatch((count + shared::crossings_group - 1) / shared::crossings_group);
}

std::vector<Crossing> CrossingPass::collect(const Pending& pending, std::span<const Segment> segments) const {
  GREATX_CHECK(segments.size() == pending.row_of.size(), "{} segments were recorded, {} are collected",
               pending.row_of.size(), segments.size());
  std::vector<Crossing> crossings(segments.size());
  if (segments.empty()) return crossings;
  const std::span<const uint32_t> results = pending.results.as<const uint32_t>();
  for (size_t i = 0; i < crossings.size(); ++i) {
    const uint32_t* row = results.data() + size_t{pending.row_of[i]} * pending.row_words;
    Crossing& crossing = crossings[i];
    const uint32_t status = *row++;
    crossing.blocked = status == shared::crossings_blocked;
    if (crossing.blocked) continue;
    crossing.foliage_open = (status & shared::crossings_foliage_open) != 0;
    if (foliage_boxes_ > 0)
      crossing.foliage_m =
          glm::distance(segments[i].a, segments[i].b) * (*row++ / double{shared::crossings_foliage_one});
    crossing.walls.assign(row, row + (status & ~shared::crossings_foliage_open));
    std::sort(crossing.walls.begin(), crossing.walls.end());
  }
  return crossings;
}

}  // namespace greatx::rf
