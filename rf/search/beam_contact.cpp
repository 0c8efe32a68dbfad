// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Cells in which a facet meets the one that hides it, along an edge or in a vertex of the mesh: a wall at the far side
// of a roof. However small such a cell is, neither covers it, and at the edge itself neither is in front. But around a
// common vertex everything is a fan of sectors, with straight rays between them, and in each sector the order of two
// planes through the vertex is the same all the way out.
#include <algorithm>
#include <array>
#include <cmath>

#include "rf/search/beam_cells.h"

namespace greatx::rf {
namespace {

constexpr uint32_t none = ~0u;
constexpr size_t most_fans = 16, most_rays = 40;

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

/// Lines through one point: all edges at a vertex, or one edge alone.
struct BeamCells::Pencil {
  uint32_t vertex = none;  ///< none: the edge alone
  uint32_t edge = none;
  dvec2 center{0.0};
  bool holds(const ViewEdge& other) const {
    return vertex == none ? other.edge == edge : other.vertices[0] == vertex || other.vertices[1] == vertex;
  }
};

namespace {

struct Fan {            ///< a facet around the centre
  dvec2 gradient{0.0};  ///< of its inverse depth
  bool opaque = false;
  bool at_sample = false;
};

struct Ray {
  dvec2 along{0.0};
  double angle = 0.0;
  uint32_t toggles = 0;  ///< bits of the fans that it is an edge of
};

class Fans {
 public:
  bool add_fan(const Fan& fan) {
    if (fan_count == most_fans) return false;
    fans[fan_count++] = fan;
    return true;
  }
  /// A ray with the edge `edge` (none: of no edge) of fan `fan`.
  bool add_ray(const dvec2& along, uint32_t edge, uint32_t fan) {
    for (size_t i = 0; i < ray_count && edge != none; ++i)
      if (edges[i] == edge) {
        rays[i].toggles ^= 1u << fan;
        return true;
      }
    const double length = std::hypot(along.x, along.y);
    if (ray_count == most_rays || length == 0.0) return false;
    edges[ray_count] = edge;
    rays[ray_count++] = {along / length, std::atan2(along.y, along.x), edge == none ? 0 : 1u << fan};
    return true;
  }
  /// Is fan 0 behind an opaque one, or behind `walls` others, in every sector that it is in?
  bool first_is_hidden(const dvec2& to_sample, uint32_t walls);

 private:
  /// Is a fan in front of fan 0 from one ray to the next, all the way out?
  bool in_front(uint32_t fan, const Ray& from, const Ray& to) const {
    const dvec2 difference = fans[fan].gradient - fans[0].gradient;
    const double scale = glm::length(fans[fan].gradient) + glm::length(fans[0].gradient);
    const uint32_t both = 1u | 1u << fan;
    double least = 1.0;
    uint32_t shared = 0;
    for (const Ray* ray : {&from, &to}) {
      if ((ray->toggles & both) == both)
        ++shared;  // the planes meet in their common edge
      else
        least = std::min(least, glm::dot(difference, ray->along) / scale);
    }
    return shared < 2 && least > 1e-7;
  }

