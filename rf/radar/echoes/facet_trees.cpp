// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/facet_trees.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/error.h"

namespace greatx::rf {
namespace {

/// The corners of a convex piece, counter-clockwise about the facet's normal.
using Corners = std::vector<uint32_t>;

/// Joins the triangles of one facet greedily: across every edge that two pieces share, if the joined piece is
/// convex.
class Joiner {
 public:
  Joiner(const scene::Facet& facet, std::span<const scene::FacetTriangle> triangles) : normal_(facet.normal) {
    std::map<std::array<double, 3>, uint32_t> ids;
    const auto id_of = [&](const dvec3& p) {
      const auto [at, is_new] = ids.try_emplace({p.x, p.y, p.z}, static_cast<uint32_t>(points.size()));
      if (is_new) points.push_back(p);
      return at->second;
    };
    for (const scene::FacetTriangle& triangle : triangles) {
      const dvec3* c = triangle.corners;
      const double turn = glm::dot(normal_, glm::cross(c[1] - c[0], c[2] - c[0]));
      if (turn == 0.0) continue;  // no area
      Corners corners{id_of(c[0]), id_of(c[1]), id_of(c[2])};
      if (turn < 0.0) std::swap(corners[1], corners[2]);
      pieces.push_back(std::move(corners));
    }
    for (uint32_t piece = 0; piece < pieces.size(); ++piece)
      for (size_t i = 0; i < 3; ++i) {
        const auto [at, is_new] = owner_.try_emplace(edge(pieces[piece], i), piece);
        if (!is_new) at->second = nobody;  // triangles overlap
      }
    for (uint32_t piece = 0; piece < pieces.size(); ++piece)
      while (join_one(piece)) {
      }
  }
  std::vector<dvec3> points;
  std::vector<Corners> pieces;  ///< pieces that were joined to another are empty

 private:
  using Edge = std::pair<uint32_t, uint32_t>;
  static constexpr uint32_t nobody = ~0u;
  static Edge edge(const Corners& piece, size_t i) { return {piece[i], piece[(i + 1) % piece.size()]}; }

  bool convex_at(uint32_t before, uint32_t at, uint32_t after) const {
    const dvec3 a = points[at] - points[before], b = points[after] - points[at];
    return glm::dot(normal_, glm::cross(a, b)) >= -1e-9 * glm::length(a) * glm::length(b);
  }
  bool join_one(uint32_t piece) {
    Corners& own = pieces[piece];
    for (size_t i = 0; i < own.size(); ++i) {
      const auto [a, b] = edge(own, i);
      const auto mine = owner_.find({a, b}), found = owner_.find({b, a});
      if (found == owner_.end() || found->second == nobody || mine->second != piece) continue;
      const uint32_t other = found->second;
      if (other == piece || own.size() + pieces[other].size() - 2 > FacetTrees::most_corners) continue;
      Corners& theirs = pieces[other];
      // The joined outline runs from b around this piece to a. Then it follows the other piece from the
      // corner after a to the corner before b.
      Corners joined(own);
      std::rotate(joined.begin(), joined.begin() + (i + 1) % own.size(), joined.end());
      const size_t at_a = std::find(theirs.begin(), theirs.end(), a) - theirs.begin();
      for (size_t k = 1; k + 1 < theirs.size(); ++k) joined.push_back(theirs[(at_a + k) % theirs.size()]);
      const size_t joint = own.size() - 1;  // index of a
      if (!convex_at(joined[joint - 1], a, joined[joint + 1]) || !convex_at(joined.back(), b, joined[1]))
        continue;
      for (size_t k = 0; k < theirs.size(); ++k)
        if (uint32_t& owner = owner_[edge(theirs, k)]; owner == other) owner = piece;
      owner_.erase({a, b}), owner_.erase({b, a});
      own = std::move(joined);
      theirs.clear();
      return true;
    }
    return false;
  }

