// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Diffraction at a straight edge: where on it (Keller's cone), and what it does to the field (rf/field/utd.h,
// as a map between field vectors). Wedges are posed: in local coordinates, where their body stands at this
// instant.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/vec.h"
#include "rf/antenna/field_vector.h"
#include "rf/facets/facet_world.h"
#include "rf/field/utd.h"
#include "rf/surface/surfaces.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// A wedge of the scene in local coordinates, where its body stands in `world`.
scene::Wedge posed(const scene::Wedge& wedge, const FacetWorld& world);

/// Why an edge has no point for a pair of ends.
enum class KellerRefusal : uint8_t {
  none = 0,
  beyond_the_edge = 1,  ///< the cone's tip lies on the edge's line, but not between its ends
  on_the_line = 2,      ///< an end lies on the edge's line: beta_0 is 0, or the distance to the edge
  not_outside = 3,      ///< an end is not in the exterior: the ray would run through the wedge
};

/// Where the path from `before` through the edge to `after` is shortest: equal angles with the edge (J. B.
/// Keller, "Geometrical theory of diffraction", J. Opt. Soc. Am. 52, 1962), in closed form by unfolding: z =
/// (z_a d_b + z_b d_a)/ (d_a + d_b). Ends may be images: they have to be in_exterior() then, like the
/// vertices next to the edge, which lie in the same direction but may be too near to tell. The edge is
/// closed, within 1e-9 of its length plus 1e-13 of its coordinates; an end that close to its line is refused.
/// A path that is reflected at one of the wedge's own faces just before or after is none, and not found out
/// here: that reflection is part of the dyadic.
std::optional<dvec3> keller_point(const scene::Wedge& posed, const dvec3& before, const dvec3& after,
                                  KellerRefusal* why = nullptr);

/// Can waves be there: in the exterior's angle (its faces included, within the same tolerance)?
bool in_exterior(const scene::Wedge& posed, const dvec3& point);

/// Does the wedge stand between `source` and `observer`, were its faces endless? What the solver's
/// shadow-only diffraction keeps. Leaving out the diffracted field of the lit region costs 6.02 dB of the
/// total at the shadow boundary (there half the field is missing, or what is not is counted twice), 1.37 dB
/// at most beyond nu = -0.78 (Fresnel and Kirchhoff's parameter), 0.45 dB beyond -3, 0.14 dB at -10; and as
/// much of a reflection beside the reflection's own boundary.
bool in_shadow(const scene::Wedge& posed, const dvec3& source, const dvec3& observer);

/// What an edge does to the field: from components on (beta_0', phi') of the incident ray to those on
/// (beta_0, phi) of the diffracted one, phi' = -e x s'/sin(beta_0), beta_0' = phi' x s', phi = e x
/// s/sin(beta_0), beta_0 = phi x s (C. A. Balanis, "Advanced Engineering Electromagnetics", 2nd ed., 13.3.3).
struct EdgeDyadic {
  dvec3 beta_in{0.0}, phi_in{0.0}, beta_out{0.0}, phi_out{0.0};
  /// Row-major, out by in, without dimension: [beta beta', beta phi', phi beta', phi phi'].
  Complex matrix[4]{};

  FieldVector apply(const FieldVector& field) const {
    const Complex beta = field.along(beta_in), phi = field.along(phi_in);
    FieldVector out;
    out.add(matrix[0] * beta + matrix[1] * phi, beta_out);
    out.add(matrix[2] * beta + matrix[3] * phi, phi_out);
    return out;
  }
};

/// Amplitude that roughness and scattering leave to the reflection by a material at a cosine of incidence.
using SpecularShare = std::function<double(uint32_t material, double cos_theta)>;

/// The edge's dyadic for a spherical wave, with the spreading A(s', s) = sqrt(s'/(s (s + s'))) folded in, so
/// that
///   E(receiver) = e^{-jk(s' + s)}/(s' + s) * dyadic . E_0,
/// E_0 the incident field without its phase and spreading 1/s': a diffracted path spreads like any other, by
/// its whole length. `in` and `out`: unit directions to and from the edge; `before_m` and `after_m`: s' and
/// s, the whole unfolded lengths on both sides of it.
///
///   dyadic = -(d_1 + d_2) I + d_4 M_0 + d_3 M_n,   d of rf/field/utd.h,
///
/// M the reflection of each face between the same unit vectors, at Luebbers' angles, with TE and TM turned
/// into (beta_0, phi): at normal incidence on the edge M = -diag(r_TE, r_TM). So the sum with the direct and
/// the reflected field is continuous for any direction of incidence, and any wall. A face whose plane one end
/// lies in does not reflect, as in rf/geometry/geometry.h. A free edge has both sides of its facet as faces.
///
/// Approximations: plane faces without end and no second edge near; the faces let nothing through (a path
/// through the wall behind a shadow boundary comes on top); surface waves and slopes of the incident field
/// are left out.
EdgeDyadic edge_dyadic(const scene::Wedge& posed, const dvec3& in, const dvec3& out, double before_m,
                       double after_m, const FacetWorld& world, const RadioSurfaces& surfaces,
                       const SpecularShare& share = {});

}  // namespace greatx::rf
