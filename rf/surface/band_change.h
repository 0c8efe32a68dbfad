// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Bounds what a channel's band changes in the reflection and transmission of a material. The effect
// `dispersion` may stay off while this is within the tolerance.
#pragma once

#include <optional>
#include <string>

#include "core/band.h"
#include "rf/surface/roughness.h"
#include "scene/material/material.h"

namespace greatx::rf {

/// Holds the largest |c(f) - c(f_c)| of the coefficients c of a wall, over the frequencies f of the band, all
/// angles of incidence, both polarizations and both sides. It is relative to the incident field and not to
/// the coefficient, which is 0 at Brewster's angle, where a ratio has no bound. The difference is that of
/// complex numbers, so it includes the phase.
struct BandChange {
  double reflection = 0.0;    ///< 0 to 2
  double transmission = 0.0;  ///< of the wall as a sheet; 0 for a wall that lets nothing pass
};

/// Returns the bound for a material that is not foliage. `roughness` (nullopt: off) and `scattering` select
/// the effects that weaken its reflections (specular_share).
///
/// The maximum is searched for, not derived: on a grid of angles, dense towards grazing incidence, and of
/// frequencies, both so dense that the phase within the layers changes by at most pi/16 between neighbours
/// (up to 512 angles and 256 frequencies), and from the best point on by shrinking steps. The result is 1.05
/// times the largest value found. Throws UserError naming the material if it is not known in all of the band.
BandChange most_band_change(const scene::RadioMaterial& material, const Band& band,
                            std::optional<RoughnessModel> roughness, bool scattering,
                            const std::string& material_name);

}  // namespace greatx::rf
