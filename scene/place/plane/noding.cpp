// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/plane/noding.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "scene/place/plane/geos.h"

namespace greatx::scene::place {

namespace {

/// Position on a Hilbert curve over 2^16 x 2^16 cells. Points that are inserted in this order lie near the
/// one before, so that the search for their triangle is short.
uint64_t hilbert(uint32_t x, uint32_t y) {
  uint64_t place = 0;
  for (uint32_t step = 1u << 15; step > 0; step >>= 1) {
    const uint32_t right = (x & step) != 0, up = (y & step) != 0;
    place += uint64_t{step} * step * ((3 * right) ^ up);
    if (up == 0) {
      if (right == 1) {
        x = 0xFFFFu - x;
        y = 0xFFFFu - y;
      }
      std::swap(x, y);
    }
  }
  return place;
}

}  // namespace

std::vector<std::array<GridPoint, 2>> node(std::span<const Segment> segments, double grid_m) {
  const double units = grid_m * grid_per_m;
  GREATX_CHECK(units >= 1.0 && units == std::round(units), "grid of {} m", grid_m);
  if (segments.empty()) return {};
  std::vector<GEOSGeometry*> lines;
  for (const Segment& segment : segments) lines.push_back(line_of({segment[0], segment[1]}).release());
  const Geometry all = own(GEOSGeom_createCollection_r(geos(), GEOS_MULTILINESTRING, lines.data(),
                                                       static_cast<unsigned>(lines.size())));
  const Geometry noded = own(GEOSUnaryUnionPrec_r(geos(), all.get(), grid_m));
  std::set<std::array<GridPoint, 2>> edges;
  const auto add_line = [&](const GEOSGeometry* line) {
    const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(geos(), line);
    unsigned count = 0;
    GEOSCoordSeq_getSize_r(geos(), sequence, &count);
    GridPoint last{};
    for (unsigned i = 0; i < count; ++i) {
      dvec2 p;
      GEOSCoordSeq_getXY_r(geos(), sequence, i, &p.x, &p.y);
      const GridPoint here = to_grid(p);
      if (i > 0 && here != last) edges.insert({std::min(last, here), std::max(last, here)});
      last = here;
    }
  };
  const int count = GEOSGetNumGeometries_r(geos(), noded.get());
  for (int i = 0; i < count; ++i) {
    const GEOSGeometry* part = GEOSGetGeometryN_r(geos(), noded.get(), i);
    if (GEOSGeomTypeId_r(geos(), part) == GEOS_LINESTRING && GEOSisEmpty_r(geos(), part) == 0) add_line(part);
  }
  return {edges.begin(), edges.end()};
}

Triangulation triangulate_noded(const GridPoint& low, const GridPoint& high,
                                std::span<const std::array<GridPoint, 2>> edges) {
  Triangulation triangulation(low, high);
  std::vector<GridPoint> points;
  for (const auto& edge : edges) points.insert(points.end(), edge.begin(), edge.end());
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const double scale = 65535.0 / static_cast<double>(std::max(high.x - low.x, high.y - low.y));
  const auto place = [&](const GridPoint& p) {
    return hilbert(static_cast<uint32_t>(static_cast<double>(p.x - low.x) * scale),
                   static_cast<uint32_t>(static_cast<double>(p.y - low.y) * scale));
  };
  std::vector<std::pair<uint64_t, GridPoint>> order;
  for (const GridPoint& p : points) order.emplace_back(place(p), p);
  std::sort(order.begin(), order.end());
  for (const auto& [key, p] : order) triangulation.add(p);
  for (const auto& edge : edges) triangulation.force(triangulation.add(edge[0]), triangulation.add(edge[1]));
  return triangulation;
}

}  // namespace greatx::scene::place
