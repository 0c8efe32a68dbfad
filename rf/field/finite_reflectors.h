// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Weighs a reflection by what its surface covers of the Fresnel zones: physical optics over the facet instead
// of an endless wall.
//
//   scene ─► find_wedges ─► edges where a reflecting surface ends or bends, per facet     (once, here)
//   path ─► runs ─► at each reflection: mirrored ends S and R ─► weight(facet, S, R, k) ─► field
//
// The weight is Kirchhoff's diffraction integral over the facet in units of the field that an endless wall
// would reflect: W = 1 - sum of the boundary waves of its edges (rf/field/boundary_wave.h). It tends to 1 for
// a facet of many zones, to 1/2 with the reflection point on an edge and to 1/4 on a right angle, and to j A
// cos(theta) D/(lambda d_1 d_2) for a facet of area A much smaller than the first zone.
//
// Which edges count. Those that scene::find_wedges finds, free edges included. Where a surface goes on in its
// plane (another facet, another material, a seam of less than 2 degrees), at the foot of a wall, and in inner
// corners there is no edge: there the reflecting surface does not end, or the reflection by the other face
// continues it.
//
// Surfaces that bend. Facets that meet at less than `smooth_bend_rad` are pieces of one surface, such as a
// round pole. Each neighbour that both ends see adds its own integral with its own mirrored ends, relative to
// the path's, if the reflection point reaches it: fully where the path over the common edge is less than
// `full_phase` rad longer, not at all beyond `no_phase`, and with a smooth step between. A neighbour that has
// a reflection point of its own is left to its own path. Several facets with reflection points share the
// others equally.
//
// Relation with diffraction. A path diffracted at an edge of the facet by UTD carries the same boundary wave
// of an endless edge. If the diffraction of that edge is counted as a path (edges_diffract), the weight takes
// only the rest: minus the waves of the edge's line beyond its ends, which UTD lacks (unless the
// diffraction counts these ends, too), and nothing of
// neighbours across that edge. The sum of all paths is then that of weighted reflections, as far as UTD's
// coefficient and Kirchhoff's agree.
//
// Approximations, with their bounds:
// - Kirchhoff's obliquity (cos theta_S + cos theta_R)/2 stands for the vector integral, and the reflection
//   coefficients and polarizations are those of the reflection point. Over a facet that the ends see within
//   an angle of alpha the difference is of the order of alpha tan(theta) at its rim, with opposite signs on
//   opposite sides (`FiniteReflectors.VectorPhysicalOptics...`).
// - Reflections of one path are weighed one by one. This is exact if at most one of them covers less than its
//   zones. Two facets far below the zones are too weak by the factor 1 - c^2, c^2 = z_1 (D - z_2)/(z_2 (D -
//   z_1)) with the places z_1 < z_2 of the reflections along the path of length D
//   (`FiniteReflectors.TwoSmallPlates...`).
// - A path exists only where its reflection point hits a facet. Just beside, physical optics has a field of
//   the same order, at most half of an endless wall's, which is left out (it is diffraction's).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/field/boundary_wave.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// Describes a reflection with its unfolded ends: mirrored at the other reflections of the path, so that they
/// are seen on straight lines.
template <typename Real>
struct ReflectionSightOf {
  Vec3Of<Real> point{dvec3(0.0)};                ///< on the facet, local coordinates
  Vec3Of<Real> in{dvec3(0.0)}, out{dvec3(0.0)};  ///< unit directions of the ray before and after
  Real before_m = 0.0, after_m = 0.0;            ///< unfolded distances of the ends from the point
};
using ReflectionSight = ReflectionSightOf<double>;

/// Selects the edges that the diffraction counts.
struct DiffractingEdges {
  bool free = false;     ///< free edges, too
  bool corners = false;  ///< ends of edges, too (rf/edges/corners.h)
};

class FiniteReflectors {
 public:
  /// Facets that meet at less than this are pieces of one surface (a hexagonal pole: 60 degrees).
  static constexpr double smooth_bend_rad = 1.1;
  static constexpr double full_phase = 20.0, no_phase = 60.0;

