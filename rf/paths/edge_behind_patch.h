// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds paths that a patch scatters over an edge to the target:
//
//   source ─► reflections ─► patch ─► edge ─► target      PathLimits::scattering_beside_diffraction
//
// The target sees few edges, and the source lights many patches. Candidates are drawn: an edge that the
// target sees, by angle and distance, a place on it near the target, and a patch by a descent of the tree of
// what the source lights towards this place. Whether and how strongly the pair diffracts, the closed forms of
// Keller's point and of edge_share() say. From the candidates draw_scatterings() draws, by delay and by
// power, those that are traced (resampled importance sampling, as in rf/paths/indirect_light.h). Each pair of
// edge and patch that carries power may be drawn, and a path grows by the inverse of its probability.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/config/path_limits.h"
#include "rf/geometry/geometry.h"
#include "rf/geometry/path.h"
#include "rf/paths/radio_model.h"
#include "rf/paths/scatterers.h"

namespace greatx::rf {

/// Appends the paths that are drawn for a target, from transmitter to receiver. `tree` is that of the source,
/// which lights the patches of `scatterers`, and `edges` are the wedges that the target may see.
/// limits.scattering_budget must be greater than 0.
void scatter_over_edges(const RadioModel& model, const PathLimits& limits, const Scatterers& scatterers,
                        const ImageTree& tree, const dvec3& target, std::span<const uint32_t> edges,
                        std::vector<GeometricPath>& paths);

}  // namespace greatx::rf
