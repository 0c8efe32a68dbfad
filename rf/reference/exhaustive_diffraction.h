// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the reference paths over one edge: every sequence of facets before it and after it is tried at every
// wedge. It shares no code with rf/search/, rf/paths/ or rf/field/, and finds the point on the edge by
// bisection instead of Keller's closed form.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/path.h"
#include "scene/description/scene.h"
#include "scene/description/wedges.h"

namespace greatx::rf::reference {

struct DiffractionOptions {
  uint32_t max_depth = 3;          ///< interactions of a path
  uint32_t max_transmissions = 0;  ///< walls (FacetKind::wall) that a whole path may pass
  uint32_t max_beside = 2;         ///< reflections on each side of the edge
};

/// Returns [receivers] all paths with one diffraction by these rules, in canonical order:
/// - The point on the edge is where the unfolded path is shortest, and lies between the edge's ends.
/// - The points before and after it lie in the wedge's exterior.
/// - No reflection next to the edge is at one of the wedge's own faces, which belongs to the edge's field.
/// - Reflections and obstruction are those of exhaustive_paths(). The faces of the wedge do not block.
/// All wedges belong to the static world, and nothing carries the ends. `body_poses` [bodies] are those of
/// `world`.
std::vector<std::vector<GeometricPath>> exhaustive_diffraction(
    const scene::Scene& scene, const FacetWorld& world, std::span<const Pose> body_poses,
    const FacetKinds& kinds, std::span<const scene::Wedge> wedges, const dvec3& transmitter,
    std::span<const dvec3> receivers, const DiffractionOptions& options);

}  // namespace greatx::rf::reference