  dvec3 normal_;
  std::map<Edge, uint32_t> owner_;  ///< owner of each directed edge
};

}  // namespace

FacetTrees::FacetTrees(const scene::Scene& scene) : trees_(scene.facets.size()) {
  for (uint32_t i = 0; i < scene.facets.size(); ++i) {
    const scene::Facet& facet = scene.facets[i];
    const Joiner joined(facet,
                        std::span(scene.facet_triangles).subspan(facet.first_triangle, facet.triangle_count));
    const uint32_t first = static_cast<uint32_t>(pieces_.size());
    first_piece_.push_back(first);
    for (const Corners& corners : joined.pieces) {
      if (corners.empty()) continue;
      Piece& piece = pieces_.emplace_back();
      piece.first = static_cast<uint32_t>(corners_.size()),
      piece.count = static_cast<uint32_t>(corners.size());
      scene::Bounds box;
      for (const uint32_t id : corners) {
        corners_.push_back(joined.points[id]);
        box.add(joined.points[id]);
      }
      piece.ball.center = box.center();
      for (const uint32_t id : corners)
        piece.ball.radius = std::max(piece.ball.radius, glm::length(joined.points[id] - piece.ball.center));
      piece.ball.radius += 1e-6 + 1e-12 * glm::length(piece.ball.center);
    }
    const uint32_t count = static_cast<uint32_t>(pieces_.size()) - first;
    if (count <= small_facet) continue;
    std::vector<scene::Bounds> boxes;
    for (uint32_t piece = first; piece < first + count; ++piece) boxes.push_back(bounds_of(piece));
    trees_[i] = scene::BoxTree(boxes);
  }
  first_piece_.push_back(static_cast<uint32_t>(pieces_.size()));
}

scene::Bounds FacetTrees::bounds_of(uint32_t piece) const {
  scene::Bounds bounds;
  for (uint32_t i = 0; i < pieces_[piece].count; ++i) bounds.add(corners_[pieces_[piece].first + i]);
  return bounds;
}

std::span<const dvec3> FacetTrees::corners(const FacetWorld& world, uint32_t facet, uint32_t piece,
                                           std::array<dvec3, most_corners>& room) const {
  const std::span<const dvec3> own = corners(piece);
  const uint32_t body = world.facet(facet).body;
  if (body == 0) return own;
  const Pose& pose = world.motion(body).pose;
  for (size_t i = 0; i < own.size(); ++i) room[i] = pose.apply(own[i]);
  return std::span(room).first(own.size());
}

void FacetTrees::find(const FacetWorld& world, uint32_t facet, std::span<const KeptSide> spaces,
                      std::vector<uint32_t>& pieces) const {
  pieces.clear();
  const PosedFacet& posed = world.facet(facet);
  if (trees_[facet].empty()) {
    for (uint32_t i = first_piece_[facet]; i < first_piece_[facet + 1]; ++i) pieces.push_back(i);
    return;
  }
  const BodySpaces local(spaces, world, posed.body);
  const uint32_t first = first_piece_[facet];
  trees_[facet].gather([&](const scene::Bounds& box) { return local.outside(box); }, pieces);
  for (uint32_t& piece : pieces) piece += first;
}

bool FacetTrees::contains(const FacetWorld& world, uint32_t facet, const dvec3& point) const {
  const PosedFacet& posed = world.facet(facet);
  if (trees_[facet].empty()) return world.contains(facet, posed.plane_coordinates(point));
  const Pose pose = posed.body == 0 ? Pose{} : world.motion(posed.body).pose.inverse();
  const dvec3 at = pose.apply(point), normal = pose.rotate(posed.normal);
  const auto inside = [&](uint32_t piece) {
    const std::span<const dvec3> outline = corners(piece);
    for (size_t i = 0; i < outline.size(); ++i) {
      const dvec3 side = outline[i + 1 < outline.size() ? i + 1 : 0] - outline[i];
      if (glm::dot(normal, glm::cross(side, at - outline[i])) < -1e-9 * glm::dot(side, side)) return false;
    }
    return true;
  };
  const auto outside = [&](const scene::Bounds& box) {
    // The boxes of a plane may be flat. A point of the plane is outside of such a box by rounding errors.
    const dvec3 off = glm::abs(at - box.center()) - 0.5 * (box.max - box.min);
    return std::max({off.x, off.y, off.z}) > 1e-5;
  };
  const uint32_t first = first_piece_[facet];
  return trees_[facet].visit_until(outside, [&](uint32_t piece) { return inside(first + piece); });
}

}  // namespace greatx::rf
