// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds pairs of triangles, of any objects, that lie on each other.
#pragma once

#include "scene/check/soup.h"

namespace greatx::scene::check {

/// Compares all pairs of triangles whose boxes come within `gap_m` of each other. The overlap of a pair is
/// the intersection of the first triangle with the second, projected along the first one's normal. It counts
/// if it has at least `overlap_m2` and all its corners are nearer than the gap to the second triangle; planes
/// that only cross within the gap do not. Two faces coincide if the gap is at most 10 um, or what fp32 in the
/// file may have moved them. Adds, with the area of the overlap as the size,
///   duplicate         the same three corners twice, in one object, or in two with the same orientation
///   coincident        coincident faces of one object, and of two that look the same way
///   back_to_back      faces of two objects with a gap below gap_m that look in opposite directions,
///                     duplicates included: solids that touch, or a party wall that both have (a doubt)
///   close_faces       faces that look the same way with a gap below gap_m, which flicker in pictures (a
///                     doubt)
/// Of one triangle, at most 16 pairs with larger triangles are counted (of triangles of one size: with
/// later ones).
/// Opposite faces of one object with a gap, such as the two sides of a plate, are none of these.
/// Returns the number of triangles with more than most_neighbors larger neighbours, of which some were left
/// out.
uint64_t find_overlaps(const Soup& soup, const SoupTree& tree, const CheckOptions& options,
                       FaultList& faults);

}  // namespace greatx::scene::check
