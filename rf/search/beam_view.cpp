// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/beam_view.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/rf.h"

namespace greatx::rf {
namespace {

constexpr uint32_t none = ~0u;

/// An end of an edge that is being cut: where it is in the beam's frame, and its vertex if it is still that.
struct CutEnd {
  dvec3 at;
  uint32_t vertex;
};

/// Keeps what has side(point) >= 0, a linear function; false: nothing.
template <typename Side>
bool cut(CutEnd& from, CutEnd& to, const Side& side) {
  const double at_from = side(from.at), at_to = side(to.at);
  if (at_from < 0.0 && at_to < 0.0) return false;
  if (at_from >= 0.0 && at_to >= 0.0) return true;
  const dvec3 between = from.at + at_from / (at_from - at_to) * (to.at - from.at);
  (at_from < 0.0 ? from : to) = {between, none};
  return true;
}

double direction_length(double a, double b) { return std::sqrt(1.0 + a * a + b * b); }

double longest_direction_in(const SlopeRect& rect) {
  return direction_length(std::max(std::abs(rect.min_a), std::abs(rect.max_a)),
                          std::max(std::abs(rect.min_b), std::abs(rect.max_b)));
}

}  // namespace

void BeamView::look(const Beam& beam, bool edge_strips, bool wedges) {
  beam_ = beam;
  facets_.clear();
  edges_.clear();
  gathered_.clear();
  const double width = beam.window.max_a - beam.window.min_a, height = beam.window.max_b - beam.window.min_b;
  clip_ = {beam.window.min_a - 0.5 * width, beam.window.max_a + 0.5 * width, beam.window.min_b - 0.5 * height,
           beam.window.max_b + 0.5 * height};
  longest_direction_ = longest_direction_in(beam.window);
  longest_clip_ = longest_direction_in(clip_);
  const double coordinate = std::max(
      {scene_->largest_coordinate(), std::abs(beam.apex.x), std::abs(beam.apex.y), std::abs(beam.apex.z)});
  rounding_m_ = 1e-13 * coordinate;
  mesh_m_ = 4.0 * 0x1p-24 * scene_->largest_coordinate();
  const double reach = beam.mirror == Beam::no_mirror ? coordinate : scene_->largest_coordinate();
  room_m_ = 4.0 * shared::visibility_tolerance(static_cast<float>(reach)) + rounding_m_;

  const double slack = 2e-4 + mesh_m_ + rounding_m_;
  const auto side = [&](const dvec3& normal, double beyond) {
    return HalfSpace{normal, glm::dot(normal, beam.apex) + beyond - slack * (1.0 + glm::length(normal))};
  };
  const HalfSpace region[] = {side(beam.right - beam.window.min_a * beam.forward, 0.0),
                              side(beam.window.max_a * beam.forward - beam.right, 0.0),
                              side(beam.up - beam.window.min_b * beam.forward, 0.0),
                              side(beam.window.max_b * beam.forward - beam.up, 0.0),
                              side(beam.forward, beam.near_m)};
  if (beam.mirror != Beam::no_mirror) add_mirror();
  scene_->gather(region, gathered_);
  for (const uint32_t facet : gathered_)
    if (facet != beam.mirror) add_facet(facet, edge_strips);
  if (!wedges) return;
  for (const uint32_t facet : gathered_)
    for (const BeamWedge& wedge : scene_->wedges(scene_->facet(facet))) add_wedge(wedge, edge_strips);
}

void BeamView::add_mirror() {
  const BeamFacet& facet = scene_->facet(beam_.mirror);
  ViewFacet view;
  view.role = ViewFacet::Role::mirror;
  view.scene_facet = beam_.mirror;
  view.regular = facet.regular;
  view.n = 1.0;
  view.distance = view.min_depth = view.max_depth = beam_.near_m;
  view.first_edge = static_cast<uint32_t>(edges_.size());
  for (const BeamBorder& border : scene_->borders(facet)) {
    dvec3 from = in_frame(scene_->vertex(border.from)), to = in_frame(scene_->vertex(border.to));
    from.z = to.z = beam_.near_m;
    ViewEdge edge{};
    edge.edge = border.edge, edge.vertices[0] = border.from, edge.vertices[1] = border.to;
    add_edge(view, from, to, 2.0 * facet.tolerance_m + rounding_m_, 0.0, edge);
  }
  finish(view);
}

bool BeamView::hidden_by_its_mirror(const BeamFacet& facet, const ViewFacet& view, bool edge_strips) const {
  if (beam_.mirror == Beam::no_mirror) return false;
  const BeamFacet& mirror = scene_->facet(beam_.mirror);
  // What lies in the mirror's plane: the image method takes no two reflections of one plane in one point, nor of an
  // edge that the second facet does not rise from (joins_as_corner in rf/geometry.cpp).
  const bool never_a_path = std::all_of(corners_.begin(), corners_.end(), [&](const dvec3& corner) {
    const double above = corner.z - beam_.near_m;
    return above <= 0.5 * mirror.tolerance_m &&
           above * glm::length(corner) <= 2.0 * (mirror.tolerance_m + facet.tolerance_m) * beam_.near_m;
  });
  if (never_a_path) return true;
  return !edge_strips && view.max_depth - beam_.near_m <= 0.25 * room_m_ &&
         scene_->meet_at_an_angle(beam_.mirror, view.scene_facet);
}

void BeamView::add_facet(uint32_t scene_facet, bool edge_strips) {
  const BeamFacet& facet = scene_->facet(scene_facet);
  const double ahead = facet.offset - glm::dot(facet.normal, beam_.apex);
  if (std::abs(ahead) <= 0.5 * facet.tolerance_m) return;  // edge-on: neither a mirror nor in anything's way
  const double sign = ahead > 0.0 ? 1.0 : -1.0;
  ViewFacet view;
  view.scene_facet = scene_facet;
  view.kind = facet.kind;
  view.regular = facet.regular;
  view.n = sign * glm::dot(facet.normal, beam_.forward);
  view.na = sign * glm::dot(facet.normal, beam_.right);
  view.nb = sign * glm::dot(facet.normal, beam_.up);
  view.distance = std::abs(ahead);

  const auto borders = scene_->borders(facet);
  const dvec3 normal(view.na, view.nb, view.n);
  corners_.clear();
  view.min_depth = 1e300, view.max_depth = -1e300;
  for (const BeamBorder& border : borders) {
    for (const uint32_t vertex : {border.from, border.to}) {
      dvec3 corner = in_frame(scene_->vertex(vertex));
      corner -= (glm::dot(normal, corner) - view.distance) * normal;  // into the plane, where facets reflect
      corners_.push_back(corner);
      view.min_depth = std::min(view.min_depth, corner.z);
      view.max_depth = std::max(view.max_depth, corner.z);
    }
  }
  const double mirror_tolerance =
      beam_.mirror == Beam::no_mirror ? 0.0 : scene_->facet(beam_.mirror).tolerance_m;
  view.contact_m = mirror_tolerance + facet.tolerance_m + rounding_m_;
  if (view.max_depth < beam_.near_m - view.contact_m || view.max_depth <= 0.0) return;
  if (hidden_by_its_mirror(facet, view, edge_strips)) return;

  const double least_depth =
      beam_.mirror == Beam::no_mirror ? 0.5 * view.distance / longest_clip_ : beam_.near_m - view.contact_m;
  const double displacement = facet.deviation_m + 2.0 * facet.tolerance_m + mesh_m_ + rounding_m_;
  view.first_edge = static_cast<uint32_t>(edges_.size());
  for (size_t i = 0; i < borders.size(); ++i) {
    ViewEdge edge{};
    edge.edge = borders[i].edge, edge.vertices[0] = borders[i].from, edge.vertices[1] = borders[i].to;
    edge.left = (borders[i].from < borders[i].to) == (ahead > 0.0);
    add_edge(view, corners_[2 * i], corners_[2 * i + 1], displacement, least_depth, edge);
  }
  view.max_depth += view.contact_m;
  view.min_depth = std::max(view.min_depth - view.contact_m, std::max(least_depth, beam_.near_m));
  finish(view);
}

void BeamView::add_wedge(const BeamWedge& wedge, bool edge_strips) {
  ViewFacet view;
  view.role = ViewFacet::Role::wedge;
  view.scene_facet = wedge.index;
  view.wedge_faces[0] = wedge.faces[0], view.wedge_faces[1] = wedge.faces[1];
  const dvec3 from = in_frame(wedge.a), to = in_frame(wedge.b);
  const double tolerance = beam_.mirror == Beam::no_mirror ? 0.0 : scene_->facet(beam_.mirror).tolerance_m;
  view.max_depth = std::max(from.z, to.z), view.min_depth = std::min(from.z, to.z);
  if (view.max_depth <= beam_.near_m + 0.5 * tolerance) return;  // in the mirror's plane: no path
  if (!edge_strips && view.max_depth <= beam_.near_m + 0.25 * room_m_)
    for (const uint32_t face : wedge.faces)
      if (face == beam_.mirror && face != none) return;

  // Any plane through the edge will do to compare depths; this one faces the apex.
  const dvec3 along = glm::normalize(to - from);
  const dvec3 foot = from - glm::dot(from, along) * along;
  view.distance = glm::length(foot);
  if (view.distance > 0.0)
    view.na = foot.x / view.distance, view.nb = foot.y / view.distance, view.n = foot.z / view.distance;
  view.contact_m = tolerance + rounding_m_;
  const double least_depth =
      beam_.mirror == Beam::no_mirror ? 0.5 * view.distance / longest_clip_ : beam_.near_m - view.contact_m;
  view.first_edge = static_cast<uint32_t>(edges_.size());
  ViewEdge edge{};
  edge.edge = edge.vertices[0] = edge.vertices[1] = none;
  add_edge(view, from, to, 2e-4 + mesh_m_ + rounding_m_, least_depth, edge);
  view.max_depth += view.contact_m;
  view.min_depth = std::max(view.min_depth - view.contact_m, std::max(least_depth, beam_.near_m));
  if (edges_.size() > view.first_edge) finish(view);
}

void BeamView::add_edge(ViewFacet&, dvec3 from, dvec3 to, double displacement_m, double least_depth,
                        ViewEdge edge) {
  CutEnd ends[2] = {{from, edge.vertices[0]}, {to, edge.vertices[1]}};
  if (!cut(ends[0], ends[1], [&](const dvec3& at) { return at.z - least_depth; })) return;
  // What touches the mirror may be behind it by a rounding: a ray starts there, not farther back.
  for (CutEnd& end : ends) end.at.z = std::max(end.at.z, beam_.near_m);
  if (!cut(ends[0], ends[1], [&](const dvec3& at) { return at.x - clip_.min_a * at.z; })) return;
  if (!cut(ends[0], ends[1], [&](const dvec3& at) { return clip_.max_a * at.z - at.x; })) return;
  if (!cut(ends[0], ends[1], [&](const dvec3& at) { return at.y - clip_.min_b * at.z; })) return;
  if (!cut(ends[0], ends[1], [&](const dvec3& at) { return clip_.max_b * at.z - at.y; })) return;
  double nearest = 1e300, longest = 0.0;
  for (int k = 0; k < 2; ++k) {
    edge.ends[k] = {ends[k].at.x / ends[k].at.z, ends[k].at.y / ends[k].at.z};
    edge.vertices[k] = ends[k].vertex;
    nearest = std::min(nearest, ends[k].at.z);
    longest = std::max(longest, direction_length(edge.ends[k].x, edge.ends[k].y));
  }
  // A point moved by d at depth z is seen elsewhere by at most d (1 + |direction|) / z in slopes.
  edge.room = displacement_m * (1.0 + longest) / nearest + 1e-14 * longest;
  edge.min_a = std::min(edge.ends[0].x, edge.ends[1].x) - edge.room;
  edge.max_a = std::max(edge.ends[0].x, edge.ends[1].x) + edge.room;
  edge.min_b = std::min(edge.ends[0].y, edge.ends[1].y) - edge.room;
  edge.max_b = std::max(edge.ends[0].y, edge.ends[1].y) + edge.room;
  const dvec2 along = edge.ends[1] - edge.ends[0];
  const double length = std::hypot(along.x, along.y);
  edge.normal_a = length > 0.0 ? -along.y / length : 0.0;
  edge.normal_b = length > 0.0 ? along.x / length : 0.0;
  edge.offset = edge.normal_a * edge.ends[0].x + edge.normal_b * edge.ends[0].y;
  edges_.push_back(edge);
}

void BeamView::finish(ViewFacet& view) {
  view.edge_count = static_cast<uint32_t>(edges_.size()) - view.first_edge;
  const SlopeRect& window = beam_.window;
  SlopeRect around{1e300, -1e300, 1e300, -1e300};
  for (uint32_t i = view.first_edge; i < edges_.size(); ++i) {
    around.min_a = std::min(around.min_a, edges_[i].min_a),
    around.max_a = std::max(around.max_a, edges_[i].max_a);
    around.min_b = std::min(around.min_b, edges_[i].min_b),
    around.max_b = std::max(around.max_b, edges_[i].max_b);
  }
  if (view.edge_count == 0) around = window;
  view.extent = std::max(std::min(around.max_a, window.max_a) - std::max(around.min_a, window.min_a),
                         std::min(around.max_b, window.max_b) - std::max(around.min_b, window.min_b));
  facets_.push_back(view);
}

bool BeamView::contains(const ViewFacet& view, double a, double b) const {
  const double depth = view.distance / view.slope_sum(a, b);
  const dvec3 point = beam_.apex + depth * (a * beam_.right + b * beam_.up + beam_.forward);
  const uint32_t facet = scene_->facet(view.scene_facet).index;
  return scene_->world().contains(facet, scene_->world().facet(facet).plane_coordinates(point));
}

}  // namespace greatx::rf
