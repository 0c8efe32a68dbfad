// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a path does to the field: every interaction between the polarizations at both ends, the air,
// spreading, delay and Doppler shift.
#pragma once

#include <optional>
#include <span>

#include "rf/atmosphere/path_attenuation.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/path.h"
#include "rf/surface/roughness.h"
#include "rf/surface/surfaces.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// Which effects act on the field of each path; all off: smooth walls in vacuum.
struct FieldEffects {
  bool roughness = false;   ///< specular part x the roughness factor of the material's rms height
  bool scattering = false;  ///< specular part x sqrt(1 - S^2): what is scattered is not reflected
  bool gas = false, rain = false, fog = false, foliage = false;
  uint64_t seed = 1;  ///< of the phases of scattering patches
  RoughnessModel roughness_model = RoughnessModel::ament;
};

/// What acts on the field of a channel's paths; the same for all of them, at one frequency.
struct FieldModel {
  const FacetWorld* world = nullptr;  ///< the one that the paths were solved in
  const RadioSurfaces* surfaces = nullptr;
  FieldEffects effects;
  std::span<const scene::Wedge> wedges;  ///< that paths may be diffracted at
  PathAttenuation attenuation;           ///< of the air, at the surfaces' carrier: of the effects that are on
  std::optional<scene::Foliage>
      foliage;  ///< what GeometricPath::foliage_m is of; needed where effects.foliage is on
};

/// The field along one path of any reflections and transmissions and at most one diffraction or scattering;
/// velocities in m/s, local axes (those of the facets and wedges come from FacetWorld::move).
///
/// - Directions. A run is what is straight: from one interaction that turns the path to the next; walls that
///   it passes
///   do not split it. The longest run has the direction between its ends, the others follow by the law of
/// reflection, so
///   that a run of no length in a corner or one of a few millimetres costs no accuracy, and a wall on the way
/// does not
///   change a bit of it. Before and after a diffraction or scattering this is done apart.
/// - Reflection: s = k x n / |k x n|, p = k x s before and after; E' = rho sqrt(1 - S^2) (r_TE (s . E) s
///   + r_TM (p_in . E) p_out), rho of the roughness and S of the scattering only where that effect is on
/// (both: both;
///   what neither returns is absorbed). At normal incidence any s does.
/// - Transmission: E' = t_TE (s . E) s + t_TM (p . E) p of the whole wall as a sheet
///   (RadioSurfaces::transmit), direction
///   kept. Neither rho nor S applies: both are defined for the reflected power (S^2 of it is what a patch
/// scatters), and
///   what passes an rms height is delayed by (sqrt(eta) - 1) of it, not by the 2 cos(theta) that a reflection
/// is.
/// - Scattering: E' = (S/(s' s)) sqrt(f_s cos(theta_i) dA) M diag(r_TE, r_TM) E, s' and s the unfolded
///   lengths before and
///   after, M and f_s of rf/surface/scattering.h, r of the smooth wall: so S^2 Gamma^2 |E|^2 cos(theta_i) dA
/// leaves the patch,
///   Gamma^2 = |r_TE|^2 and |r_TM|^2 weighed with the power in each.
/// - Diffraction: edge_dyadic (rf/field/diffraction.h), whose faces reflect with the same rho and S.
/// - Air: each segment takes its dB of theta_hat and phi_hat of its direction; foliage takes foliage_db of
///   the depth.
/// - transfer = theta-phi components at the receiver of the two unit fields at the transmitter, with the
///   spreading:
///   1/length, but for scattering.
/// - delay = length / c; doppler = (f/c)(v_tx . k_0 - v_rx . k_n + sum v_i . (k_i - k_{i-1})), the sum of
///   small numbers,
///   never a product of (1 + v/c) (1e-3 Hz and 7500 m/s alike). Approaching: positive. The phase turns as
///   e^{+j 2 pi doppler t}. A transmission adds nothing, whatever its wall does.
Path path_field(const GeometricPath& geometry, const FieldModel& model, const dvec3& transmitter_velocity,
                const dvec3& receiver_velocity);

/// Path::transfer alone, by another model of the same world: another frequency.
void path_transfer(const GeometricPath& geometry, const FieldModel& model, Complex (&transfer)[4]);

}  // namespace greatx::rf
