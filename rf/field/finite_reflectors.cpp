// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/field/finite_reflectors.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "rf/edges/corners.h"

namespace greatx::rf {
namespace {

/// Facets are taken as pieces of one surface up to this many around a reflection; more are left out.
constexpr size_t most_neighbours = 256;

bool hard(FacetKind kind) { return kind == FacetKind::opaque || kind == FacetKind::wall; }

/// Returns 1 below full_phase, 0 above no_phase, and a smooth step between.
template <typename Real>
Real taper(const Real& phase) {
  const double range = FiniteReflectors::no_phase - FiniteReflectors::full_phase;
  const Real x = std::clamp(Real((FiniteReflectors::no_phase - phase) / range), Real(0.0), Real(1.0));
  return x * x * (3.0 - 2.0 * x);
}

/// Returns the distance by which a reflection point has to move inwards so that it lies on the inner side of
/// an edge that it is on. Outlines may differ by a weld between the facets that meet in them.
double way_in(const dvec3& from_start, const dvec3& along, const dvec3& inward, double length_m) {
  constexpr double inside_m = 1e-7, weld_m = 2e-4;
  const double height = glm::dot(from_start, inward), place = glm::dot(from_start, along);
  if (height >= inside_m || height < -weld_m || place < -weld_m || place > length_m + weld_m) return 0.0;
  return inside_m - height;
}

template <typename V>
auto distance_of(const PosedFacet& facet, const V& point) {
  return dot(facet.normal, point) - facet.offset;
}

/// Tells whether a surface ends, or bends away from where the normal of its facet points.
bool has_outer_edge(const scene::Scene& scene) {
  return scene::any_wedge(scene, FiniteReflectors::edge_options(), [&](const scene::Wedge& wedge) {
    return wedge.facet_n == scene::no_facet ||
           glm::dot(scene.facets[wedge.facet_0].normal, wedge.normal_0) > 0.0;
  });
}

double area_of(const scene::Scene& scene, const scene::Facet& facet) {
  double area = 0.0;
  for (uint32_t t = facet.first_triangle; t < facet.first_triangle + facet.triangle_count; ++t) {
    const dvec3* corners = scene.facet_triangles[t].corners;
    area += 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  }
  return area;
}

}  // namespace

/// The ends of a reflection as one facet mirrors them.
template <typename Real>
struct FiniteReflectors::Side {
  Vec3Of<Real> near_end{dvec3(0.0)}, far_end{dvec3(0.0)};  ///< as the facet sees them, on one side of it
  Vec3Of<Real> point{dvec3(0.0)};                          ///< where the ray meets the facet's plane
  UnfoldedRayOf<Real> ray;                                 ///< from the mirrored near end to the far end
  bool lit = false;                                        ///< both ends are on the same side
  double front = 1.0;                                      ///< +1: on the side of the facet's normal
};

/// Holds the facets around a reflection that are pieces of the same surface.
template <typename Real>
struct FiniteReflectors::Neighbours {
  struct Piece {
    uint32_t facet;
    Real share;  ///< 0 to 1, by taper()
    Side<Real> side;
  };
  std::vector<Piece> pieces;  ///< those that are lit; without the facet of the reflection itself
  std::vector<uint32_t> known;
  uint32_t reflecting = 1;  ///< facets with a reflection point of their own
  bool edges_diffract = false;
  Real length_m = 0.0;  ///< D of the reflection

