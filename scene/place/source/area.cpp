// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/area.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::scene::place {

namespace {

/// A place is flat to the eye: the frame touches the Earth at one point.
constexpr double most_degrees = 2.0;

DegreesArea area_of(Polygon polygon, const std::string& where) {
  DegreesArea area;
  const double near = polygon.outer.front().x;
  const auto turn = [&](Ring& ring) {
    for (dvec2& corner : ring) corner.x = longitude_near(corner.x, near);
  };
  turn(polygon.outer);
  for (Ring& hole : polygon.holes) turn(hole);
  area.box = box_of(polygon.outer);
  area.polygon = std::move(polygon);
  const dvec2 size = area.box.high - area.box.low;
  if (!(size.x > 0.0 && size.y > 0.0))
    throw_user_error("{}: the area is empty: {}", where, extent_text(area.box));
  if (size.x * std::cos(radians(area.centre().y)) > most_degrees || size.y > most_degrees)
    throw_user_error("{}: expected an area of {} degrees at most, found {}: give an area", where,
                     most_degrees, extent_text(area.box));
  return area;
}

DegreesArea area_of_file(const std::filesystem::path& file) {
  MapSource source;
  source.file = file;
  source.name = file.filename().string();
  source.as = "place=area";
  const MapContents contents = read_table(source, std::nullopt);
  for (const Feature& feature : contents.features)
    if (!feature.polygons.empty()) return area_of(feature.polygons.front(), file.string());
  throw_user_error("{}: expected a polygon, found {} objects without one", file.string(),
                   contents.features.size());
}

}  // namespace

std::string extent_text(const Box& degrees) {
  if (degrees.empty()) return "nowhere";
  return fmt::format("latitude {:.5f} to {:.5f}, longitude {:.5f} to {:.5f}", degrees.low.y, degrees.high.y,
                     longitude_near(degrees.low.x, 0.0), longitude_near(degrees.high.x, 0.0));
}

std::string swapped_hint(const Box& extent, const Box& area) {
  if (extent.empty() || meets_turned(extent, area)) return {};
  const Box swapped{{extent.low.y, extent.low.x}, {extent.high.y, extent.high.x}};
  return meets_turned(swapped, area) ? "; latitude and longitude seem to be swapped" : "";
}

std::optional<DegreesArea> given_area(const PlaceConfig& config) {
  const std::string where = config.file.string() + ": area";
  if (config.area.bounds_deg) {
    const auto& [south, west, north, east] = *config.area.bounds_deg;
    const double end = west < east ? east : east + 360.0;
    DegreesArea area;
    area.polygon.outer = {{west, south}, {end, south}, {end, north}, {west, north}};
    area.box = box_of(area.polygon.outer);
    if (end - west < 180.0) return area_of(std::move(area.polygon), where);
    throw_user_error("{}: expected an area of {} degrees at most, found {} degrees from west to east", where,
                     most_degrees, end - west);
  }
  if (!config.area.polygon.empty()) {
    Polygon polygon;
    for (const Geodetic& corner : config.area.polygon)
      polygon.outer.emplace_back(corner.longitude_deg, corner.latitude_deg);
    return area_of(std::move(polygon), where);
  }
  if (!config.area.polygon_file.empty()) return area_of_file(config.area.polygon_file);
  return std::nullopt;
}

DegreesArea area_of_extent(const Box& extent, const std::string& where) {
  if (extent.empty()) throw_user_error("{}: no source has an object, so there is no area", where);
  // A point on the edge counts as within, whatever the rounding.
  constexpr double more = 1e-5;
  const dvec2 low = extent.low - more, high = extent.high + more;
  return area_of({{low, {high.x, low.y}, high, {low.x, high.y}}, {}}, where);
}

Polygon area_in_frame(const DegreesArea& area, const Placement& placement) {
  constexpr double most_edge_m = 500.0;
  const auto move = [&](const Ring& ring) {
    Ring moved;
    for (size_t i = 0; i < ring.size(); ++i) {
      const dvec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double length = glm::distance(placement.on_ground(a), placement.on_ground(b));
      const int pieces = std::max(1, static_cast<int>(std::ceil(length / most_edge_m)));
      for (int k = 0; k < pieces; ++k)
        moved.push_back(placement.on_ground(a + (b - a) * (double(k) / pieces)));
    }
    return moved;
  };
  Polygon result{move(area.polygon.outer), {}};
  for (const Ring& hole : area.polygon.holes) result.holes.push_back(move(hole));
  return result;
}

}  // namespace greatx::scene::place
