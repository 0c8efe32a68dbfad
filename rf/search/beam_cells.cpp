// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/beam_cells.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/watch.h"

namespace greatx::rf {
namespace {

/// Cells with fewer facets are not worth cutting; nor are those that have been cut so often.
constexpr size_t facets_of_leaf = 24;
constexpr uint32_t most_levels = 24;
/// Corners sharper than this (sine of half the angle) are blunted when an outline is moved outwards.
constexpr double sharp = 0.3;

/// Slope halfway between two directions, by angle.
double bisect(double a, double b) {
  const double length_a = std::sqrt(1.0 + a * a), length_b = std::sqrt(1.0 + b * b);
  return (a * length_b + b * length_a) / (length_a + length_b);
}

/// Least and largest depth at which rays of a cell meet a plane.
std::pair<double, double> depths(const ViewFacet& facet, const SlopeRect& rect) {
  const HalfPlane sum{facet.na, facet.nb, facet.n};
  const double least = sum.least(rect), most = sum.most(rect);
  return {most > 0.0 ? std::max(facet.min_depth, facet.distance / most) : facet.max_depth,
          least > 0.0 ? std::min(facet.max_depth, facet.distance / least) : facet.max_depth};
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

/// The cell's facets are lists_[first, end), the last ones of the list.
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
    // Not where cutting would but do the same work twice.
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

/// Constraints of a polygon's rays: its edges, moved outwards by the clearance so that no gaps are left between
/// neighbours, and that they start well before it.
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
    for (size_t i = 0; i <= count; ++i) {  // the first edge again, for the corner before it
      const dvec2 &from = corners[i % count], &to = corners[(i + 1) % count];
      const double length = std::hypot(to.x - from.x, to.y - from.y);
      if (length == 0.0) continue;
      const dvec2 inwards = sign / length * dvec2(from.y - to.y, to.x - from.x);
      if (i < count)
        halves_.push_back({inwards.x, inwards.y, wider - inwards.x * from.x - inwards.y * from.y});
      const dvec2 bisector = before + inwards;
      const double half = 0.5 * std::hypot(bisector.x, bisector.y);  // sine of half the angle
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

/// Takes what the nearest facet that fills the cell hides off the last list.
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
  for (const Entry& entry : entries_) {
    if (view_->facets()[entry.facet].is_wedge)
      settle_wedge(rect, entry);
    else
      settle_facet(rect, entry);
  }
}

/// Where `cover` is in front of `facet`, in slopes; of unit gradient where it has one.
HalfPlane BeamCells::in_front(const ViewFacet& cover, const ViewFacet& facet) const {
  const double room = facet.is_wedge
                          ? view_->room_m()
                          : view_->room_between({cover.na, cover.nb, cover.n}, {facet.na, facet.nb, facet.n});
  const double reach = cover.distance + room + view_->rounding_m();
  const double distance = facet.distance - view_->rounding_m();
  if (reach <= 0.0 || distance <= 0.0) return {0.0, 0.0, -1.0};  // the apex is all but in its plane
  HalfPlane front{cover.na * distance - facet.na * reach, cover.nb * distance - facet.nb * reach,
                  cover.n * distance - facet.n * reach};
  const double gradient = std::hypot(front.a, front.b);
  if (gradient <= 1e-15 * (distance + reach))
    return {0.0, 0.0, front.c > 1e-14 * (distance + reach) ? 1.0 : -1.0};
  return {front.a / gradient, front.b / gradient, front.c / gradient};
}

}  // namespace greatx::rf
