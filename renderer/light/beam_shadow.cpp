// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/beam_shadow.h"

#include <algorithm>
#include <cmath>

#include "renderer/light/lamp_shadow.h"
#include "shaders/shared/beam.h"

namespace greatx::render {

namespace {

using Light = scene::PunctualLight;

/// The road that a lamp lights well enough for its shadows to matter is a ball that begins at the lamp and is
/// at most so long, m.
constexpr double lit_length_m = 30.0;

bool has_beam(const Light& light) {
  return light.body != 0 && light.type == Light::Type::spot && light.intensity > 0.0f &&
         lamp_reach(light) > double(shared::lamp_shadow_near);
}

double brightest(const Light& light) {
  return double(light.intensity) * double(std::max({light.color.x, light.color.y, light.color.z}));
}

/// Returns how much of a picture's light a lamp may give.
double score_of(const Light& light, const Pose& body, const BeamView& view) {
  const double radius = 0.5 * std::min(lamp_reach(light), lit_length_m);
  const dvec3 center = body.apply(light.position) + radius * glm::normalize(body.rotate(light.direction));
  const dvec3 away = center - view.eye;
  return brightest(light) * view.share(center, radius) * radius * radius /
         (glm::dot(away, away) + radius * radius);
}

}  // namespace

BeamAxes beam_axes(const Light& light, const Pose& body) {
  BeamAxes axes;
  axes.along = glm::normalize(body.rotate(light.direction));
  dvec3 up = body.rotate({0.0, 0.0, 1.0});
  if (std::abs(glm::dot(axes.along, up)) > 0.9999) up = body.rotate({1.0, 0.0, 0.0});
  axes.right = glm::normalize(glm::cross(axes.along, up));
  axes.up = glm::cross(axes.right, axes.along);
  return axes;
}

BeamShadows::BeamShadows(const scene::GpuScene& scene, const BeamShadowOptions& options) : scene_(&scene) {
  const std::vector<Light>& lights = scene.scene().lights;
  for (uint32_t i = 0; options.wanted && i < lights.size(); ++i) {
    if (!has_beam(lights[i])) continue;
    const uint32_t body = scene.scene().owner_of(lights[i].body);
    auto at = std::ranges::find(bodies_, body, &Bearer::body);
    if (at == bodies_.end()) at = bodies_.insert(at, {body, {}});
    if (at->lights.size() < most_beam_tiles) at->lights.push_back(i);
  }
  if (bodies_.empty()) return;
  still_ = static_casters(scene.scene(), options.alpha_mask);
  if (!still_.opaque.empty()) still_opaque_ = caster_pipeline(scene, false, false, "static caster");
  if (!still_.masked.empty()) still_masked_ = caster_pipeline(scene, false, true, "static caster");
}

uvec2 BeamShadows::area(uint32_t width) const {
  if (!any()) return uvec2(0);
  const uint32_t across = std::clamp(width / shared::beam_tile_width, 2u, most_beam_tiles);
  return {across * shared::beam_tile_width,
          (most_beam_tiles + across - 1) / across * shared::beam_tile_height};
}

std::vector<BeamTile> BeamShadows::choose(std::span<const Pose> body_poses, const BeamView& view) const {
  const std::vector<Light>& lights = scene_->scene().lights;
  std::vector<std::pair<double, uint32_t>> order;
  for (uint32_t i = 0; i < bodies_.size(); ++i) {
    double score = 0.0;
    for (const uint32_t light : bodies_[i].lights)
      score += score_of(lights[light], body_poses[lights[light].body], view);
    if (score > 0.0) order.emplace_back(score, i);
  }
  std::ranges::stable_sort(order, [](const auto& a, const auto& b) { return a.first > b.first; });
  size_t count = 0, tiles = 0;
  for (; count < std::min<size_t>(order.size(), most_beam_bodies); ++count) {
    tiles += bodies_[order[count].second].lights.size();
    if (tiles > most_beam_tiles) break;
  }
  const double next = count < order.size() ? order[count].first : 0.0;
  std::vector<BeamTile> chosen;
  for (size_t k = 0; k < count; ++k) {
    const double strength = next > 0.0 ? std::min((order[k].first / next - 1.0) / beam_fade, 1.0) : 1.0;
    if (strength <= 0.0) continue;
    for (const uint32_t light : bodies_[order[k].second].lights) {
      BeamTile tile;
      tile.light = light;
      tile.strength = strength;
      chosen.push_back(tile);
    }
  }
  return chosen;
}

BeamShadows::Frustum BeamShadows::frustum_of(uint32_t index, std::span<const Pose> body_poses) const {
  const Light& light = scene_->scene().lights[index];
  const Pose& body = body_poses[light.body];
  Frustum frustum;
  frustum.position = body.apply(light.position);
  frustum.axes = beam_axes(light, body);
  frustum.reach = lamp_reach(light);
  if (light.beam == Light::Beam::passing) {
    frustum.half = {double(shared::beam_tile_right), double(shared::beam_tile_up)};
    frustum.middle = double(shared::beam_tile_middle);
    frustum.passing = true;
  } else {
    frustum.half = dvec2(std::tan(std::min(double(light.outer_cone), most_cone_half_angle)));
  }
  return frustum;
}

shared::CasterConstants BeamShadows::Frustum::constants() const {
  const auto row = [&](const dvec3& axis) { return vec4(dvec4(axis, -glm::dot(axis, position))); };
  return {{row(axes.right / half.x), row((axes.up - axes.along * middle) / half.y),
           vec4(0.0f, 0.0f, 0.0f, shared::lamp_shadow_near), row(axes.along)}};
}

bool BeamShadows::Frustum::outside(const dvec3& center, const dvec3& half_edges) const {
  const dvec3 away = center - position, gap = glm::max(glm::abs(away) - half_edges, dvec3(0.0));
  if (glm::length(gap) > reach) return true;
  const dvec3 up = axes.up - axes.along * middle;
  for (const dvec3& inwards : {axes.along, axes.along * half.x + axes.right, axes.along * half.x - axes.right,
                               axes.along * half.y + up, axes.along * half.y - up})
    if (glm::dot(inwards, away) + glm::dot(glm::abs(inwards), half_edges) < 0.0) return true;
  if (!passing) return false;
  const dvec3 level = axes.up - axes.along * double(shared::beam_edge_high),
              rising = level - axes.right * double(shared::beam_rise);
  const auto above = [&](const dvec3& plane) {
    return glm::dot(plane, away) - glm::dot(glm::abs(plane), half_edges) > 0.0;
  };
  return above(level) && above(rising);
}

bool BeamShadows::Frustum::outside(const dvec3& center, double radius) const {
  return outside(center, dvec3(radius));
}

void BeamShadows::draw_static(gpu::Cmd& cmd, const Frustum& frustum, const std::vector<CasterBlock>& blocks,
                              bool joins) const {
  CasterRange run;
  const auto draw = [&] {
    if (run.index_count > 0) cmd.draw_indexed(run.first_index, run.index_count, run.primitive);
  };
  for (const CasterBlock& block : blocks) {
    if (frustum.outside(block.center, block.half)) continue;
    if (joins && run.index_count > 0 && run.first_index + run.index_count == block.range.first_index) {
      run.index_count += block.range.index_count;  // one draw serves blocks in a row
      continue;
    }
    draw();
    run = block.range;
  }
  draw();
}

void BeamShadows::record(gpu::TickSlot& slot, gpu::Image& map, uint32_t top, std::span<const Pose> body_poses,
                         const MovingCasters& moving, std::span<BeamTile> tiles) const {
  if (tiles.empty()) return;
  const double texels = map.desc().width;
  const uint32_t across = area(map.desc().width).x / shared::beam_tile_width;
  std::vector<Frustum> frusta;
  std::vector<VkRect2D> places;
  const uvec2 size(shared::beam_tile_width, shared::beam_tile_height);
  for (uint32_t i = 0; i < tiles.size(); ++i) {
    frusta.push_back(frustum_of(tiles[i].light, body_poses));
    const uvec2 corner(i % across * size.x, top + i / across * size.y);
    places.push_back({{int32_t(corner.x), int32_t(corner.y)}, {size.x, size.y}});
    tiles[i].center = (dvec2(corner) + 0.5 * dvec2(size)) / texels;
    tiles[i].scale = 0.5 * dvec2(size) / texels / frusta[i].half;
  }
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope("beam shadows");
  cmd.transition(map, gpu::ImageUse::depth_target);
  cmd.begin_rendering({.color = {},
                       .depth = &map,
                       .keep_depth = true,
                       .width = map.desc().width,
                       .height = map.desc().height});
  cmd.clear_depth(places, 0.0f);
  const auto draw_all = [&](const gpu::GraphicsPipeline& with, const std::vector<gpu::Descriptor>& bound,
                            const auto& draw) {
    if (!with) return;
    cmd.bind(with);
    cmd.push(bound);
    cmd.bind_indices(scene_->indices());
    for (uint32_t i = 0; i < tiles.size(); ++i) {
      cmd.viewport(places[i]);
      cmd.constants(frusta[i].constants());
      draw(i);
    }
  };
  const auto bodies = [&](std::vector<CasterRange> BodyCaster::*ranges) {
    return [&, ranges](uint32_t i) {
      const scene::Scene& scene = scene_->scene();
      const uint32_t own = scene.owner_of(scene.lights[tiles[i].light].body);
      for (const BodyCaster& caster : moving.bodies) {
        if (caster.body == own || (caster.*ranges).empty()) continue;
        if (frusta[i].outside(body_poses[caster.body].apply(caster.center), caster.radius)) continue;
        draw_casters(cmd, caster.*ranges);
      }
    };
  };
  const std::vector<gpu::Descriptor> still = static_caster_descriptors(*scene_),
                                     all = scene_->raster_descriptors();
  draw_all(still_opaque_, still, [&](uint32_t i) { draw_static(cmd, frusta[i], still_.opaque, true); });
  draw_all(still_masked_, still, [&](uint32_t i) { draw_static(cmd, frusta[i], still_.masked, false); });
  draw_all(moving.opaque, all, bodies(&BodyCaster::opaque));
  draw_all(moving.masked, all, bodies(&BodyCaster::masked));
  cmd.end_rendering();
  cmd.transition(map, gpu::ImageUse::sampled);
}

}  // namespace greatx::render
