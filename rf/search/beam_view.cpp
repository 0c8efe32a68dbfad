// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/beam_view.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/rf.h"

namespace greatx::rf {
namespace {

constexpr double least_sine = 0.1;  ///< least sine between planes that count as meeting at an angle

double longest_direction_in(const SlopeRect& rect) {
  const double a = std::max(std::abs(rect.min_a), std::abs(rect.max_a));
  const double b = std::max(std::abs(rect.min_b), std::abs(rect.max_b));
  return std::sqrt(1.0 + a * a + b * b);
}

double sine_between(const dvec3& a, const dvec3& b) { return glm::length(glm::cross(a, b)); }

/// Keeps the part of a segment with z >= least. Returns false if nothing is left.
bool cut_depth(dvec3& from, dvec3& to, double least) {
  if (from.z < least && to.z < least) return false;
  if (from.z >= least && to.z >= least) return true;
  const dvec3 between = from + (least - from.z) / (to.z - from.z) * (to - from);
  (from.z < least ? from : to) = between;
  return true;
}

}  // namespace

void BeamView::look(const Beam& beam, double clearance_m, uint32_t transparent_body, bool wedges) {
  beam_ = beam;
  facets_.clear();
  polygons_.clear();
  corners_.clear();
  gathered_.clear();
  examined_ = 0;
  longest_direction_ = longest_direction_in(beam.window);
  const double coordinate = std::max(
      {scene_->largest_coordinate(), std::abs(beam.apex.x), std::abs(beam.apex.y), std::abs(beam.apex.z)});
  rounding_m_ = 1e-13 * coordinate;
  const double mesh_m = 4.0 * 0x1p-24 * scene_->largest_coordinate();
  clearance_m_ = clearance_m > 0.0 ? clearance_m + mesh_m : 0.0;
  const double reach = beam.mirror == Beam::no_mirror ? coordinate : scene_->largest_coordinate();
  room_m_ = 4.0 * shared::visibility_tolerance(static_cast<float>(reach)) + rounding_m_;

  const double slack = 2e-4 + mesh_m + rounding_m_;
  const auto side = [&](const dvec3& normal, double beyond) {
    return HalfSpace{normal, glm::dot(normal, beam.apex) + beyond - slack * (1.0 + glm::length(normal))};
  };
  const HalfSpace region[] = {side(beam.right - beam.window.min_a * beam.forward, 0.0),
                              side(beam.window.max_a * beam.forward - beam.right, 0.0),
                              side(beam.up - beam.window.min_b * beam.forward, 0.0),
                              side(beam.window.max_b * beam.forward - beam.up, 0.0),
                              side(beam.forward, beam.near_m)};
  scene_->gather_polygons(region, gathered_);
  for (size_t first = 0, end = 0; first < gathered_.size(); first = end) {
    const uint32_t facet = scene_->polygon(gathered_[first]).facet;
    while (end < gathered_.size() && scene_->polygon(gathered_[end]).facet == facet) ++end;
    if (facet != beam.mirror)
      add_facet(facet, std::span(gathered_).subspan(first, end - first), transparent_body);
  }
  if (!wedges) return;
  gathered_.clear();
  scene_->gather_wedges(region, gathered_);
  for (const uint32_t wedge : gathered_) add_wedge(scene_->wedge(wedge));
}

double BeamView::room_between(const dvec3& normal, const dvec3& other) const {
  if (clearance_m_ == 0.0) return room_m_;
  const double sine = sine_between(normal, other);
  return sine < least_sine ? room_m_ : -clearance_m_ * sine;
}

void BeamView::add_facet(uint32_t scene_facet, std::span<const uint32_t> polygons,
                         uint32_t transparent_body) {
  const BeamFacet& facet = scene_->facet(scene_facet);
  const double ahead = facet.offset - glm::dot(facet.normal, beam_.apex);
  if (std::abs(ahead) <= 0.5 * facet.tolerance_m) return;  // edge-on: it neither reflects nor blocks
  const double sign = ahead > 0.0 ? 1.0 : -1.0;
  ViewFacet view;
  view.scene_facet = scene_facet;
  view.kind = facet.kind;
  view.n = sign * glm::dot(facet.normal, beam_.forward);
  view.na = sign * glm::dot(facet.normal, beam_.right);
  view.nb = sign * glm::dot(facet.normal, beam_.up);
  view.distance = std::abs(ahead);
  view.min_depth = 1e300, view.max_depth = -1e300;
  view.box = SlopeRect::none();
  view.first_polygon = static_cast<uint32_t>(polygons_.size());
  double least_depth = 0.5 * view.distance / longest_direction_, least_rise = -1e300;
  if (beam_.mirror != Beam::no_mirror) {
    const BeamFacet& mirror = scene_->facet(beam_.mirror);
    least_depth = beam_.near_m - mirror.tolerance_m - facet.tolerance_m - rounding_m_;
    least_rise = std::max(0.5 * mirror.tolerance_m, -room_between(facet.normal, mirror.normal));
  }
  bool above = false;
  for (const uint32_t polygon : polygons)
    above = add_polygon(view, scene_->corners(scene_->polygon(polygon)), least_depth, least_rise) || above;
  view.polygon_count = static_cast<uint32_t>(polygons_.size()) - view.first_polygon;
  // A facet in the mirror's plane has no path. A facet that rises from this plane by less than the clearance
  // has no path that is clear of edges.
  if (view.polygon_count == 0 || !above) {
    polygons_.resize(view.first_polygon);
    return;
  }
  view.hides = facet.owner != transparent_body;
  find_start(view, facet);
  facets_.push_back(view);
}

/// Projects the part of a polygon that is deeper than the mirror. Returns true if there is such a part and it
/// rises above the mirror by more than `least_rise`.
bool BeamView::add_polygon(ViewFacet& view, std::span<const uint32_t> vertices, double least_depth,
                           double least_rise) {
  ++examined_;
  constexpr size_t most = Convex::capacity;
  dvec3 at[most];
  const dvec3 normal(view.na, view.nb, view.n);
  size_t count = 0;
  double max_depth = -1e300;
  for (const uint32_t vertex : vertices) {
    dvec3 corner = in_frame(scene_->vertex(vertex));
    corner -= (glm::dot(normal, corner) - view.distance) * normal;  // moves it into the reflecting plane
    max_depth = std::max(max_depth, corner.z);
    at[count++] = corner;
  }
  if (max_depth < least_depth || max_depth <= 0.0) return false;
  ViewPolygon polygon;
  polygon.first = static_cast<uint32_t>(corners_.size());
  polygon.box = SlopeRect::none();
  double min_depth = 1e300;
  const auto add = [&](const dvec3& point) {
    // A point that touches the mirror may be behind it by a rounding. The ray starts at the mirror.
    const double depth = std::max(point.z, beam_.near_m);
    const dvec2 slopes(point.x / depth, point.y / depth);
    min_depth = std::min(min_depth, depth);
    polygon.box.add(slopes);
    corners_.push_back(slopes);
  };
  for (size_t i = 0; i < count; ++i) {
    const dvec3 &from = at[i], &to = at[(i + 1) % count];
    if (from.z >= least_depth) add(from);
    if ((from.z >= least_depth) != (to.z >= least_depth))
      add(from + (least_depth - from.z) / (to.z - from.z) * (to - from));
  }
  polygon.count = static_cast<uint32_t>(corners_.size()) - polygon.first;
  polygon.max_depth = max_depth;
  if (polygon.count < 3 || !polygon.box.overlaps(beam_.window)) {
    corners_.resize(polygon.first);
    return false;
  }
  polygons_.push_back(polygon);
  for (uint32_t i = 0; i < polygon.count; ++i) view.box.add(corners_[polygon.first + i]);
  view.min_depth = std::min(view.min_depth, min_depth);
  view.max_depth = std::max(view.max_depth, max_depth);
  return max_depth - beam_.near_m > least_rise;
}

/// Finds the rays that a facet stops: those that start well before it. The other rays are decided where the
/// mirror is met.
void BeamView::find_start(ViewFacet& view, const BeamFacet& facet) {
  if (beam_.mirror == Beam::no_mirror) {
    view.hides = view.hides && view.distance >= room_m_;
    return;
  }
  const double room = room_between(facet.normal, scene_->facet(beam_.mirror).normal);
  const double near = beam_.near_m;
  view.start = {-view.na * near, -view.nb * near, view.distance - room - view.n * near};
  view.hides = view.hides && view.start.most(beam_.window) > 0.0;
}

void BeamView::add_wedge(const BeamWedge& wedge) {
  dvec3 from = in_frame(wedge.a), to = in_frame(wedge.b);
  const bool mirrored = beam_.mirror != Beam::no_mirror;
  const double tolerance = mirrored ? scene_->facet(beam_.mirror).tolerance_m : 0.0;
  const double above = std::max(from.z, to.z) - beam_.near_m;
  if (above <= 0.5 * tolerance) return;  // in the mirror's plane: no path
  if (above <= clearance_m_)
    for (const uint32_t face : wedge.faces)
      if (mirrored && face == beam_.mirror) return;

  ViewFacet view;
  view.is_wedge = true;
  view.scene_facet = wedge.index;
  view.wedge_faces[0] = wedge.faces[0], view.wedge_faces[1] = wedge.faces[1];
  // Any plane through the edge serves to compare depths. This plane faces the apex.
  const dvec3 along = glm::normalize(to - from);
  const dvec3 foot = from - glm::dot(from, along) * along;
  view.distance = glm::length(foot);
  if (view.distance <= rounding_m_) return;  // the apex is on the edge's line: there is no cone
  view.na = foot.x / view.distance, view.nb = foot.y / view.distance, view.n = foot.z / view.distance;
  const double least_depth =
      mirrored ? beam_.near_m - tolerance - rounding_m_ : 0.5 * view.distance / longest_direction_;
  if (!cut_depth(from, to, least_depth)) return;
  view.min_depth = 1e300, view.max_depth = -1e300;
  view.box = SlopeRect::none();
  const dvec3 ends[] = {from, to};
  for (int k = 0; k < 2; ++k) {
    const double depth = std::max(ends[k].z, beam_.near_m);
    view.ends[k] = {ends[k].x / depth, ends[k].y / depth};
    view.box.add(view.ends[k]);
    view.min_depth = std::min(view.min_depth, depth);
    view.max_depth = std::max(view.max_depth, depth);
  }
  if (view.box.overlaps(beam_.window)) facets_.push_back(view);
}

}  // namespace greatx::rf
