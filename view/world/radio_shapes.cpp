// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/world/radio_shapes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "view/overlay/shape_parts.h"

namespace greatx::view {

namespace {

io::Color color_of_facet(rf::FacetKind kind) {
  switch (kind) {
    case rf::FacetKind::opaque:
      return {255, 176, 96};
    case rf::FacetKind::wall:
      return {96, 220, 255};
    case rf::FacetKind::foliage:
      return {120, 220, 110};
    case rf::FacetKind::absent:
      return dim_color;
  }
  return dim_color;
}

/// n is 1 for a plane and 2 for a free edge.
io::Color color_of_wedge(double n) { return io::turbo(0.12 + 0.8 * std::clamp(n - 1.0, 0.0, 1.0)); }

/// From a point to the nearest point of a box; `point` is in the box's frame.
double distance_to_box(const scene::Bounds& box, const dvec3& point) {
  return glm::length(glm::max(glm::max(box.min - point, point - box.max), dvec3(0.0)));
}

/// The items nearest to the focus, the nearest first; and how many there are within the distance.
struct NearestItems {
  std::vector<std::pair<double, uint32_t>> items;
  size_t found = 0;
};

template <typename DistanceOf>
NearestItems nearest_items(size_t count, size_t most, double within_m, DistanceOf distance_of) {
  NearestItems nearest;
  for (size_t i = 0; i < count; ++i) {
    const double distance = distance_of(static_cast<uint32_t>(i));
    if (distance <= within_m) nearest.items.emplace_back(distance, static_cast<uint32_t>(i));
  }
  nearest.found = nearest.items.size();
  const auto end = nearest.items.begin() + static_cast<std::ptrdiff_t>(std::min(most, nearest.found));
  std::partial_sort(nearest.items.begin(), end, nearest.items.end());
  nearest.items.erase(end, nearest.items.end());
  return nearest;
}

std::string count_text(const char* what, const NearestItems& nearest, size_t all) {
  if (nearest.items.size() == all) return fmt::format("{}: all {}", what, all);
  return fmt::format("{}: the nearest {} of {}", what, nearest.items.size(), all);
}

/// Draws the facets and wedges of one moment.
class RadioDrawing {
 public:
  RadioDrawing(const RadioFacts& facts, const FacetOutlines& outlines, std::span<const Pose> bodies,
               const dvec3& focus, const RadioShapeOptions& options)
      : facts_(facts), scene_(facts.scene()), outlines_(outlines), bodies_(bodies), options_(options) {
    for (const Pose& body : bodies) focus_in_body_.push_back(body.inverse().apply(focus - scene_.origin));
  }

  Shapes draw() {
    if (options_.facets) facets();
    if (options_.wedges) wedges();
    return std::move(shapes_);
  }

 private:
  dvec3 world(uint32_t body, const dvec3& point) const { return bodies_[body].apply(point) + scene_.origin; }

  void facets() {
    const rf::FacetKinds& kinds = facts_.model().kinds;
    const NearestItems nearest =
        nearest_items(scene_.facets.size(), options_.most_facets, options_.within_m, [&](uint32_t facet) {
          return distance_to_box(outlines_.bounds(facet), focus_in_body_[scene_.facets[facet].body]);
        });
    Legend legend;
    for (const auto& [distance, number] : nearest.items) {
      const scene::Facet& facet = scene_.facets[number];
      const bool by_kind = options_.colors == FacetColors::kind;
      const io::Color color = by_kind ? color_of_facet(kinds[number]) : io::color_of_id(facet.material + 1);
      const auto key =
          by_kind ? std::pair(std::string(name_of(kinds[number])), static_cast<uint32_t>(kinds[number]))
                  : std::pair(printable(scene_.materials[facet.material].name), facet.material + 1);
      ++legend[key];
      const uint32_t row = shapes_.add_row(facet_text(number), row_id("facet", number));
      for (const FacetOutlines::Edge& edge : outlines_.of(number))
        shapes_.lines.push_back({world(facet.body, edge[0]), world(facet.body, edge[1]), color, 1.2f, row});
    }
    shapes_.note(count_text("facets", nearest, scene_.facets.size()));
    add_legend(legend);
  }

  using Legend = std::map<std::pair<std::string, uint32_t>, size_t>;  ///< of (name, key of the colour)

  /// The kinds or materials of most facets: more names would hide the picture.
  void add_legend(const Legend& legend) {
    constexpr size_t most_names = 10;
    std::vector<std::pair<Legend::key_type, size_t>> entries(legend.begin(), legend.end());
    std::ranges::stable_sort(entries, std::greater(), [](const auto& entry) { return entry.second; });
    for (size_t i = 0; i < std::min(entries.size(), most_names); ++i) {
      const auto& [key, count] = entries[i];
      shapes_.legend.emplace_back(fmt::format("{} ({})", key.first, count),
                                  options_.colors == FacetColors::kind
                                      ? color_of_facet(static_cast<rf::FacetKind>(key.second))
                                      : io::color_of_id(key.second));
    }
    if (entries.size() > most_names)
      shapes_.note(fmt::format("{} more materials", entries.size() - most_names));
  }