  std::array<Fan, most_fans> fans;
  uint32_t fan_count = 0;
  std::array<Ray, most_rays> rays;
  std::array<uint32_t, most_rays> edges;
  size_t ray_count = 0;
};

bool Fans::first_is_hidden(const dvec2& to_sample, uint32_t walls) {
  constexpr double pi = 3.14159265358979323846;
  std::sort(rays.begin(), rays.begin() + static_cast<ptrdiff_t>(ray_count),
            [](const Ray& a, const Ray& b) { return a.angle < b.angle; });
  // A gap of more than half a turn: the centre is outside of the cell, and the gap is no sector of it.
  size_t start = 0;
  bool outside = false;
  for (size_t i = 0; i < ray_count; ++i) {
    const Ray &ray = rays[i], &next = rays[(i + 1) % ray_count];
    const double gap = i + 1 < ray_count ? next.angle - ray.angle : next.angle + 2.0 * pi - ray.angle;
    if (std::abs(gap - pi) < 1e-6) return false;  // on the cell's side: a smaller cell will know
    if (gap > pi) start = (i + 1) % ray_count, outside = true;
  }
  std::rotate(rays.begin(), rays.begin() + static_cast<ptrdiff_t>(start),
              rays.begin() + static_cast<ptrdiff_t>(ray_count));
  const size_t sectors = outside ? ray_count - 1 : ray_count;
  if (sectors == 0) return false;
  // Which sector is the sample in?
  size_t at = sectors;
  for (size_t i = 0; i < sectors && at == sectors; ++i)
    if (cross(rays[i].along, to_sample) >= 0.0 && cross(rays[(i + 1) % ray_count].along, to_sample) <= 0.0)
      at = i;
  if (at == sectors) return false;
  uint32_t here = 0, all = 0;
  for (uint32_t fan = 0; fan < fan_count; ++fan) here |= fans[fan].at_sample ? 1u << fan : 0u;
  for (size_t i = 0; i < ray_count; ++i) all ^= rays[i].toggles;
  if (!outside && all != 0) return false;                    // an outline that does not come back
  for (size_t i = 1; i <= at; ++i) here ^= rays[i].toggles;  // back to the first sector
  for (size_t i = 0; i < sectors; ++i) {
    if (i > 0) here ^= rays[i].toggles;
    if (!(here & 1u)) continue;
    uint32_t passed = 0;
    bool hidden = false;
    for (uint32_t fan = 1; fan < fan_count && !hidden; ++fan) {
      if (!(here >> fan & 1u) || !in_front(fan, rays[i], rays[(i + 1) % ray_count])) continue;
      hidden = fans[fan].opaque || ++passed >= walls;
    }
    if (!hidden) return false;
  }
  return true;
}

}  // namespace

bool BeamCells::hidden_at_contact(const Entry& entry) const {
  const auto edges = edges_of(entry);
  if (edges.empty() || edges.size() > 8 || entry.at_sample == unknown || !facet_of(entry).regular)
    return false;
  const ViewEdge& first = view_->edges()[edges[0]];
  for (int end = 0; end < 2; ++end) {
    const Pencil pencil{first.vertices[end], none, first.ends[end]};
    if (pencil.vertex == none) continue;
    const bool all = std::all_of(edges.begin(), edges.end(),
                                 [&](uint32_t edge) { return pencil.holds(view_->edges()[edge]); });
    if (all && hidden_around(entry, pencil)) return true;
  }
  return edges.size() == 1 && hidden_around(entry, {none, first.edge, first.ends[0]});
}

bool BeamCells::hidden_around(const Entry& entry, const Pencil& pencil) const {
  Fans fans;
  const ViewFacet& hidden = facet_of(entry);
  const auto add = [&](const Entry& from) {
    const ViewFacet& facet = facet_of(from);
    return fans.add_fan({{facet.na / facet.distance, facet.nb / facet.distance},
                         facet.kind == FacetKind::opaque || options_.walls == 0,
                         from.at_sample == present});
  };
  const auto add_rays = [&](const Entry& from, uint32_t fan) {
    const auto edges = edges_of(from);
    return std::all_of(edges.begin(), edges.end(), [&](uint32_t index) {
      const ViewEdge& edge = view_->edges()[index];
      const bool backwards = pencil.vertex != none && edge.vertices[1] == pencil.vertex;
      return fans.add_ray(backwards ? edge.ends[0] - edge.ends[1] : edge.ends[1] - edge.ends[0], edge.edge,
                          fan);
    });
  };
  if (!add(entry) || !add_rays(entry, 0)) return false;
  uint32_t count = 1;
  for (const Entry& other : entries_) {
    if (&other == &entry || !other.stops || other.at_sample == unknown) continue;
    const ViewFacet& cover = facet_of(other);
    const auto edges = edges_of(other);
    if (!cover.regular) continue;
    if (!std::all_of(edges.begin(), edges.end(),
                     [&](uint32_t edge) { return pencil.holds(view_->edges()[edge]); }))
      continue;
    if (edges.empty() &&
        (pencil.vertex == none || !view_->scene().has_vertex(cover.scene_facet, pencil.vertex)))
      continue;
    if (!view_->scene().meet_at_an_angle(hidden.scene_facet, cover.scene_facet)) continue;
    if (!add(other) || !add_rays(other, count)) return false;
    ++count;
  }
  if (count == 1) return false;
  // Towards the corners of the cell, a little wider: sectors that no edge bounds.
  for (const double a : {-1.01, 1.01})
    for (const double b : {-1.01, 1.01})
      if (!fans.add_ray(dvec2(here_.a + a * here_.half_a, here_.b + b * here_.half_b) - pencil.center, none,
                        0))
        return false;
  return fans.first_is_hidden(dvec2(here_.sample_a, here_.sample_b) - pencil.center,
                              options_.walls + 1 - entry.walls);
}

}  // namespace greatx::rf
