// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/moving_shadow.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/units.h"
#include "renderer/light/shadow_grid.h"
#include "renderer/light/shadow_raster.h"
#include "renderer/surface/pane_color.h"

namespace greatx::render {

namespace {

/// The atlas has at most so many texels along a side, and tiles at least so many.
constexpr uint32_t most_map_texels = 2048, least_tile_texels = 16;
/// Empty texels around each tile, so that filtering never reaches its neighbour.
constexpr double tile_rim_texels = 3.0;
/// A part whose outline around its joint's axis varies by less than this share of a texel is drawn as if it
/// had not turned: wheels would otherwise draw the tiles of vehicles anew at every tick.
constexpr double round_texels = 0.25;
constexpr int outline_directions = 64;

/// Returns by how much the outline of a part varies, seen along the axis of its joint: the largest less the
/// smallest distance from the axis to a line that touches its hull.
double outline_variation(const scene::Scene& scene, uint32_t body) {
  const scene::Joint& joint = *scene.bodies[body].joint;
  const dvec3 other = std::abs(joint.axis.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  const dvec3 x = glm::normalize(glm::cross(other, joint.axis)), y = glm::cross(joint.axis, x);
  std::vector<double> reach(outline_directions, -std::numeric_limits<double>::infinity());
  std::vector<dvec3> directions;
  for (int k = 0; k < outline_directions; ++k) {
    const double angle = 2.0 * pi * k / outline_directions;
    directions.push_back(x * std::cos(angle) + y * std::sin(angle));
  }
  const scene::Body& range = scene.bodies[body];
  for (uint32_t i = range.first_primitive; i < range.first_primitive + range.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    for (uint32_t k = 0; k < primitive.index_count; ++k) {
      const dvec3 p(scene.positions[scene.indices[primitive.first_index + k]]);
      for (int d = 0; d < outline_directions; ++d)
        reach[size_t(d)] = std::max(reach[size_t(d)], glm::dot(p, directions[size_t(d)]));
    }
  }
  const auto [least, most] = std::ranges::minmax_element(reach);
  return *most - *least;
}

bool same(std::span<const shared::GpuShadowPart> a, std::span<const shared::GpuShadowPart> b) {
  return std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

}  // namespace

MovingShadows::MovingShadows(const scene::GpuScene& scene, const SunFrame& frame,
                             const MovingShadowOptions& options)
    : scene_(&scene), frame_(frame), panes_(options.panes) {
  gpu::Device& device = scene.device();
  collect(options);
  uint32_t size = 1;
  if (!casters_.empty()) {
    tiles_across_ = static_cast<uint32_t>(std::ceil(std::sqrt(double(casters_.size()))));
    // If there are many bodies, each has a smaller tile.
    size = std::min(tiles_across_ * options.tile_texels,
                    std::max(most_map_texels, least_tile_texels * tiles_across_));
  }
  const double texels = double(size) / std::max(tiles_across_, 1u) - 2.0 * tile_rim_texels;
  bool any_opaque = false, any_masked = false, any_closed = false, any_pane = false;
  for (Caster& caster : casters_)
    for (Part& part : caster.parts) {
      any_opaque |= !part.opaque.empty();
      any_masked |= !part.masked.empty();
      any_closed |= !part.closed.empty();
      any_pane |= !part.panes.empty();
      part.round = scene.scene().bodies[part.body].joint && part.masked.empty() &&
                   outline_variation(scene.scene(), part.body) < round_texels * 2.0 * caster.radius / texels;
    }
  map_ = shadow_map(device, size, "moving shadow map");
  gpu::GraphicsDesc desc;
  desc.vertex_shader = "camera/moving_shadow.vert";
  desc.push_constant_bytes = sizeof(shared::GpuShadowPart);
  if (any_opaque) opaque_ = shadow_pipeline(scene, desc, false, "moving shadow");
  if (any_masked) masked_ = shadow_pipeline(scene, desc, true, "moving shadow");
  if (any_pane) {
    gpu::GraphicsDesc panes = desc;
    panes.vertex_shader = "camera/pane_moving_shadow.vert";
    pane_pipeline_ = pane_shadow_pipeline(scene, panes, "moving shadow");
  }
  // In the sun's frame y points up, and in clip space down: what faces the sun winds clockwise.
  desc.cull = VK_CULL_MODE_FRONT_BIT;
  if (any_closed) closed_ = shadow_pipeline(scene, desc, false, "moving shadow of closed bodies");
  gpu::submit_setup(device, [&](gpu::Cmd& cmd) {
    cmd.transition(map_, gpu::ImageUse::depth_target, true);
    cmd.begin_rendering({.color = {}, .depth = &map_, .clear_depth = 0.0f, .width = size, .height = size});
    cmd.end_rendering();
    cmd.transition(map_, gpu::ImageUse::sampled);
  });
  shared::GpuShadowPart unknown;
  std::memset(&unknown, 0xff, sizeof unknown);
  drawn_.assign(part_count_, unknown);
  const std::vector<uint32_t> empty_grid = shadow_grid({});
  no_tiles_ = gpu::upload_buffer(device, std::as_bytes(std::span(empty_grid)), "no shadow tiles");
  tiles_ = no_tiles_.slice();
}

MovingShadows::Part MovingShadows::part_of(uint32_t body, const MovingShadowOptions& options,
                                           const std::vector<bool>& is_pane) const {
  const scene::Scene& scene = scene_->scene();
  Part part;
  part.body = body;
  const scene::Body& range = scene.bodies[body];
  for (uint32_t i = range.first_primitive; i < range.first_primitive + range.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    const Range next{primitive.first_index, primitive.index_count, i};
    if (is_pane[primitive.material]) {
      part.panes.push_back(next);
    } else if (options.alpha_mask && scene.has_holes(i)) {
      part.masked.push_back(next);
    } else if (!part.opaque.empty() &&
               part.opaque.back().first_index + part.opaque.back().index_count == next.first_index) {
      part.opaque.back().index_count += next.index_count;  // one draw serves primitives in a row
    } else {
      part.opaque.push_back(next);
    }
  }
  // Through panes the sun sees the inside of a body, too.
  if (part.panes.empty() && body < options.closed.size() && options.closed[body])
    part.closed.swap(part.opaque);
  return part;
}

void MovingShadows::collect(const MovingShadowOptions& options) {
  const scene::Scene& scene = scene_->scene();
  const std::vector<bool> is_pane = pane_materials(scene, options.panes != nullptr);
  std::vector<uint32_t> caster_of(scene.bodies.size(), ~0u);
  for (uint32_t b = 1; options.casters && b < scene.bodies.size(); ++b) {
    const uint32_t owner = scene.owner_of(b);
    if (owner == b && !scene.reach_of(b).empty()) {
      caster_of[b] = static_cast<uint32_t>(casters_.size());
      Caster caster;
      caster.body = b;
      caster.center = scene.reach_of(b).center();
      caster.radius = std::max(0.5 * glm::length(scene.reach_of(b).size()), 1e-3);
      casters_.push_back(std::move(caster));
    }
    if (caster_of[owner] != ~0u) casters_[caster_of[owner]].parts.push_back(part_of(b, options, is_pane));
  }
  for (Caster& caster : casters_) {
    caster.first_part = part_count_;
    part_count_ += static_cast<uint32_t>(caster.parts.size());
  }
}

shared::GpuShadowTile MovingShadows::tile_of(uint32_t i, std::span<const Pose> body_poses) const {
  const Caster& caster = casters_[i];
  const double tile_uv = 1.0 / tiles_across_, texel_uv = 1.0 / map_.desc().width;
  shared::GpuShadowTile tile;
  tile.center = vec3(frame_.from_local(body_poses[caster.body].apply(caster.center)));
  tile.radius = float(caster.radius);
  tile.uv_center = vec2((i % tiles_across_ + 0.5) * tile_uv, (i / tiles_across_ + 0.5) * tile_uv);
  tile.uv_radius = float(0.5 * tile_uv - tile_rim_texels * texel_uv);
  tile.texel_m = float(caster.radius * texel_uv / tile.uv_radius);
  return tile;
}

shared::GpuShadowPart MovingShadows::rows_of(const Caster& caster, const Part& part,
                                             const shared::GpuShadowTile& tile,
                                             std::span<const Pose> body_poses) const {
  const Pose& owner = body_poses[caster.body];
  Pose pose = body_poses[part.body];
  if (part.round) {
    const scene::Joint& joint = *scene_->scene().bodies[part.body].joint;
    pose = {owner.apply(joint.position), owner.orientation};
  }
  // Positions are taken relative to the caster's centre, so that the rows do not depend on where it is.
  const dvec3 from_center = (pose.position - owner.position) - owner.rotate(caster.center);
  const dmat3 turn = glm::mat3_cast(pose.orientation);
  const auto row = [&](const dvec3& axis, double scale, double offset) {
    scale /= caster.radius;
    return vec4(dvec4(scale * (axis * turn), scale * glm::dot(axis, from_center) + offset));
  };
  const double scale = 2.0 * double(tile.uv_radius);
  return {row(frame_.x, scale, 2.0 * double(tile.uv_center.x) - 1.0),
          row(frame_.y, scale, 2.0 * double(tile.uv_center.y) - 1.0), row(frame_.z, 0.5, 0.5)};
}

void MovingShadows::record(gpu::TickSlot& slot, std::span<const Pose> body_poses) {
  if (casters_.empty()) return;
  std::vector<shared::GpuShadowTile> tiles;
  tiles.reserve(casters_.size());
  wanted_.clear();
  centers_.clear();
  const scene::Bounds& bounds = scene_->scene().bounds;
  lowest_ = bounds.empty() ? std::numeric_limits<double>::infinity() : bounds.min.z;
  for (uint32_t i = 0; i < casters_.size(); ++i) {
    const Caster& caster = casters_[i];
    tiles.push_back(tile_of(i, body_poses));
    for (const Part& part : caster.parts) wanted_.push_back(rows_of(caster, part, tiles.back(), body_poses));
    centers_.push_back(body_poses[caster.body].apply(caster.center));
    lowest_ = std::min(lowest_, centers_.back().z - caster.radius);
  }
  tiles_ = slot.upload.put(std::span<const uint32_t>(shadow_grid(tiles)));
}

/// Returns the casters whose tiles must be drawn for a picture.
std::vector<uint32_t> MovingShadows::stale(const Outside& outside) const {
  std::vector<uint32_t> all;
  for (uint32_t i = 0; i < casters_.size(); ++i) {
    const Caster& caster = casters_[i];
    if (same(rows(wanted_, caster), rows(drawn_, caster))) continue;
    // The shadow lies in the ball around the caster, swept away from the sun.
    const double length = (centers_[i].z + caster.radius - lowest_) / std::max(frame_.z.z, 1e-6);
    if (!outside(centers_[i], centers_[i] - frame_.z * length, caster.radius)) all.push_back(i);
  }
  return all;
}

void MovingShadows::draw(gpu::TickSlot& slot, const Outside& outside) {
  const std::vector<uint32_t> casters = stale(outside);
  if (casters.empty()) return;
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope("moving shadow");
  cmd.transition(map_, gpu::ImageUse::depth_target);
  const uint32_t size = map_size();
  cmd.begin_rendering({.color = {}, .depth = &map_, .keep_depth = true, .width = size, .height = size});
  std::vector<VkRect2D> areas;
  for (const uint32_t i : casters) {
    const auto begin = [&](uint32_t tile) { return size_t{tile} * size / tiles_across_; };
    const uint32_t column = i % tiles_across_, row = i / tiles_across_;
    areas.push_back({{int32_t(begin(column)), int32_t(begin(row))},
                     {uint32_t(begin(column + 1) - begin(column)), uint32_t(begin(row + 1) - begin(row))}});
  }
  cmd.clear_depth(areas, 0.0f);
  const auto draw_all = [&](const gpu::GraphicsPipeline& with, std::vector<Range> Part::*ranges) {
    if (!with) return;
    cmd.bind(with);
    std::vector<gpu::Descriptor> descriptors = scene_->raster_descriptors();
    if (&with == &pane_pipeline_)
      descriptors.push_back(gpu::Descriptor::buffer(shared::material_records_binding, *panes_));
    cmd.push(descriptors);
    cmd.bind_indices(scene_->indices());
    for (const uint32_t i : casters)
      for (uint32_t k = 0; k < casters_[i].parts.size(); ++k) {
        const Part& part = casters_[i].parts[k];
        if ((part.*ranges).empty()) continue;
        cmd.constants(wanted_[casters_[i].first_part + k]);
        for (const Range& range : part.*ranges)
          cmd.draw_indexed(range.first_index, range.index_count, range.primitive);
      }
  };
  draw_all(opaque_, &Part::opaque);
  draw_all(closed_, &Part::closed);
  draw_all(masked_, &Part::masked);
  draw_all(pane_pipeline_, &Part::panes);
  cmd.end_rendering();
  cmd.transition(map_, gpu::ImageUse::sampled);
  drawn_tiles_ += casters.size();
  for (const uint32_t i : casters) {
    const auto from = wanted_.begin() + casters_[i].first_part;
    const auto to = drawn_.begin() + casters_[i].first_part;
    std::copy_n(from, casters_[i].parts.size(), to);
    // If the GPU may leave these draws out, nobody here knows what the tile holds.
    if (cmd.conditional()) std::memset(static_cast<void*>(&*to), 0xff, sizeof *to);
  }
}

}  // namespace greatx::render