  std::string facet_text(uint32_t number) const {
    const scene::Facet& facet = scene_.facets[number];
    return fmt::format("facet {} of {}\n{}, {} triangle{}\nat {:.4g} GHz: {}", number,
                       printable(scene_.instances[facet.instance].name),
                       name_of(facts_.model().kinds[number]), facet.triangle_count,
                       facet.triangle_count == 1 ? "" : "s", 1e-9 * facts_.carrier_hz(),
                       material_text(facet.material));
  }

  const std::string& material_text(uint32_t material) const {
    const auto [place, added] = materials_.try_emplace(material);
    if (added) place->second = facts_.material_text(material);
    return place->second;
  }

  void wedges() {
    const std::vector<scene::Wedge>& all = facts_.wedges();
    const NearestItems nearest =
        nearest_items(all.size(), options_.most_wedges, options_.within_m, [&](uint32_t wedge) {
          scene::Bounds box;
          box.add(all[wedge].a);
          box.add(all[wedge].b);
          return distance_to_box(box, focus_in_body_[all[wedge].body]);
        });
    for (const auto& [distance, number] : nearest.items) {
      const scene::Wedge& wedge = all[number];
      shapes_.lines.push_back({world(wedge.body, wedge.a), world(wedge.body, wedge.b),
                               color_of_wedge(wedge.n), 2.5f,
                               shapes_.add_row(wedge_text(number), row_id("wedge", number))});
    }
    shapes_.note(count_text("wedges", nearest, all.size()) +
                 (facts_.diffracts() ? "" : "; the effect diffraction is off: they would diffract"));
    if (nearest.items.empty()) return;
    shapes_.legend.emplace_back("exterior angle 360 deg: a free edge", color_of_wedge(2.0));
    shapes_.legend.emplace_back("270 deg: the corner of a house", color_of_wedge(1.5));
    shapes_.legend.emplace_back("near 180 deg: nearly flat", color_of_wedge(1.0));
  }

  std::string wedge_text(uint32_t number) const {
    const scene::Wedge& wedge = facts_.wedges()[number];
    const auto face = [&](uint32_t facet) {
      return fmt::format("facet {} of {} ({})", facet,
                         printable(scene_.instances[scene_.facets[facet].instance].name),
                         printable(scene_.materials[scene_.facets[facet].material].name));
    };
    return fmt::format(
        "wedge {}: {:.3f} m, exterior angle {:.1f} deg (n = {:.3f})\n{}\n{}", number,
        glm::distance(wedge.a, wedge.b), degrees(wedge.n * pi), wedge.n, face(wedge.facet_0),
        wedge.facet_n == scene::no_facet ? std::string("free edge: no second face") : face(wedge.facet_n));
  }

  const RadioFacts& facts_;
  const scene::Scene& scene_;
  const FacetOutlines& outlines_;
  std::span<const Pose> bodies_;
  const RadioShapeOptions& options_;
  std::vector<dvec3> focus_in_body_;  ///< [bodies]
  mutable std::map<uint32_t, std::string> materials_;
  Shapes shapes_;
};

}  // namespace

FacetOutlines::FacetOutlines(const scene::Scene& scene) {
  first_.push_back(0);
  const auto before = [](const dvec3& a, const dvec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  const auto edge_before = [&](const Edge& a, const Edge& b) {
    return before(a[0], b[0]) || (a[0] == b[0] && before(a[1], b[1]));
  };
  std::vector<Edge> edges;
  for (const scene::Facet& facet : scene.facets) {
    edges.clear();
    scene::Bounds& box = bounds_.emplace_back();
    for (uint32_t t = 0; t < facet.triangle_count; ++t) {
      const scene::FacetTriangle& triangle = scene.facet_triangles[facet.first_triangle + t];
      for (int corner = 0; corner < 3; ++corner) {
        const dvec3 &a = triangle.corners[corner], &b = triangle.corners[(corner + 1) % 3];
        box.add(a);
        edges.push_back(before(a, b) ? Edge{a, b} : Edge{b, a});
      }
    }
    std::ranges::sort(edges, edge_before);
    for (size_t i = 0; i < edges.size();) {
      size_t next = i + 1;
      while (next < edges.size() && edges[next] == edges[i]) ++next;
      if (next - i == 1) edges_.push_back(edges[i]);
      i = next;
    }
    first_.push_back(edges_.size());
  }
}

Shapes radio_shapes(const RadioFacts& facts, const FacetOutlines& outlines, std::span<const Pose> bodies,
                    const dvec3& focus, const RadioShapeOptions& options) {
  GREATX_CHECK(bodies.size() == facts.scene().bodies.size(), "{} poses of {} bodies", bodies.size(),
               facts.scene().bodies.size());
  return RadioDrawing(facts, outlines, bodies, focus, options).draw();
}

}  // namespace greatx::view
