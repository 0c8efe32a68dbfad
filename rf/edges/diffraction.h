// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the diffraction at a straight edge: the point on the edge (Keller's cone) and the map between the
// incident and the diffracted field vector (from the coefficients of rf/edges/utd.h). Wedges are posed: in
// local coordinates, at the present pose of their body.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/units.h"
#include "core/vec.h"
#include "rf/antenna/field_vector.h"
#include "rf/edges/utd.h"
#include "rf/facets/facet_world.h"
#include "rf/surface/surfaces.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// Returns a wedge of the scene in local coordinates, at the pose of its body in `world`.
scene::Wedge posed(const scene::Wedge& wedge, const FacetWorld& world);

/// Reasons why an edge has no diffraction point for a pair of ends.
enum class KellerRefusal : uint8_t {
  none = 0,
  beyond_the_edge = 1,  ///< the cone's tip lies on the edge's line but not between the edge's ends
  on_the_line = 2,      ///< an end of the path lies on the edge's line: beta_0 or the distance is 0
  not_outside = 3,      ///< an end is not in the exterior: the ray would run through the wedge
};

/// Returns the point of the edge through which the path from `before` to `after` is shortest, where the
/// angles with the edge are equal (J. B. Keller, "Geometrical theory of diffraction", J. Opt. Soc. Am. 52,
/// 1962). It is computed in closed form by unfolding: z = (z_a d_b + z_b d_a)/(d_a + d_b). The edge is
/// closed, within 1e-9 of its length plus 1e-13 of its coordinates; an end of the path that is this close to
/// its line is refused.
///
/// `before` and `after` may be images of the ends. They must be in_exterior(), as must the vertices next to
/// the edge. These vertices lie in the same directions, but may be too near the edge to tell. A path that is
/// reflected at one of the wedge's own faces right before or after the edge is not a path of its own, because
/// the dyadic contains that reflection. This function does not detect this case.
std::optional<dvec3> keller_point(const scene::Wedge& posed, const dvec3& before, const dvec3& after,
                                  KellerRefusal* why = nullptr);

/// Returns the components of a vector across the edge, in (tangent_0, normal_0).
template <typename R = double>
Vec2Of<R> across(const scene::Wedge& wedge, const Vec3Of<R>& vector) {
  return {dot(wedge.tangent_0, vector), dot(wedge.normal_0, vector)};
}

/// Returns the direction in which face n goes off from the edge, in (tangent_0, normal_0).
inline dvec2 face_n_direction(const scene::Wedge& wedge) {
  return {std::cos(wedge.n * pi), std::sin(wedge.n * pi)};
}
/// Returns the normal of face n into the exterior. That of face 0 is normal_0.
inline dvec3 face_n_normal(const scene::Wedge& wedge) {
  const dvec2 along = face_n_direction(wedge);
  return along.y * wedge.tangent_0 - along.x * wedge.normal_0;
}

/// Returns the tolerance of keller_point() for an edge, metres.
double edge_tolerance_m(const scene::Wedge& wedge);

/// Tells whether waves can reach `point`: whether it lies in the angle of the exterior, faces included,
/// within the same tolerance.
bool in_exterior(const scene::Wedge& posed, const dvec3& point);

/// Tells whether the wedge, with endless faces, would stand between `source` and `observer`. Shadow-only
/// diffraction of the solver keeps these paths. Without the diffracted field of the lit region, the total is
/// wrong by 6.02 dB at the shadow boundary, where it misses half of the field or counts the rest twice. It is
/// wrong by at most 1.37 dB beyond nu = -0.78 (the parameter of Fresnel and Kirchhoff), 0.45 dB beyond -3 and
/// 0.14 dB at -10. A reflection has the same error beside its own boundary.
bool in_shadow(const scene::Wedge& posed, const dvec3& source, const dvec3& observer);

/// Maps components of the incident field on (beta_0', phi') to components of the diffracted field on (beta_0,
/// phi): phi' = -e x s'/sin(beta_0), beta_0' = phi' x s', phi = e x s/sin(beta_0), beta_0 = phi x s (C. A.
/// Balanis, "Advanced Engineering Electromagnetics", 2nd ed., 13.3.3).
template <typename R>
struct EdgeDyadicOf {
  Vec3Of<R> beta_in{dvec3(0.0)}, phi_in{dvec3(0.0)}, beta_out{dvec3(0.0)}, phi_out{dvec3(0.0)};
  /// Row-major, out by in, dimensionless: [beta beta', beta phi', phi beta', phi phi'].
  ComplexOf<R> matrix[4]{};

  FieldVectorOf<R> apply(const FieldVectorOf<R>& field) const {
    const ComplexOf<R> beta = field.along(beta_in), phi = field.along(phi_in);
    FieldVectorOf<R> out;
    out.add(matrix[0] * beta + matrix[1] * phi, beta_out);
    out.add(matrix[2] * beta + matrix[3] * phi, phi_out);
    return out;
  }
};
using EdgeDyadic = EdgeDyadicOf<double>;

/// Returns the amplitude share that roughness and scattering leave to the reflection by a material at a
/// cosine of incidence.
template <typename R>
using SpecularShareOf = std::function<R(uint32_t material, const R& cos_theta)>;
using SpecularShare = SpecularShareOf<double>;

