// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/reference/pyramid.h"

#include <algorithm>
#include <cmath>

namespace greatx::rf::reference {

namespace {

constexpr double room_m = 1e-6;  ///< covers the roundings of a plane through three points at kilometres

struct Corner {
  dvec2 at;
  dvec3 point;
};

double turn(const Corner& a, const Corner& b, const Corner& c) {
  return (b.at.x - a.at.x) * (c.at.y - a.at.y) - (b.at.y - a.at.y) * (c.at.x - a.at.x);
}

}  // namespace

/// Uses the algorithm of A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions",
/// 1979.
Hull convex_hull(const PosedFacet& facet, const std::vector<dvec3>& points) {
  Hull hull;
  std::vector<Corner> corners;
  for (const dvec3& corner : points) {
    const dvec3 point =
        corner - facet.distance(corner) * facet.normal;  // files have it slightly off the plane
    corners.push_back({facet.plane_coordinates(point), point});
    hull.box.add(point);
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return a.at.x != b.at.x ? a.at.x < b.at.x : a.at.y < b.at.y;
  });
  std::vector<Corner> chain;
  for (int half = 0; half < 2; ++half) {
    const size_t start = chain.size();
    for (const Corner& corner : corners) {
      while (chain.size() >= start + 2 && turn(chain[chain.size() - 2], chain.back(), corner) <= 0.0)
        chain.pop_back();
      chain.push_back(corner);
    }
    chain.pop_back();
    std::reverse(corners.begin(), corners.end());
  }
  for (const Corner& corner : chain) {
    hull.corners.push_back(corner.point);
    hull.center += corner.point / static_cast<double>(chain.size());
  }
  return hull;
}

void pyramid(const dvec3& image, const PosedFacet& facet, const Hull& hull, double side,
             std::vector<HalfSpace>& half_spaces) {
  half_spaces.clear();
  half_spaces.push_back({side * facet.normal, side * facet.offset - facet.tolerance_m});
  const dvec3 to_center = hull.center - image;
  for (size_t i = 0; i < hull.corners.size(); ++i) {
    const dvec3 from = hull.corners[i], edge = hull.corners[(i + 1) % hull.corners.size()] - from;
    // The facet is closed within its tolerance, so that the edge is moved outwards.
    dvec3 outwards = glm::cross(facet.normal, edge);
    if (glm::dot(outwards, hull.center - from) > 0.0) outwards = -outwards;
    const double length = glm::length(outwards);
    if (!(length > 0.0)) continue;
    const dvec3 a = from + (4.0 * facet.tolerance_m + room_m) / length * outwards - image, b = a + edge;
    const dvec3 normal = glm::cross(a, b);
    const double size = glm::length(normal);
    if (!(size > 1e-5 * glm::length(a) * glm::length(b))) continue;
    const double inwards = glm::dot(normal, to_center) / size;
    if (std::abs(inwards) < 1e-9 * glm::length(to_center)) continue;
    const dvec3 unit = normal / std::copysign(size, inwards);
    half_spaces.push_back({unit, glm::dot(unit, image) - room_m});
  }
}

HalfSpace mirrored(const HalfSpace& half, const PosedFacet& facet) {
  const double along = glm::dot(half.normal, facet.normal);
  return {half.normal - 2.0 * along * facet.normal, half.offset - 2.0 * along * facet.offset};
}

bool may_meet(const Hull& hull, const std::vector<HalfSpace>& half_spaces) {
  return std::all_of(half_spaces.begin(), half_spaces.end(), [&](const HalfSpace& half) {
    return std::any_of(hull.corners.begin(), hull.corners.end(),
                       [&](const dvec3& corner) { return half.depth(corner) >= 0.0; });
  });
}

}  // namespace greatx::rf::reference
