// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/gradient/path_continuation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/error.h"
#include "rf/edges/diffraction.h"

namespace greatx::rf {
namespace {

bool is_bend(const Interaction& interaction) {
  return interaction.type == InteractionType::diffraction || interaction.type == InteractionType::scattering;
}

dvec3 image_in(const PosedFacet& facet, const dvec3& point) {
  return point - 2.0 * facet.distance(point) * facet.normal;
}

/// A line along an edge: point + z direction.
struct EdgeLine {
  dvec3 point{0.0}, direction{0.0};
  double length_m = 0.0, tolerance_m = 0.0;
  dvec3 at(double z) const { return point + z * direction; }
  bool holds(double z) const { return z >= -tolerance_m && z <= length_m + tolerance_m; }
  double place(const dvec3& of) const { return glm::dot(of - point, direction); }
};

/// Follows one sequence of interactions from end to end.
class Continuer {
 public:
  Continuer(const GeometricPath& path, const FacetWorld& world, std::span<const scene::Wedge> wedges,
            const dvec3& transmitter, const dvec3& receiver)
      : old_(path), world_(world), wedges_(wedges) {
    new_.path = path;
    new_.path.vertices.front() = transmitter;
    new_.path.vertices.back() = receiver;
    new_.path.edge_sides = {};
    new_.path.keller_side = KellerSide::by_place;
    for (size_t i = 0; i < path.interactions.size(); ++i)
      if (is_bend(path.interactions[i])) bends_.push_back(i + 1);
  }

  ContinuedPath solve() {
    if (!place_bends()) return lost();
    double length_m = 0.0;
    size_t from = 0;
    for (size_t part = 0; part <= bends_.size(); ++part) {
      const size_t to = part < bends_.size() ? bends_[part] : old_.vertices.size() - 1;
      const std::optional<double> part_m = place_reflections(from, to);
      if (!part_m) return lost();
      length_m += *part_m;
      from = to;
    }
    new_.path.length_m = length_m;
    place_passages();
    return std::move(new_);
  }

 private:
  ContinuedPath lost() {
    new_.state = Continuation::lost;
    return std::move(new_);
  }
  void mark_beyond() { new_.state = Continuation::beyond; }
  const Interaction& at(size_t vertex) const { return old_.interactions[vertex - 1]; }
  dvec3& vertex(size_t index) { return new_.path.vertices[index]; }

  /// Tells whether a bend moves along an edge.
  bool slides(size_t bend) const {
    return at(bend).type == InteractionType::diffraction && at(bend).patch == 0;
  }
  EdgeLine edge_of(size_t bend) const {
    GREATX_CHECK(at(bend).element < wedges_.size(), "wedge {} of {}", at(bend).element, wedges_.size());
    const scene::Wedge wedge = posed(wedges_[at(bend).element], world_);
    return {wedge.a, glm::normalize(wedge.b - wedge.a), glm::distance(wedge.a, wedge.b),
            edge_tolerance_m(wedge)};
  }
  /// Returns the image of a vertex in the mirrors between it and another vertex, as seen from there.
  dvec3 image(size_t of, size_t from) {
    dvec3 point = vertex(of);
    const int step = of < from ? 1 : -1;
    for (size_t i = of; i != from; i += static_cast<size_t>(step))
      if (i != of && at(i).type == InteractionType::reflection)
        point = image_in(world_.facet(at(i).element), point);
    return point;
  }

  bool place_bends() {
    for (size_t i = 0; i < bends_.size(); ++i) {
      if (!slides(bends_[i])) continue;
      const size_t before = i == 0 ? 0 : bends_[i - 1];
      const bool two = i + 1 < bends_.size() && slides(bends_[i + 1]);
      const size_t after_bend = i + (two ? 2 : 1);
      const size_t after = after_bend < bends_.size() ? bends_[after_bend] : old_.vertices.size() - 1;
      const dvec3 source = image(before, bends_[i]), target = image(after, bends_[after_bend - 1]);
      if (!(two ? place_two(i, source, target) : place_one(bends_[i], source, target))) return false;
      if (two) ++i;
    }
    return true;
  }

  /// Keller's point: the distances from the line divide the way along it.
  bool place_one(size_t bend, const dvec3& source, const dvec3& target) {
    const EdgeLine edge = edge_of(bend);
    const double z_source = edge.place(source), z_target = edge.place(target);
    const double d_source = glm::distance(source, edge.at(z_source)),
                 d_target = glm::distance(target, edge.at(z_target));
    if (d_source <= edge.tolerance_m || d_target <= edge.tolerance_m) return false;
    const double z = (z_source * d_target + z_target * d_source) / (d_source + d_target);
    if (!edge.holds(z)) mark_beyond();
    vertex(bend) = edge.at(z);
    return true;
  }