/// A map between field components on two pairs of axes, row-major.
template <typename R>
using EdgeMatrixOf = std::array<ComplexOf<R>, 4>;
using EdgeMatrix = EdgeMatrixOf<double>;
template <typename R = double>
EdgeMatrixOf<R> product(const ComplexOf<R>* a, const ComplexOf<R>* b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
          a[2] * b[1] + a[3] * b[3]};
}
/// Tells whether the matrix of a term is not that of a face that does not reflect.
template <typename R = double>
bool reflects(const ComplexOf<R>* matrix) {
  return value_of(matrix[0]) != 0.0 || value_of(matrix[1]) != 0.0 || value_of(matrix[3]) != 0.0;
}

/// Tells whether a ray bends at Keller's point, where its angles with the edge are equal, or at an end.
enum class AtKeller : uint8_t { no, yes };
/// Names the face of a wedge that a ray runs along.
enum class GrazedFace : uint8_t { none = 0, face_0, face_n };

/// Holds the dyadic of an edge by terms: dyadic = sum of d_t matrix_t over the UtdTerms t.
template <typename R>
struct EdgeTermsOf {
  /// As in EdgeDyadic.
  Vec3Of<R> beta_in{dvec3(0.0)}, phi_in{dvec3(0.0)}, beta_out{dvec3(0.0)}, phi_out{dvec3(0.0)};
  R sin_in = 1.0, sin_out = 1.0;  ///< sines of the angles with the edge
  UtdFactorsOf<R> factors;
  ComplexOf<R> matrices[4][4]{};  ///< [UtdTerm][row-major]; zero for a face that does not reflect
  ComplexOf<R>* matrix(UtdTerm term) { return matrices[static_cast<uint32_t>(term)]; }
  const ComplexOf<R>* matrix(UtdTerm term) const { return matrices[static_cast<uint32_t>(term)]; }
};
using EdgeTerms = EdgeTermsOf<double>;
/// Returns the terms for the arguments of edge_dyadic(). `in_along` and `out_along` name faces along which
/// the ray comes and goes: it then has exactly their angle. Such a face does not reflect in these terms.
/// Throws ContractError if the angles with the edge differ `at_keller`.
template <typename R = double>
EdgeTermsOf<R> edge_terms(const scene::Wedge& posed, const Vec3Of<R>& in, const Vec3Of<R>& out,
                          const Given<R>& before_m, const Given<R>& after_m, const FacetWorld& world,
                          const RadioSurfacesOf<Given<R>>& surfaces,
                          const SpecularShareOf<Given<R>>& share = {}, const EdgeSides& sides = {},
                          GrazedFace in_along = GrazedFace::none, GrazedFace out_along = GrazedFace::none,
                          AtKeller at_keller = AtKeller::yes);

/// Describes a face of a wedge as the wave in the exterior meets it.
struct WedgeFace {
  uint32_t material = 0;
  bool from_front = true;
  double tolerance_m = 0.0;
  dvec3 normal{0.0};  ///< into the exterior
};
WedgeFace face_of(const scene::Wedge& posed, GrazedFace face, const FacetWorld& world);

/// Returns the edge's dyadic for a spherical wave. It includes the spreading A(s', s) = sqrt(s'/(s (s +
/// s'))), so that
///   E(receiver) = e^{-jk(s' + s)}/(s' + s) * dyadic . E_0,
/// where E_0 is the incident field without its phase and its spreading 1/s': a diffracted path spreads like
/// any other path, by its whole length. `in` and `out` are the unit directions to and from the edge;
/// `before_m` and `after_m` are s' and s, the whole unfolded lengths on both sides of the edge.
///
///   dyadic = -d_near I - d_far M M + d_4 M_0 + d_3 M_n,   d of rf/edges/utd.h
///
/// near and far are the shadow terms of the face near the source and of the other (d_2 and d_1 if that is
/// face 0). The far term has no boundary; with the reflections at both faces, first the near one, the field
/// of a lossy wedge tends to zero along a face, as it does over any lossy surface (P. D. Holm, "A new
/// heuristic UTD diffraction coefficient for nonperfectly conducting wedges", IEEE Trans. AP-48(8), 2000).
/// Luebbers, and Rec. ITU-R P.526, have I there; for a conductor both are the same.
///
/// M is the reflection of each face between the same unit vectors, at Luebbers' angles, with TE and TM turned
/// into (beta_0, phi). At normal incidence on the edge M = -diag(r_TE, r_TM). Hence the sum with the direct
/// and the reflected field is continuous for any direction of incidence and any wall. A face does not reflect
/// if an end lies in its plane, as in rf/geometry/geometry.h. A free edge has both sides of its facet as
/// faces.
///
/// Approximations: the faces are plane and endless, and no second edge is near. The faces let nothing
/// through; a path through the wall behind a shadow boundary is added to the result. Surface waves and slopes
/// of the incident field are left out.
///
/// `sides` tells where the observer counts if it is too near to a boundary.
template <typename R = double>
EdgeDyadicOf<R> edge_dyadic(const scene::Wedge& posed, const Vec3Of<R>& in, const Vec3Of<R>& out,
                            const Given<R>& before_m, const Given<R>& after_m, const FacetWorld& world,
                            const RadioSurfacesOf<Given<R>>& surfaces,
                            const SpecularShareOf<Given<R>>& share = {}, const EdgeSides& sides = {});

/// Tells near which boundaries of the edge (1: near, 0: not) a path lies that comes from `before`, bends at
/// `at` and goes on to `after`: within `room_m` of the boundary at the nearer of these points, and within 1
/// mrad.
EdgeSides near_boundaries(const scene::Wedge& posed, const dvec3& before, const dvec3& at, const dvec3& after,
                          double room_m);

}  // namespace greatx::rf
