// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Models foliage as a volume: a closed mesh that neither reflects nor blocks. It attenuates a path by the
// depth of foliage that the path crosses.
#pragma once

#include "core/dual.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// Validity of Weissberger's modified exponential decay, which was fitted to measurements from 230 MHz to 95
/// GHz in up to 400 m of foliage.
inline constexpr double weissberger_min_hz = 0.23e9, weissberger_max_hz = 95e9;
inline constexpr double weissberger_branch_m = 14.0, weissberger_max_depth_m = 400.0;

/// Returns whether the attenuation of `foliage` is known at `frequency_hz`. An explicit attenuation in dB/m
/// holds at all frequencies.
bool foliage_model_covers(const scene::Foliage& foliage, double frequency_hz);

/// Returns the attenuation in dB (a loss, >= 0) of `depth_m` metres of foliage. `depth_m` is the total depth
/// along a path. An explicit attenuation in dB/m is multiplied by the depth. Otherwise the function follows
/// M. A. Weissberger, "An initial critical summary of models for predicting the attenuation of radio waves by
/// trees", ESD-TR-81-101, 1982, with f in GHz:
///   0.45 f^0.284 d           for d <= 14 m,
///   1.33 f^0.284 d^0.588     for 14 m < d <= 400 m.
/// The branches do not meet: at 14 m the second is 0.023 f^0.284 dB below the first (0.06 dB at 28 GHz).
/// Beyond 400 m, where there are no measurements, the second branch is extrapolated. Throws UserError for a
/// frequency outside 0.23 to 95 GHz.
template <typename R = double>
R foliage_db(const scene::Foliage& foliage, const Given<R>& frequency_hz, double depth_m);

/// Checks a scene in which foliage attenuates. Throws UserError naming
/// - the material, if its attenuation is not known at `frequency_hz`;
/// - the object and the material, if their facets have an open edge, since a depth needs a closed volume. An
///   edge is open if the number of triangles that run along it in one direction differs from the number in
///   the other. Overlapping crowns count as closed. The ends of edges are compared by their exact positions.
void check_foliage(const scene::Scene& scene, double frequency_hz);

}  // namespace greatx::rf
