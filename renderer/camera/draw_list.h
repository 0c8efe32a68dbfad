// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lists what a camera draws: the primitives of a scene in pieces, each of which takes one draw. Most objects
// have a few triangles of each material, so a primitive for itself is a small draw.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/camera/camera_view.h"
#include "renderer/surface/closed_bodies.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// Primitives of one body that follow one another.
struct DrawPiece {
  uint32_t first_index = 0, index_count = 0;
  uint32_t body = 0;
  uint32_t primitive = 0;  ///< the first of them
  /// The piece belongs to closed surfaces (renderer/surface/closed_bodies.h). Seen from outside of them, its
  /// back faces need not be drawn.
  bool closed = false;
  scene::Bounds hull;    ///< of these surfaces, if they stand still
  scene::Bounds bounds;  ///< in the body's frame
  /// With panes, their numbers in DrawList::panes(), and in DrawList::rests() those of the solid rest and of
  /// the insides behind the panes, which the piece itself does not draw.
  std::vector<uint32_t> panes, rests;
  /// The sphere around the bounds.
  dvec3 center() const { return bounds.center(); }
  double radius() const { return 0.5 * glm::length(bounds.size()); }
};

class DrawList {
 public:
  /// The body `excluded` and its parts are left out. With `alpha_mask`, primitives with holes are listed
  /// apart. `pane_materials` has a value for each material; empty: no material is a pane.
  DrawList(const scene::Scene& scene, const ClosedSurfaces& surfaces, std::optional<uint32_t> excluded,
           bool alpha_mask, const std::vector<bool>& pane_materials);

  /// Opaque pieces of the static world. Primitives share a piece if its sphere stays small, or hardly larger
  /// than the largest of theirs.
  std::span<const DrawPiece> still() const { return still_; }
  std::span<const DrawPiece> moving() const { return moving_; }  ///< opaque
  std::span<const DrawPiece> masked() const { return masked_; }  ///< one primitive each
  std::span<const DrawPiece> panes() const { return panes_; }    ///< one primitive each
  /// What pieces with panes have beside them, open: their insides are seen.
  std::span<const DrawPiece> rests() const { return rests_; }
  bool any_closed() const;        ///< of those that move
  bool any_closed_still() const;  ///< of the static world

  /// What the materials of the listed primitives need.
  bool textured() const { return textured_; }
  bool normal_mapped() const { return normal_mapped_; }
  bool emissive() const { return emissive_; }
  bool switched() const { return switched_; }

 private:
  /// `insides` are those of bodies and of instances of the static world that have no piece yet.
  void split_panes(const scene::Scene& scene, const std::vector<bool>& pane_materials,
                   std::map<uint32_t, std::vector<uint32_t>>& insides, DrawPiece& piece);
  void add_rest(const scene::Scene& scene, uint32_t primitive, DrawPiece& piece);

  std::vector<DrawPiece> still_, moving_, masked_, panes_, rests_;
  bool textured_ = false, normal_mapped_ = false, emissive_ = false, switched_ = false;
};

/// Returns how far from the eye the nearest visible depth may cut faces off, with room for roundings.
double nearest_room(const CameraView& view);

/// Returns whether an eye sees a closed piece of the static world from outside and from more than `room`
/// (nearest_room), so that front faces hide its back faces, and none of them is cut off.
bool sees_from_outside(const DrawPiece& piece, const dvec3& eye, double room);

/// Takes the pieces with panes nearer than `reach` out of `order`, and returns their numbers in the same
/// order.
std::vector<uint32_t> take_glazed(std::vector<uint32_t>& order, std::span<const DrawPiece> pieces,
                                  std::span<const Pose> poses, const dvec3& eye, double reach);

/// Returns the numbers of the pieces that the view may see, front to back. `poses` has one for each body.
std::vector<uint32_t> visible_pieces(std::span<const DrawPiece> pieces, std::span<const Pose> poses,
                                     const CameraView& view);

}  // namespace greatx::render
