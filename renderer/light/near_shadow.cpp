// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/near_shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/light/shadow_raster.h"
#include "renderer/surface/pane_color.h"

namespace greatx::render {

namespace {

constexpr uint32_t block_triangles = 64;
constexpr double ground_cell_m = 64.0;
constexpr uint32_t most_ground_cells = 512;
/// Filters reach so many texels beyond a point, and the point is moved off its surface by two.
constexpr double near_rim_texels = 4.0;

size_t slot_of(int64_t x, int64_t y) {
  constexpr int64_t n = near_pages;
  return static_cast<size_t>(((y % n + n) % n) * n + (x % n + n) % n);
}

}  // namespace

std::vector<double> cascade_texels(double static_texel_m) {
  const double finest = std::min(near_texel_m, std::exp2(std::floor(std::log2(0.5 * static_texel_m))));
  const double ratio = static_texel_m / finest;
  if (ratio < 4.0) return {finest};
  return {finest, finest * std::exp2(std::floor(0.5 * std::log2(ratio)))};
}

NearShadows::NearShadows(const ShadowMaps& base) : base_(&base), scene_(&base.scene()) {
  find_casters();
  find_ground();
  if (!opaque_.empty()) opaque_pipeline_ = caster_pipeline(*scene_, false, false, "shadow cascade");
  if (!masked_.empty()) masked_pipeline_ = caster_pipeline(*scene_, false, true, "shadow cascade");
  if (!panes_.empty()) pane_pipeline_ = pane_caster_pipeline(*scene_, "shadow cascade");
  sampler_ = shadow_sampler(scene_->device(), "shadow cascade", true);
  for (const double texel_m : cascade_texels(base.static_texel_m())) {
    Level level;
    level.texel_m = texel_m;
    level.map = shadow_map(scene_->device(), near_map_texels, "shadow cascade");
    levels_.push_back(std::move(level));
  }
  gpu::submit_setup(scene_->device(), [&](gpu::Cmd& cmd) {
    for (Level& level : levels_) {
      cmd.transition(level.map, gpu::ImageUse::depth_target, true);
      cmd.begin_rendering({.color = {},
                           .depth = &level.map,
                           .clear_depth = 0.0f,
                           .width = near_map_texels,
                           .height = near_map_texels});
      cmd.end_rendering();
      cmd.transition(level.map, gpu::ImageUse::sampled);
    }
  });
}

void NearShadows::find_casters() {
  const scene::Scene& scene = scene_->scene();
  const SunFrame& frame = base_->frame();
  const std::vector<bool> is_pane = pane_materials(scene, base_->panes() != nullptr);
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    std::vector<Block>& blocks = is_pane[primitive.material]                 ? panes_
                                 : base_->alpha_mask() && scene.has_holes(i) ? masked_
                                                                             : opaque_;
    for (uint32_t first = 0; first < primitive.index_count; first += 3 * block_triangles) {
      Block block{i, primitive.first_index + first,
                  std::min(3 * block_triangles, primitive.index_count - first)};
      block.least = dvec2(std::numeric_limits<double>::infinity());
      block.most = -block.least;
      for (uint32_t k = 0; k < block.index_count; ++k) {
        const dvec2 at(frame.from_local(dvec3(scene.positions[scene.indices[block.first_index + k]])));
        block.least = glm::min(block.least, at);
        block.most = glm::max(block.most, at);
      }
      blocks.push_back(block);
    }
  }
}

void NearShadows::find_ground() {
  const scene::Scene& scene = scene_->scene();
  const dvec3 size = scene.bounds.size();
  const auto cells = [](double along) {
    return static_cast<uint32_t>(
        std::clamp(std::ceil(along / ground_cell_m), 1.0, double(most_ground_cells)));
  };
  columns_ = cells(size.x);
  rows_ = cells(size.y);
  constexpr double nothing = std::numeric_limits<double>::infinity();
  ground_.assign(size_t{columns_} * rows_, nothing);
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    for (uint32_t k = 0; k < primitive.index_count; ++k) {
      const dvec3 p(scene.positions[scene.indices[primitive.first_index + k]]);
      const dvec2 at = glm::floor((dvec2(p) - dvec2(scene.bounds.min)) / ground_cell_m);
      const auto column = static_cast<uint32_t>(std::clamp(at.x, 0.0, columns_ - 1.0));
      const auto row = static_cast<uint32_t>(std::clamp(at.y, 0.0, rows_ - 1.0));
      double& low = ground_[size_t{row} * columns_ + column];
      low = std::min(low, p.z);
    }
  }
  for (double& low : ground_)  // a large triangle may span cells without a vertex
    if (low == nothing) low = scene.bounds.min.z;
}

