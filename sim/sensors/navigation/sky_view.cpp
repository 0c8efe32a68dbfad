// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/navigation/sky_view.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/units.h"

namespace greatx::sim {

namespace {

using navigation::SignalPath;

constexpr int wall_azimuths = 48;
constexpr double wall_elevations[] = {radians(2.0), radians(15.0), radians(35.0)};
/// A wall is within 20 degrees of plumb.
const double most_wall_slope = std::sin(radians(20.0));
/// The least sine of the angle between a mirror and the signal; below it a wall is seen edge on.
constexpr double least_incidence = 0.02;
constexpr double same_plane_m = 0.01, same_plane = 1e-4;

rf::FacetKinds without_foliage(const scene::Scene& scene) {
  rf::FacetKinds kinds;
  for (const scene::Facet& facet : scene.facets) {
    const std::optional<scene::RadioMaterial>& radio = scene.materials[facet.material].radio;
    kinds.push_back(radio && radio->foliage ? rf::FacetKind::absent : rf::FacetKind::opaque);
  }
  return kinds;
}

}  // namespace

SkyView::SkyView(const World& world) : world_(world), surfaces_(world.scene, without_foliage(world.scene)) {}

std::vector<SkyView::Wall> SkyView::walls_around(const Antenna& antenna) const {
  std::vector<Wall> walls;
  for (const double elevation : wall_elevations)
    for (int step = 0; step < wall_azimuths; ++step) {
      const double azimuth = 2.0 * pi * step / wall_azimuths;
      const dvec3 direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                            std::sin(elevation));
      const auto seen =
          surfaces_.first_seen(antenna.position, direction, antenna.body_poses, antenna.own_body);
      if (!seen || world_.scene.facets[*seen].body != 0) continue;
      const scene::Facet& facet = world_.scene.facets[*seen];
      if (std::abs(facet.normal.z) > most_wall_slope) continue;
      Wall wall{facet.normal, facet.offset};
      if (glm::dot(wall.normal, antenna.position) < wall.offset)
        wall = {-wall.normal, -wall.offset};  // sheets reflect on both sides
      const bool known = std::ranges::any_of(walls, [&](const Wall& other) {
        return glm::dot(other.normal, wall.normal) > 1.0 - same_plane &&
               std::abs(other.offset - wall.offset) < same_plane_m;
      });
      if (!known) walls.push_back(wall);
    }
  return walls;
}

std::optional<SignalPath> SkyView::reflected(const Antenna& antenna, std::span<const Wall> walls,
                                             const dvec3& direction) const {
  constexpr double off_wall_m = 1e-3;
  std::optional<SignalPath> shortest;
  for (const Wall& wall : walls) {
    const double facing = glm::dot(wall.normal, direction);
    if (facing < least_incidence) continue;
    const double distance = glm::dot(wall.normal, antenna.position) - wall.offset;
    const SignalPath path = navigation::reflected_path(direction, wall.normal, distance, antenna.velocity);
    if (shortest && shortest->excess_m <= path.excess_m) continue;
    const dvec3 back = direction - 2.0 * facing * wall.normal;
    const auto seen = surfaces_.first_seen(antenna.position, back, antenna.body_poses, antenna.own_body);
    if (!seen || world_.scene.facets[*seen].body != 0) continue;
    const scene::Facet& facet = world_.scene.facets[*seen];
    const double sign = glm::dot(facet.normal, wall.normal) < 0.0 ? -1.0 : 1.0;
    if (sign * glm::dot(facet.normal, wall.normal) < 1.0 - same_plane ||
        std::abs(sign * facet.offset - wall.offset) > same_plane_m)
      continue;  // something else is in front of the wall, or the wall ends before
    const dvec3 point = antenna.position + distance / facing * back + off_wall_m * wall.normal;
    if (surfaces_.first_seen(point, direction, antenna.body_poses, antenna.own_body)) continue;
    shortest = path;
  }
  return shortest;
}

navigation::Sky SkyView::sky(const Antenna& antenna, bool reflections) const {
  // Walls are looked for when the first satellite is hidden.
  auto walls = std::make_shared<std::optional<std::vector<Wall>>>();
  return [this, antenna, reflections, walls](const dvec3& direction) {
    if (!surfaces_.first_seen(antenna.position, direction, antenna.body_poses, antenna.own_body))
      return SignalPath{};
    if (reflections) {
      if (!walls->has_value()) *walls = walls_around(antenna);
      if (const auto path = reflected(antenna, **walls, direction)) return *path;
    }
    return SignalPath{SignalPath::State::blocked, 0.0, 0.0};
  };
}

}  // namespace greatx::sim
