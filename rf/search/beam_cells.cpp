// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/beam_cells.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/watch.h"

namespace greatx::rf {
namespace {

/// Cells with fewer facets than this are not cut, and neither are cells at this level of cuts.
constexpr size_t facets_of_leaf = 24;
constexpr uint32_t most_levels = 24;
/// When an outline is moved outwards, corners sharper than this (sine of half the angle) are blunted.
constexpr double sharp = 0.3;

/// Returns the slope halfway between two directions, by angle.
double bisect(double a, double b) {
  const double length_a = std::sqrt(1.0 + a * a), length_b = std::sqrt(1.0 + b * b);
  return (a * length_b + b * length_a) / (length_a + length_b);
}

/// Returns the least and the largest depth at which rays of a cell meet a plane.
std::pair<double, double> depths(const ViewFacet& facet, const SlopeRect& rect) {
  const HalfPlane sum{facet.na, facet.nb, facet.n};
  const double least = sum.least(rect), most = sum.most(rect);
  return {most > 0.0 ? std::max(facet.min_depth, facet.distance / most) : facet.max_depth,
          least > 0.0 ? std::min(facet.max_depth, facet.distance / least) : facet.max_depth};
}

/// Cuts the part [from, to] of the segment a, b. Returns false if nothing is left.
bool cut(const HalfPlane& half, const dvec2& a, const dvec2& b, double& from, double& to) {
  const double at_a = half.at(a), at_b = half.at(b);
  if (at_a < 0.0 && at_b < 0.0) return false;
  if (at_a < 0.0) from = std::max(from, at_a / (at_a - at_b));
  if (at_b < 0.0) to = std::min(to, at_a / (at_a - at_b));
  return from < to;
}

}  // namespace

void FacetRegion::add(double a, double b, double room) {
  min_a = std::min(min_a, a - room), max_a = std::max(max_a, a + room);
  min_b = std::min(min_b, b - room), max_b = std::max(max_b, b + room);
  min_sum = std::min(min_sum, a + b - 2.0 * room), max_sum = std::max(max_sum, a + b + 2.0 * room);
  min_difference = std::min(min_difference, a - b - 2.0 * room);
  max_difference = std::max(max_difference, a - b + 2.0 * room);
}

void FacetRegion::add(const FacetRegion& other) {
  min_a = std::min(min_a, other.min_a), max_a = std::max(max_a, other.max_a);
  min_b = std::min(min_b, other.min_b), max_b = std::max(max_b, other.max_b);
  min_sum = std::min(min_sum, other.min_sum), max_sum = std::max(max_sum, other.max_sum);
  min_difference = std::min(min_difference, other.min_difference);
  max_difference = std::max(max_difference, other.max_difference);
}

void BeamCells::settle(const BeamView& view, uint32_t walls, std::vector<BeamHit>& hits,
                       std::vector<uint32_t>& wedges) {
  view_ = &view;
  GREATX_CHECK(walls <= most_passed, "{} walls, at most {}", walls, most_passed);
  walls_ = walls;
  const size_t count = view.facets().size();
  regions_.assign(count * (walls_ + 1), FacetRegion{});
  lit_.assign(count, 0);
  outlines_.clear();
  halves_.clear();
  lists_.clear();
  for (uint32_t facet = 0; facet < count; ++facet)
    if (view.facets()[facet].box.overlaps(view.beam().window)) lists_.push_back(facet);
  for (const ViewFacet& facet : view.facets())
    outlines_.resize(std::max<size_t>(outlines_.size(), facet.first_polygon + facet.polygon_count));
  look_at(view.beam().window, 0, lists_.size(), 0);

  const size_t first_wedge = wedges.size();
  for (uint32_t i = 0; i < count; ++i) {
    const ViewFacet& facet = view.facets()[i];
    if (facet.is_wedge && lit_[i]) wedges.push_back(facet.scene_facet);
    if (facet.is_wedge) continue;
    for (uint32_t passed = 0; passed <= walls_; ++passed)
      if (const FacetRegion& region = regions_[i * (walls_ + 1) + passed]; !region.empty())
        hits.push_back({facet.scene_facet, passed, region});
  }
  std::sort(wedges.begin() + static_cast<ptrdiff_t>(first_wedge), wedges.end());
}

/// Examines a cell. Its facets are lists_[first, end), the last facets of the list.
void BeamCells::look_at(const SlopeRect& rect, size_t first, size_t end, uint32_t level) {
  checkpoint();
  ++cells_;
  drop_hidden(rect, first);
  end = lists_.size();
  if (end - first > facets_of_leaf && level < most_levels) {
    const double a = bisect(rect.min_a, rect.max_a), b = bisect(rect.min_b, rect.max_b);
    // Angles that the sides span, up to a common factor.
    const bool across = (rect.max_a - rect.min_a) * std::sqrt(1.0 + b * b) >=
                        (rect.max_b - rect.min_b) * std::sqrt(1.0 + a * a);
    SlopeRect halves[2] = {rect, rect};
    if (across)
      halves[0].max_a = halves[1].min_a = a;
    else
      halves[0].max_b = halves[1].min_b = b;
    size_t counts[2] = {0, 0};
    for (int side = 0; side < 2; ++side)
      for (size_t i = first; i < end; ++i)
        counts[side] += view_->facets()[lists_[i]].box.overlaps(halves[side]);
    // The cell is not cut if both halves would hold nearly all facets, which would only do the work twice.
    if (10 * std::max(counts[0], counts[1]) < 9 * (end - first)) {
      for (const SlopeRect& half : halves) {
        for (size_t i = first; i < end; ++i)
          if (view_->facets()[lists_[i]].box.overlaps(half)) lists_.push_back(lists_[i]);
        look_at(half, end, lists_.size(), level + 1);
        lists_.resize(end);
      }
      return;
    }
  }
  settle_leaf(rect, first);
}

/// Returns the constraints of the rays that a polygon stops: its edges, moved outwards by the clearance so
/// that no gaps are left between neighbours, and the condition that the rays start well before the polygon.
std::span<const HalfPlane> BeamCells::outline(uint32_t polygon, const ViewFacet& facet) {
  Outline& known = outlines_[polygon];
  if (known.count == 0) {
    const ViewPolygon& shape = view_->polygons(facet)[polygon - facet.first_polygon];
    const std::span<const dvec2> corners = view_->corners(shape);
    const double wider = view_->clearance_m() / shape.max_depth;
    known.first = static_cast<uint32_t>(halves_.size());
    double area = 0.0;
    for (size_t i = 1; i + 1 < corners.size(); ++i) {
      const dvec2 u = corners[i] - corners[0], v = corners[i + 1] - corners[0];
      area += u.x * v.y - u.y * v.x;
    }
    const double sign = area < 0.0 ? -1.0 : 1.0;
    dvec2 before(0.0);
    const size_t count = corners.size();
    for (size_t i = 0; i <= count; ++i) {  // repeats the first edge, for the corner before it
      const dvec2 &from = corners[i % count], &to = corners[(i + 1) % count];
      const double length = glm::distance(from, to);
      if (length == 0.0) continue;
      const dvec2 inwards = sign / length * dvec2(from.y - to.y, to.x - from.x);
      if (i < count)
        halves_.push_back({inwards.x, inwards.y, wider - inwards.x * from.x - inwards.y * from.y});
      const dvec2 bisector = before + inwards;
      const double half = 0.5 * glm::length(bisector);  // sine of half the angle
      if (before != dvec2(0.0) && half < sharp) {
        const dvec2 back = half > 1e-9 ? bisector / (2.0 * half) : 1.0 / length * (to - from);
        halves_.push_back({back.x, back.y, wider - back.x * from.x - back.y * from.y});
      }
      before = inwards;
    }
    if (view_->beam().mirror != Beam::no_mirror && facet.start.least(view_->beam().window) < 0.0)
      halves_.push_back(facet.start);
    known.count = static_cast<uint32_t>(halves_.size()) - known.first;
  }
  return std::span(halves_).subspan(known.first, known.count);
}

bool BeamCells::covers(uint32_t index, const SlopeRect& rect) {
  const ViewFacet& facet = view_->facets()[index];
  const SlopeRect& box = facet.box;
  const double wider = view_->clearance_m() / facet.max_depth;
  if (box.min_a - wider > rect.min_a || box.max_a + wider < rect.max_a || box.min_b - wider > rect.min_b ||
      box.max_b + wider < rect.max_b)
    return false;
  for (uint32_t i = 0; i < facet.polygon_count; ++i) {
    const auto constraints = outline(facet.first_polygon + i, facet);
    if (std::all_of(constraints.begin(), constraints.end(),
                    [&](const HalfPlane& half) { return half.least(rect) >= 0.0; }))
      return true;
  }
  return false;
}

/// Removes the facets from the last list that are hidden by the nearest facet that fills the cell.
void BeamCells::drop_hidden(const SlopeRect& rect, size_t first) {
  uint32_t cover = ~0u;
  double nearest = 1e300;
  for (size_t i = first; i < lists_.size(); ++i) {
    const ViewFacet& facet = view_->facets()[lists_[i]];
    if (!facet.hides || (facet.kind != FacetKind::opaque && walls_ > 0)) continue;
    const double far = depths(facet, rect).second;
    if (far < nearest && covers(lists_[i], rect)) cover = lists_[i], nearest = far;
  }
  if (cover == ~0u) return;
  const ViewFacet& front = view_->facets()[cover];
  const auto hidden = [&](uint32_t index) {
    const ViewFacet& facet = view_->facets()[index];
    if (index == cover) return false;
    if (facet.is_wedge &&
        (facet.wedge_faces[0] == front.scene_facet || facet.wedge_faces[1] == front.scene_facet))
      return false;
    return in_front(front, facet).least(rect) > 0.0;
  };
  lists_.erase(std::remove_if(lists_.begin() + static_cast<ptrdiff_t>(first), lists_.end(), hidden),
               lists_.end());
}

void BeamCells::settle_leaf(const SlopeRect& rect, size_t first) {
  entries_.clear();
  for (size_t i = first; i < lists_.size(); ++i) {
    const auto [near, far] = depths(view_->facets()[lists_[i]], rect);
    entries_.push_back({lists_[i], near, far});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.min_depth != b.min_depth ? a.min_depth < b.min_depth : a.facet < b.facet;
  });
  covers_.clear();
  for (const Entry& entry : entries_) {
    const ViewFacet& facet = view_->facets()[entry.facet];
    for (uint32_t i = 0; facet.hides && i < facet.polygon_count; ++i)
      if (const SlopeRect& box = view_->polygons(facet)[i].box; box.overlaps(rect))
        covers_.add({box, entry.min_depth, entry.facet, facet.first_polygon + i});
  }
  covers_.build();
  for (const Entry& entry : entries_) {
    if (view_->facets()[entry.facet].is_wedge)
      settle_wedge(rect, entry);
    else
      settle_facet(rect, entry);
  }
}