  /// `kinds`: [facets of the scene]. `survey`: null, or one of the scene.
  FiniteReflectors(const scene::Scene& scene, const FacetKinds& kinds, const DiffractingEdges& diffracting,
                   const scene::EdgeSurvey* survey = nullptr);
  /// The options by which edges count. Seams of less than 0.2 degrees are no edges; those up to 2 degrees are
  /// edges here but do not diffract.
  static scene::WedgeOptions edge_options();

  /// Returns the weight of a reflection by `facet`. `edges_diffract`: the diffraction at the facet's edges is
  /// counted by paths of their own. Swapping the ends gives the same weight within 1e-12.
  template <typename Real = double>
  ComplexOf<Real> weight(const FacetWorld& world, uint32_t facet, const ReflectionSightOf<Given<Real>>& sight,
                         const Given<Real>& wave_number, bool edges_diffract) const;

  /// Returns the number of edges that count.
  size_t edge_count() const { return edges_.size(); }

 private:
  static constexpr uint32_t none = ~0u;
  struct Edge {
    dvec3 start{0.0}, along{0.0};  ///< in the body's frame
    dvec3 inward{0.0};             ///< unit, in the facet, away from the edge
    double length_m = 0.0;
    uint32_t neighbour = none;  ///< the facet that goes on behind a bend below smooth_bend_rad
    /// +1 if the facet's normal points into the exterior of the edge, else -1; of this facet and of the
    /// neighbour.
    double exterior = 1.0, neighbour_exterior = 1.0;
    bool free = false;       ///< no other facet meets the edge
    bool diffracts = false;  ///< the edge is one of those that the diffraction effect takes
    bool start_diffracts = false, end_diffracts = false;  ///< so do the ends of the edge
    /// Tells whether the facets meet in an inner corner, as seen from the side of the facet with this sign.
    bool inner_corner_from(double front) const { return !free && neighbour == none && front != exterior; }
  };
  template <typename Real>
  struct Side;
  template <typename Real>
  struct Neighbours;
  std::span<const Edge> edges_of(uint32_t facet) const {
    return std::span(edges_).subspan(offsets_[facet], offsets_[facet + 1] - offsets_[facet]);
  }
  static Edge posed(const Edge& edge, const FacetWorld& world, uint32_t facet);
  template <typename Real>
  static ComplexOf<Real> beyond_ends(const UnfoldedRayOf<Real>& ray, const Edge& edge,
                                     EdgePieceOf<Real> piece, double place, const Real& wave_number);
  template <typename Real>
  ComplexOf<Real> boundary(const FacetWorld& world, uint32_t facet, const Side<Real>& side,
                           const Real& wave_number, bool edges_diffract) const;
  template <typename Real>
  ComplexOf<Real> neighbours(const FacetWorld& world, uint32_t facet, const Side<Real>& own,
                             const Real& wave_number, bool edges_diffract) const;
  template <typename Real>
  void add_neighbours(const FacetWorld& world, uint32_t facet, const Side<Real>& side, const Real& reached,
                      const Real& wave_number, Neighbours<Real>& found) const;

  std::vector<uint32_t> offsets_;  ///< [facets + 1] into edges_
  std::vector<Edge> edges_;
};

/// Bounds the change that the weights of a scene make.
struct FiniteReflectorBound {
  /// A surface ends somewhere, or bends away from the side that the normal of its facet points to.
  bool edges = false;
  double most_db = 0.0;  ///< largest change of a reflection in the middle of a facet, dB; 0 without edges
  uint32_t facet = 0;    ///< the facet with this change
  double area_m2 = 0.0;  ///< its area
  uint32_t facets = 0;   ///< hard facets
  uint32_t below_a_zone = 0;  ///< those with less area than the first Fresnel zone
};

/// Bounds the change at normal incidence, halfway on a path of `longest_m`, where zones are largest: a facet
/// of area A reflects at least about A 4/(lambda longest_m) of what an endless wall would, unless that is
/// more. Facets of surfaces that go on lose less. At oblique incidence A cos(theta) counts instead of A.
/// Without `find_edges`, which takes time, every scene with facets counts as one with edges.
FiniteReflectorBound finite_reflector_bound(const scene::Scene& scene, double wavelength_m, double longest_m,
                                            bool find_edges = true);

}  // namespace greatx::rf