/// Returns the height of the ground, interpolated between cells so that it does not jump.
double NearShadows::ground_below(const dvec2& at) const {
  const scene::Bounds& bounds = scene_->scene().bounds;
  const dvec2 most(columns_ - 1.0, rows_ - 1.0);
  const dvec2 place = glm::clamp((at - dvec2(bounds.min)) / ground_cell_m - 0.5, dvec2(0.0), most);
  const dvec2 cell = glm::floor(place), next = glm::min(cell + 1.0, most), part = place - cell;
  const auto height = [&](double x, double y) {
    return ground_[static_cast<size_t>(y) * columns_ + static_cast<size_t>(x)];
  };
  return std::lerp(std::lerp(height(cell.x, cell.y), height(next.x, cell.y), part.x),
                   std::lerp(height(cell.x, next.y), height(next.x, next.y), part.x), part.y);
}

dvec2 NearShadows::center_of(const dvec3& eye) const {
  const double ground = scene_->scene().bounds.empty() ? eye.z : std::min(eye.z, ground_below(dvec2(eye)));
  return dvec2(base_->frame().from_local({eye.x, eye.y, ground}));
}

double NearShadows::reach_m(uint32_t cascade) const {
  // The square of pages is centred to half a page.
  return levels_[cascade].texel_m * (0.5 * near_map_texels - 0.5 * near_page_texels - near_rim_texels);
}

/// Returns the slots of the pages that the square around a place lacks, and notes which pages they shall be.
std::vector<uint32_t> NearShadows::claim_missing(Level& level, const dvec2& center) {
  std::vector<uint32_t> slots;
  const dvec2 first = glm::round(center / (level.texel_m * near_page_texels)) - 0.5 * near_pages;
  for (uint32_t j = 0; j < near_pages; ++j)
    for (uint32_t i = 0; i < near_pages; ++i) {
      const int64_t x = static_cast<int64_t>(first.x) + i, y = static_cast<int64_t>(first.y) + j;
      const auto slot = static_cast<uint32_t>(slot_of(x, y));
      Page& page = level.pages[slot];
      if (page.known && page.x == x && page.y == y) continue;
      slots.push_back(slot);
      page = {x, y, true};
    }
  return slots;
}

void NearShadows::draw_blocks(gpu::Cmd& cmd, const Level& level, const Page& page,
                              const std::vector<Block>& blocks) const {
  const double page_m = level.texel_m * near_page_texels;
  const dvec2 least = dvec2(page.x, page.y) * page_m, most = least + page_m;
  const auto touches = [&](const Block& block) {
    return block.least.x <= most.x && block.least.y <= most.y && block.most.x >= least.x &&
           block.most.y >= least.y;
  };
  for (size_t i = 0; i < blocks.size(); ++i) {
    if (!touches(blocks[i])) continue;
    Block run = blocks[i];  // one draw serves blocks in a row
    while (i + 1 < blocks.size() && blocks[i + 1].primitive == run.primitive && touches(blocks[i + 1]))
      run.index_count += blocks[++i].index_count;
    cmd.draw_indexed(run.first_index, run.index_count, run.primitive);
  }
}

