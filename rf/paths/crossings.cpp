// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/crossings.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"

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

/// Returns one box for each body that has foliage. A box exceeds its foliage by far more than the rounding of
/// fp32, since a line must begin and end outside.
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

}  // namespace

/// Holds the order in which segments are traced: first the segments without a leader, in their order, and
/// then the others by leader, so that segments that need no tracing are adjacent.
struct CrossingPass::Rows {
  explicit Rows(std::span<const Segment> batch);
  std::vector<uint32_t> of;        ///< [segments]
  std::vector<uint32_t> segments;  ///< [rows]
  uint32_t first_hanging = 0;      ///< first row whose segment has a leader
  /// Returns the row of the leader of the segment in `row`.
  uint32_t leader_of(uint32_t row, std::span<const Segment> batch) const {
    return of[batch[segments[row]].only_if];
  }
};

CrossingPass::Rows::Rows(std::span<const Segment> batch) {
  of.assign(batch.size(), shared::rf_none);
  const auto leader = [&](uint32_t i) {
    const uint32_t on = batch[i].only_if;
    GREATX_CHECK(on < batch.size() && batch[on].only_if == shared::rf_none,
                 "segment {} hangs on segment {} of {}, which hangs on another", i, on, batch.size());
    return batch[on].same_as == shared::rf_none ? on : batch[on].same_as;
  };
  std::vector<uint32_t> hanging;
  for (uint32_t i = 0; i < batch.size(); ++i) {
    if (batch[i].same_as != shared::rf_none) continue;
    if (batch[i].only_if != shared::rf_none) {
      hanging.push_back(i);
      continue;
    }
    of[i] = static_cast<uint32_t>(segments.size());
    segments.push_back(i);
  }
  first_hanging = static_cast<uint32_t>(segments.size());
  std::vector<uint32_t> next(segments.size() + 1, 0);  // a counting sort by the leader's row
  for (const uint32_t i : hanging) ++next[of[leader(i)] + 1];
  for (size_t row = 1; row < next.size(); ++row) next[row] += next[row - 1];
  segments.resize(segments.size() + hanging.size());
  for (const uint32_t i : hanging) {
    of[i] = first_hanging + next[of[leader(i)]]++;
    segments[of[i]] = i;
  }
  for (uint32_t i = 0; i < batch.size(); ++i) {
    const uint32_t same = batch[i].same_as;
    if (same == shared::rf_none) continue;
    GREATX_CHECK(same < i && batch[same].same_as == shared::rf_none,
                 "segment {} is the same as segment {}, which is the same as another", i, same);
    of[i] = of[same];
  }
}

CrossingPass::CrossingPass(scene::GpuScene& scene, const FacetKinds& kinds, uint64_t part_bytes)
    : scene_(&scene),
      static_foliage_(scene.scene(), kinds),
      exact_(scene.scene(), kinds),
      part_bytes_(part_bytes) {
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
  planes_by_address_ = planes_.size() > std::min<uint64_t>(scene.options().most_table_bytes,
                                                           device.limits().maxStorageBufferRange);
  foliage_ = gpu::upload_buffer(device, std::as_bytes(std::span(boxes)), "foliage boxes");

  gpu::ComputeDesc compute;
  compute.specialization = {walls_ ? 1u : 0u, foliage_boxes_ > 0 ? 1u : 0u, planes_by_address_ ? 1u : 0u};
  scene.prepare_tracing(compute, "rf/crossings.comp");
  for (const uint32_t slot : {shared::crossings_segments_binding, shared::crossings_planes_binding,
                              shared::crossings_foliage_binding, shared::crossings_results_binding,
                              shared::crossings_leaders_binding})
    compute.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  compute.push_constant_bytes = sizeof(shared::CrossingConstants);
  pipeline_ = gpu::ComputePipeline(device, compute, "crossings");
}

/// Splits the rows into parts: first the segments without a leader, then the others. A part of the others
/// ends where the part of their leaders ends.
std::vector<CrossingPass::Part> CrossingPass::parts_of(const Rows& rows, std::span<const Segment> segments,
                                                       uint32_t row_words) const {
  const uint64_t bytes = std::min<uint64_t>(part_bytes_, scene_->device().limits().maxStorageBufferRange),
                 row_bytes = std::max<uint64_t>(sizeof(shared::GpuSegment), sizeof(uint32_t) * row_words);
  const auto most = static_cast<uint32_t>(std::clamp<uint64_t>(bytes / row_bytes, 1, ~0u));
  std::vector<Part> parts;
  for (uint32_t first = 0; first < rows.first_hanging; first += parts.back().count)
    parts.push_back({.first = first,
                     .count = std::min(most, rows.first_hanging - first),
                     .leaders = static_cast<uint32_t>(parts.size())});
  const auto count = static_cast<uint32_t>(rows.segments.size());
  for (uint32_t row = rows.first_hanging; row < count; ++row) {
    const uint32_t leaders = rows.leader_of(row, segments) / most;
    const bool hangs = parts.back().first >= rows.first_hanging;
    if (!hangs || parts.back().leaders != leaders || parts.back().count == most)
      parts.push_back({.first = row, .leaders = leaders});
    ++parts.back().count;
  }
  return parts;
}

