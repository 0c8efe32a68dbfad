// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds triangles that face the wrong way. The winding decides which side is the front: there `layers` of a
// wall begin, and there normals point.
#pragma once

#include "scene/check/topology.h"

namespace greatx::scene::check {

/// Adds
///   flipped           triangles that face another way than most of the area of their part
///   inside_out        closed or nearly closed parts of negative volume; a doubt if the part contains the
///                     whole scene, since rooms are modelled so, and nothing if it lies within another closed
///                     part of its object, since cavities are
///   not_orientable    parts with no consistent orientation
/// The place of `inside_out` is the middle of the part and its size the volume, m^3; that of `flipped` is the
/// middle of the triangle and its size the area, m^2.
void find_wrong_sides(const Soup& soup, const Topology& topology, FaultList& faults);

/// Adds normals_against_winding: triangles at all of whose corners the file's normals point to the back.
void find_wrong_normals(const Model& model, FaultList& faults);

}  // namespace greatx::scene::check
