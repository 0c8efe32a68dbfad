// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Owns the objects of GEOS. Only files of this room include it.
#pragma once

#include <geos_c.h>
#include <memory>
#include <vector>

#include "core/vec.h"
#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

/// Returns this thread's context. Errors of GEOS become UserError.
GEOSContextHandle_t geos();

struct FreeGeometry {
  void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(geos(), geometry); }
};
using Geometry = std::unique_ptr<GEOSGeometry, FreeGeometry>;

/// Takes the result of a call of GEOS. Throws UserError with GEOS's own message if it is null.
Geometry own(GEOSGeometry* geometry);
Geometry geometry_of(const Polygon& polygon);
Geometry geometry_of(const std::vector<Polygon>& polygons);
Geometry line_of(const std::vector<dvec2>& points);
/// Returns the polygons of a geometry; points and lines in it are left out. Outer rings are
/// counter-clockwise, holes clockwise.
std::vector<Polygon> polygons_of(const GEOSGeometry* geometry);

}  // namespace greatx::scene::place