  /// The length over both lines is convex. Newton's method starts from the points of the path and halves
  /// steps that lengthen the way.
  bool place_two(size_t first, const dvec3& source, const dvec3& target) {
    const EdgeLine edges[2] = {edge_of(bends_[first]), edge_of(bends_[first + 1])};
    dvec2 z{edges[0].place(old_.vertices[bends_[first]]), edges[1].place(old_.vertices[bends_[first + 1]])};
    const auto length = [&](const dvec2& places) {
      const dvec3 p = edges[0].at(places.x), q = edges[1].at(places.y);
      return glm::distance(source, p) + glm::distance(p, q) + glm::distance(q, target);
    };
    constexpr int most_steps = 100;
    for (int i = 0; i < most_steps; ++i) {
      const dvec3 p = edges[0].at(z.x), q = edges[1].at(z.y);
      const double r[3] = {glm::distance(source, p), glm::distance(p, q), glm::distance(q, target)};
      if (std::min({r[0], r[1], r[2]}) <= 1e-9) return false;
      const dvec3 u[3] = {(p - source) / r[0], (q - p) / r[1], (target - q) / r[2]};
      const dvec3 &t0 = edges[0].direction, &t1 = edges[1].direction;
      const double c00 = glm::dot(t0, u[0]), c01 = glm::dot(t0, u[1]), c11 = glm::dot(t1, u[1]),
                   c12 = glm::dot(t1, u[2]);
      const dvec2 slope{c00 - c01, c11 - c12};
      const double h00 = (1.0 - c00 * c00) / r[0] + (1.0 - c01 * c01) / r[1],
                   h11 = (1.0 - c11 * c11) / r[1] + (1.0 - c12 * c12) / r[2],
                   h01 = -(glm::dot(t0, t1) - c01 * c11) / r[1];
      const double determinant = h00 * h11 - h01 * h01;
      if (!(determinant > 0.0)) return false;
      dvec2 step = dvec2(h01 * slope.y - h11 * slope.x, h01 * slope.x - h00 * slope.y) / determinant;
      const double now_m = length(z);
      while (length(z + step) > now_m * (1.0 + 1e-14) && glm::length(step) > 1e-15 * now_m) step *= 0.5;
      z += step;
      if (glm::length(step) > 1e-14 * now_m) continue;
      if (!edges[0].holds(z.x) || !edges[1].holds(z.y)) mark_beyond();
      vertex(bends_[first]) = edges[0].at(z.x);
      vertex(bends_[first + 1]) = edges[1].at(z.y);
      return true;
    }
    return false;
  }

  /// Sets the reflections between two vertices by images. Returns the unfolded length, or nothing if a mirror
  /// does not lie between its neighbours.
  std::optional<double> place_reflections(size_t from, size_t to) {
    std::vector<size_t> mirrors;
    std::vector<dvec3> images{vertex(from)};
    for (size_t i = from + 1; i < to; ++i) {
      if (at(i).type != InteractionType::reflection) continue;
      mirrors.push_back(i);
      images.push_back(image_in(world_.facet(at(i).element), images.back()));
    }
    const double length_m = glm::distance(images.back(), vertex(to));
    if (!(length_m > 0.0)) return std::nullopt;
    dvec3 target = vertex(to);
    for (size_t i = mirrors.size(); i-- > 0;) {
      const uint32_t index = at(mirrors[i]).element;
      const PosedFacet& facet = world_.facet(index);
      const double behind = facet.distance(images[i + 1]), before = facet.distance(target);
      if (!(behind * before < 0.0)) return std::nullopt;
      target = images[i + 1] + behind / (behind - before) * (target - images[i + 1]);
      if (!world_.contains(index, facet.plane_coordinates(target))) mark_beyond();
      vertex(mirrors[i]) = target;
    }
    return length_m;
  }

  /// Sets the points where the segments pass walls. Each wall has to be met on its way and in its order.
  void place_passages() {
    size_t from = 0;
    for (size_t to = 1; to < old_.vertices.size(); ++to) {
      if (to + 1 < old_.vertices.size() && at(to).type == InteractionType::transmission) continue;
      double before = 0.0;
      for (size_t i = from + 1; i < to; ++i) {
        const uint32_t index = at(i).element;
        const PosedFacet& facet = world_.facet(index);
        const dvec3 a = vertex(from), b = vertex(to);
        const double at_a = facet.distance(a), at_b = facet.distance(b);
        const double t = at_a == at_b ? 0.5 : at_a / (at_a - at_b);
        const double kept = std::clamp(t, before, 1.0);
        vertex(i) = a + kept * (b - a);
        if (kept != t || !world_.contains(index, facet.plane_coordinates(vertex(i)))) mark_beyond();
        before = kept;
      }
      from = to;
    }
  }

  const GeometricPath& old_;
  const FacetWorld& world_;
  std::span<const scene::Wedge> wedges_;
  ContinuedPath new_;
  std::vector<size_t> bends_;  ///< vertices of diffractions and scatterings
};

}  // namespace

ContinuedPath continued_path(const GeometricPath& path, const FacetWorld& world,
                             std::span<const scene::Wedge> wedges, const dvec3& transmitter,
                             const dvec3& receiver) {
  GREATX_CHECK(path.vertices.size() == path.interactions.size() + 2, "{} vertices of {} interactions",
               path.vertices.size(), path.interactions.size());
  if (path.vertices.front() == transmitter && path.vertices.back() == receiver)
    return {path, Continuation::exists};
  return Continuer(path, world, wedges, transmitter, receiver).solve();
}

}  // namespace greatx::rf
