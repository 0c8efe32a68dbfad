// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds faults in the triangles and materials of a model, before anybody simulates with it:
//
//   Model ─► Soup (soup.h)          placed triangles in fp64; those without area or with NaN are set apart
//         ─► Topology (topology.h)  welded corners, edges, parts, edges that only one triangle has
//         ─► openings.h             which open edges other surfaces close; holes, sheets, T-junctions
//         ─► orientation.h          flipped triangles, parts inside out, vertex normals
//         ─► inside_rays.h          rays from points within solids
//         ─► overlaps.h             duplicates, coincident faces, faces too close to each other
//         ─► sizes.h                slivers, tiny facets, coordinates, scales, axes
//         ─► model_materials.h      radio properties, pictures
//         ─► SceneFaults            by kind: how many, the worst, and where
//
// A part is a set of triangles of one object (a node with a mesh) that hang together by edges that exactly
// two of them share. A part is closed if it has no other edges, nearly closed if caps over its openings would
// have at most 45 % of its area, and otherwise a sheet. Closed and nearly closed parts claim to be solids.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/gltf/model.h"

namespace greatx::scene {

struct CheckOptions {
  /// Corners of one object this close together are welded, if their edges are open otherwise, and an open
  /// edge is closed by a surface that is this close; or a tenth of the edge's length, if that is less.
  double weld_m = 1e-3;
  double gap_m = 1e-3;        ///< faces that overlap with a smaller gap are reported
  double overlap_m2 = 1e-4;   ///< overlaps of a smaller area are not
  double sliver_m = 0.01;     ///< triangles of a smaller height are slivers
  double facet_m = 0.01;      ///< facets of a smaller mean width (area/diameter) are tiny
  uint32_t rays = 256;        ///< from within each part that claims to be a solid; 0: none
  uint64_t seed = 1;          ///< of the points and directions of the rays
  bool radio = true;          ///< materials need radio properties
  size_t most_places = 1000;  ///< kept of each kind, worst first
  uint32_t threads = 0;       ///< 0: usable_cores(); the result does not depend on it
};

/// Names how bad something is. `fault`: the data of sensors would be wrong. `doubt`: it may be meant, and a
/// person should look at it.
enum class FaultSeverity { doubt, fault };

/// A place of a fault. Of `no_radio`, `other` holds the suggested radio fields; of `lost_picture`, `material`
/// holds the message.
struct FaultPlace {
  dvec3 at{0.0};         ///< m, in the model's frame (x east, y north, z up)
  std::string object;    ///< name of the node; empty: none
  std::string other;     ///< the second object of a pair; empty: none
  std::string material;  ///< empty: none
  double size = 0.0;     ///< in SceneFault::unit
};

/// All faults of one kind.
struct SceneFault {
  FaultSeverity severity = FaultSeverity::doubt;
  std::string kind;  ///< a name for programs: hole, open_sheet, t_junction, ...
  std::string text;  ///< words for people that follow a count: "holes in solids"
  std::string unit;  ///< of sizes: "m", "m2", ...; empty: sizes have no meaning
  uint64_t count = 0;
  double worst = 0.0;              ///< the size of the worst place
  double total = 0.0;              ///< the sum of the sizes of all places
  std::vector<FaultPlace> places;  ///< worst first, at most CheckOptions::most_places
};

struct CheckFigures {
  uint64_t objects = 0, triangles = 0, facets = 0, materials = 0;
  uint64_t closed_parts = 0, nearly_closed_parts = 0, sheets = 0;
  uint64_t open_edges = 0, closed_by_others = 0;  ///< edges with one triangle; those that other parts close
  uint64_t rays = 0, rays_out = 0;
  uint64_t crowds = 0;  ///< triangles and edges of whose many neighbours only 1024 were looked at
  Bounds bounds;
};

struct SceneFaults {
  std::vector<SceneFault> faults;  ///< faults first, then doubts
  CheckFigures figures;
  uint64_t count(FaultSeverity severity) const;           ///< of places of this severity
  const SceneFault* find(const std::string& kind) const;  ///< null: none was found
};

/// Checks a model, which should be loaded with LoadOptions::keep_faults and `optical_only`, so that the
/// loader leaves the faults to this function. The same model and options give the same result. docs/check.md
/// lists the kinds.
SceneFaults check_scene(const Model& model, const CheckOptions& options = {});

}  // namespace greatx::scene
