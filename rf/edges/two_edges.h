// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the diffraction at two edges, one after the other: the points on both edges and the map between
// the field that arrives at the first and the field behind the second.
//
//   ends ─► keller_points ─► Q_1, Q_2 ─► edge_terms at each ─► two_edge_matrix ─► field of the path
//
// Each edge has four terms (utd.h), and each term of the first meets each of the second. Alone, a term is
// a erfcx(w): the Fresnel integral of a half-plane with an amplitude that is regular at its boundary. A pair
// of terms is therefore the field behind two half-planes, with the same amplitudes:
//
//   a_1 a_2 V(w_1, w_2, rho)   instead of   a_1 erfcx(w_1) a_2 erfcx(w_2),
//
// with V of double_fresnel.h. The integral of Kirchhoff over two half-planes with skew edges gives
//
//   rho = -+ cos(tau) sqrt(r_1 r_3/((r_1 + r_2)(r_2 + r_3))),   w_i = sqrt(2 k L_i) |sin(delta_i/2)|,
//   L_1 = (1 - rho^2) sin^2(beta_1) r_1 (r_2 + r_3)/R,   L_2 = (1 - rho^2) sin^2(beta_2) (r_1 + r_2) r_3/R.
//
// r are the lengths before, between and behind the edges and R their sum; tau is the angle between both edges
// as seen along the ray. rho is positive if the shadows of both terms grow in the same direction across the
// ray, and changes its sign where a term is on its lit side. Hence
// - the sum with all other fields is continuous at every boundary of both edges, also where these overlap
//   (edges in line with an end), as utd.h alone is not;
// - far from the boundaries it is the product of two GTD coefficients with the spreading of two skew edges,
//   1/sqrt(r_1 r_3 ((r_1 + r_2)(r_2 + r_3) - r_1 r_3 cos^2(tau)));
// - slopes need no terms of their own: the difference of V(rho) and V(-rho) is the slope diffraction of all
//   orders. Two knife edges are exact.
//
// Edges with a common face (over a roof, round a house). The ray between them runs along that face. The term
// that is the image of another in the face has the same w and the opposite rho, and between the edges lies
// one reflection at grazing incidence, with the coefficient of a spherical wave over an impedance surface
// (K. A. Norton, "The propagation of radio waves over the surface of the earth", Proc. IRE 24, 1936):
//
//   V(rho) + W V(-rho),   W(theta) = 2 F - 1 + 2 j k r_2 D F theta,   F = 1 - sqrt(pi) z erfcx(z),
//   z = e^{j pi/4} sqrt(k r_2/2) D,   D = lim cos(theta_i) (1 - R)/(1 + R)  at grazing,
//
// and theta = (y_1 + y_2)/r_2 by the heights of both apertures, which are the moments of V. D = 0 is a hard
// face (W = 1), and a large D a soft one (W = -1). The edges of a plate have a common face on each side.
//
// Where an end stands above the common face, other paths hold its wave and its reflection, and W goes over
// into the coefficient of a plane wave, so that the sum is continuous (grazing_wave in the source file).
//
// Errors (`TwoEdges.*`): a conducting block of two wavelengths within 0.2 dB (hard) and 0.35 dB (soft, down
// to -39 dB) of a boundary integral, blocks with a surface impedance (eta of 6.6 to 400) within 0.4 dB (TE)
// and 1 dB (TM), ends in the shadow, beside the plane of the roof and above it; 0.05 dB at most where a path
// appears or ends on a walk round a block of concrete. Approximations: no wave runs back from the second edge
// to the first; an impedance stands for the common face, which is not rough there and scatters nothing; and
// those of edge_dyadic().
#pragma once

#include <functional>

#include "rf/edges/diffraction.h"
#include "rf/edges/keller_points.h"

namespace greatx::rf {

/// Describes a path over two edges by its rays. Lengths are unfolded.
template <typename R>
struct TwoEdgeRaysOf {
  Vec3Of<R> in{dvec3(0.0)}, between{dvec3(0.0)}, out{dvec3(0.0)};  ///< unit
  R before_m = 0.0, between_m = 0.0, after_m = 0.0;
  EdgeSides sides[2];
};
using TwoEdgeRays = TwoEdgeRaysOf<double>;

/// Maps the field on (beta', phi') of the first edge to that on (beta, phi) of the second, as EdgeDyadic does
/// for one: E(receiver) = e^{-jkR}/R * map . E_0.
template <typename R>
struct TwoEdgeMatrixOf {
  Vec3Of<R> beta_in{dvec3(0.0)}, phi_in{dvec3(0.0)}, beta_out{dvec3(0.0)}, phi_out{dvec3(0.0)};
  ComplexOf<R> matrix[4]{};

  FieldVectorOf<R> apply(const FieldVectorOf<R>& field) const {
    return EdgeDyadicOf<R>{beta_in, phi_in, beta_out, phi_out, {matrix[0], matrix[1], matrix[2], matrix[3]}}
        .apply(field);
  }
};
using TwoEdgeMatrix = TwoEdgeMatrixOf<double>;

/// Maps a field vector along the ray between the edges: through its walls and the air.
template <typename R>
using BetweenEdgesOf = std::function<FieldVectorOf<R>(const FieldVectorOf<R>&)>;
using BetweenEdges = BetweenEdgesOf<double>;

template <typename R = double>
TwoEdgeMatrixOf<R> two_edge_matrix(const scene::Wedge& first, const scene::Wedge& second,
                                   const TwoEdgeRaysOf<Given<R>>& rays, const FacetWorld& world,
                                   const RadioSurfacesOf<Given<R>>& surfaces,
                                   const SpecularShareOf<Given<R>>& share = {},
                                   const BetweenEdgesOf<Given<R>>& between = {});

/// Holds W = ground - 1 + slope theta of a common face, with ground = 2 F.
template <typename R>
struct GrazingReflectionOf {
  ComplexOf<R> ground = 0.0, slope = 0.0;
  ComplexOf<R> steady() const { return ground - 1.0; }
};
using GrazingReflection = GrazingReflectionOf<double>;
/// Returns W between two points on a surface that are `length_m` apart. `grazing_constant` is D; infinity: a
/// soft surface.
template <typename R = double>
GrazingReflectionOf<R> grazing_reflection(const ComplexOf<R>& grazing_constant, const Given<R>& wave_number,
                                          const Given<R>& length_m);

}  // namespace greatx::rf
