// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/plane/polygons.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "scene/place/plane/geos.h"

namespace greatx::scene::place {

namespace {

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Drops corners that repeat the one before, and spikes, whose two edges lie on each other.
Ring cleaned(Ring ring, std::vector<std::string>& faults) {
  constexpr double same_m = 1e-6;
  const auto note = [&](const char* fault) {
    if (std::find(faults.begin(), faults.end(), fault) == faults.end()) faults.emplace_back(fault);
  };
  for (bool again = true; again && ring.size() >= 3;) {
    again = false;
    for (size_t i = 0; i < ring.size() && ring.size() >= 3;) {
      const dvec2 a = ring[(i + ring.size() - 1) % ring.size()], b = ring[i], c = ring[(i + 1) % ring.size()];
      const bool repeated = glm::distance(a, b) < same_m;
      const double along = glm::length(b - a) * glm::length(c - b);
      const bool spike =
          !repeated && glm::dot(b - a, c - b) < 0.0 && std::abs(cross(b - a, c - b)) < 1e-9 * along;
      if (!repeated && !spike) {
        ++i;
        continue;
      }
      note(repeated ? "repeated corner" : "spike");
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
      again = true;
    }
  }
  return ring.size() >= 3 ? ring : Ring{};
}

}  // namespace

double signed_area(const Ring& ring) {
  double sum = 0.0;
  for (size_t i = 1; i + 1 < ring.size(); ++i) sum += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  return 0.5 * sum;
}

double area(const Polygon& polygon) {
  double sum = std::abs(signed_area(polygon.outer));
  for (const Ring& hole : polygon.holes) sum -= std::abs(signed_area(hole));
  return sum;
}

double area(std::span<const Polygon> polygons) {
  double sum = 0.0;
  for (const Polygon& polygon : polygons) sum += area(polygon);
  return sum;
}

double perimeter(const Polygon& polygon) {
  double sum = 0.0;
  const auto add = [&](const Ring& ring) {
    for (size_t i = 0; i < ring.size(); ++i) sum += glm::distance(ring[i], ring[(i + 1) % ring.size()]);
  };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
  return sum;
}

Box box_of(const Polygon& polygon) {
  Box box;
  for (const dvec2& p : polygon.outer) box.add(p);
  return box;
}

Box box_of(std::span<const Polygon> polygons) {
  Box box;
  for (const Polygon& polygon : polygons) box.add(box_of(polygon));
  return box;
}

Repaired repair(const Polygon& polygon) {
  Repaired result;
  Polygon clean{cleaned(polygon.outer, result.faults), {}};
  for (const Ring& hole : polygon.holes)
    if (Ring ring = cleaned(hole, result.faults); !ring.empty()) clean.holes.push_back(std::move(ring));
  if (clean.outer.empty()) return result;
  const Geometry geometry = geometry_of(clean);
  if (GEOSisValid_r(geos(), geometry.get()) == 1) {
    result.polygons = polygons_of(geometry.get());
    return result;
  }
  result.faults.emplace_back("crosses itself");
  // "linework" keeps what the rings cover under the even-odd rule.
  const Geometry valid = own(GEOSMakeValid_r(geos(), geometry.get()));
  result.polygons = polygons_of(valid.get());
  return result;
}

std::vector<Polygon> repaired(const std::vector<Polygon>& polygons) {
  std::vector<Polygon> pieces;
  for (const Polygon& polygon : polygons)
    for (Polygon& piece : repair(polygon).polygons) pieces.push_back(std::move(piece));
  return pieces;
}

std::vector<Polygon> repaired(const std::vector<Polygon>& polygons, const std::string& object,
                              const std::string& what, std::vector<Finding>& findings) {
  std::vector<Polygon> pieces;
  for (const Polygon& polygon : polygons) {
    Repaired valid = repair(polygon);
    for (const std::string& fault : valid.faults)
      findings.push_back({Finding::Kind::repaired,
                          fault == "crosses itself" ? "ring_crosses_itself" : "ring_repeats_itself", object,
                          fmt::format("{}: {}", what, fault)});
    for (Polygon& piece : valid.polygons) pieces.push_back(std::move(piece));
  }
  return pieces;
}

std::vector<Polygon> unite(const std::vector<Polygon>& polygons) {
  if (polygons.empty()) return {};
  return polygons_of(own(GEOSUnaryUnion_r(geos(), geometry_of(polygons).get())).get());
}

std::vector<Polygon> subtract(const std::vector<Polygon>& from, const std::vector<Polygon>& what) {
  const Geometry a = geometry_of(from), b = geometry_of(what);
  return polygons_of(own(GEOSDifference_r(geos(), a.get(), b.get())).get());
}

std::vector<Polygon> intersect(const std::vector<Polygon>& a, const std::vector<Polygon>& b) {
  const Geometry left = geometry_of(a), right = geometry_of(b);
  return polygons_of(own(GEOSIntersection_r(geos(), left.get(), right.get())).get());
}

std::vector<Polygon> grow(const std::vector<Polygon>& polygons, double distance_m, bool round) {
  const Geometry geometry = geometry_of(polygons);
  return polygons_of(own(GEOSBufferWithStyle_r(geos(), geometry.get(), distance_m, 4, GEOSBUF_CAP_ROUND,
                                               round ? GEOSBUF_JOIN_ROUND : GEOSBUF_JOIN_MITRE, 2.0))
                         .get());
}

std::vector<Polygon> band(const std::vector<dvec2>& line, double width_m) {
  const Geometry geometry = line_of(line);
  // Four chords a quarter circle of 10 m deviate by 10 m (1 - cos(pi / 16)) = 0.19 m; six by 0.09 m.
  return polygons_of(own(GEOSBufferWithStyle_r(geos(), geometry.get(), 0.5 * width_m, width_m > 8.0 ? 6 : 3,
                                               GEOSBUF_CAP_FLAT, GEOSBUF_JOIN_ROUND, 2.0))
                         .get());
}

std::vector<Polygon> cut(const std::vector<Polygon>& polygons, const dvec2& normal, double offset) {
  const Box box = box_of(polygons);
  if (box.empty()) return {};
  const dvec2 unit = normal / glm::length(normal), along(-unit.y, unit.x);
  const dvec2 middle = 0.5 * (box.low + box.high);
  const double reach = glm::distance(box.low, box.high) + 1.0;
  const dvec2 on_line = middle + unit * (offset / glm::length(normal) - glm::dot(unit, middle));
  const Polygon half{
      {on_line + along * reach, on_line - along * reach, on_line - along * reach - unit * (2 * reach),
       on_line + along * reach - unit * (2 * reach)},
      {}};
  // A line that misses the box leaves all or nothing.
  const double distance = glm::dot(unit, middle - on_line);
  if (distance > reach) return {};
  if (distance < -reach) return polygons;
  return intersect(polygons, {half});
}

}  // namespace greatx::scene::place
