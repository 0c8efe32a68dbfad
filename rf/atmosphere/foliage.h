// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Foliage as a volume: a closed mesh that neither reflects nor blocks and takes power by the depth of it on
// the way.
#pragma once

#include "scene/description/scene.h"

namespace greatx::rf {

/// Weissberger's modified exponential decay: fitted to measurements from 230 MHz to 95 GHz, in up to 400 m of
/// foliage.
inline constexpr double weissberger_min_hz = 0.23e9, weissberger_max_hz = 95e9;
inline constexpr double weissberger_branch_m = 14.0, weissberger_max_depth_m = 400.0;

/// Whether `foliage` is known at `frequency_hz`; explicit dB/m hold everywhere.
bool foliage_model_covers(const scene::Foliage& foliage, double frequency_hz);

/// Attenuation in dB (a loss, >= 0) of `depth_m` metres of foliage, all of a path's together: explicit dB/m
/// times the depth, else M. A. Weissberger, "An initial critical summary of models for predicting the
/// attenuation of radio waves by trees", ESD-TR-81-101, 1982, f in GHz:
///   0.45 f^0.284 d           for d <= 14 m,
///   1.33 f^0.284 d^0.588     for 14 m < d <= 400 m.
/// The branches do not meet: at 14 m the second is 0.023 f^0.284 dB below the first (0.06 dB at 28 GHz).
/// Beyond 400 m, where nothing was measured, the second is carried on. Throws UserError for a frequency
/// outside 0.23 to 95 GHz.
double foliage_db(const scene::Foliage& foliage, double frequency_hz, double depth_m);

/// For scenes whose foliage counts: throws UserError naming
/// - the material, if it is not known at `frequency_hz`;
/// - the object and the material, if their facets have an open edge (one that not as many triangles run along
///   in one
///   direction as in the other): a depth needs an inside. Crowns that overlap are closed all the same. Edges
/// are
///   compared by the exact positions of their ends.
void check_foliage(const scene::Scene& scene, double frequency_hz);

}  // namespace greatx::rf
