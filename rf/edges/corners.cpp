// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/edges/corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "core/error.h"
#include "core/units.h"
#include "scene/description/triangle_tree.h"

namespace greatx::rf {
namespace {

/// Where a facet is looked for that stands across an edge's end.
constexpr double look_aside_m = 5e-3, look_along_m = 2.5e-3;
constexpr double seen_inwards_m = 2e-3;

/// Returns the unit direction, perpendicular to the edge, halfway between the faces in the exterior.
dvec3 middle_of_exterior(const scene::Wedge& wedge) {
  const double angle = 0.5 * wedge.n * pi;
  return std::cos(angle) * wedge.tangent_0 + std::sin(angle) * wedge.normal_0;
}

/// Returns the unit direction in which the edge ends.
dvec3 outwards(const scene::Wedge& wedge, Corner corner) {
  const dvec3 along = glm::normalize(wedge.b - wedge.a);
  return corner == Corner::a ? -along : along;
}

/// Finds ends of wedges by their place.
class EndGrid {
 public:
  explicit EndGrid(const std::vector<scene::Wedge>& wedges) : wedges_(wedges) {
    for (uint32_t i = 0; i < wedges.size(); ++i)
      for (const Corner corner : both_corners)
        cells_.emplace(hash(cell_of(corner_point(wedges[i], corner))), End{i, corner});
  }

  /// Tells whether a wedge with the same faces goes on in the line of this one beyond the end.
  bool goes_on(uint32_t wedge, Corner corner) const {
    const dvec3& at = corner_point(wedges_[wedge], corner);
    const std::array<int64_t, 3> cell = cell_of(at);
    for (int64_t x = -1; x <= 1; ++x)
      for (int64_t y = -1; y <= 1; ++y)
        for (int64_t z = -1; z <= 1; ++z) {
          const auto [first, last] = cells_.equal_range(hash({cell[0] + x, cell[1] + y, cell[2] + z}));
          for (auto other = first; other != last; ++other)
            if (other->second.wedge != wedge && continues(wedge, corner, other->second)) return true;
        }
    return false;
  }

 private:
  struct End {
    uint32_t wedge;
    Corner corner;
  };
  static std::array<int64_t, 3> cell_of(const dvec3& point) {
    const auto cell = [](double x) { return static_cast<int64_t>(std::floor(x / corner_weld_m)); };
    return {cell(point.x), cell(point.y), cell(point.z)};
  }
  static uint64_t hash(const std::array<int64_t, 3>& cell) {
    uint64_t sum = 0;
    for (const int64_t part : cell) sum = (sum ^ static_cast<uint64_t>(part)) * 0x9e3779b97f4a7c15u;
    return sum;
  }
  bool continues(uint32_t wedge, Corner corner, const End& other) const {
    const scene::Wedge &here = wedges_[wedge], &there = wedges_[other.wedge];
    return here.body == there.body &&
           glm::distance(corner_point(here, corner), corner_point(there, other.corner)) <= corner_weld_m &&
           glm::dot(outwards(here, corner), outwards(there, other.corner)) < -0.99999 &&
           glm::dot(middle_of_exterior(here), middle_of_exterior(there)) > 0.9999 &&
           std::abs(here.n - there.n) < 0.01;
  }

  const std::vector<scene::Wedge>& wedges_;
  std::unordered_multimap<uint64_t, End> cells_;
};

/// Tells whether a segment runs through a triangle, its outline included.
bool crosses(const scene::FacetTriangle& triangle, const dvec3& a, const dvec3& b) {
  const dvec3 &p = triangle.corners[0], &q = triangle.corners[1], &r = triangle.corners[2];
  const dvec3 normal = glm::cross(q - p, r - p), along = b - a;
  const double slope = glm::dot(normal, along), area = glm::length(normal);
  if (std::abs(slope) < 0.1 * area * glm::length(along)) return false;
  const double t = glm::dot(normal, p - a) / slope;
  if (t < 0.0 || t > 1.0) return false;
  const dvec3 at = a + t * along;
  const auto inside = [&](const dvec3& from, const dvec3& to) {
    return glm::dot(glm::cross(to - from, at - from), normal) >= -1e-9 * area * area;
  };
  return inside(p, q) && inside(q, r) && inside(r, p);
}

/// Finds facets that stand across the ends of edges.
class Across {
 public:
  Across(const scene::Scene& scene, const FacetKinds& kinds)
      : triangles_(collect(scene, kinds)), tree_(triangles_) {}