void CrossingPass::upload(const Rows& rows, std::span<const Segment> segments, const std::vector<Part>& parts,
                          const Part& part) const {
  const std::span<shared::GpuSegment> input = part.segments.as<shared::GpuSegment>();
  for (uint32_t i = 0; i < part.count; ++i) {
    const uint32_t row = part.first + i;
    const Segment& segment = segments[rows.segments[row]];
    input[i] = gpu_segment(segment, rows.segments[row], static_foliage_);
    if (segment.only_if != shared::rf_none)
      input[i].only_if = rows.leader_of(row, segments) - parts[part.leaders].first;
  }
}

CrossingPass::Pending CrossingPass::record(gpu::TickSlot& slot, std::span<const Segment> segments) {
  if (segments.empty()) return {};
  if (segments.size() >= shared::rf_none)
    throw_user_error("a tick has {} segments of paths; expected fewer than {} (max_paths bounds them)",
                     segments.size(), shared::rf_none);
  Rows rows(segments);
  uint32_t most_walls = 0;
  for (const uint32_t index : rows.segments) most_walls = std::max(most_walls, segments[index].walls);
  const uint32_t row_words = 1 + (foliage_boxes_ > 0 ? 1 : 0) + (walls_ ? most_walls : 0);
  std::vector<Part> parts = parts_of(rows, segments, row_words);
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope("crossings");
  cmd.bind(pipeline_);
  for (Part& part : parts) {
    part.segments = slot.upload.allocate_for<shared::GpuSegment>(part.count);
    // The results are a few bytes per segment, each written once: they go straight into memory that the host
    // reads.
    part.results = slot.readback.allocate_for<uint32_t>(size_t{part.count} * row_words);
    upload(rows, segments, parts, part);
    if (part.first == rows.first_hanging) cmd.barrier(gpu::sync::compute_write, gpu::sync::compute_read);
    dispatch(cmd, part, parts[part.leaders], row_words);
  }
  return {std::move(parts), row_words, std::move(rows.of)};
}

void CrossingPass::dispatch(gpu::Cmd& cmd, const Part& part, const Part& leaders, uint32_t row_words) {
  std::vector<gpu::Descriptor> descriptors = scene_->descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(shared::crossings_segments_binding, part.segments));
  descriptors.push_back(
      gpu::Descriptor::buffer(shared::crossings_planes_binding, planes_by_address_ ? foliage_ : planes_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::crossings_foliage_binding, foliage_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::crossings_results_binding, part.results));
  descriptors.push_back(gpu::Descriptor::buffer(shared::crossings_leaders_binding, leaders.results));
  cmd.push(descriptors);
  cmd.constants(shared::CrossingConstants{part.count, row_words, foliage_boxes_, planes_.address()});
  cmd.dispatch_linear(part.count, shared::crossings_group);
}

std::vector<Crossing> CrossingPass::collect(const Pending& pending, std::span<const Segment> segments,
                                            const FacetWorld& world, uint64_t* settled) const {
  GREATX_CHECK(segments.size() == pending.row_of.size(), "{} segments were recorded, {} are collected",
               pending.row_of.size(), segments.size());
  std::vector<Crossing> crossings(segments.size());
  if (segments.empty()) return crossings;
  size_t at = 0;  // the part of the segment before, which mostly holds this segment, too
  for (size_t i = 0; i < crossings.size(); ++i) {
    const uint32_t number = pending.row_of[i];
    if (const Part& part = pending.parts[at]; number < part.first || number - part.first >= part.count)
      at = static_cast<size_t>(std::ranges::upper_bound(pending.parts, number, {}, &Part::first) -
                               pending.parts.begin()) -
           1;
    const Part& part = pending.parts[at];
    const uint32_t* row =
        part.results.as<const uint32_t>().data() + size_t{number - part.first} * pending.row_words;
    Crossing& crossing = crossings[i];
    const uint32_t status = *row++;
    crossing.blocked = status == shared::crossings_blocked;
    if (crossing.blocked) continue;
    crossing.foliage_open = (status & shared::crossings_foliage_open) != 0;
    crossing.undecided = (status & shared::crossings_undecided) != 0;
    if (foliage_boxes_ > 0)
      crossing.foliage_m =
          glm::distance(segments[i].a, segments[i].b) * (*row++ / double{shared::crossings_foliage_one});
    if (crossing.undecided) continue;
    crossing.walls.assign(row, row + (status & ~shared::crossings_foliage_open));
    std::sort(crossing.walls.begin(), crossing.walls.end());
  }
  const uint64_t count = settle(segments, world, crossings);
  if (settled != nullptr) *settled = count;
  return crossings;
}

/// Decides the segments that the GPU has left open. Segments that hang on one of them were traced; they are
/// blocked if it is.
uint64_t CrossingPass::settle(std::span<const Segment> segments, const FacetWorld& world,
                              std::vector<Crossing>& crossings) const {
  std::vector<size_t> open;
  for (size_t i = 0; i < crossings.size(); ++i)
    if (crossings[i].undecided) open.push_back(i);
  if (open.empty()) return 0;
  parallel_for(open.size(), 0,
               [&](size_t i) { exact_.settle(world, segments[open[i]], crossings[open[i]]); });
  for (size_t i = 0; i < crossings.size(); ++i) {
    const uint32_t leader = segments[i].only_if;
    if (leader != shared::rf_none && crossings[leader].blocked) crossings[i].blocked = true;
  }
  return open.size();
}

}  // namespace greatx::rf
