// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/draw_list.h"

#include <algorithm>
#include <cmath>

#include "scene/description/index_bounds.h"

namespace greatx::render {

namespace {

// A piece is seen as a whole or not at all, so one that is much larger than its parts draws in vain.
constexpr double free_radius_m = 4.0, most_growth = 1.2;

void bound(const scene::Scene& scene, DrawPiece& piece) {
  const scene::Bounds bounds = scene::bounds_of_indices(scene, piece.first_index, piece.index_count);
  piece.center = bounds.center();
  piece.radius = 0.5 * glm::length(bounds.size());
}

}  // namespace

DrawList::DrawList(const scene::Scene& scene, const std::vector<bool>& closed,
                   const std::vector<bool>& closed_instances, std::optional<uint32_t> excluded,
                   bool alpha_mask)
    : scene_(&scene) {
  for (uint32_t i = 0; i < scene.primitives.size(); ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    const uint32_t body = scene.instances[primitive.instance].body;
    if (excluded && scene.owner_of(body) == *excluded) continue;
    DrawPiece piece{primitive.first_index, primitive.index_count, body, i};
    bound(scene, piece);
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
  }
}

/// Adds a piece to the last one if it follows it, both have one body, and both are closed or both open.
/// Without `any_size`, the sphere limits this.
void DrawList::add(std::vector<DrawPiece>& pieces, DrawPiece next, bool any_size) {
  if (!pieces.empty()) {
    DrawPiece& last = pieces.back();
    const bool follows = last.body == next.body && last.closed == next.closed &&
                         last.first_index + last.index_count == next.first_index;
    DrawPiece both = last;
    both.hull.add(next.hull);
    both.index_count += next.index_count;
    if (follows) bound(*scene_, both);
    const double most = std::max(free_radius_m, most_growth * std::max(last.radius, next.radius));
    if (follows && (any_size || both.radius <= most)) {
      last = both;
      return;
    }
  }
  pieces.push_back(next);
}

bool DrawList::any_closed() const { return std::ranges::any_of(moving_, &DrawPiece::closed); }
bool DrawList::any_closed_still() const { return std::ranges::any_of(still_, &DrawPiece::closed); }

bool sees_from_outside(const DrawPiece& piece, const CameraView& view) {
  if (!piece.closed) return false;
  // The corners of the picture see the farthest from the eye at the nearest depth.
  const PinholeView& p = view.pinhole;
  const double x = std::max(std::abs(p.cx), std::abs(p.width - p.cx)) / p.fx,
               y = std::max(std::abs(p.cy), std::abs(p.height - p.cy)) / p.fy;
  const double room = 1e-3 + double(view.constants.near_m) * std::sqrt(1.0 + x * x + y * y);
  const dvec3 nearest = glm::clamp(view.eye, piece.hull.min, piece.hull.max);
  return glm::distance(nearest, view.eye) > room;
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
    const dvec3 center = poses[pieces[i].body].apply(pieces[i].center) - view.eye;
    if (view.outside(center, pieces[i].radius)) continue;
    drawn.push_back({glm::dot(view.forward, center) - pieces[i].radius, i});
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
