// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/plane/geos.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "scene/place/plane/polygons.h"

namespace greatx::scene::place {

namespace {

thread_local std::string geos_message;

void keep_message(const char* message, void*) { geos_message = message; }

struct Context {
  GEOSContextHandle_t handle = GEOS_init_r();
  Context() { GEOSContext_setErrorMessageHandler_r(handle, keep_message, nullptr); }
  ~Context() { GEOS_finish_r(handle); }
};

/// Makes a closed sequence of coordinates.
GEOSCoordSequence* sequence_of(const std::vector<dvec2>& points, bool close) {
  const size_t count = points.size() + (close && !points.empty() ? 1 : 0);
  GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(geos(), static_cast<unsigned>(count), 2);
  GREATX_CHECK(sequence, "no memory for {} points", count);
  for (size_t i = 0; i < count; ++i) {
    const dvec2& p = points[i % points.size()];
    GEOSCoordSeq_setXY_r(geos(), sequence, static_cast<unsigned>(i), p.x, p.y);
  }
  return sequence;
}

Ring ring_of(const GEOSGeometry* linear_ring, bool counter_clockwise) {
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(geos(), linear_ring);
  unsigned count = 0;
  GEOSCoordSeq_getSize_r(geos(), sequence, &count);
  Ring ring;
  for (unsigned i = 0; i + 1 < count; ++i) {
    dvec2 p;
    GEOSCoordSeq_getXY_r(geos(), sequence, i, &p.x, &p.y);
    ring.push_back(p);
  }
  if ((signed_area(ring) > 0.0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

}  // namespace

GEOSContextHandle_t geos() {
  thread_local const Context context;
  return context.handle;
}

Geometry own(GEOSGeometry* geometry) {
  if (!geometry) throw_user_error("place: geometry: {}", geos_message);
  return Geometry(geometry);
}

Geometry line_of(const std::vector<dvec2>& points) {
  return own(GEOSGeom_createLineString_r(geos(), sequence_of(points, false)));
}

Geometry geometry_of(const Polygon& polygon) {
  std::vector<GEOSGeometry*> holes;
  for (const Ring& hole : polygon.holes)
    if (hole.size() >= 3)
      holes.push_back(own(GEOSGeom_createLinearRing_r(geos(), sequence_of(hole, true))).release());
  if (polygon.outer.size() < 3) return own(GEOSGeom_createEmptyPolygon_r(geos()));
  GEOSGeometry* outer = own(GEOSGeom_createLinearRing_r(geos(), sequence_of(polygon.outer, true))).release();
  return own(GEOSGeom_createPolygon_r(geos(), outer, holes.data(), static_cast<unsigned>(holes.size())));
}

Geometry geometry_of(const std::vector<Polygon>& polygons) {
  std::vector<GEOSGeometry*> parts;
  for (const Polygon& polygon : polygons) parts.push_back(geometry_of(polygon).release());
  return own(GEOSGeom_createCollection_r(geos(), GEOS_MULTIPOLYGON, parts.data(),
                                         static_cast<unsigned>(parts.size())));
}

std::vector<Polygon> polygons_of(const GEOSGeometry* geometry) {
  std::vector<Polygon> polygons;
  const int count = GEOSGetNumGeometries_r(geos(), geometry);
  for (int i = 0; i < count; ++i) {
    const GEOSGeometry* part = GEOSGetGeometryN_r(geos(), geometry, i);
    const int type = GEOSGeomTypeId_r(geos(), part);
    if (type == GEOS_MULTIPOLYGON || type == GEOS_GEOMETRYCOLLECTION) {
      for (Polygon& inner : polygons_of(part)) polygons.push_back(std::move(inner));
    } else if (type == GEOS_POLYGON && GEOSisEmpty_r(geos(), part) == 0) {
      Polygon& polygon = polygons.emplace_back();
      polygon.outer = ring_of(GEOSGetExteriorRing_r(geos(), part), true);
      const int holes = GEOSGetNumInteriorRings_r(geos(), part);
      for (int hole = 0; hole < holes; ++hole)
        polygon.holes.push_back(ring_of(GEOSGetInteriorRingN_r(geos(), part, hole), false));
    }
  }
  return polygons;
}

}  // namespace greatx::scene::place
