// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a specular path does to the field: Fresnel coefficients between the polarizations at both ends,
// spreading, delay and Doppler shift.
#pragma once

#include "rf/facet_world.h"
#include "rf/path.h"
#include "rf/surfaces.h"

namespace greatx::rf {

/// Which effects act on the field of each path; all off: plain Fresnel reflection.
struct FieldEffects {
  bool roughness = false;   ///< specular part x the roughness factor of the material's rms height
  bool scattering = false;  ///< specular part x sqrt(1 - S^2): what is scattered is not reflected
  bool gas = false, rain = false, fog = false, foliage = false;
  uint64_t seed = 1;  ///< of the phases of scattering patches
};

/// What acts on the field of a channel's paths; the same for all of them.
struct FieldModel {
  const FacetWorld* world = nullptr;  ///< the one that the paths were solved in
  const RadioSurfaces* surfaces = nullptr;
};

/// The field along one path; velocities in m/s, local axes
/// (those of the facets come from FacetWorld::move).
///
/// - Directions follow from the longest segment by the law of reflection, so that a segment of zero length in
/// a corner
///   or one of a few millimetres costs no accuracy.
/// - At each reflection: s = k x n / |k x n|, p = k x s before and after;
///   E' = r_TE (s . E) s + r_TM (p_in . E) p_out. At normal incidence any s does.
/// - transfer = theta-phi components at the receiver of the two unit fields at the transmitter, times
/// 1/length.
/// - delay = length / c; doppler = (f/c)(v_tx . k_0 - v_rx . k_n + sum v_i . (k_i - k_{i-1})), the sum of
/// small numbers,
///   never a product of (1 + v/c) (1e-3 Hz and 7500 m/s alike). Approaching: positive. The phase turns as
///   e^{+j 2 pi doppler t}.
/// - Scattering coefficient and roughness are not applied: they belong to the diffuse effect.
Path path_field(const GeometricPath& geometry, const FieldModel& model, const dvec3& transmitter_velocity,
                const dvec3& receiver_velocity);

}  // namespace greatx::rf