/// Returns the half-plane of slopes where `cover` is in front of `facet`, with unit gradient unless it is
/// constant.
HalfPlane BeamCells::in_front(const ViewFacet& cover, const ViewFacet& facet) const {
  const double room = facet.is_wedge
                          ? view_->room_m()
                          : view_->room_between({cover.na, cover.nb, cover.n}, {facet.na, facet.nb, facet.n});
  const double reach = cover.distance + room + view_->rounding_m();
  const double distance = facet.distance - view_->rounding_m();
  if (reach <= 0.0 || distance <= 0.0) return {0.0, 0.0, -1.0};  // the apex almost lies in its plane
  HalfPlane front{cover.na * distance - facet.na * reach, cover.nb * distance - facet.nb * reach,
                  cover.n * distance - facet.n * reach};
  const double gradient = std::sqrt(front.a * front.a + front.b * front.b);
  if (gradient <= 1e-15 * (distance + reach))
    return {0.0, 0.0, front.c > 1e-14 * (distance + reach) ? 1.0 : -1.0};
  return {front.a / gradient, front.b / gradient, front.c / gradient};
}

// The functions below find the lit parts of the facets and edges of a leaf: they subtract everything in
// front.

/// Returns the sides of the cell and of the beam.
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

/// Tells whether every path that passes both walls counts them as two. Walls in one plane count as one at the
/// crossings (shaders/rf/crossings.comp.glsl).
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

