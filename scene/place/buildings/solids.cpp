// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Takes roofs from solids (CityJSON).
#include <algorithm>
#include <cmath>

#include "scene/place/buildings/make_buildings.h"

namespace greatx::scene::place {

namespace {

/// Twice the area vector of a face, holes included (Newell).
dvec3 newell(const SolidFace& face) {
  dvec3 sum(0.0);
  for (const auto& ring : face.rings)
    for (size_t i = 1; i + 1 < ring.size(); ++i) sum += glm::cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  return sum;
}

double lowest(const std::vector<SolidFace>& faces) {
  double low = 1e300;
  for (const SolidFace& face : faces)
    for (const auto& ring : face.rings)
      for (const dvec3& p : ring) low = std::min(low, p.z);
  return low;
}

/// Integral of (z - low) over the faces' projections to the plan, counted positive where they look upwards.
double signed_volume(const std::vector<SolidFace>& faces, double low) {
  double volume = 0.0;
  for (const SolidFace& face : faces)
    for (const auto& ring : face.rings)
      for (size_t i = 1; i + 1 < ring.size(); ++i) {
        const dvec2 a(ring[i] - ring[0]), b(ring[i + 1] - ring[0]);
        const double mean = (ring[0].z + ring[i].z + ring[i + 1].z) / 3.0 - low;
        volume += 0.5 * (a.x * b.y - a.y * b.x) * mean;
      }
  return volume;
}

}  // namespace

double volume_of_solid(const std::vector<SolidFace>& faces) {
  return std::abs(signed_volume(faces, lowest(faces)));
}

std::vector<RoofFace> roof_of_solid(const std::vector<SolidFace>& faces, double& bottom_z) {
  bottom_z = lowest(faces);
  const double up = signed_volume(faces, bottom_z) < 0.0 ? -1.0 : 1.0;
  std::vector<RoofFace> roof;
  std::vector<std::vector<Polygon>> level_areas;  // of level faces, united below
  for (const SolidFace& face : faces) {
    if (face.kind == SolidFace::Kind::wall || face.kind == SolidFace::Kind::ground) continue;
    const dvec3 normal = newell(face) * up;
    const double size = glm::length(normal);
    // A face of no area has no plane; a face steeper than 87 degrees is a wall.
    if (!(size > 1e-9) || normal.z < 0.05 * size) continue;
    dvec3 mean(0.0);
    double low = 1e300, high = -1e300;
    for (const dvec3& p : face.rings.front()) {
      mean += p / static_cast<double>(face.rings.front().size());
      low = std::min(low, p.z);
      high = std::max(high, p.z);
    }
    Plane plane{dvec2(mean), mean.z, {-normal.x / normal.z, -normal.y / normal.z}};
    if (high - low < 0.002) plane = {dvec2(mean), std::round(mean.z * 1e3) / 1e3, dvec2(0.0)};
    Polygon polygon;
    for (size_t i = 0; i < face.rings.size(); ++i) {
      Ring ring;
      for (const dvec3& p : face.rings[i]) ring.emplace_back(p);
      if (i == 0)
        polygon.outer = std::move(ring);
      else
        polygon.holes.push_back(std::move(ring));
    }
    const std::vector<Polygon> pieces = repair(polygon).polygons;
    // Triangles of one level roof become one area.
    const auto same = std::find_if(roof.begin(), roof.end(), [&](const RoofFace& other) {
      return plane.level() && other.plane.level() && other.plane.height == plane.height;
    });
    RoofFace& target = same != roof.end() ? *same : roof.emplace_back(RoofFace{{}, plane});
    target.area.insert(target.area.end(), pieces.begin(), pieces.end());
  }
  for (RoofFace& face : roof)
    if (face.area.size() > 1) face.area = unite(face.area);
  std::erase_if(roof, [](const RoofFace& face) { return face.area.empty(); });
  return roof;
}

}  // namespace greatx::scene::place
