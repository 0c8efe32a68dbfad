// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What of the facets and edges of a leaf is lit: all that stands before them is taken away.
#include <algorithm>
#include <cmath>

#include "rf/search/beam_cells.h"

namespace greatx::rf {
namespace {

/// Pieces of one polygon; what else would cut them up further is left out, so that they stay too large.
constexpr size_t most_pieces = 512;

/// Cuts the part [from, to] of the segment a, b; false: nothing is left.
bool cut(const HalfPlane& half, const dvec2& a, const dvec2& b, double& from, double& to) {
  const double at_a = half.at(a), at_b = half.at(b);
  if (at_a < 0.0 && at_b < 0.0) return false;
  if (at_a < 0.0) from = std::max(from, at_a / (at_a - at_b));
  if (at_b < 0.0) to = std::min(to, at_a / (at_a - at_b));
  return from < to;
}

}  // namespace

/// Of the cell, and of the beam.
std::array<HalfPlane, 8> BeamCells::sides_of(const SlopeRect& rect) const {
  const Beam& beam = view_->beam();
  return {{{1.0, 0.0, -rect.min_a},
           {-1.0, 0.0, rect.max_a},
           {0.0, 1.0, -rect.min_b},
           {0.0, -1.0, rect.max_b},
           {1.0, 1.0, -beam.min_sum},
           {-1.0, -1.0, beam.max_sum},
           {1.0, -1.0, -beam.min_difference},
           {-1.0, 1.0, beam.max_difference}}};
}

/// Will two walls be counted as two by every path that passes them? Not if they are in one plane, which crossings take for
/// one (shaders/rf/crossings.comp.glsl).
bool BeamCells::apart(uint32_t wall, uint32_t other) const {
  const BeamScene& scene = view_->scene();
  const BeamFacet& a = scene.facet(view_->facets()[wall].scene_facet);
  const BeamFacet& b = scene.facet(view_->facets()[other].scene_facet);
  if (wall == other) return false;
  if (std::abs(glm::dot(a.normal, b.normal)) < 0.99) return true;
  const double room = view_->room_m() + 1e-5 * scene.largest_coordinate();
  return std::abs(glm::dot(a.normal, b.reference) - a.offset) >= room &&
         std::abs(glm::dot(b.normal, a.reference) - b.offset) >= room;
}

/// Counts a wall that a piece lies behind; false: that is one too many.
bool BeamCells::passes_one_more(std::array<uint32_t, most_passed>& passed, uint32_t& walls,
                                uint32_t wall) const {
  for (uint32_t i = 0; i < walls; ++i)
    if (!apart(passed[i], wall)) return true;
  if (walls == walls_) return false;
  passed[walls++] = wall;
  return true;
}

void BeamCells::settle_facet(const SlopeRect& rect, const Entry& entry) {
  const ViewFacet& facet = view_->facets()[entry.facet];
  const std::array<HalfPlane, 8> sides = sides_of(rect);
  for (const ViewPolygon& polygon : view_->polygons(facet)) {
    if (!polygon.box.overlaps(rect)) continue;
    Convex shape;
    for (const dvec2& corner : view_->corners(polygon)) shape.add(corner);
    if (std::all_of(sides.begin(), sides.end(), [&](const HalfPlane& side) { return clip(shape, side); }))
      settle_polygon(facet, entry, shape);
  }
}

/// Takes all that is in front away from a polygon; what is left is lit.
void BeamCells::settle_polygon(const ViewFacet& facet, const Entry& entry, const Convex& whole) {
  pieces_.assign(1, Piece{whole, 0, {}});
  const SlopeRect box = whole.box();
  double cut_by = 0.0;
  for (const Entry& other : entries_) {
    if (other.min_depth > entry.max_depth) break;
    const ViewFacet& cover = view_->facets()[other.facet];
    if (!cover.hides || other.facet == entry.facet || !cover.box.overlaps(box)) continue;
    const HalfPlane front = in_front(cover, facet);
    if (front.most(box) <= 0.0) continue;
    for (uint32_t i = 0; i < cover.polygon_count && !pieces_.empty(); ++i) {
      const uint32_t polygon = cover.first_polygon + i;
      const ViewPolygon& shape = view_->polygons(cover)[i];
      if (!shape.box.overlaps(box)) continue;
      const auto constraints = outline(polygon, cover);
      if (std::any_of(constraints.begin(), constraints.end(),
                      [&](const HalfPlane& half) { return half.most(box) <= 0.0; }))
        continue;
      subtract(other.facet, front, constraints);
      cut_by = std::max(cut_by, view_->clearance_m() / shape.max_depth);
    }
    if (pieces_.empty()) return;
  }
  for (const Piece& piece : pieces_)
    add_to(regions_[entry.facet * (walls_ + 1) + piece.walls], facet, piece.shape, cut_by);
}

/// Takes away what is inside of all constraints, or counts a wall for it.
void BeamCells::subtract(uint32_t cover, const HalfPlane& front, std::span<const HalfPlane> outline) {
  const bool stops = view_->facets()[cover].kind == FacetKind::opaque || walls_ == 0;
  const size_t count = pieces_.size();
  for (size_t i = 0; i < count; ++i) {
    if (!find_cuts(pieces_[i].shape, front, outline)) continue;
    if (pieces_.size() + cuts_.size() > most_pieces) continue;
    if (pieces_[i].shape.count + 2 * cuts_.size() > Convex::capacity) continue;
    Convex inside, outside;
    for (const HalfPlane& half : cuts_) {
      split(pieces_[i].shape, half, inside, outside);
      if (outside.count > 0) {
        pieces_.push_back(pieces_[i]);
        pieces_.back().shape = outside;
      }
      pieces_[i].shape = inside;
    }
    if (stops || !passes_one_more(pieces_[i].passed, pieces_[i].walls, cover)) pieces_[i].shape.count = 0;
  }
  std::erase_if(pieces_, [](const Piece& piece) { return piece.shape.count == 0; });
}

/// Which constraints run through a polygon? False: it is outside of one.
bool BeamCells::find_cuts(const Convex& shape, const HalfPlane& front, std::span<const HalfPlane> outline) {
  cuts_.clear();
  const auto look = [&](const HalfPlane& half) {
    double least = 1e300, most = -1e300;
    for (uint32_t i = 0; i < shape.count; ++i) {
      const double value = half.at(shape.at[i]);
      least = std::min(least, value), most = std::max(most, value);
    }
    if (least < 0.0) cuts_.push_back(half);
    return most > 0.0;
  };
  return look(front) && std::all_of(outline.begin(), outline.end(), look);
}

/// The same for an edge, which is lit if any of it is.
void BeamCells::settle_wedge(const SlopeRect& rect, const Entry& entry) {
  if (lit_[entry.facet]) return;
  const ViewFacet& wedge = view_->facets()[entry.facet];
  const dvec2 &a = wedge.ends[0], &b = wedge.ends[1];
  const std::array<HalfPlane, 8> sides = sides_of(rect);
  Interval whole;
  for (const HalfPlane& side : sides)
    if (!cut(side, a, b, whole.from, whole.to)) return;
  intervals_.assign(1, whole);
  for (const Entry& other : entries_) {
    if (other.min_depth > entry.max_depth) break;
    const ViewFacet& cover = view_->facets()[other.facet];
    if (!cover.hides || !cover.box.overlaps(wedge.box)) continue;
    if (cover.scene_facet == wedge.wedge_faces[0] || cover.scene_facet == wedge.wedge_faces[1]) continue;
    double from = 0.0, to = 1.0;
    if (!cut(in_front(cover, wedge), a, b, from, to)) continue;
    for (uint32_t i = 0; i < cover.polygon_count; ++i) {
      double part_from = from, part_to = to;
      const auto constraints = outline(cover.first_polygon + i, cover);
      if (!std::all_of(constraints.begin(), constraints.end(),
                       [&](const HalfPlane& half) { return cut(half, a, b, part_from, part_to); }))
        continue;
      next_intervals_.clear();
      for (const Interval& interval : intervals_) subtract(interval, other.facet, part_from, part_to);
      std::swap(intervals_, next_intervals_);
    }
    if (intervals_.empty()) return;
  }
  lit_[entry.facet] = 1;
}

void BeamCells::subtract(Interval interval, uint32_t cover, double from, double to) {
  const double begin = std::max(interval.from, from), end = std::min(interval.to, to);
  if (begin >= end) {
    next_intervals_.push_back(interval);
    return;
  }
  Interval part = interval;
  if (interval.from < begin) part.to = begin, next_intervals_.push_back(part);
  part = interval;
  if (end < interval.to) part.from = end, next_intervals_.push_back(part);
  if (view_->facets()[cover].kind == FacetKind::opaque || walls_ == 0) return;
  if (!passes_one_more(interval.passed, interval.walls, cover)) return;
  interval.from = begin, interval.to = end;
  next_intervals_.push_back(interval);
}

/// Where a part of the facet's projection lies on the facet itself, `pad` (slopes) wider.
void BeamCells::add_to(FacetRegion& region, const ViewFacet& view, const Convex& shape, double pad) const {
  const BeamFacet& facet = view_->scene().facet(view.scene_facet);
  const Beam& beam = view_->beam();
  const double border = 2.0 * facet.tolerance_m + view_->rounding_m() + view_->clearance_m();
  const double least = view.distance / view.max_depth * (1.0 - 1e-9);
  const double apex_a = glm::dot(facet.axis_a, beam.apex) - facet.offset_a;
  const double apex_b = glm::dot(facet.axis_b, beam.apex) - facet.offset_b;
  const dvec3 to_a(glm::dot(facet.axis_a, beam.right), glm::dot(facet.axis_a, beam.up),
                   glm::dot(facet.axis_a, beam.forward));
  const dvec3 to_b(glm::dot(facet.axis_b, beam.right), glm::dot(facet.axis_b, beam.up),
                   glm::dot(facet.axis_b, beam.forward));
  FacetRegion found;
  bool bounded = true;
  const auto add = [&](const dvec2& x) {
    double sum = view.slope_sum(x.x, x.y);
    if (sum < least && pad > 0.0) bounded = bounded && sum > 0.5 * least;
    sum = std::max(sum, 0.5 * least);
    const double depth = view.distance / sum;
    const double roundings = depth * (1.0 + std::abs(x.x) + std::abs(x.y)) * 1e-13 +
                             4.0 * view_->rounding_m() * depth / view.distance;
    found.add(apex_a + depth * (to_a.x * x.x + to_a.y * x.y + to_a.z),
              apex_b + depth * (to_b.x * x.x + to_b.y * x.y + to_b.z), border + roundings);
  };
  for (uint32_t i = 0; i < shape.count; ++i) {
    const dvec2& x = shape.at[i];
    if (pad == 0.0) {
      add(x);
      continue;
    }
    for (const double a : {-pad, pad})
      for (const double b : {-pad, pad}) add({x.x + a, x.y + b});
  }
  if (!bounded) {  // the padding reaches the plane's horizon
    found = {};
    for (const double a : {facet.min_a, facet.max_a})
      for (const double b : {facet.min_b, facet.max_b}) found.add(a, b, border);
  }
  found.min_a = std::max(found.min_a, facet.min_a - border),
  found.max_a = std::min(found.max_a, facet.max_a + border);
  found.min_b = std::max(found.min_b, facet.min_b - border),
  found.max_b = std::min(found.max_b, facet.max_b + border);
  if (!found.empty() && found.min_b <= found.max_b) region.add(found);
}

}  // namespace greatx::rf
