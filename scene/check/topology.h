// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Says which triangles hang together, and which edges only one triangle has.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/check/soup.h"

namespace greatx::scene::check {

/// An edge that exactly one triangle of its part has.
struct OpenEdge {
  uint32_t triangle = 0;
  dvec3 a{0.0}, b{0.0};            ///< in the order of the triangle's winding
  uint32_t from = 0, to = 0;       ///< Topology::corners of a and b
  uint32_t shared_with = nothing;  ///< another part of the same object that has the same edge
  bool closed = false;             ///< set by close_by_others(): surfaces lie along the whole edge
  double open_m = 0.0;             ///< set by close_by_others(): length that no surface closes
};

/// Where openings would have caps: the open edges of a part that hang together.
struct Loop {
  std::vector<uint32_t> edges;  ///< into Topology::open_edges
  dvec3 center{0.0};            ///< mean of the edges' middles
  double length_m = 0.0;
  double cap_m2 = 0.0;    ///< area of the triangles between the edges and the centre
  dvec3 cap_normal{0.0};  ///< their area vector, m^2
};

enum class PartKind { closed, nearly_closed, sheet };

struct Part {
  uint32_t object = 0;
  uint32_t first = 0, count = 0;  ///< into Topology::part_triangles
  PartKind kind = PartKind::closed;
  double area_m2 = 0.0;
  /// Of the part with its caps, if all triangles are turned as Topology::turned says, m^3: never negative.
  double volume_m3 = 0.0;
  bool one_sided = true;  ///< false: no orientation fits all triangles (a Moebius strip)
  Bounds bounds;
  bool hidden_opening = false;  ///< set by find_openings()
  std::vector<Loop> loops;      ///< of all its open edges
};

struct Topology {
  std::vector<uint32_t> corners;  ///< [3 * triangles] numbers; equal ones are welded
  std::vector<uint32_t> part;     ///< [triangles] into parts
  /// [triangles] whether a triangle must be turned for its part to have one orientation: outwards if it is
  /// closed or nearly closed, and that of most of its area if it is a sheet.
  std::vector<uint8_t> turned;
  std::vector<Part> parts;
  std::vector<uint32_t> part_triangles;  ///< part by part
  std::vector<OpenEdge> open_edges;      ///< part by part

  std::span<const uint32_t> triangles_of(const Part& one) const {
    return std::span(part_triangles).subspan(one.first, one.count);
  }
};

/// Caps may have this part of the area of a part that is nearly closed. A cube without one face has 1/5, half
/// a sphere 1/2, and a hall of 20 x 20 x 6.5 m without its floor 0.43.
inline constexpr double most_cap_share = 0.45;
/// A cap of a part that is nearly closed is at most this many times as large as the surfaces that face the
/// cap's direction or the opposite one, projected and halved. A box without one face has 2. A tube has no
/// surface across it and is a sheet.
inline constexpr double most_cap_by_shadow = 3.0;

/// Corners at exactly the same place are one. Where edges then are open, their ends are welded within
/// `weld_m`, or a tenth of the shortest open edge at either if that is less (each to the nearest one before
/// it), so that a mesh of details smaller than that keeps its form.
/// Triangles that welding leaves without area belong to no edge and are parts of their own.
Topology make_topology(const Soup& soup, double weld_m);

}  // namespace greatx::scene::check
