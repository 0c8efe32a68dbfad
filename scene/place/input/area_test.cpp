// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/input/area_test.h"

#include <algorithm>
#include <utility>

namespace greatx::scene::place {

namespace {

bool crosses_odd(const Ring& ring, const dvec2& p) {
  bool odd = false;
  for (size_t i = 0, before = ring.size() - 1; i < ring.size(); before = i++) {
    const dvec2 &a = ring[before], &b = ring[i];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) odd = !odd;
  }
  return odd;
}

double side(const dvec2& a, const dvec2& b, const dvec2& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

bool segments_meet(const dvec2& a, const dvec2& b, const dvec2& c, const dvec2& d) {
  Box first, second;
  first.add(a), first.add(b), second.add(c), second.add(d);
  if (!first.meets(second)) return false;
  return side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0;
}

bool ring_meets(const Ring& ring, const dvec2& a, const dvec2& b) {
  for (size_t i = 0, before = ring.size() - 1; i < ring.size(); before = i++)
    if (segments_meet(ring[before], ring[i], a, b)) return true;
  return false;
}

Polygon plan_of(const SolidFace& face) {
  Polygon plan;
  for (size_t i = 0; i < face.rings.size(); ++i) {
    Ring ring(face.rings[i].begin(), face.rings[i].end());
    if (i == 0)
      plan.outer = std::move(ring);
    else
      plan.holes.push_back(std::move(ring));
  }
  return plan;
}

}  // namespace

bool contains(const Polygon& polygon, const dvec2& point) {
  bool odd = !polygon.outer.empty() && crosses_odd(polygon.outer, point);
  for (const Ring& hole : polygon.holes)
    if (!hole.empty() && crosses_odd(hole, point)) odd = !odd;
  return odd;
}

Box box_of(std::span<const dvec2> points) {
  Box box;
  for (const dvec2& point : points) box.add(point);
  return box;
}

Box box_of(const Feature& feature) {
  Box box;
  for (const Polygon& polygon : feature.polygons)
    for (const dvec2& point : polygon.outer) box.add(point);
  for (const auto& line : feature.lines)
    for (const dvec2& point : line) box.add(point);
  if (feature.point) box.add(*feature.point);
  for (const SolidFace& face : feature.faces)
    for (const auto& ring : face.rings)
      for (const dvec3& point : ring) box.add(dvec2(point));
  return box;
}

AreaTest::AreaTest(Polygon area) : area_(std::move(area)), box_(box_of(area_.outer)) {}

bool AreaTest::contains(const dvec2& point) const { return place::contains(area_, point); }

bool AreaTest::crosses(const dvec2& a, const dvec2& b) const {
  Box box;
  box.add(a), box.add(b);
  if (!box.meets(box_)) return false;
  return ring_meets(area_.outer, a, b) ||
         std::ranges::any_of(area_.holes, [&](const Ring& hole) { return ring_meets(hole, a, b); });
}

bool AreaTest::meets_line(std::span<const dvec2> line, bool closed) const {
  if (line.empty() || !box_of(line).meets(box_)) return false;
  if (contains(line.front())) return true;
  for (size_t i = 1; i < line.size(); ++i)
    if (crosses(line[i - 1], line[i])) return true;
  return closed && crosses(line.back(), line.front());
}

bool AreaTest::meets(const Polygon& polygon) const {
  if (polygon.outer.empty()) return false;
  if (meets_line(polygon.outer, true)) return true;
  return box_of(polygon.outer).meets(box_) && place::contains(polygon, area_.outer.front());
}

bool AreaTest::meets(const Feature& feature) const {
  if (feature.point && contains(*feature.point)) return true;
  return std::ranges::any_of(feature.polygons, [&](const Polygon& polygon) { return meets(polygon); }) ||
         std::ranges::any_of(feature.lines, [&](const auto& line) { return meets_line(line, false); }) ||
         std::ranges::any_of(feature.faces, [&](const SolidFace& face) { return meets(plan_of(face)); });
}

}  // namespace greatx::scene::place
