// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the field of a path: every interaction, the polarizations at both ends, the air, spreading, delay
// and Doppler shift.
#pragma once

#include <optional>
#include <span>

#include "rf/atmosphere/path_attenuation.h"
#include "rf/facets/facet_world.h"
#include "rf/field/finite_reflectors.h"
#include "rf/geometry/path.h"
#include "rf/surface/roughness.h"
#include "rf/surface/surfaces.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// Selects the effects that act on the field of each path. With all effects off, walls are smooth and in
/// vacuum.
struct FieldEffects {
  bool roughness = false;   ///< multiplies the specular part by the factor of the material's rms height
  bool scattering = false;  ///< multiplies the specular part by sqrt(1 - S^2); the rest is scattered
  bool gas = false, rain = false, fog = false, foliage = false;
  /// Weighs each reflection by what its surface covers of the Fresnel zones (FieldModel::reflectors).
  bool finite_reflectors = false;
  uint64_t seed = 1;  ///< seed of the phases of scattering patches
  RoughnessModel roughness_model = RoughnessModel::ament;
};

/// Holds the models that act on the fields of a channel's paths, at one frequency. All paths share them.
template <typename R>
struct FieldModelOf {
  const FacetWorld* world = nullptr;  ///< the world in which the paths were solved
  const RadioSurfacesOf<R>* surfaces = nullptr;
  FieldEffects effects;
  std::span<const scene::Wedge> wedges;  ///< wedges that may diffract paths
  PathAttenuationOf<R> attenuation;      ///< of the air at the surfaces' carrier, for the effects that are on
  /// The foliage of GeometricPath::foliage_m. It must have a value if effects.foliage is on.
  std::optional<scene::Foliage> foliage;
  const FiniteReflectors* reflectors = nullptr;  ///< set if and only if effects.finite_reflectors is on
};
using FieldModel = FieldModelOf<double>;

/// Computes the field along one path with any number of reflections and transmissions, and at most two
/// scatterings and diffractions, of which two diffractions follow one right after the other. Velocities are
/// in m/s along local axes; FacetWorld::move gives those of facets and wedges.
///
/// - Directions. A run is a straight part of the path, between two interactions that turn the path; walls
///   that the path passes do not split a run. The longest run takes its direction from its ends. The
///   directions of the others follow from the law of reflection. Hence a run of a few millimetres, or of no
///   length in a corner, costs no accuracy, and a wall on the way changes no bit of the directions. The runs
///   before and after a diffraction or scattering are treated separately.
/// - Reflection. s = k x n / |k x n|, and p = k x s before and after. E' = rho sqrt(1 - S^2) (r_TE (s . E) s
///   + r_TM (p_in . E) p_out), with rho of the roughness and S of the scattering only if that effect is on.
///   If both are on, both factors apply, and the power that neither returns is absorbed. At normal incidence
///   any s gives the same field. With finite reflectors, FiniteReflectors::weight multiplies E'. Its ends are
///   those of the path, or the diffraction or scattering between: a patch sends a wave of its own, and of the
///   wave behind an edge this holds across the edge.
/// - Transmission. E' = t_TE (s . E) s + t_TM (p . E) p of the whole wall as a sheet
///   (RadioSurfaces::transmit), with the direction unchanged. Neither rho nor S applies: both are defined for
///   the reflected power, of which a patch scatters the share S^2. A surface height h delays a transmitted
///   wave by (sqrt(eta) - 1) h, and a reflected wave by 2 cos(theta) h.
/// - Scattering. E' = (S/(s' s)) sqrt(f_s cos(theta_i) dA) M diag(r_TE, r_TM) E, with the unfolded lengths s'
///   before and s after the patch, M and f_s of rf/surface/scattering.h, and r of the smooth wall. The power
///   S^2 Gamma^2 |E|^2 cos(theta_i) dA leaves the patch, where Gamma^2 is the mean of |r_TE|^2 and |r_TM|^2,
///   weighted by the power in each.
/// - Diffraction. edge_dyadic (rf/edges/diffraction.h), whose faces reflect with the same rho and S; at two
///   edges two_edge_matrix (rf/edges/two_edges.h).
/// - Air. Each segment loses its dB in theta_hat and phi_hat of its direction. Foliage takes foliage_db of
///   the depth.
/// - Transfer. The theta and phi components at the receiver of the two unit fields at the transmitter, with
///   the spreading 1/length (for scattering 1/(s' s)). A wave spreads from its last scattering on, also
///   across an edge: by 1/((s'' + s') s) over an edge before a patch. Behind a patch of the area A, another
///   one at the distance s' has 1/sqrt(s'^2 + A/pi) in place of 1/s', as on the axis of a disk: patches that
///   touch would else send each other more power than they have.
/// - Delay and Doppler shift. delay = length / c. doppler = (f/c)(v_tx . k_0 - v_rx . k_n + sum v_i . (k_i -
///   k_{i-1})), positive for approaching ends. It is a sum of small numbers and not a product of factors (1 +
///   v/c), and is therefore accurate for 1e-3 Hz and for 7500 m/s alike. The phase turns as e^{+j 2 pi
///   doppler t}. A transmission adds nothing, whatever the motion of its wall.
Path path_field(const GeometricPath& geometry, const FieldModel& model, const dvec3& transmitter_velocity,
                const dvec3& receiver_velocity);

/// Returns Path::departure and Path::arrival alone.
struct PathDirections {
  dvec3 departure{0.0}, arrival{0.0};
};
PathDirections path_directions(const GeometricPath& geometry, const FacetWorld& world);

/// Holds what of a path depends on the positions and velocities of its ends.
template <typename R>
struct PathPlacesOf {
  std::span<const Vec3Of<R>> vertices;  ///< as GeometricPath::vertices
  R length_m = 0.0;                     ///< as GeometricPath::length_m
  Vec3Of<R> transmitter_velocity{dvec3(0.0)}, receiver_velocity{dvec3(0.0)};
};

/// Holds what path_field() computes of a path; the members are those of Path.
template <typename R>
struct PathValuesOf {
  ComplexOf<R> transfer[4]{};
  R doppler_hz = 0.0;
  Vec3Of<R> departure{dvec3(0.0)}, arrival{dvec3(0.0)};
};

/// Computes the field of path_field() for R = double or Dual. `geometry` says what the path does; its places
/// are those of `places`.
template <typename R>
PathValuesOf<R> path_values(const GeometricPath& geometry, const PathPlacesOf<R>& places,
                            const FieldModelOf<R>& model);

/// Computes Path::transfer alone with another model of the same world, as for another frequency.
void path_transfer(const GeometricPath& geometry, const FieldModel& model, Complex (&transfer)[4]);

}  // namespace greatx::rf