void NearShadows::draw(gpu::Cmd& cmd, Level& level, const std::vector<uint32_t>& slots) {
  const auto scope = cmd.scope("shadow cascade");
  cmd.transition(level.map, gpu::ImageUse::depth_target);
  cmd.begin_rendering({.color = {},
                       .depth = &level.map,
                       .keep_depth = true,
                       .width = near_map_texels,
                       .height = near_map_texels});
  const auto corner = [](uint32_t slot) {
    return uvec2(slot % near_pages, slot / near_pages) * near_page_texels;
  };
  std::vector<VkRect2D> areas;
  for (const uint32_t slot : slots)
    areas.push_back(
        {{int32_t(corner(slot).x), int32_t(corner(slot).y)}, {near_page_texels, near_page_texels}});
  cmd.clear_depth(areas, 0.0f);
  const SunFrame& frame = base_->frame();
  const double page_m = level.texel_m * near_page_texels;
  const auto row = [](const dvec3& axis, double scale, double offset) {
    return vec4(dvec4(axis * scale, offset));
  };
  const auto draw_all = [&](const gpu::GraphicsPipeline& with, const std::vector<Block>& blocks) {
    if (blocks.empty()) return;
    cmd.bind(with);
    cmd.push(static_caster_descriptors(*scene_, &with == &pane_pipeline_ ? base_->panes() : nullptr));
    cmd.bind_indices(scene_->indices());
    for (const uint32_t slot : slots) {
      const Page& page = level.pages[slot];
      cmd.viewport(corner(slot).x, corner(slot).y, near_page_texels);
      cmd.constants(shared::CasterConstants{{row(frame.x, 2.0 / page_m, -2.0 * double(page.x) - 1.0),
                                             row(frame.y, 2.0 / page_m, -2.0 * double(page.y) - 1.0),
                                             row(frame.z, base_->depth_scale(), base_->depth_offset()),
                                             vec4(0.0f, 0.0f, 0.0f, 1.0f)}});
      draw_blocks(cmd, level, page, blocks);
    }
  };
  draw_all(opaque_pipeline_, opaque_);
  draw_all(masked_pipeline_, masked_);
  draw_all(pane_pipeline_, panes_);
  cmd.end_rendering();
  cmd.transition(level.map, gpu::ImageUse::sampled);
  drawn_pages_ += slots.size();
  // If the GPU may leave these draws out, nobody here knows what the pages hold.
  if (cmd.conditional())
    for (const uint32_t slot : slots) level.pages[slot].known = false;
}

void NearShadows::record(gpu::TickSlot& slot, const dvec3& eye) {
  const dvec2 center = center_of(eye);
  shared::GpuNearShadows block{};
  block.center = vec2(center);
  for (uint32_t i = 0; i < cascades(); ++i) {
    Level& level = levels_[i];
    const std::vector<uint32_t> slots = claim_missing(level, center);
    if (!slots.empty()) draw(*slot.cmd, level, slots);
    // It fades into the next coarser map over half a page.
    block.reach[i] = float(reach_m(i));
    block.fade[i] = float(2.0 / (level.texel_m * near_page_texels));
    block.texel_m[i] = float(level.texel_m);
    block.uv_scale[i] = float(1.0 / (level.texel_m * near_map_texels));
  }
  block_ = slot.upload.put(std::span<const shared::GpuNearShadows>(&block, 1));
}

std::vector<gpu::Binding> NearShadows::bindings() {
  return {{shared::near_shadows_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
          {shared::fine_shadow_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
          {shared::middle_shadow_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}};
}

std::vector<gpu::Descriptor> NearShadows::descriptors() const {
  return {gpu::Descriptor::buffer(shared::near_shadows_binding, block_),
          gpu::Descriptor::sampled(shared::fine_shadow_binding, levels_.front().map, sampler_),
          gpu::Descriptor::sampled(shared::middle_shadow_binding, levels_.back().map, sampler_)};
}

std::vector<gpu::Descriptor> NearShadows::no_descriptors(const ShadowMaps& base) {
  return {gpu::Descriptor::buffer(shared::near_shadows_binding, base.moving().tiles()),
          gpu::Descriptor::sampled(shared::fine_shadow_binding, base.static_map(), base.sampler()),
          gpu::Descriptor::sampled(shared::middle_shadow_binding, base.static_map(), base.sampler())};
}

}  // namespace greatx::render
