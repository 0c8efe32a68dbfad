// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/buildings/roofs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/units.h"

namespace greatx::scene::place {

namespace {

dvec2 across_of(const dvec2& along) { return {-along.y, along.x}; }

/// A plane of height `height` on the line through `point` with the normal `up`, rising along `up`.
Plane rising(const dvec2& point, double height, const dvec2& up, double slope) {
  return {point, height, up * slope};
}

/// Distances of the footprint from the middle of its rectangle.
struct Extent {
  double low = 0.0, high = 0.0;
};
Extent extent(const Polygon& footprint, const dvec2& center, const dvec2& axis) {
  Extent range{1e300, -1e300};
  for (const dvec2& p : footprint.outer) {
    const double at = glm::dot(p - center, axis);
    range = {std::min(range.low, at), std::max(range.high, at)};
  }
  return range;
}

/// Planes of a roof with a ridge: over each of the two long sides a chain of planes through the points
/// (distance from the eaves as a share of the half width, share of the height), from the eaves to the ridge.
std::vector<Plane> ridge_planes(const Rectangle& box, const RoofOptions& roof,
                                const std::vector<dvec2>& profile, double ridge_shift = 0.0) {
  const double rise = roof.ridge_z - roof.eaves_z;
  const dvec2 across = across_of(box.along);
  std::vector<Plane> planes;
  for (const double side : {-1.0, 1.0}) {
    const double width = box.half.y - side * ridge_shift;
    const dvec2 eaves = box.center + across * (side * box.half.y);
    for (size_t i = 0; i + 1 < profile.size(); ++i) {
      const double run = (profile[i + 1].x - profile[i].x) * width,
                   up = (profile[i + 1].y - profile[i].y) * rise;
      planes.push_back(rising(eaves - across * (side * profile[i].x * width),
                              roof.eaves_z + profile[i].y * rise, across * -side, up / run));
    }
  }
  return planes;
}

/// Planes that rise from the two short sides with the slope of the long sides, from `start_share` of the
/// height on.
void add_hips(std::vector<Plane>& planes, const Rectangle& box, const RoofOptions& roof, double start_share) {
  const double rise = roof.ridge_z - roof.eaves_z;
  for (const double side : {-1.0, 1.0})
    planes.push_back(rising(box.center + box.along * (side * box.half.x), roof.eaves_z + start_share * rise,
                            box.along * -side, rise / box.half.y));
}

bool convex(const Ring& ring) {
  for (size_t i = 0; i < ring.size(); ++i) {
    const dvec2 a = ring[(i + 1) % ring.size()] - ring[i],
                b = ring[(i + 2) % ring.size()] - ring[(i + 1) % ring.size()];
    if (a.x * b.y - a.y * b.x < -1e-3 * glm::length(a) * glm::length(b)) return false;
  }
  return true;
}

/// Planes that rise from every edge of a convex ring to one point.
std::vector<Plane> pyramid_planes(const Ring& ring, const dvec2& apex, double eaves, double top) {
  std::vector<Plane> planes;
  for (size_t i = 0; i < ring.size(); ++i) {
    const dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
    if (glm::distance(a, b) < 1e-3) continue;
    planes.push_back(plane_through(dvec3(a, eaves), dvec3(b, eaves), dvec3(apex, top)));
  }
  return planes;
}

dvec2 centroid(const Ring& ring) {
  dvec2 sum(0.0);
  double total = 0.0;
  for (size_t i = 1; i + 1 < ring.size(); ++i) {
    const dvec2 a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
    const double weight = a.x * b.y - a.y * b.x;
    sum += weight * (a + b) / 3.0;
    total += weight;
  }
  return ring[0] + sum / total;
}

/// Planes of half an ellipsoid over the rectangle, which it circumscribes: 12 segments, 3 rings, a flat top.
std::vector<Plane> dome_planes(const Rectangle& box, const RoofOptions& roof) {
  constexpr int segments = 12, rings = 3;
  const dvec2 across = across_of(box.along);
  const double rise = roof.ridge_z - roof.eaves_z, widest = std::numbers::sqrt2 / std::cos(pi / segments);
  const auto corner = [&](int ring, int segment) {
    const double up = 0.5 * pi * ring / (rings + 0.5), turn = 2.0 * pi * segment / segments;
    const dvec2 share = std::cos(up) * dvec2(std::cos(turn), std::sin(turn)) * widest;
    return dvec3(box.center + box.along * (share.x * box.half.x) + across * (share.y * box.half.y),
                 roof.eaves_z + rise * std::sin(up) / std::sin(0.5 * pi * rings / (rings + 0.5)));
  };
  std::vector<Plane> planes;
  for (int ring = 0; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment)
      planes.push_back(
          plane_through(corner(ring, segment), corner(ring, segment + 1), corner(ring + 1, segment)));
  planes.push_back({box.center, roof.ridge_z, dvec2(0.0)});
  return planes;
}

Rectangle oriented(Rectangle box, bool across) {
  if (!across) return box;
  // `half.y` is half the span between the eaves, whichever side is longer.
  return {box.center, across_of(box.along), {box.half.y, box.half.x}};
}

/// Planes whose lower envelope over a rectangle is the roof.
std::vector<Plane> planes_over(const Rectangle& box, const RoofOptions& roof) {
  switch (roof.shape) {
    case RoofShape::gabled:
      return ridge_planes(box, roof, {{0, 0}, {1, 1}});
    case RoofShape::gambrel:
      return ridge_planes(box, roof, {{0, 0}, {0.4, 0.65}, {1, 1}});
    case RoofShape::round: {
      std::vector<dvec2> arc;
      for (int i = 0; i <= 4; ++i) {
        const double turn = 0.5 * pi * i / 4;
        arc.emplace_back(1.0 - std::cos(turn), std::sin(turn));
      }
      return ridge_planes(box, roof, arc);
    }
    case RoofShape::saltbox:
      return ridge_planes(box, roof, {{0, 0}, {1, 1}}, box.half.y / 3.0);
    case RoofShape::half_hipped: {
      std::vector<Plane> planes = ridge_planes(box, roof, {{0, 0}, {1, 1}});
      add_hips(planes, box, roof, 0.5);
      return planes;
    }
    case RoofShape::mansard: {
      // Steep up to 0.7 of the height within 0.25 of the half width, on all four sides.
      std::vector<Plane> planes = ridge_planes(box, roof, {{0, 0}, {0.25, 0.7}, {1, 1}});
      const double rise = roof.ridge_z - roof.eaves_z, w = box.half.y;
      for (const double side : {-1.0, 1.0}) {
        const dvec2 end = box.center + box.along * (side * box.half.x);
        planes.push_back(rising(end, roof.eaves_z, box.along * -side, 0.7 * rise / (0.25 * w)));
        planes.push_back(rising(end - box.along * (side * 0.25 * w), roof.eaves_z + 0.7 * rise,
                                box.along * -side, 0.3 * rise / (0.75 * w)));
      }
      return planes;
    }
    case RoofShape::dome:
      return dome_planes(box, roof);
    default: {  // hipped
      std::vector<Plane> planes = ridge_planes(box, roof, {{0, 0}, {1, 1}});
      add_hips(planes, box, roof, 0.0);
      return planes;
    }
  }
}

/// Adds the faces of a wing to the roof where they are higher than the faces that are there.
void add_wing(std::vector<RoofFace>& roof, const std::vector<RoofFace>& wing) {
  std::vector<RoofFace> added;
  for (const RoofFace& face : wing) {
    std::vector<Polygon> left = face.area;
    for (RoofFace& other : roof) {
      const std::vector<Polygon> both = intersect(left, other.area);
      if (area(both) < 1e-6) continue;
      // face.z(p) >= other.z(p)  <=>  (other.slope - face.slope) . p <= face.z(0) - other.z(0)
      const dvec2 normal = other.plane.slope - face.plane.slope;
      const double lead = face.plane.z(dvec2(0.0)) - other.plane.z(dvec2(0.0));
      std::vector<Polygon> higher;
      if (glm::length(normal) > 1e-9)
        higher = cut(both, normal, lead);
      else if (lead > 0.0)
        higher = both;
      other.area = subtract(other.area, higher);
      left = subtract(left, subtract(both, higher));
    }
    if (area(left) > 1e-6) added.push_back({left, face.plane});
  }
  std::erase_if(roof, [](const RoofFace& face) { return area(face.area) < 1e-6; });
  roof.insert(roof.end(), added.begin(), added.end());
}

/// Roof over wings of different widths with one slope.
std::vector<RoofFace> roof_over_wings(const Polygon& footprint, const std::vector<Rectangle>& rectangles,
                                      const RoofOptions& options) {
  double widest = 0.0;
  for (const Rectangle& wing : rectangles) widest = std::max(widest, wing.half.y);
  std::vector<RoofFace> roof;
  std::vector<Polygon> left{footprint};
  for (const Rectangle& wing : rectangles) {
    RoofOptions narrow = options;
    narrow.ridge_z = options.eaves_z + (options.ridge_z - options.eaves_z) * (wing.half.y / widest);
    // Walls that are not quite straight reach beyond the wing's rectangle; its planes go on to them.
    const dvec2 a = wing.along * (wing.half.x + same_line_m),
                b = across_of(wing.along) * (wing.half.y + same_line_m);
    const Polygon box{{wing.center - a - b, wing.center + a - b, wing.center + a + b, wing.center - a + b},
                      {}};
    const std::vector<Polygon> area_of_wing = intersect({footprint}, {box});
    add_wing(roof, lower_envelope(area_of_wing, planes_over(wing, narrow)));
    left = subtract(left, {box});
  }
  // Wings narrower than 2 m are level.
  if (area(left) > 1e-6) roof.push_back({left, {box_of(footprint).low, options.eaves_z, dvec2(0.0)}});
  return roof;
}

}  // namespace

Plane plane_through(const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 normal = glm::cross(b - a, c - a);
  return {dvec2(a), a.z, dvec2(-normal.x / normal.z, -normal.y / normal.z)};
}

std::optional<RoofShape> roof_shape(const std::string& value) {
  // https://wiki.openstreetmap.org/wiki/Key:roof:shape, and the names of OSM Buildings.
  static const std::vector<std::pair<std::string, RoofShape>> names{
      {"flat", RoofShape::flat},
      {"skillion", RoofShape::skillion},
      {"lean_to", RoofShape::skillion},
      {"gabled", RoofShape::gabled},
      {"side_gabled", RoofShape::gabled},
      {"front_gabled", RoofShape::gabled},
      {"cross_gabled", RoofShape::gabled},
      {"half-hipped", RoofShape::half_hipped},
      {"half_hipped", RoofShape::half_hipped},
      {"side_half-hipped", RoofShape::half_hipped},
      {"hipped", RoofShape::hipped},
      {"side_hipped", RoofShape::hipped},
      {"hipped-and-gabled", RoofShape::half_hipped},
      {"pyramidal", RoofShape::pyramidal},
      {"cone", RoofShape::pyramidal},
      {"conical", RoofShape::pyramidal},
      {"gambrel", RoofShape::gambrel},
      {"mansard", RoofShape::mansard},
      {"saltbox", RoofShape::saltbox},
      {"double_saltbox", RoofShape::saltbox},
      {"quadruple_saltbox", RoofShape::hipped},
      {"round", RoofShape::round},
      {"dome", RoofShape::dome},
      {"onion", RoofShape::dome}};
  for (const auto& [name, shape] : names)
    if (name == value) return shape;
  return std::nullopt;
}

const char* name_of(RoofShape shape) {
  constexpr std::array<const char*, 11> names{"flat",    "skillion",  "gabled",  "half-hipped",
                                              "hipped",  "pyramidal", "gambrel", "mansard",
                                              "saltbox", "round",     "dome"};
  return names[static_cast<size_t>(shape)];
}

Rectangle smallest_rectangle(const std::vector<dvec2>& points) {
  std::vector<dvec2> sorted = points, hull;
  std::sort(sorted.begin(), sorted.end(),
            [](const dvec2& a, const dvec2& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); });
  // Andrew's monotone chain: the lower hull, then the upper one.
  for (int pass = 0; pass < 2; ++pass) {
    const size_t start = hull.size();
    for (const dvec2& p : sorted) {
      while (hull.size() >= start + 2) {
        const dvec2 a = hull[hull.size() - 1] - hull[hull.size() - 2], b = p - hull[hull.size() - 2];
        if (a.x * b.y - a.y * b.x > 0.0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(sorted.begin(), sorted.end());
  }
  Rectangle best;
  double least = 1e300;
  for (size_t i = 0; i < hull.size(); ++i) {
    const dvec2 edge = hull[(i + 1) % hull.size()] - hull[i];
    if (glm::length(edge) < 1e-9) continue;
    const dvec2 along = glm::normalize(edge), across = across_of(along);
    Extent u{1e300, -1e300}, v{1e300, -1e300};
    for (const dvec2& p : hull) {
      u = {std::min(u.low, glm::dot(p, along)), std::max(u.high, glm::dot(p, along))};
      v = {std::min(v.low, glm::dot(p, across)), std::max(v.high, glm::dot(p, across))};
    }
    const double size = (u.high - u.low) * (v.high - v.low);
    // A later rectangle must be clearly smaller, so that rounding does not decide.
    if (size > least * (1.0 - 1e-6)) continue;
    least = size;
    best = {0.5 * (u.low + u.high) * along + 0.5 * (v.low + v.high) * across,
            along,
            {0.5 * (u.high - u.low), 0.5 * (v.high - v.low)}};
  }
  if (best.half.y > best.half.x * (1.0 + 1e-6))
    best = {best.center, across_of(best.along), {best.half.y, best.half.x}};
  return best;
}

std::vector<RoofFace> lower_envelope(const std::vector<Polygon>& area_m, const std::vector<Plane>& planes) {
  std::vector<RoofFace> faces;
  for (size_t i = 0; i < planes.size(); ++i) {
    std::vector<Polygon> left = area_m;
    for (size_t j = 0; j < planes.size() && !left.empty(); ++j) {
      if (i == j) continue;
      // planes[i].z(p) <= planes[j].z(p)
      const dvec2 normal = planes[i].slope - planes[j].slope;
      const double lead = planes[j].z(dvec2(0.0)) - planes[i].z(dvec2(0.0));
      if (glm::length(normal) > 1e-12)
        left = cut(left, normal, lead);
      else if (lead < 0.0 || (lead == 0.0 && j < i))
        left.clear();
    }
    if (area(left) > 1e-6) faces.push_back({left, planes[i]});
  }
  return faces;
}

std::vector<RoofFace> make_roof(const Polygon& footprint, const RoofOptions& options) {
  const double rise = options.ridge_z - options.eaves_z;
  const std::vector<Polygon> whole{footprint};
  if (options.shape == RoofShape::flat || rise < 0.01)
    return {{whole, {box_of(footprint).low, options.ridge_z, dvec2(0.0)}}};
  const Rectangle box = smallest_rectangle(footprint.outer);
  if (options.shape == RoofShape::skillion) {
    const dvec2 down = options.direction_rad
                           ? dvec2(std::cos(*options.direction_rad), std::sin(*options.direction_rad))
                           : across_of(box.along);
    const Extent range = extent(footprint, box.center, down);
    return {{whole, rising(box.center + down * range.high, options.eaves_z, -down,
                           rise / (range.high - range.low))}};
  }
  const bool is_convex = footprint.holes.empty() && convex(footprint.outer);
  if (options.shape == RoofShape::pyramidal && is_convex)
    return lower_envelope(
        whole, pyramid_planes(footprint.outer, centroid(footprint.outer), options.eaves_z, options.ridge_z));
  const bool square_planned =
      options.shape == RoofShape::dome || options.shape == RoofShape::round || is_convex;
  if (!square_planned)
    if (const std::vector<Rectangle> rectangles = wings(footprint); rectangles.size() > 1)
      return roof_over_wings(footprint, rectangles, options);
  return lower_envelope(whole, planes_over(oriented(box, options.across), options));
}

}  // namespace greatx::scene::place
