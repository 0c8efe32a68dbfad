// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds openings: edges of one triangle that no other surface closes.
//
// An open edge is closed where another triangle, of any object, comes within the tolerance of it: a
// triangle's slab (its plane and its three sides, moved outwards by the tolerance) cuts an interval out of
// the edge. So the wall that two houses share may belong to one of them, a terrain may consist of several
// objects, and a house without a floor may stand on the ground. The tolerance is weld_m or a tenth of the
// edge's length, the smaller of the two: neighbours in a mesh of fine triangles must not close the edges of a
// hole in it. Hence a hole is found if it is wider than weld_m across each of its edges, or than a tenth of
// the edge.
#pragma once

#include "scene/check/topology.h"

namespace greatx::scene::check {

/// What closes the open edges of parts.
struct Closing {
  /// [parts] Parts of the same group close edges of each other.
  std::vector<uint32_t> group;
  uint64_t crowds = 0;  ///< edges with more than most_neighbors; those that were left out close nothing
};

/// Sets `closed` and `open_m` of all open edges, and adds T-junctions to `faults`: corners of the closing
/// triangles that lie on the inside of an open edge.
Closing close_by_others(const Soup& soup, Topology& topology, const SoupTree& tree,
                        const CheckOptions& options, FaultList& faults);

/// Adds what is left open: holes of solids and of foliage (faults), and the borders of sheets (doubts; none
/// for ground, roads, pavements, markings and water). A hole is a doubt if it is hidden: if another surface
/// is above each of its edges, no higher than the part (a house without a floor that reaches into the
/// ground), or if most of 128 rays out of it first meet the back of a surface (the open end of a sill within
/// a wall). A sheet of ground has holes where its loops other than the largest are open, and cracks where its
/// border runs within 0.1 m of the border of another part, unless another surface is at most 1 m below
/// (doubts). Sets Part::hidden_opening.
void find_openings(const Soup& soup, Topology& topology, const SoupTree& tree, const CheckOptions& options,
                   FaultList& faults);

}  // namespace greatx::scene::check
