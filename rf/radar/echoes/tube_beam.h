// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes a tube on its way, unfolded: the point from which its rays seem to come, and coordinates that a
// ray keeps when it is reflected.
#pragma once

#include <cmath>

#include "core/vec.h"
#include "rf/facets/facet_world.h"

namespace greatx::rf {

/// Returns the image of a point in the plane of a mirror.
inline dvec3 mirrored(const PosedFacet& mirror, const dvec3& point) {
  return point - 2.0 * mirror.distance(point) * mirror.normal;
}

/// Holds the axes of a beam. Rays leave `source` along axis + u e1 + v e2. Straight lines of the (u, v) plane
/// are planes through the source, so that triangles are polygons there. A reflection mirrors all four
/// vectors, and the (u, v) of a ray stays the same.
struct TubeBeam {
  dvec3 source{0.0}, axis{1, 0, 0}, e1{0, 1, 0}, e2{0, 0, 1};

  TubeBeam() = default;
  TubeBeam(const dvec3& from, const dvec3& unit_axis) : source(from), axis(unit_axis) {
    const dvec3 up = std::abs(axis.z) < 0.7 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
    e1 = glm::normalize(glm::cross(up, axis));
    e2 = glm::cross(axis, e1);
  }
  dvec3 along(const dvec2& uv) const { return axis + uv.x * e1 + uv.y * e2; }
  /// Returns (u, v) of a point in front of the source.
  dvec2 uv(const dvec3& point) const {
    const dvec3 arm = point - source;
    return dvec2(glm::dot(arm, e1), glm::dot(arm, e2)) / glm::dot(arm, axis);
  }
  /// Returns the distance to the plane of `facet` along a ray, in units of the length of `direction`. The
  /// result is not finite for a ray parallel to the plane.
  double reach(const PosedFacet& facet, const dvec3& direction) const {
    return -facet.distance(source) / glm::dot(facet.normal, direction);
  }
  /// Returns where a ray meets the plane of `facet`.
  dvec3 on(const PosedFacet& facet, const dvec2& at) const {
    const dvec3 direction = along(at);
    return source + reach(facet, direction) * direction;
  }
  TubeBeam mirrored(const PosedFacet& facet) const {
    TubeBeam beam = *this;
    const auto flip = [&](dvec3& v) { v -= 2.0 * glm::dot(facet.normal, v) * facet.normal; };
    beam.source = rf::mirrored(facet, source);
    flip(beam.axis), flip(beam.e1), flip(beam.e2);
    return beam;
  }
};

/// Returns the point of a facet's plane with the plane coordinates `p`.
inline dvec3 point_of(const PosedFacet& facet, const dvec2& p) {
  return facet.normal * facet.offset + facet.axis_u * (p.x + facet.offset_u) +
         facet.axis_v * (p.y + facet.offset_v);
}

}  // namespace greatx::rf
