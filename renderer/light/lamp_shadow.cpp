// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/lamp_shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "renderer/light/shadow_raster.h"
#include "scene/description/index_bounds.h"
#include "shaders/shared/beam.h"

namespace greatx::render {

namespace {

using Light = scene::PunctualLight;

/// Returns the area of the disc that a lamp lights at the end of its reach, over pi.
double lit_area(const Light& light) {
  const double across =
      lamp_reach(light) * (light.type == Light::Type::spot ? std::sin(light.outer_cone) : 1.0);
  return across * across;
}

struct CasterSphere {
  dvec3 center{0.0};
  double radius = 0.0;
};

/// Returns the mean of a passing beam over the directions of a cone about its elbow.
double mean_of_beam(double half_angle) {
  constexpr int rings = 64, sectors = 64;
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double cosine = 1.0 - (i + 0.5) / rings * (1.0 - std::cos(half_angle));  // equal solid angles
    const double tangent = std::sqrt(1.0 - cosine * cosine) / cosine;
    for (int k = 0; k < sectors; ++k) {
      const double angle = 2.0 * pi * (k + 0.5) / sectors;
      sum += double(shared::passing_beam(float(tangent * std::cos(angle)), float(tangent * std::sin(angle))));
    }
  }
  return sum / (rings * sectors);
}

CasterSphere sphere_of(const scene::Scene& scene, const scene::Primitive& primitive) {
  const scene::Bounds bounds = scene::bounds_of_indices(scene, primitive.first_index, primitive.index_count);
  return {bounds.center(), 0.5 * glm::length(bounds.size())};
}

}  // namespace

double lamp_reach(const Light& light) {
  if (light.type == Light::Type::directional) return std::numeric_limits<double>::infinity();
  if (light.range_m > 0.0f) return light.range_m;
  const vec3 peak = light.color * light.intensity;
  return std::sqrt(std::max({peak.x, peak.y, peak.z, 0.0f}) / lamp_least_lux);
}

dvec3 lamp_flux(const Light& light) {
  const dvec3 peak = dvec3(light.color) * double(light.intensity);
  if (light.type == Light::Type::directional) return dvec3(0.0);
  if (light.type == Light::Type::point) return 4.0 * pi * peak;
  const double inner = std::cos(double(light.inner_cone)), outer = std::cos(double(light.outer_cone));
  const double mean = light.beam == Light::Beam::passing ? mean_of_beam(double(light.outer_cone)) : 1.0;
  return 2.0 * pi * (1.0 - inner + (inner - outer) / 3.0) * mean * peak;
}

LampShadows::LampShadows(const scene::GpuScene& scene, const LampShadowOptions& options) : scene_(&scene) {
  tiles_.resize(scene.scene().lights.size());
  sampler_ = shadow_sampler(scene.device(), "lamp shadow");
  if (options.wanted) place_lamps();
  beams_ = BeamShadows(scene, {.wanted = options.beams, .alpha_mask = options.alpha_mask});
  if (beams_.any()) place_beams();
  if (!lamps_.empty() || beams_.any()) moving_ = moving_casters(scene, options.alpha_mask);
  const double half_uv = 0.5 * tile_texels_ / map_texels_;
  for (const Lamp& lamp : lamps_)
    tiles_[lamp.light] = {lamp.across * (half_uv / lamp.tangent),
                          (dvec2(lamp.x, lamp.y) + 0.5 * tile_texels_) / double(map_texels_)};
  draw_static(options.alpha_mask);
}

void LampShadows::place_beams() {
  beam_top_ = lamps_.empty() ? 0 : map_texels_;
  const uvec2 area = beams_.area(beam_top_);
  map_texels_ = std::max(beam_top_ + area.y, area.x);
}

