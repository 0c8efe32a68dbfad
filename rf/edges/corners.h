// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the diffraction at the ends of edges (corner diffraction). The field of one edge alone steps to
// nothing where Keller's point runs off the edge's end. A wave from that end makes up for the step.
//
// A diffracted field is an integral along the edge, whose integrand is D e^{-jkL}/(r s), L = r + s, with a
// stationary phase at Keller's point. It is cut off at the ends, and each end therefore adds
//
//   -+ (1/2) erfcx(sqrt(jk (L_e - L_K))) e^{-jk L_e},   - while Keller's point lies on the edge's side of it,
//
// in units of the wave of the endless edge, for lengths L_K over Keller's point of the edge's line and L_e
// over the end. Three factors of the integrand are taken where the end is:
// - the coefficients d_t and the matrices of edge_terms(), at the directions that the end is seen in;
// - sqrt(2 L'' (L_e - L_K))/|L'|, so that far from Keller's point the wave is that of the first order of the
//   integral's end, 1/(jk L') (N. Bleistein, R. A. Handelsman, "Asymptotic Expansions of Integrals", 9.4);
// - (L_K^2 - D_t^2)/(L_e^2 - D_t^2) for each term t, whose wave without the edge has the length D_t. This is
//   the kernel of Rubinowicz' boundary wave (rf/field/boundary_wave.h). With it the corner of a quarter-plane
//   has the product of the transition functions of both of its edges, and no field steps where a term changes
//   its sign beyond the end.
//
// Hence the total is continuous where Keller's point runs off the end, and where a boundary of geometrical
// optics passes the corner, and its amplitude is Kirchhoff's for the shadow terms. D. P. Sikta et al. have
// the same structure ("First-order equivalent current and corner diffraction scattering from flat plate
// structures", IEEE Trans. AP-31(4), 1983).
//
// Approximations: the coefficients are those of a straight endless wedge between two directions that do not
// have the same angle with the edge (beta_0: the geometric mean of the sines); waves that run along one edge
// and bend at the next are left out.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "rf/edges/diffraction.h"
#include "rf/facets/facet_kind.h"

namespace greatx::rf {

/// A facet whose plane is this near to a corner meets in it.
inline constexpr double corner_weld_m = 2e-4;

/// Names an end of an edge. The values are those of Interaction::patch of a diffraction: 0 is Keller's point.
enum class Corner : uint32_t { a = 1, b = 2 };
inline constexpr Corner both_corners[] = {Corner::a, Corner::b};

/// Holds for each wedge which of its ends diffract: bit 0 for a, bit 1 for b.
class OpenCorners {
 public:
  OpenCorners() = default;
  /// An end is open if the edge really ends there. It does not where another wedge with the same faces goes
  /// on in its line, nor where a facet of the same body stands across the exterior (the foot of a wall, an
  /// eave that meets a higher house): there the image of the edge in that facet continues it. `wedges`: of
  /// this scene, at rest.
  OpenCorners(const scene::Scene& scene, const FacetKinds& kinds, const std::vector<scene::Wedge>& wedges);

  bool open(uint32_t wedge, Corner corner) const {
    return wedge < bits_.size() && (bits_[wedge] & static_cast<uint32_t>(corner)) != 0;
  }

 private:
  std::vector<uint8_t> bits_;
};

inline const dvec3& corner_point(const scene::Wedge& wedge, Corner corner) {
  return corner == Corner::a ? wedge.a : wedge.b;
}
/// Returns the place from which the corner is seen: on the edge, 2 mm from its end, or in the middle of an
/// edge below 4 mm. Hence a corner is seen if and only if a diffraction of its edge beside it would be, and
/// other faces that meet in the corner do not hide it.
dvec3 seen_corner(const scene::Wedge& posed, Corner corner);

/// Describes where an end lies on the way between two points.
template <typename R>
struct CornerPlaceOf {
  R excess_m = 0.0;  ///< L_e - L_K, without cancellation
  /// From the end to Keller's point, along the edge: > 0 on the edge's side of the end.
  R inwards_m = 0.0;
};
using CornerPlace = CornerPlaceOf<double>;
/// Returns the place for ends of the path that lie `along_m` from the corner, along the edge in one fixed
/// sense of `inwards`, and `away_m` from the edge's line.
template <typename R = double>
CornerPlaceOf<R> corner_place(const Given<R>& before_along_m, const Given<R>& before_away_m,
                              const Given<R>& after_along_m, const Given<R>& after_away_m);
/// Does the same for the two ends, or their images. Empty if an end of the path lies on the edge's line.
std::optional<CornerPlace> corner_place(const scene::Wedge& posed, Corner corner, const dvec3& before,
                                        const dvec3& after);

/// Returns the largest excess at which a corner still has a step of `step_db` to make up for: where the wave
/// of the end is less than this, relative to the field of its edge, metres.
double largest_excess_m(double step_db, double wave_number);

/// Returns the dyadic of a corner, which spreads by the whole length over the corner, like edge_dyadic().
/// Arguments as there, with `in` and `out` at the corner.
template <typename R = double>
EdgeDyadicOf<R> corner_dyadic(const scene::Wedge& posed, Corner corner, const Vec3Of<R>& in,
                              const Vec3Of<R>& out, const Given<R>& before_m, const Given<R>& after_m,
                              const FacetWorld& world, const RadioSurfacesOf<Given<R>>& surfaces,
                              const SpecularShareOf<Given<R>>& share = {},
                              KellerSide side = KellerSide::by_place);

}  // namespace greatx::rf
