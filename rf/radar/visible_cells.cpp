// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/visible_cells.h"

#include <algorithm>
#include <array>

namespace greatx::rf {
namespace {

constexpr double nearest_m = 1e-5;  ///< of the source: what is nearer is not seen

/// At most a triangle cut by two planes.
struct Corners3 {
  std::array<dvec3, 8> points;
  uint32_t count = 0;
};

/// The part where normal . x + offset >= 0.
Corners3 cut(const Corners3& corners, const dvec3& normal, double offset) {
  Corners3 kept;
  for (uint32_t i = 0; i < corners.count; ++i) {
    const dvec3 &a = corners.points[i], &b = corners.points[i + 1 < corners.count ? i + 1 : 0];
    const double at_a = glm::dot(normal, a) + offset, at_b = glm::dot(normal, b) + offset;
    if (at_a >= 0.0) kept.points[kept.count++] = a;
    if ((at_a > 0.0 && at_b < 0.0) || (at_a < 0.0 && at_b > 0.0))
      kept.points[kept.count++] = a + (b - a) * (at_a / (at_a - at_b));
  }
  return kept;
}

struct Box {
  dvec2 low{1e300}, high{-1e300};
  void add(const dvec2& p) { low = glm::min(low, p), high = glm::max(high, p); }
  bool meets(const Box& o) const {
    return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y;
  }
};

/// The planes around a box of the (u, v) plane, and that of the facet that the beam starts from.
std::array<KeptSide, 5> around(const TubeBeam& beam, const BeamStart& start, const Box& box) {
  const auto side = [&](const dvec3& normal) { return KeptSide{normal, -glm::dot(normal, beam.source)}; };
  std::array<KeptSide, 5> spaces{side(beam.e1 - box.low.x * beam.axis),
                                  side(box.high.x * beam.axis - beam.e1),
                                  side(beam.e2 - box.low.y * beam.axis),
                                  side(box.high.y * beam.axis - beam.e2),
                                  {}};
  if (start.facet != nullptr)
    spaces[4] = {start.side * start.facet->normal, -start.side * start.facet->offset};
  return spaces;
}

/// A triangle as the beam sees it; empty if it does not.
Polygon seen(const std::array<dvec3, 3>& triangle, const TubeBeam& beam, const BeamStart& start,
             const Box& within) {
  Corners3 corners{{triangle[0], triangle[1], triangle[2]}, 3};
  corners = cut(corners, beam.axis, -glm::dot(beam.axis, beam.source) - nearest_m);
  if (start.facet != nullptr) {
    const dvec3 normal = start.side * start.facet->normal;
    corners = cut(corners, normal, -start.side * start.facet->offset);
  }
  if (corners.count < 3) return {};
  std::array<dvec2, 8> points;
  Box box;
  for (uint32_t i = 0; i < corners.count; ++i) box.add(points[i] = beam.uv(corners.points[i]));
  if (!box.meets(within)) return {};
  return Polygon(std::span(points.data(), corners.count));
}

/// Takes `cover` out of `part`: what remains, as convex pieces.
void subtract(Polygon part, const Polygon& cover, uint32_t facet, double smallest,
              std::vector<VisibleCell>& out) {
  for (uint32_t i = 0; i < cover.size() && !part.empty(); ++i) {
    const HalfPlane inside = cover.inside(i);
    const Polygon beyond = part.clipped({-inside.normal, -inside.offset});
    if (beyond.area() > smallest) out.push_back({beyond, facet});
    part = part.clipped(inside);
  }
}

}  // namespace

void find_visible(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam,
                  const BeamStart& start, const Polygon& whole, std::span<const uint32_t> facets,
                  double smallest, std::vector<VisibleCell>& cells) {
  cells.assign(1, {whole, VisibleCell::nothing});
  Box within;
  for (uint32_t i = 0; i < whole.size(); ++i) within.add(whole[i]);
  const std::array<KeptSide, 5> spaces = around(beam, start, within);
  const std::span<const KeptSide> used(spaces.data(), start.facet == nullptr ? 4u : 5u);
  std::vector<VisibleCell> next;
  std::vector<uint32_t> triangles;
  for (const uint32_t facet : facets) {
    if (facet == start.index) continue;
    const PosedFacet& posed = world.facet(facet);
    const auto nearer = [&](const dvec2& at, uint32_t than) {
      const dvec3 direction = beam.along(at);
      const double reach = beam.reach(posed, direction);
      if (!(reach > 0.0)) return false;
      if (start.facet != nullptr && reach <= beam.reach(*start.facet, direction) * (1.0 + 1e-12))
        return false;
      return than == VisibleCell::nothing || reach < beam.reach(world.facet(than), direction) * (1.0 - 1e-9);
    };
    trees.find(world, facet, used, triangles);
    for (const uint32_t triangle : triangles) {
      const Polygon cover = seen(world.corners(facet, triangle), beam, start, within);
      if (cover.empty()) continue;
      next.clear();
      for (const VisibleCell& cell : cells) {
        if (cell.facet == facet) {
          next.push_back(cell);
          continue;
        }
        const Polygon overlap = intersection(cell.part, cover);
        if (!(overlap.area() > smallest) || !nearer(overlap.centroid(), cell.facet)) {
          next.push_back(cell);
          continue;
        }
        next.push_back({overlap, facet});
        subtract(cell.part, cover, cell.facet, smallest, next);
      }
      cells.swap(next);
    }
  }
}

}  // namespace greatx::rf