/// Counts a wall in front of a piece. Returns false if that is one wall too many.
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

/// Subtracts everything in front from a polygon. The rest is lit.
void BeamCells::settle_polygon(const ViewFacet& facet, const Entry& entry, const Convex& whole) {
  pieces_.start(whole);
  const SlopeRect box = whole.box();
  double cut_by = 0.0;
  uint32_t front_of = ~0u;
  HalfPlane front;
  const bool dark = covers_.visit_until(box, entry.max_depth, [&](const LeafCover& other) {
    if (other.facet == entry.facet) return false;
    const ViewFacet& cover = view_->facets()[other.facet];
    if (other.facet != front_of) front = in_front(cover, facet), front_of = other.facet;
    if (front.most(box) <= 0.0) return false;
    const auto constraints = outline(other.polygon, cover);
    if (std::any_of(constraints.begin(), constraints.end(),
                    [&](const HalfPlane& half) { return half.most(box) <= 0.0; }))
      return false;
    const bool stops = cover.kind == FacetKind::opaque || walls_ == 0;
    pieces_.subtract(front, constraints, [&](LitPiece& piece) {
      return !stops && passes_one_more(piece.passed, piece.walls, other.facet);
    });
    const ViewPolygon& shape = view_->polygons(cover)[other.polygon - cover.first_polygon];
    cut_by = std::max(cut_by, view_->clearance_m() / shape.max_depth);
    return pieces_.empty();
  });
  if (dark) return;
  pieces_.for_each([&](const LitPiece& piece) {
    add_to(regions_[entry.facet * (walls_ + 1) + piece.walls], facet, piece.shape, cut_by);
  });
}

