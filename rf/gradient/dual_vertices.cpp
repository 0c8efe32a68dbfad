// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/gradient/dual_vertices.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "rf/edges/diffraction.h"

namespace greatx::rf {
namespace {

using V = Vec3Of<Dual>;

/// Returns the value with the slopes of another number.
Dual with_slopes(double value, const Dual& of) {
  Dual result = of;
  result.value = value;
  return result;
}
V with_slopes(const dvec3& value, const V& of) {
  return {with_slopes(value.x, of.x), with_slopes(value.y, of.y), with_slopes(value.z, of.z)};
}

Dual distance_from(const PosedFacet& facet, const V& point) {
  return dot(facet.normal, point) - facet.offset;
}

V mirrored_at(const PosedFacet& facet, const V& point) {
  return point - 2.0 * distance_from(facet, point) * facet.normal;
}

/// Returns the slopes of the place on one edge: z = (z_a d_b + z_b d_a)/(d_a + d_b).
Dual keller_place_of(const scene::Wedge& wedge, const V& before, const V& after) {
  const dvec3 edge = glm::normalize(wedge.b - wedge.a);
  const V from = before - wedge.a, to = after - wedge.a;
  const Dual z_before = dot(from, edge), z_after = dot(to, edge);
  const Dual d_before = length(from - z_before * edge), d_after = length(to - z_after * edge);
  return (z_before * d_after + z_after * d_before) / (d_before + d_after);
}

/// Sets the slopes of the places on two edges.
void set_keller_places(const scene::Wedge& first, const scene::Wedge& second, const V& before, const dvec3& p,
                       const dvec3& q, const V& after, Dual (&place)[2]) {
  const dvec3 t[2] = {glm::normalize(first.b - first.a), glm::normalize(second.b - second.a)};
  const V rays[2] = {p - before, after - q};
  const Dual r_0 = length(rays[0]), r_2 = length(rays[1]);
  const double r[3] = {r_0.value, glm::distance(p, q), r_2.value};
  GREATX_CHECK(std::min({r[0], r[1], r[2]}) > 0.0, "runs of {}, {} and {} m at two edges", r[0], r[1], r[2]);
  const dvec3 between = (q - p) / r[1];
  const Dual c_00 = dot(rays[0], t[0]) / r_0, c_12 = dot(rays[1], t[1]) / r_2;
  const double c_01 = glm::dot(t[0], between), c_11 = glm::dot(t[1], between);
  const double h_00 = (1.0 - c_00.value * c_00.value) / r[0] + (1.0 - c_01 * c_01) / r[1],
               h_11 = (1.0 - c_11 * c_11) / r[1] + (1.0 - c_12.value * c_12.value) / r[2],
               h_01 = -(glm::dot(t[0], t[1]) - c_01 * c_11) / r[1];
  const double determinant = h_00 * h_11 - h_01 * h_01;
  GREATX_CHECK(determinant > 0.0, "edges in line with their path");
  for (int i = 0; i < Dual::count; ++i) {
    const double g_0 = c_00.slope(i), g_1 = -c_12.slope(i);
    place[0].set_slope(i, (h_01 * g_1 - h_11 * g_0) / determinant);
    place[1].set_slope(i, (h_01 * g_0 - h_00 * g_1) / determinant);
  }
}

class Unfolding {
 public:
  Unfolding(const GeometricPath& path, const FacetWorld& world, std::span<const scene::Wedge> wedges)
      : path_(path), world_(world), wedges_(wedges) {}

  DualVertices solve(const V& transmitter, const V& receiver) {
    result_.vertices.assign(path_.vertices.begin(), path_.vertices.end());
    result_.vertices.front() = transmitter;
    result_.vertices.back() = receiver;
    for (size_t from = 0; from + 1 < path_.vertices.size();) from = place_edges(from);
    Dual sum = 0.0;
    for (size_t from = 0; from + 1 < path_.vertices.size();) from = place_reflections(from, sum);
    for (size_t from = 0; from + 1 < path_.vertices.size();) from = place_walls(from);
    result_.length_m = with_slopes(path_.length_m, sum);
    return std::move(result_);
  }

 private:
  enum class Vertex { anchor, edge, reflection, wall };

