// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/tube_shapes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "view/overlay/shape_parts.h"

namespace greatx::view {

namespace {

constexpr io::Color zone_color{150, 230, 255};
constexpr int zone_sides = 12, rings_of_leg = 12;

/// Two directions across `along`.
std::pair<dvec3, dvec3> across(const dvec3& along) {
  const dvec3 other = std::abs(along.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  const dvec3 u = glm::normalize(glm::cross(along, other));
  return {u, glm::cross(along, u)};
}

/// A leg of a zone: `begin_m` and `zone_m` are lengths along the zone.
void add_leg(Shapes& shapes, const dvec3& a, const dvec3& b, double begin_m, double zone_m,
             double wavelength_m, uint32_t row) {
  const double length = glm::distance(a, b);
  if (!(length > 0.0)) return;
  const dvec3 along = (b - a) / length;
  const auto [u, v] = across(along);
  const auto point = [&](int ring, int side) {
    const double at = length * ring / rings_of_leg, angle = 2.0 * pi * side / zone_sides;
    const double radius = fresnel_radius_m(wavelength_m, begin_m + at, zone_m - begin_m - at);
    return a + at * along + radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  for (int ring = 0; ring <= rings_of_leg; ++ring)
    for (int side = 0; side < zone_sides; ++side) {
      shapes.lines.push_back({point(ring, side), point(ring, side + 1), zone_color, 1.0f, row});
      if (ring < rings_of_leg && side % 2 == 0)
        shapes.lines.push_back({point(ring, side), point(ring + 1, side), zone_color, 1.0f, row});
    }
}

bool begins_a_zone(rf::InteractionType type) {
  return type == rf::InteractionType::diffraction || type == rf::InteractionType::scattering ||
         type == rf::InteractionType::target;
}

}  // namespace

double fresnel_radius_m(double wavelength_m, double d1_m, double d2_m) {
  const double sum = d1_m + d2_m;
  return sum > 0.0 ? std::sqrt(wavelength_m * std::max(0.0, d1_m) * std::max(0.0, d2_m) / sum) : 0.0;
}

Shapes fresnel_shapes(const PathStory& story) {
  Shapes shapes;
  const uint32_t row =
      shapes.add_row(fmt::format("first Fresnel zone of path {}\nwavelength {:.4g} m, length {:.2f} m",
                                 story.chain, story.wavelength_m, story.length_m),
                     row_id("Fresnel zone", 0));
  std::vector<dvec3> points{story.start};
  for (const PathStop& stop : story.stops) points.push_back(stop.at);
  points.push_back(story.end);
  double widest_m = 0.0;
  for (size_t first = 0; first + 1 < points.size();) {
    size_t last = first + 1;  // of the zone: the next point that sends out a wave, or the receiver
    while (last + 1 < points.size() && !begins_a_zone(story.stops[last - 1].type)) ++last;
    double zone_m = 0.0, begin_m = 0.0;
    for (size_t i = first; i < last; ++i) zone_m += glm::distance(points[i], points[i + 1]);
    for (size_t i = first; i < last; ++i) {
      add_leg(shapes, points[i], points[i + 1], begin_m, zone_m, story.wavelength_m, row);
      begin_m += glm::distance(points[i], points[i + 1]);
    }
    widest_m = std::max(widest_m, fresnel_radius_m(story.wavelength_m, 0.5 * zone_m, 0.5 * zone_m));
    first = last;
  }
  shapes.legend.emplace_back(
      fmt::format("first Fresnel zone of the pinned path: {:.2f} m radius at most", widest_m), zone_color);
  return shapes;
}

}  // namespace greatx::view
