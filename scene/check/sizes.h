// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks sizes: of triangles and facets, of objects by their class, of the scene, and of coordinates.
#pragma once

#include "scene/check/topology.h"

namespace greatx::scene::check {

/// Adds doubts
///   sliver        triangles of a height (twice the area by the longest side) below sliver_m
///   tiny_facet    facets as radio sees them (scene/build/facets.h) of a mean width (area by diameter) below
///                 facet_m; a facet of many slivers is none
/// Returns the number of facets.
uint64_t find_small_faces(const Soup& soup, const Topology& topology, const CheckOptions& options,
                          FaultList& faults);

/// Adds
///   rounded       objects whose coordinates are so large that fp32 in the file rounds them by more than half
///                 of weld_m (a doubt; the size is the rounding)
///   far_away      objects whose middle is farther from the median of all middles than ten times the distance
///                 of nine tenths of the others, and than 100 m (a doubt; the size is the distance)
///   scene_size    a scene of a longest side below 0.1 m or above 100 km (a doubt; the size is that side)
///   object_size   objects too large or too small for their class by docs/check.md, as a car of 400 m in a
///                 file in centimetres (a doubt; the size is the longest side)
///   on_its_side   a scene that seems to lie on its side, by the rule of docs/check.md (a fault; the size is
///                 the area that faces the direction that should be up)
void find_strange_sizes(const Soup& soup, const CheckOptions& options, FaultList& faults);

}  // namespace greatx::scene::check