  Vertex kind(size_t vertex) const {
    if (vertex == 0 || vertex + 1 == path_.vertices.size()) return Vertex::anchor;
    const Interaction& interaction = path_.interactions[vertex - 1];
    switch (interaction.type) {
      case InteractionType::reflection:
        return Vertex::reflection;
      case InteractionType::transmission:
        return Vertex::wall;
      case InteractionType::diffraction:
        return interaction.patch == 0 ? Vertex::edge : Vertex::anchor;
      case InteractionType::scattering:
        return Vertex::anchor;
      case InteractionType::none:
      case InteractionType::target:
        break;
    }
    GREATX_CHECK(false, "interaction {} is of type {}", vertex - 1, static_cast<int>(interaction.type));
    return Vertex::anchor;
  }
  const PosedFacet& facet(size_t vertex) const {
    return world_.facet(path_.interactions[vertex - 1].element);
  }
  scene::Wedge wedge(size_t vertex) const {
    const uint32_t element = path_.interactions[vertex - 1].element;
    GREATX_CHECK(element < wedges_.size(), "wedge {} of {}", element, wedges_.size());
    return posed(wedges_[element], world_);
  }
  /// Returns the image of an anchor in the reflections from `first` up to, or down to, the one before `end`.
  V image(size_t anchor, size_t end) const {
    V point = result_.vertices[anchor];
    const ptrdiff_t step = anchor < end ? 1 : -1;
    for (ptrdiff_t i = static_cast<ptrdiff_t>(anchor) + step; i != static_cast<ptrdiff_t>(end); i += step)
      if (kind(static_cast<size_t>(i)) == Vertex::reflection)
        point = mirrored_at(facet(static_cast<size_t>(i)), point);
    return point;
  }

  /// Places the edges between the anchor `from` and the next one. Returns that.
  size_t place_edges(size_t from) {
    size_t edges[2] = {0, 0}, count = 0, to = from + 1;
    for (; kind(to) != Vertex::anchor; ++to) {
      if (kind(to) != Vertex::edge) continue;
      GREATX_CHECK(count < 2, "path with more than two diffractions between its ends");
      edges[count++] = to;
    }
    if (count == 0) return to;
    const V before = image(from, edges[0]), after = image(to, edges[count - 1]);
    Dual places[2];
    if (count == 1) {
      places[0] = keller_place_of(wedge(edges[0]), before, after);
    } else {
      for (size_t i = edges[0] + 1; i < edges[1]; ++i)
        GREATX_CHECK(kind(i) == Vertex::wall, "reflection between two edges");
      set_keller_places(wedge(edges[0]), wedge(edges[1]), before, path_.vertices[edges[0]],
                        path_.vertices[edges[1]], after, places);
    }
    for (size_t i = 0; i < count; ++i) {
      const scene::Wedge at = wedge(edges[i]);
      result_.vertices[edges[i]] =
          with_slopes(path_.vertices[edges[i]], places[i] * glm::normalize(at.b - at.a));
    }
    return to;
  }

  /// Places the reflections between the bend `from` and the next one, and adds the length of this part.
  size_t place_reflections(size_t from, Dual& sum) {
    std::vector<size_t> reflections;
    std::vector<V> images{result_.vertices[from]};
    size_t to = from + 1;
    for (; kind(to) == Vertex::reflection || kind(to) == Vertex::wall; ++to) {
      if (kind(to) == Vertex::wall) continue;
      reflections.push_back(to);
      images.push_back(mirrored_at(facet(to), images.back()));
    }
    V point = result_.vertices[to];
    sum += length(point - images.back());
    for (size_t i = reflections.size(); i-- > 0;) {
      const PosedFacet& plane = facet(reflections[i]);
      const V& seen = images[i + 1];
      const Dual behind = distance_from(plane, seen), before = distance_from(plane, point);
      GREATX_CHECK(std::abs(behind.value - before.value) > 0.0, "reflection {} along its facet",
                   reflections[i]);
      const V hit = seen + behind / (behind - before) * (point - seen);
      point = result_.vertices[reflections[i]] = with_slopes(path_.vertices[reflections[i]], hit);
    }
    return to;
  }

  /// Places the walls between the turn `from` and the next one.
  size_t place_walls(size_t from) {
    size_t to = from + 1;
    while (kind(to) == Vertex::wall) ++to;
    const V &start = result_.vertices[from], &end = result_.vertices[to];
    for (size_t i = from + 1; i < to; ++i) {
      const Dual before = distance_from(facet(i), start), after = distance_from(facet(i), end);
      GREATX_CHECK(std::abs(before.value - after.value) > 0.0, "transmission {} along its wall", i);
      result_.vertices[i] = with_slopes(path_.vertices[i], start + before / (before - after) * (end - start));
    }
    return to;
  }

  const GeometricPath& path_;
  const FacetWorld& world_;
  std::span<const scene::Wedge> wedges_;
  DualVertices result_;
};

}  // namespace

DualVertices dual_vertices(const GeometricPath& path, const FacetWorld& world,
                           std::span<const scene::Wedge> wedges, const V& transmitter, const V& receiver) {
  return Unfolding(path, world, wedges).solve(transmitter, receiver);
}

}  // namespace greatx::rf
