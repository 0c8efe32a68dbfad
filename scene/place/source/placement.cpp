// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/placement.h"

namespace greatx::scene::place {

namespace {
/// Each step makes the error of x and y smaller by the terrain's slope times distance over the Earth's
/// radius, below 0.003 at 20 km and 45 degrees. The first step is wrong by some 3 m per km of height there.
constexpr int height_steps = 3;
/// The mean radius of WGS 84; a height that is wrong by 1 m at 20 km moves x and y by 3 mm.
constexpr double earth_radius_m = 6'371'009.0;
}  // namespace

Placement::Placement(const Georeference& reference, const HeightField& terrain)
    : frame_(reference),
      terrain_(terrain),
      origin_height_m_(reference.origin.height_m - reference.undulation_m) {}

dvec3 Placement::at_height(const dvec2& degrees, double height_m) const {
  return frame_.local_of_datum({degrees.y, degrees.x, height_m});
}

double Placement::ground_height_m(const dvec2& local) const {
  const auto z = terrain_.at(local);
  return z ? frame_.datum_place({local, *z}).height_m : origin_height_m_;
}

dvec2 Placement::degrees_of(const dvec2& local) const {
  // Without terrain the ground follows the Earth: z falls by the square of the distance over its diameter.
  const double fall = glm::dot(local, local) / (2.0 * earth_radius_m);
  const Geodetic place = frame_.place({local, terrain_.at(local).value_or(-fall)});
  return {place.longitude_deg, place.latitude_deg};
}

dvec2 Placement::on_ground(const dvec2& degrees) const {
  dvec2 place(at_height(degrees, origin_height_m_));
  if (terrain_.empty()) return place;
  for (int step = 0; step < height_steps; ++step) place = dvec2(at_height(degrees, ground_height_m(place)));
  return place;
}

void Placement::place(Feature& feature) const {
  const auto move = [&](std::vector<dvec2>& points) {
    for (dvec2& point : points) point = on_ground(point);
  };
  for (Polygon& polygon : feature.polygons) {
    move(polygon.outer);
    for (Ring& hole : polygon.holes) move(hole);
  }
  for (auto& line : feature.lines) move(line);
  if (feature.point) feature.point = on_ground(*feature.point);
  for (SolidFace& face : feature.faces)
    for (auto& ring : face.rings)
      for (dvec3& point : ring) point = at_height(dvec2(point), point.z);
}

}  // namespace greatx::scene::place
