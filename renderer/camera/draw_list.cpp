// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/draw_list.h"

#include <algorithm>
#include <cmath>

#include "scene/description/index_bounds.h"
#include "scene/description/lamps.h"

namespace greatx::render {

namespace {

// A piece is seen as a whole or not at all, so one that is much larger than its parts draws in vain.
constexpr double free_radius_m = 4.0, most_growth = 1.2;

/// Adds a piece to the last one if it follows it, both have one body, and both are closed or both open.
/// Without `any_size`, the sphere limits this.
void add(std::vector<DrawPiece>& pieces, const DrawPiece& next, bool any_size) {
  if (!pieces.empty()) {
    DrawPiece& last = pieces.back();
    const bool follows = last.body == next.body && last.closed == next.closed &&
                         last.first_index + last.index_count == next.first_index;
    DrawPiece both = last;
    both.index_count += next.index_count;
    both.bounds.add(next.bounds);
    both.hull.add(next.hull);
    const double most = std::max(free_radius_m, most_growth * std::max(last.radius(), next.radius()));
    if (follows && (any_size || both.radius() <= most)) {
      last = both;
      return;
    }
  }
  pieces.push_back(next);
}

}  // namespace

DrawList::DrawList(const scene::Scene& scene, const std::vector<bool>& closed,
                   const std::vector<bool>& closed_instances, std::optional<uint32_t> excluded,
                   bool alpha_mask, const std::vector<bool>& pane_materials) {
  for (uint32_t i = 0; i < scene.primitives.size(); ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    const uint32_t body = scene.instances[primitive.instance].body;
    if (excluded && scene.owner_of(body) == *excluded) continue;
    DrawPiece piece{primitive.first_index, primitive.index_count, body, i};
    piece.bounds = scene::bounds_of_indices(scene, primitive.first_index, primitive.index_count);
    if (alpha_mask && scene.has_holes(i)) {
      masked_.push_back(piece);
    } else {
      piece.closed = body != 0 ? closed[body] : closed_instances[primitive.instance] && !scene.has_holes(i);
      piece.hull = scene.instances[primitive.instance].bounds;
      add(body == 0 ? still_ : moving_, piece, body != 0);
    }
    const scene::PbrMaterial& pbr = scene.materials[primitive.material].pbr;
    textured_ |=
        pbr.base_color_texture >= 0 || pbr.metallic_roughness_texture >= 0 || pbr.emissive_texture >= 0;
    normal_mapped_ |= pbr.normal_texture >= 0;
    emissive_ |= pbr.emissive != vec3(0.0f);
    switched_ |= scene::lamp_role(scene.materials[primitive.material]).has_value();
  }
  if (pane_materials.empty()) return;
  for (std::vector<DrawPiece>* pieces : {&still_, &moving_})
    for (DrawPiece& piece : *pieces) split_panes(scene, pane_materials, piece);
}

void DrawList::split_panes(const scene::Scene& scene, const std::vector<bool>& pane_materials,
                           DrawPiece& piece) {
  const auto is_pane = [&](uint32_t i) { return pane_materials[scene.primitives[i].material]; };
  uint32_t end = piece.primitive;
  for (uint32_t left = piece.index_count; left > 0; ++end) left -= scene.primitives[end].index_count;
  bool any = false;
  for (uint32_t i = piece.primitive; i < end; ++i) any |= is_pane(i);
  if (!any) return;
  bool follows = false;
  for (uint32_t i = piece.primitive; i < end; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    const scene::Bounds bounds =
        scene::bounds_of_indices(scene, primitive.first_index, primitive.index_count);
    const bool pane = is_pane(i);
    if (!pane && follows) {
      rests_.back().index_count += primitive.index_count;
      rests_.back().bounds.add(bounds);
    } else {
      DrawPiece part{primitive.first_index, primitive.index_count, piece.body, i};
      part.bounds = bounds;
      std::vector<DrawPiece>& to = pane ? panes_ : rests_;
      (pane ? piece.panes : piece.rests).push_back(static_cast<uint32_t>(to.size()));
      to.push_back(part);
    }
    follows = !pane;
  }
}

bool DrawList::any_closed() const { return std::ranges::any_of(moving_, &DrawPiece::closed); }
bool DrawList::any_closed_still() const { return std::ranges::any_of(still_, &DrawPiece::closed); }

double nearest_room(const CameraView& view) {
  // The corners of the picture see the farthest from the eye at the nearest depth.
  const PinholeView& p = view.pinhole;
  const double x = std::max(std::abs(p.cx), std::abs(p.width - p.cx)) / p.fx,
               y = std::max(std::abs(p.cy), std::abs(p.height - p.cy)) / p.fy;
  return 1e-3 + double(view.constants.near_m) * std::sqrt(1.0 + x * x + y * y);
}

bool sees_from_outside(const DrawPiece& piece, const dvec3& eye, double room) {
  if (!piece.closed) return false;
  return glm::distance(glm::clamp(eye, piece.hull.min, piece.hull.max), eye) > room;
}

std::vector<uint32_t> take_glazed(std::vector<uint32_t>& order, std::span<const DrawPiece> pieces,
                                  std::span<const Pose> poses, const dvec3& eye, double reach) {
  std::vector<uint32_t> taken;
  std::erase_if(order, [&](uint32_t i) {
    const DrawPiece& piece = pieces[i];
    const bool near = !piece.panes.empty() &&
                      glm::distance(poses[piece.body].apply(piece.center()), eye) < reach + piece.radius();
    if (near) taken.push_back(i);
    return near;
  });
  return taken;
}

std::vector<uint32_t> visible_pieces(std::span<const DrawPiece> pieces, std::span<const Pose> poses,
                                     const CameraView& view) {
  struct Drawn {
    double nearest;
    uint32_t piece;
  };
  std::vector<Drawn> drawn;
  drawn.reserve(pieces.size());
  for (uint32_t i = 0; i < pieces.size(); ++i) {
    const dvec3 center = poses[pieces[i].body].apply(pieces[i].center()) - view.eye;
    const double radius = pieces[i].radius();
    if (view.outside(center, radius)) continue;
    drawn.push_back({glm::dot(view.forward, center) - radius, i});
  }
  // The order is front to back, so that hidden triangles cost only a depth test. It is total, so that ties
  // come out the same every time.
  std::ranges::sort(drawn, [](const Drawn& a, const Drawn& b) {
    return a.nearest != b.nearest ? a.nearest < b.nearest : a.piece < b.piece;
  });
  std::vector<uint32_t> order;
  order.reserve(drawn.size());
  for (const Drawn& d : drawn) order.push_back(d.piece);
  return order;
}

}  // namespace greatx::render
