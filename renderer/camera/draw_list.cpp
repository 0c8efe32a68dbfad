// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/draw_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "scene/description/index_bounds.h"
#include "scene/description/lamps.h"

namespace greatx::render {

namespace {

// A piece is seen as a whole or not at all, so one that is much larger than its parts draws in vain.
// What panes show is drawn together as far as a vehicle reaches.
constexpr double free_radius_m = 4.0, glazed_radius_m = 8.0, most_growth = 1.2;

/// Returns the number of a primitive's body, or of its instance in the static world, and no two are equal.
uint32_t thing_of(const scene::Scene& scene, uint32_t primitive) {
  const uint32_t instance = scene.primitives[primitive].instance, body = scene.instances[instance].body;
  return body != 0 ? body : static_cast<uint32_t>(scene.bodies.size()) + instance;
}

/// Adds a piece to the last one if it follows it, both have one body, and both are closed or both open.
/// The sphere limits this beyond a radius that is free.
void add(std::vector<DrawPiece>& pieces, const DrawPiece& next, double free_m) {
  if (!pieces.empty()) {
    DrawPiece& last = pieces.back();
    const bool follows = last.body == next.body && last.closed == next.closed &&
                         last.first_index + last.index_count == next.first_index;
    DrawPiece both = last;
    both.index_count += next.index_count;
    both.bounds.add(next.bounds);
    both.hull.add(next.hull);
    const double most = std::max(free_m, most_growth * std::max(last.radius(), next.radius()));
    if (follows && both.radius() <= most) {
      last = both;
      return;
    }
  }
  pieces.push_back(next);
}

}  // namespace

DrawList::DrawList(const scene::Scene& scene, const ClosedSurfaces& surfaces,
                   std::optional<uint32_t> excluded, bool alpha_mask,
                   const std::vector<bool>& pane_materials) {
  std::set<uint32_t> glazed;
  for (uint32_t i = 0; i < scene.primitives.size() && !pane_materials.empty(); ++i)
    if (pane_materials[scene.primitives[i].material]) glazed.insert(thing_of(scene, i));
  std::map<uint32_t, std::vector<uint32_t>> insides;
  for (uint32_t i = 0; i < scene.primitives.size(); ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    const uint32_t body = scene.instances[primitive.instance].body, thing = thing_of(scene, i);
    if (excluded && scene.owner_of(body) == *excluded) continue;
    DrawPiece piece{primitive.first_index, primitive.index_count, body, i};
    piece.bounds = scene::bounds_of_indices(scene, primitive.first_index, primitive.index_count);
    if (alpha_mask && scene.has_holes(i)) {
      masked_.push_back(piece);
    } else if (glazed.contains(thing) && surfaces.insides[i]) {
      insides[thing].push_back(i);
    } else {
      piece.closed =
          body != 0 ? surfaces.bodies[body] : surfaces.instances[primitive.instance] && !scene.has_holes(i);
      piece.hull = scene.instances[primitive.instance].bounds;
      std::vector<DrawPiece>& to = body == 0 ? still_ : moving_;
      const bool one = glazed.contains(thing) && !to.empty() && thing_of(scene, to.back().primitive) == thing;
      add(to, piece,
          body != 0 ? std::numeric_limits<double>::infinity()
          : one     ? glazed_radius_m
                    : free_radius_m);
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
    for (DrawPiece& piece : *pieces) {
      split_panes(scene, pane_materials, insides, piece);
      // What stands apart from the panes that show its back faces keeps them.
      if (piece.panes.empty() && glazed.contains(thing_of(scene, piece.primitive))) piece.closed = false;
    }
}

void DrawList::add_rest(const scene::Scene& scene, uint32_t primitive, DrawPiece& piece) {
  const scene::Primitive& range = scene.primitives[primitive];
  const scene::Bounds bounds = scene::bounds_of_indices(scene, range.first_index, range.index_count);
  const bool follows =
      !piece.rests.empty() && rests_.back().first_index + rests_.back().index_count == range.first_index;
  if (follows) {
    rests_.back().index_count += range.index_count;
    rests_.back().bounds.add(bounds);
    return;
  }
  DrawPiece rest{range.first_index, range.index_count, piece.body, primitive};
  rest.bounds = bounds;
  piece.rests.push_back(static_cast<uint32_t>(rests_.size()));
  rests_.push_back(rest);
}

void DrawList::split_panes(const scene::Scene& scene, const std::vector<bool>& pane_materials,
                           std::map<uint32_t, std::vector<uint32_t>>& insides, DrawPiece& piece) {
  const auto is_pane = [&](uint32_t i) { return pane_materials[scene.primitives[i].material]; };
  uint32_t end = piece.primitive;
  for (uint32_t left = piece.index_count; left > 0; ++end) left -= scene.primitives[end].index_count;
  bool any = false;
  for (uint32_t i = piece.primitive; i < end; ++i) any |= is_pane(i);
  if (!any) return;
  for (uint32_t i = piece.primitive; i < end; ++i) {
    if (!is_pane(i)) {
      add_rest(scene, i, piece);
      continue;
    }
    const scene::Primitive& primitive = scene.primitives[i];
    DrawPiece pane{primitive.first_index, primitive.index_count, piece.body, i};
    pane.bounds = scene::bounds_of_indices(scene, primitive.first_index, primitive.index_count);
    piece.panes.push_back(static_cast<uint32_t>(panes_.size()));
    panes_.push_back(pane);
  }
  for (uint32_t i = piece.primitive; i < end; ++i) {
    const auto behind = insides.find(thing_of(scene, i));
    if (behind == insides.end()) continue;
    for (const uint32_t inside : behind->second) add_rest(scene, inside, piece);
    insides.erase(behind);
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