/// Does the same for an edge, which is lit if any part of it is lit.
void BeamCells::settle_wedge(const SlopeRect& rect, const Entry& entry) {
  if (lit_[entry.facet]) return;
  const ViewFacet& wedge = view_->facets()[entry.facet];
  const dvec2 &a = wedge.ends[0], &b = wedge.ends[1];
  const std::array<HalfPlane, 8> sides = sides_of(rect);
  Interval whole;
  for (const HalfPlane& side : sides)
    if (!cut(side, a, b, whole.from, whole.to)) return;
  intervals_.assign(1, whole);
  const bool dark = covers_.visit_until(wedge.box, entry.max_depth, [&](const LeafCover& other) {
    const ViewFacet& cover = view_->facets()[other.facet];
    if (cover.scene_facet == wedge.wedge_faces[0] || cover.scene_facet == wedge.wedge_faces[1]) return false;
    double from = 0.0, to = 1.0;
    if (!cut(in_front(cover, wedge), a, b, from, to)) return false;
    const auto constraints = outline(other.polygon, cover);
    if (!std::all_of(constraints.begin(), constraints.end(),
                     [&](const HalfPlane& half) { return cut(half, a, b, from, to); }))
      return false;
    next_intervals_.clear();
    for (const Interval& interval : intervals_) subtract(interval, other.facet, from, to);
    std::swap(intervals_, next_intervals_);
    return intervals_.empty();
  });
  if (!dark) lit_[entry.facet] = 1;
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

/// Adds the region of the facet onto which a part of its projection falls. `pad` (slopes) widens the part.
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