void LampShadows::place_lamps() {
  const std::vector<Light>& lights = scene_->scene().lights;
  std::vector<uint32_t> order;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const bool still = lights[i].body == 0 && lights[i].type != Light::Type::directional &&
                       lights[i].beam == Light::Beam::cone;
    if (still && lamp_reach(lights[i]) > double(shared::lamp_shadow_near)) order.push_back(i);
  }
  std::ranges::stable_sort(order,
                           [&](uint32_t a, uint32_t b) { return lit_area(lights[a]) > lit_area(lights[b]); });
  order.resize(std::min<size_t>(order.size(), most_lamp_tiles));
  if (order.empty()) return;
  const auto along = static_cast<uint32_t>(std::ceil(std::sqrt(double(order.size()))));
  tile_texels_ = std::clamp(lamp_map_texels / along, least_lamp_tile, most_lamp_tile);
  map_texels_ = along * tile_texels_;
  for (uint32_t i = 0; i < order.size(); ++i) {
    const Light& light = lights[order[i]];
    const bool spot = light.type == Light::Type::spot;
    Lamp lamp;
    lamp.light = order[i];
    lamp.position = light.position;
    lamp.axis = spot ? glm::normalize(light.direction) : dvec3(0.0, 0.0, -1.0);
    lamp.across =
        glm::normalize(glm::cross(std::abs(lamp.axis.z) < 0.99 ? dvec3(0, 0, 1) : dvec3(0, 1, 0), lamp.axis));
    lamp.up = glm::cross(lamp.axis, lamp.across);
    lamp.reach = lamp_reach(light);
    lamp.tangent =
        std::tan(spot ? std::min(double(light.outer_cone), lamp_tile_half_angle) : lamp_tile_half_angle);
    lamp.x = i % along * tile_texels_;
    lamp.y = i / along * tile_texels_;
    lamps_.push_back(lamp);
  }
}

shared::CasterConstants LampShadows::view_of(const Lamp& lamp) const {
  const auto row = [&](const dvec3& axis) { return vec4(dvec4(axis, -glm::dot(axis, lamp.position))); };
  return {{row(lamp.across / lamp.tangent), row(lamp.up / lamp.tangent),
           vec4(0.0f, 0.0f, 0.0f, shared::lamp_shadow_near), row(lamp.axis)}};
}