  static Side<Real> side_of(const PosedFacet& facet, const Vec3Of<Real>& near_end,
                            const Vec3Of<Real>& far_end) {
    const Real from = distance_of(facet, near_end), to = distance_of(facet, far_end);
    Side<Real> side;
    side.near_end = near_end;
    side.far_end = far_end;
    side.lit =
        from * to > 0.0 && std::min(std::abs(value_of(from)), std::abs(value_of(to))) > facet.tolerance_m;
    side.front = from > 0.0 ? 1.0 : -1.0;
    if (!side.lit) return side;
    const Vec3Of<Real> image = near_end - 2.0 * from * facet.normal, ray = far_end - image;
    const Real whole = length(ray), share = from / (from + to);
    side.point = image + share * ray;
    side.ray = {ray / whole, share * whole, (1.0 - share) * whole};
    return side;
  }
};

scene::WedgeOptions FiniteReflectors::edge_options() {
  scene::WedgeOptions options;
  options.free_edges = true;
  options.flat_angle_rad = 0.0035;
  options.min_length_m = 2e-4;
  return options;
}

FiniteReflectors::FiniteReflectors(const scene::Scene& scene, const FacetKinds& kinds,
                                   const DiffractingEdges& diffracting, const scene::EdgeSurvey* survey) {
  GREATX_CHECK(kinds.size() == scene.facets.size(), "{} kinds of {} facets", kinds.size(),
               scene.facets.size());
  const double diffracting_bend = scene::WedgeOptions{}.flat_angle_rad;
  const double diffracting_length = scene::WedgeOptions{}.min_length_m;
  std::vector<std::pair<uint32_t, Edge>> all;
  const std::vector<scene::Wedge> wedges = scene::find_wedges(scene, edge_options(), nullptr, survey);
  all.reserve(2 * wedges.size());
  const OpenCorners corners = diffracting.corners ? OpenCorners(scene, kinds, wedges) : OpenCorners();
  for (uint32_t index = 0; index < wedges.size(); ++index) {
    const scene::Wedge& wedge = wedges[index];
    Edge edge;
    edge.start = wedge.a;
    edge.length_m = glm::distance(wedge.a, wedge.b);
    edge.along = (wedge.b - wedge.a) / edge.length_m;
    const bool free = wedge.facet_n == scene::no_facet;
    edge.free = free;
    const double bend = (wedge.n - 1.0) * pi;
    edge.diffracts =
        edge.length_m >= diffracting_length && (free ? diffracting.free : bend > diffracting_bend);
    edge.start_diffracts = edge.diffracts && corners.open(index, Corner::a);
    edge.end_diffracts = edge.diffracts && corners.open(index, Corner::b);
    const dvec3 normal_0 = scene.facets[wedge.facet_0].normal;
    edge.inward = wedge.tangent_0;
    edge.exterior = glm::dot(normal_0, wedge.normal_0) > 0.0 ? 1.0 : -1.0;
    if (!free) {
      const double c = std::cos(wedge.n * pi), s = std::sin(wedge.n * pi);
      const dvec3 into_exterior = s * wedge.tangent_0 - c * wedge.normal_0;
      Edge other = edge;
      other.inward = c * wedge.tangent_0 + s * wedge.normal_0;
      other.exterior = glm::dot(scene.facets[wedge.facet_n].normal, into_exterior) > 0.0 ? 1.0 : -1.0;
      edge.neighbour_exterior = other.exterior;
      other.neighbour_exterior = edge.exterior;
      if (bend < smooth_bend_rad && hard(kinds[wedge.facet_0]) && hard(kinds[wedge.facet_n]))
        edge.neighbour = wedge.facet_n, other.neighbour = wedge.facet_0;
      if (hard(kinds[wedge.facet_n])) all.emplace_back(wedge.facet_n, other);
    }
    if (hard(kinds[wedge.facet_0])) all.emplace_back(wedge.facet_0, edge);
  }
  // The edges of a facet stay in their order.
  offsets_.assign(scene.facets.size() + 1, 0);
  for (const auto& [facet, edge] : all) ++offsets_[facet + 1];
  for (size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  edges_.resize(all.size());
  std::vector<uint32_t> next(offsets_.begin(), offsets_.end() - 1);
  for (const auto& [facet, edge] : all) edges_[next[facet]++] = edge;
}

FiniteReflectors::Edge FiniteReflectors::posed(const Edge& edge, const FacetWorld& world, uint32_t facet) {
  const uint32_t body = world.facet(facet).body;
  if (body == 0) return edge;
  const Pose& pose = world.motion(body).pose;
  Edge moved = edge;
  moved.start = pose.apply(edge.start);
  moved.along = pose.rotate(edge.along);
  moved.inward = pose.rotate(edge.inward);
  return moved;
}

/// Returns the sum of the boundary waves of a facet's edges. A ray that meets the facet's plane outside of an
/// edge takes its wave with the other sign.
template <typename Real>
ComplexOf<Real> FiniteReflectors::boundary(const FacetWorld& world, uint32_t facet, const Side<Real>& side,
                                           const Real& wave_number, bool edges_diffract) const {
  ComplexOf<Real> sum = 0.0;
  for (const Edge& stored : edges_of(facet)) {
    if (stored.inner_corner_from(side.front)) continue;
    const Edge edge = posed(stored, world, facet);
    EdgePieceOf<Real> piece{edge.start - side.point, edge.along, 0.0, edge.length_m};
    const double sign = dot(piece.start, edge.inward) <= 0.0 ? 1.0 : -1.0;
    const bool taken = edges_diffract && edge.diffracts && (edge.free || side.front == edge.exterior);
    const double place = taken ? value_of(keller_place<Real>(side.ray, piece)) : -1.0;
    const bool within = place >= 0.0 && place <= edge.length_m;
    if (taken && (within || edge.start_diffracts || edge.end_diffracts))
      sum += sign * beyond_ends<Real>(side.ray, edge, piece, place, wave_number);
    else
      sum += sign * boundary_wave<Real>(side.ray, piece, wave_number);
  }
  return sum;
}

/// Returns the wave of an edge without that of its endless line, if Keller's point is at a `place` of the
/// edge, and without the waves of the ends that diffract.
template <typename Real>
ComplexOf<Real> FiniteReflectors::beyond_ends(const UnfoldedRayOf<Real>& ray, const Edge& edge,
                                              EdgePieceOf<Real> piece, double place,
                                              const Real& wave_number) {
  ComplexOf<Real> sum = 0.0;
  const auto from_end = [&](double from, double to, double sign) {
    piece.from = from, piece.to = to;
    sum += sign * boundary_wave<Real>(ray, piece, wave_number);
  };
  if (!edge.start_diffracts) place < 0.0 ? from_end(0.0, INFINITY, 1.0) : from_end(-INFINITY, 0.0, -1.0);
  if (!edge.end_diffracts)
    place > edge.length_m ? from_end(-INFINITY, edge.length_m, 1.0) : from_end(edge.length_m, INFINITY, -1.0);
  return sum;
}

/// Appends the facets beyond the smooth edges of a facet, and those beyond them.
template <typename Real>
void FiniteReflectors::add_neighbours(const FacetWorld& world, uint32_t facet, const Side<Real>& side,
                                      const Real& reached, const Real& wave_number,
                                      Neighbours<Real>& found) const {
  using std::abs;
  for (const Edge& stored : edges_of(facet)) {
    if (stored.neighbour == none || (found.edges_diffract && stored.diffracts)) continue;
    if (found.known.size() >= most_neighbours) return;
    if (std::ranges::find(found.known, stored.neighbour) != found.known.end()) continue;
    const Edge edge = posed(stored, world, facet);
    const EdgePieceOf<Real> piece{edge.start - side.point, edge.along, 0.0, edge.length_m};
    const Real place = std::clamp(keller_place<Real>(side.ray, piece), Real(0.0), Real(edge.length_m));
    const Real longer = excess_m<Real>(side.ray, piece, place) + side.ray.length_m() - found.length_m;
    const Real share = reached * taper<Real>(wave_number * abs(longer));
    if (share == 0.0) continue;
    found.known.push_back(edge.neighbour);
    const PosedFacet& next = world.facet(edge.neighbour);
    const Side<Real> beyond = Neighbours<Real>::side_of(next, side.near_end, side.far_end);
    // On the outer side of this facet the neighbour is seen from its outer side, too.
    const bool outer = side.front == edge.exterior;
    if (!beyond.lit || beyond.front != (outer ? edge.neighbour_exterior : -edge.neighbour_exterior)) continue;
    found.pieces.push_back({edge.neighbour, share, beyond});
  }
}

/// Returns what the neighbours reflect, in units of the field that an endless wall in place of the facet
/// would.
template <typename Real>
ComplexOf<Real> FiniteReflectors::neighbours(const FacetWorld& world, uint32_t facet, const Side<Real>& own,
                                             const Real& wave_number, bool edges_diffract) const {
  using std::cos, std::sin;
  Neighbours<Real> found;
  found.edges_diffract = edges_diffract;
  found.length_m = own.ray.length_m();
  found.known.push_back(facet);
  add_neighbours<Real>(world, facet, own, 1.0, wave_number, found);
  ComplexOf<Real> sum = 0.0;
  const PosedFacet& here = world.facet(facet);
  const Real heights = distance_of(here, own.near_end) * distance_of(here, own.far_end);
  for (size_t i = 0; i < found.pieces.size(); ++i) {
    const typename Neighbours<Real>::Piece piece = found.pieces[i];
    add_neighbours<Real>(world, piece.facet, piece.side, piece.share, wave_number, found);
    const PosedFacet& next = world.facet(piece.facet);
    if (world.contains(piece.facet, next.plane_coordinates(value_of(piece.side.point)))) {
      ++found.reflecting;
      continue;
    }
    // D_G^2 = |S R|^2 + 4 h_S h_R for the heights h above the plane of any facet.
    const Real whole = piece.side.ray.length_m();
    const Real longer = 4.0 * (distance_of(next, own.near_end) * distance_of(next, own.far_end) - heights) /
                        (whole + found.length_m);
    const Real phase = wave_number * longer;
    sum -= piece.share * (found.length_m / whole) * ComplexOf<Real>(cos(phase), -sin(phase)) *
           boundary<Real>(world, piece.facet, piece.side, wave_number, edges_diffract);
  }
  return sum / static_cast<double>(found.reflecting);
}

template <typename Real>
ComplexOf<Real> FiniteReflectors::weight(const FacetWorld& world, uint32_t facet,
                                         const ReflectionSightOf<Given<Real>>& sight,
                                         const Given<Real>& wave_number, bool edges_diffract) const {
  const std::span<const Edge> edges = edges_of(facet);
  if (edges.empty()) return 1.0;
  dvec3 shift(0.0);
  bool smooth = false;
  for (const Edge& stored : edges) {
    const Edge edge = posed(stored, world, facet);
    shift += way_in(value_of(sight.point) - edge.start, edge.along, edge.inward, edge.length_m) * edge.inward;
    smooth = smooth || (edge.neighbour != none && !(edges_diffract && edge.diffracts));
  }
  Side<Real> own;
  own.point = sight.point + shift;
  own.near_end = sight.point - sight.before_m * sight.in;
  own.far_end = sight.point + sight.after_m * sight.out;
  own.ray = {sight.out, sight.before_m, sight.after_m};
  own.lit = true;
  own.front = dot(sight.in, world.facet(facet).normal) < 0.0 ? 1.0 : -1.0;
  ComplexOf<Real> weight = 1.0 - boundary<Real>(world, facet, own, wave_number, edges_diffract);
  if (smooth) weight += neighbours<Real>(world, facet, own, wave_number, edges_diffract);
  return weight;
}

template Complex FiniteReflectors::weight<double>(const FacetWorld&, uint32_t, const ReflectionSight&,
                                                  const double&, bool) const;
template DualComplex FiniteReflectors::weight<Dual>(const FacetWorld&, uint32_t,
                                                    const ReflectionSightOf<Dual>&, const Dual&, bool) const;

FiniteReflectorBound finite_reflector_bound(const scene::Scene& scene, double wavelength_m, double longest_m,
                                            bool find_edges) {
  FiniteReflectorBound bound;
  if (scene.facets.empty() || !(longest_m > 0.0)) return bound;
  bound.edges = !find_edges || has_outer_edge(scene);
  double least = 1e300;
  for (uint32_t index = 0; index < scene.facets.size(); ++index) {
    const scene::Material& material = scene.materials[scene.facets[index].material];
    if (material.radio && material.radio->foliage) continue;
    const double area = area_of(scene, scene.facets[index]);
    if (area <= 0.0) continue;
    ++bound.facets;
    // The first zone has the area pi lambda d_1 d_2/D.
    if (area < 0.25 * pi * wavelength_m * longest_m) ++bound.below_a_zone;
    if (area < least) least = area, bound.facet = index;
  }
  if (!bound.edges || bound.facets == 0) return bound;
  bound.area_m2 = least;
  bound.most_db = std::max(0.0, -20.0 * std::log10(4.0 * least / (wavelength_m * longest_m)));
  return bound;
}

}  // namespace greatx::rf