  bool stands(const scene::Wedge& wedge, Corner corner) const {
    const dvec3 aside = corner_point(wedge, corner) + look_aside_m * middle_of_exterior(wedge);
    const dvec3 along = look_along_m * outwards(wedge, corner);
    std::vector<uint32_t> near;
    tree_.near_segment(aside - along, aside + along, 0.0, near);
    return std::ranges::any_of(near, [&](uint32_t i) {
      return bodies_[i] == wedge.body && crosses(triangles_[i], aside - along, aside + along);
    });
  }

 private:
  std::vector<scene::FacetTriangle> collect(const scene::Scene& scene, const FacetKinds& kinds) {
    std::vector<scene::FacetTriangle> triangles;
    for (uint32_t index = 0; index < scene.facets.size(); ++index) {
      if (kinds[index] != FacetKind::opaque && kinds[index] != FacetKind::wall) continue;
      const scene::Facet& facet = scene.facets[index];
      for (uint32_t t = facet.first_triangle; t < facet.first_triangle + facet.triangle_count; ++t) {
        triangles.push_back(scene.facet_triangles[t]);
        bodies_.push_back(facet.body);
      }
    }
    return triangles;
  }

  std::vector<uint32_t> bodies_;  ///< [triangles_]; before them, since collect() fills both
  std::vector<scene::FacetTriangle> triangles_;
  scene::TriangleTree tree_;
};

}  // namespace

OpenCorners::OpenCorners(const scene::Scene& scene, const FacetKinds& kinds,
                         const std::vector<scene::Wedge>& wedges) {
  const EndGrid ends(wedges);
  const Across facets(scene, kinds);
  bits_.assign(wedges.size(), 0);
  for (uint32_t i = 0; i < wedges.size(); ++i)
    for (const Corner corner : both_corners)
      if (!ends.goes_on(i, corner) && !facets.stands(wedges[i], corner))
        bits_[i] = static_cast<uint8_t>(bits_[i] | static_cast<uint32_t>(corner));
}

dvec3 seen_corner(const scene::Wedge& wedge, Corner corner) {
  const double inwards_m = std::min(seen_inwards_m, 0.5 * glm::distance(wedge.a, wedge.b));
  return corner_point(wedge, corner) - inwards_m * outwards(wedge, corner);
}

template <typename R>
CornerPlaceOf<R> corner_place(const Given<R>& u, const Given<R>& d_u, const Given<R>& v,
                              const Given<R>& d_v) {
  using std::hypot;
  const R r = hypot(u, d_u), s = hypot(v, d_v);
  const R inwards = u * d_v + v * d_u, far = d_u * d_v - u * v;
  // L_e^2 - L_K^2 = 2 (r s - far), and (r s)^2 - far^2 = inwards^2.
  const R squares = far > 0.0 ? 2.0 * inwards * (inwards / (r * s + far)) : 2.0 * (r * s - far);
  return {squares / (r + s + hypot(R(u - v), R(d_u + d_v))), inwards / (d_u + d_v)};
}
template CornerPlace corner_place<double>(const double&, const double&, const double&, const double&);
template CornerPlaceOf<Dual> corner_place<Dual>(const Dual&, const Dual&, const Dual&, const Dual&);

std::optional<CornerPlace> corner_place(const scene::Wedge& wedge, Corner corner, const dvec3& before,
                                        const dvec3& after) {
  const dvec3 in = -outwards(wedge, corner), &at = corner_point(wedge, corner);
  const double u = glm::dot(before - at, in), v = glm::dot(after - at, in);
  const double d_u = glm::length(before - at - u * in), d_v = glm::length(after - at - v * in);
  const double tolerance = edge_tolerance_m(wedge);
  if (d_u <= tolerance || d_v <= tolerance) return std::nullopt;
  return corner_place(u, d_u, v, d_v);
}

double largest_excess_m(double step_db, double wave_number) {
  // The end's wave is about 1/(2 sqrt(pi k excess)) of the edge's.
  const double share = 1.0 - std::pow(10.0, -step_db / 20.0);
  return 1.0 / (4.0 * pi * share * share * wave_number);
}

template <typename R>
EdgeDyadicOf<R> corner_dyadic(const scene::Wedge& wedge, Corner corner, const Vec3Of<R>& in,
                              const Vec3Of<R>& out, const Given<R>& before_m, const Given<R>& after_m,
                              const FacetWorld& world, const RadioSurfacesOf<Given<R>>& surfaces,
                              const SpecularShareOf<Given<R>>& share, KellerSide side) {
  using std::abs, std::sqrt, std::hypot;
  const EdgeTermsOf<R> terms = edge_terms<R>(wedge, in, out, before_m, after_m, world, surfaces, share, {},
                                             GrazedFace::none, GrazedFace::none, AtKeller::no);
  const R wave_number = 2.0 * pi / surfaces.wavelength_m();
  const dvec3 inward = -outwards(wedge, corner);
  const R cos_in = dot(in, inward), cos_out = dot(out, inward);
  const R away_before = before_m * terms.sin_in, away_after = after_m * terms.sin_out;
  const CornerPlaceOf<R> place =
      corner_place<R>(-before_m * cos_in, away_before, after_m * cos_out, away_after);
  const bool keller = side == KellerSide::by_place ? place.inwards_m >= 0.0 : side == KellerSide::exists;
  const R straight_m = before_m / (before_m + after_m) * after_m * terms.sin_in * terms.sin_out;  // L
  // sqrt(2 L'' excess)/|L'|, with L' = cos_out - cos_in along the edge; 1 at Keller's point.
  const R curvature = terms.sin_in * terms.sin_out * (1.0 / before_m + 1.0 / after_m);
  const R slope = abs(cos_in - cos_out), root = sqrt(2.0 * curvature * place.excess_m);
  const R ratio = slope > 1e-9 ? root / slope : R(1.0);
  const ComplexOf<R> end =
      (keller ? -0.5 : 0.5) * ratio * erfcx_on_diagonal<R>(sqrt(wave_number * place.excess_m));
  const R lengths =
      before_m + after_m + hypot(R(before_m * cos_in + after_m * cos_out), R(away_before + away_after));
  EdgeDyadicOf<R> dyadic{terms.beta_in, terms.phi_in, terms.beta_out, terms.phi_out};
  for (uint32_t term = 0; term < 4; ++term) {
    const UtdFactorOf<R>& factor = terms.factors.factors[term];
    const R past = 4.0 * away_before * away_after * factor.half_sine * factor.half_sine;  // L_K^2 - D^2
    const R beyond = place.excess_m * lengths;                                            // L_e^2 - L_K^2
    const R kernel = past + beyond > 0.0 ? past / (past + beyond) : R(0.5);
    const ComplexOf<R> d = kernel * end * utd_value<R>(factor, wave_number, straight_m);
    for (int i = 0; i < 4; ++i) dyadic.matrix[i] += d * terms.matrices[term][i];
  }
  return dyadic;
}
template EdgeDyadic corner_dyadic<double>(const scene::Wedge&, Corner, const dvec3&, const dvec3&,
                                          const double&, const double&, const FacetWorld&,
                                          const RadioSurfaces&, const SpecularShare&, KellerSide);
template EdgeDyadicOf<Dual> corner_dyadic<Dual>(const scene::Wedge&, Corner, const Vec3Of<Dual>&,
                                                const Vec3Of<Dual>&, const Dual&, const Dual&,
                                                const FacetWorld&, const RadioSurfacesOf<Dual>&,
                                                const SpecularShareOf<Dual>&, KellerSide);

}  // namespace greatx::rf