void LampShadows::draw_static(bool alpha_mask) {
  const scene::Scene& scene = scene_->scene();
  const bool moves = changes();
  static_map_ = shadow_map(scene_->device(), map_texels_, "static lamp shadows",
                           moves ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : 0);
  if (moves)
    map_ = shadow_map(scene_->device(), map_texels_, "lamp shadows", VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  const scene::Body& world = scene.bodies[0];
  std::vector<CasterSphere> spheres;
  bool any_opaque = false, any_masked = false;
  for (uint32_t i = world.first_primitive;
       !lamps_.empty() && i < world.first_primitive + world.primitive_count; ++i) {
    spheres.push_back(sphere_of(scene, scene.primitives[i]));
    (alpha_mask && scene.has_holes(i) ? any_masked : any_opaque) = true;
  }
  gpu::GraphicsPipeline opaque, masked;
  if (any_opaque) opaque = caster_pipeline(*scene_, false, false, "static caster");
  if (any_masked) masked = caster_pipeline(*scene_, false, true, "static caster");
  gpu::submit_setup(scene_->device(), [&](gpu::Cmd& cmd) {
    const auto scope = cmd.scope("static lamp shadows");
    cmd.transition(static_map_, gpu::ImageUse::depth_target, true);
    cmd.begin_rendering({.color = {},
                         .depth = &static_map_,
                         .clear_depth = 0.0f,
                         .width = map_texels_,
                         .height = map_texels_});
    for (const bool with_mask : {false, true}) {
      const gpu::GraphicsPipeline& pipeline = with_mask ? masked : opaque;
      if (!pipeline) continue;
      cmd.bind(pipeline);
      cmd.push(static_caster_descriptors(*scene_));
      cmd.bind_indices(scene_->indices());
      for (const Lamp& lamp : lamps_) {
        std::vector<uint32_t> near;
        for (uint32_t i = 0; i < spheres.size(); ++i)
          if (glm::length(spheres[i].center - lamp.position) < spheres[i].radius + lamp.reach &&
              (alpha_mask && scene.has_holes(world.first_primitive + i)) == with_mask)
            near.push_back(world.first_primitive + i);
        if (near.empty()) continue;
        cmd.viewport(lamp.x, lamp.y, tile_texels_);
        cmd.constants(view_of(lamp));
        draw_casters(cmd, scene, near);
      }
    }
    cmd.end_rendering();
    if (moves) {
      cmd.transition(static_map_, gpu::ImageUse::transfer_source);
      cmd.transition(map_, gpu::ImageUse::transfer_target, true);
      cmd.copy_square(static_map_, map_, 0, 0, map_texels_);
      cmd.transition(map_, gpu::ImageUse::sampled);
    } else {
      cmd.transition(static_map_, gpu::ImageUse::sampled);
    }
  });
}

LampShadows::Square LampShadows::square_of(const Lamp& lamp, const dvec3& center, double radius) const {
  const dvec3 away = center - lamp.position;
  if (glm::length(away) > lamp.reach + radius) return {};
  const double depth = glm::dot(lamp.axis, away), near = depth - radius;
  if (depth + radius <= double(shared::lamp_shadow_near)) return {};
  if (near <= double(shared::lamp_shadow_near)) return {lamp.x, lamp.y, tile_texels_};
  const auto span = [&](double side) {  // of the tile, from -1 to 1, over both ends of the sphere's depth
    const double low = side - radius, high = side + radius, far = depth + radius;
    return dvec2(std::min(low / near, low / far), std::max(high / near, high / far)) / lamp.tangent;
  };
  const auto texels = [&](const dvec2& part) {
    const dvec2 at = (0.5 * part + 0.5) * double(tile_texels_);
    return dvec2(std::floor(at.x) - 1.0, std::ceil(at.y) + 1.0);
  };
  const double most = tile_texels_;
  const dvec2 u = texels(span(glm::dot(lamp.across, away))), v = texels(span(glm::dot(lamp.up, away)));
  if (u.y <= 0.0 || v.y <= 0.0 || u.x >= most || v.x >= most) return {};
  const double size = std::min(std::max(u.y - std::max(u.x, 0.0), v.y - std::max(v.x, 0.0)), most);
  const auto begin = [&](double at) { return static_cast<uint32_t>(std::clamp(at, 0.0, most - size)); };
  return {lamp.x + begin(u.x), lamp.y + begin(v.x), static_cast<uint32_t>(size)};
}

void LampShadows::record(gpu::TickSlot& slot, std::span<const Pose> body_poses) {
  if (moving_.bodies.empty()) return;
  struct Draw {
    uint32_t lamp = 0, caster = 0;
  };
  std::vector<Draw> draws;
  std::vector<Square> squares;
  for (uint32_t c = 0; c < moving_.bodies.size(); ++c) {
    const dvec3 center = body_poses[moving_.bodies[c].body].apply(moving_.bodies[c].center);
    for (uint32_t l = 0; l < lamps_.size(); ++l) {
      const Square square = square_of(lamps_[l], center, moving_.bodies[c].radius);
      if (square.size == 0) continue;
      squares.push_back(square);
      draws.push_back({l, c});
    }
  }
  if (squares.empty() && changed_.empty()) return;
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope("lamp shadows");
  cmd.transition(map_, gpu::ImageUse::transfer_target);
  for (const Square& square : changed_) cmd.copy_square(static_map_, map_, square.x, square.y, square.size);
  changed_ = std::move(squares);
  if (!draws.empty()) {
    cmd.transition(map_, gpu::ImageUse::depth_target);
    cmd.begin_rendering(
        {.color = {}, .depth = &map_, .keep_depth = true, .width = map_texels_, .height = map_texels_});
    const std::vector<gpu::Descriptor> descriptors = scene_->raster_descriptors();
    const auto draw_all = [&](const gpu::GraphicsPipeline& with,
                              std::vector<CasterRange> BodyCaster::*ranges) {
      if (!with) return;
      cmd.bind(with);
      cmd.push(descriptors);
      cmd.bind_indices(scene_->indices());
      for (const Draw& draw : draws) {
        if ((moving_.bodies[draw.caster].*ranges).empty()) continue;
        cmd.viewport(lamps_[draw.lamp].x, lamps_[draw.lamp].y, tile_texels_);
        cmd.constants(view_of(lamps_[draw.lamp]));
        draw_casters(cmd, moving_.bodies[draw.caster].*ranges);
      }
    };
    draw_all(moving_.opaque, &BodyCaster::opaque);
    draw_all(moving_.masked, &BodyCaster::masked);
    cmd.end_rendering();
  }
  cmd.transition(map_, gpu::ImageUse::sampled);
}

std::vector<BeamTile> LampShadows::record_beams(gpu::TickSlot& slot, std::span<const Pose> body_poses,
                                                const BeamView& view) {
  std::vector<BeamTile> tiles = beams_.choose(body_poses, view);
  beams_.record(slot, map_, beam_top_, body_poses, moving_, tiles);
  return tiles;
}

void LampShadows::describe(shared::GpuWeather& block) const {
  block.lamp_texel_uv = float(1.0 / map_texels_);
  block.lamp_half_uv = float((0.5 * tile_texels_ - 1.0) / map_texels_);
}

gpu::Descriptor LampShadows::descriptor() const {
  return gpu::Descriptor::sampled(shared::lamp_shadow_binding, changes() ? map_ : static_map_, sampler_);
}

}  // namespace greatx::render
