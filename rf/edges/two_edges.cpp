// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/edges/two_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "rf/edges/double_fresnel.h"

namespace greatx::rf {
namespace {

/// A plane in which the ray between two edges runs along a face of each.
struct CommonFace {
  GrazedFace first = GrazedFace::none, second = GrazedFace::none;
  WedgeFace face;
};

std::vector<CommonFace> common_faces(const scene::Wedge& first, const scene::Wedge& second,
                                     const TwoEdgeRays& rays, const FacetWorld& world) {
  constexpr GrazedFace both[2] = {GrazedFace::face_0, GrazedFace::face_n};
  const auto runs_along = [&](const scene::Wedge& wedge, GrazedFace which, const dvec3& normal,
                              const dvec3& away) {
    const double off = std::abs(glm::dot(normal, away));
    if (off > coplanar_rad && off * rays.between_m > coplanar_m) return false;
    const dvec3 edge = glm::normalize(wedge.b - wedge.a);
    const dvec3 face = which == GrazedFace::face_0 ? glm::cross(normal, edge) : glm::cross(edge, normal);
    return glm::dot(face, away) > 0.0;
  };
  std::vector<CommonFace> found;
  for (const GrazedFace a : both) {
    const WedgeFace at_first = face_of(first, a, world);
    if (!runs_along(first, a, at_first.normal, rays.between)) continue;
    for (const GrazedFace b : both) {
      const WedgeFace at_second = face_of(second, b, world);
      if (glm::length(glm::cross(at_first.normal, at_second.normal)) > parallel_rad) continue;
      if (glm::dot(at_first.normal, at_second.normal) < 0.0) continue;
      if (runs_along(second, b, at_second.normal, -rays.between)) found.push_back({a, b, at_first});
    }
  }
  return found;
}

/// Holds what both edges have in common, and the map of field components from one to the other.
struct Coupling {
  double wave_number = 0.0;
  double rho = 0.0, sine = 1.0;
  double distance_m[2] = {0.0, 0.0};  ///< L
  double height_m[2] = {0.0, 0.0};    ///< modulus of y / u, and of y / v
};

Coupling coupling_of(const EdgeTerms& first, const EdgeTerms& second, const TwoEdgeRays& rays,
                     double wave_number) {
  const double r_1 = rays.before_m, r_2 = rays.between_m, r_3 = rays.after_m, sum = r_1 + r_2 + r_3;
  const double joint = (r_1 + r_2) * (r_2 + r_3), share = r_1 / joint * r_3;
  const double turn = glm::dot(first.phi_out, second.phi_in),
               off = glm::length(glm::cross(first.phi_out, second.phi_in));
  const double rest = r_2 / joint * sum + share * off * off;  // 1 - rho^2
  Coupling coupling{wave_number, turn * std::sqrt(share), std::sqrt(rest)};
  const double l_1 = rest * r_1 * ((r_2 + r_3) / sum), l_2 = rest * r_3 * ((r_1 + r_2) / sum);
  coupling.distance_m[0] = l_1 * first.sin_in * first.sin_out;
  coupling.distance_m[1] = l_2 * second.sin_in * second.sin_out;
  coupling.height_m[0] = std::sqrt(2.0 * l_1 / wave_number);
  coupling.height_m[1] = std::sqrt(2.0 * l_2 / wave_number);
  return coupling;
}

/// Returns the map from (beta, phi) behind the first edge to (beta', phi') of the second. If `only` is not
/// zero, it maps just the component along this unit vector.
EdgeMatrix between_edges(const EdgeTerms& first, const EdgeTerms& second, const BetweenEdges& between,
                         const dvec3& only) {
  EdgeMatrix map{};
  const dvec3 basis[2] = {first.beta_out, first.phi_out};
  for (int column = 0; column < 2; ++column) {
    FieldVector field;
    if (only == dvec3(0.0))
      field.add(1.0, basis[column]);
    else
      field.add(glm::dot(basis[column], only), only);
    if (between) field = between(field);
    map[column] = field.along(second.beta_in);
    map[2 + column] = field.along(second.phi_in);
  }
  return map;
}

/// Describes one term at one edge, as one of a pair.
struct PairTerm {
  const UtdFactor* factor = nullptr;
  const Complex* matrix = nullptr;
  double towards = 1.0;  ///< the shadow grows with phi (+1) or against it, turned over on the lit side
};

PairTerm at_first(const EdgeTerms& terms, UtdTerm term) {
  const UtdFactor& factor = terms.factors[term];
  return {&factor, terms.matrix(term), darkens_with_observer(term) != factor.lit ? 1.0 : -1.0};
}

PairTerm at_second(const EdgeTerms& terms, UtdTerm term) {
  const UtdFactor& factor = terms.factors[term];
  return {&factor, terms.matrix(term), darkens_with_source(term) != factor.lit ? 1.0 : -1.0};
}

/// Returns w of a term at the first edge (0) or at the second (1).
double argument(const PairTerm& term, const Coupling& coupling, int edge) {
  return std::sqrt(2.0 * coupling.wave_number * coupling.distance_m[edge]) * term.factor->half_sine;
}

DoubleFresnel transition(const PairTerm& a, const PairTerm& b, const Coupling& coupling, double sign) {
  return double_fresnel(argument(a, coupling, 0), argument(b, coupling, 1),
                        sign * a.towards * b.towards * coupling.rho, coupling.sine);
}

void add_scaled(const EdgeMatrix& matrix, Complex by, Complex (&sum)[4]) {
  for (int i = 0; i < 4; ++i) sum[i] += by * matrix[i];
}

/// Adds all pairs of terms of edges without a common face.
void add_apart(const EdgeTerms& first, const EdgeTerms& second, const Coupling& coupling,
               const BetweenEdges& between, Complex (&sum)[4]) {
  constexpr UtdTerm all[4] = {UtdTerm::shadow_n, UtdTerm::shadow_0, UtdTerm::reflection_n,
                              UtdTerm::reflection_0};
  const EdgeMatrix map = between_edges(first, second, between, dvec3(0.0));
  for (const UtdTerm i : all) {
    const PairTerm a = at_first(first, i);
    if (!reflects(a.matrix)) continue;
    const EdgeMatrix arriving = product(map.data(), a.matrix);
    for (const UtdTerm m : all) {
      const PairTerm b = at_second(second, m);
      if (!reflects(b.matrix)) continue;
      const Complex value = transition(a, b, coupling, 1.0).value;
      add_scaled(product(b.matrix, arriving.data()), a.factor->amplitude * b.factor->amplitude * value, sum);
    }
  }
}

/// Returns D of a face.
Complex grazing_constant(Complex reflection, double cosine) {
  const Complex below = 1.0 + reflection;
  if (std::abs(below) < 1e-13) return std::numeric_limits<double>::infinity();
  return cosine * (1.0 - reflection) / below;
}

/// Returns Norton's F = 1 - sqrt(pi) z erfcx(z) for z = e^{j pi/4} sqrt(k r/2) D.
Complex ground_wave(Complex constant, double wave_number, double length_m) {
  const Complex z = std::polar(std::sqrt(0.5 * wave_number * length_m), 0.25 * pi) * constant;
  if (std::abs(z) > 1e3) return 1.0 / (2.0 * z * z);  // the difference cancels; F = 1/(2 z^2) - ...
  return 1.0 - std::sqrt(pi) * z * erfcx(z);
}

/// Describes the reflection of one polarization in the common face.
struct GrazingWave {
  Complex reflected = -1.0;  ///< as of a plane wave
  Complex ground = 0.0;      ///< of the wave along the surface, which no ray has
  Complex slope = 0.0;       ///< with the heights of the apertures
};

/// Holds the angles at which the ends of the path stand above the common face, negative below it, as seen
/// from the farther edge. Small angles are meant: sines.
struct Elevations {
  double before = 0.0, after = 0.0;
};

/// Where an end is above the face, other paths hold its wave and its reflection at that angle. At the plane
/// of the face, for either end, the sum with them is continuous.
GrazingWave grazing_wave(Complex constant, double wave_number, double length_m, const Elevations& at) {
  if (std::isinf(constant.real())) return {};
  const double above = std::max(0.0, at.before) + std::max(0.0, at.after);
  const GrazingReflection below = grazing_reflection(constant, wave_number, length_m);
  if (above == 0.0) return {-1.0, below.ground, below.slope};
  if (constant == 0.0) return {1.0, 0.0, 0.0};
  const double nearer = std::min(std::abs(at.before), std::abs(at.after));
  const Complex fading = constant / (constant + above) *
                         grazing_reflection(constant + above, wave_number, length_m).ground / below.ground;
  return {(nearer - constant) / (nearer + constant), below.ground * fading, below.slope * fading};
}

/// Continues a function of both edges to the lit sides of their boundaries: `both`, and those of each edge
/// alone.
Complex continued(Complex both, Complex first, Complex second, Complex none, bool lit_1, bool lit_2) {
  if (lit_1 && lit_2) return 4.0 * none - 2.0 * first - 2.0 * second + both;
  if (lit_1) return 2.0 * second - both;
  if (lit_2) return 2.0 * first - both;
  return both;
}

/// Returns the part of a pair that the common face reflects, without amplitudes.
Complex image_part(const PairTerm& a, const PairTerm& b, const Coupling& coupling, const GrazingWave& wave,
                   const TwoEdgeRays& rays) {
  const DoubleFresnel image = transition(a, b, coupling, -1.0);
  const bool lit_1 = a.factor->lit, lit_2 = b.factor->lit;
  const double side = lit_1 != lit_2 ? -1.0 : 1.0;
  // Of each edge alone: without the factor 1 - rho^2 of L.
  const double w_1 = argument(a, coupling, 0) / coupling.sine, w_2 = argument(b, coupling, 1) / coupling.sine;
  const Complex e_1 = erfcx_on_diagonal(w_1), e_2 = erfcx_on_diagonal(w_2);
  static const Complex diagonal = std::polar(1.0, 0.25 * pi);
  const auto moment = [&](double w, Complex e) {
    return (1.0 / std::sqrt(pi) - diagonal * w * e) / coupling.sine;
  };
  const Complex ground = continued(image.value, e_1, e_2, 1.0, lit_1, lit_2);
  // The wave of one edge alone meets the face at the angle of the other aperture as its end sees it.
  const double seen_1 = rays.between_m / (rays.between_m + rays.after_m),
               seen_2 = rays.between_m / (rays.before_m + rays.between_m);
  const Complex m_1 = lit_2 ? 2.0 * seen_1 * moment(w_1, e_1) - image.moment_1 : image.moment_1,
                m_2 = lit_1 ? 2.0 * seen_2 * moment(w_2, e_2) - image.moment_2 : image.moment_2;
  const Complex theta =
      std::conj(diagonal) / rays.between_m * (coupling.height_m[0] * m_1 + coupling.height_m[1] * m_2);
  // The amplitudes carry the signs of both sides.
  return wave.reflected * image.value + side * (wave.ground * ground + wave.slope * theta);
}

/// Adds the pairs of terms of edges with a common face. Of each two terms that are images of each other in
/// that face, one is in the list: the wave past the edge, and the reflection by the edge's other face.
void add_along(const CommonFace& common, const EdgeTerms& first, const EdgeTerms& second,
               const Coupling& coupling, const TwoEdgeRays& rays, const RadioSurfaces& surfaces,
               const BetweenEdges& between, Complex (&sum)[4]) {
  constexpr double near_grazing = 1e-3;
  const ReflectionCoefficients r =
      surfaces.reflect(common.face.material, common.face.from_front, near_grazing);
  const dvec3 normal =
      glm::normalize(common.face.normal - glm::dot(common.face.normal, rays.between) * rays.between);
  const dvec3 axes[2] = {glm::cross(rays.between, normal), normal};  // TE, TM
  const Complex constants[2] = {grazing_constant(r.r_te, near_grazing),
                                grazing_constant(r.r_tm, near_grazing)};
  const Elevations elevations{-glm::dot(rays.in, normal) * rays.before_m / (rays.before_m + rays.between_m),
                              glm::dot(rays.out, normal) * rays.after_m / (rays.between_m + rays.after_m)};
  const bool first_0 = common.first == GrazedFace::face_0, second_0 = common.second == GrazedFace::face_0;
  const PairTerm at_1[2] = {at_first(first, first_0 ? UtdTerm::shadow_n : UtdTerm::shadow_0),
                            at_first(first, first_0 ? UtdTerm::reflection_n : UtdTerm::reflection_0)};
  const PairTerm at_2[2] = {at_second(second, second_0 ? UtdTerm::shadow_0 : UtdTerm::shadow_n),
                            at_second(second, second_0 ? UtdTerm::reflection_n : UtdTerm::reflection_0)};
  for (int polarization = 0; polarization < 2; ++polarization) {
    const GrazingWave wave =
        grazing_wave(constants[polarization], coupling.wave_number, rays.between_m, elevations);
    const EdgeMatrix map = between_edges(first, second, between, axes[polarization]);
    for (const PairTerm& a : at_1) {
      if (!reflects(a.matrix)) continue;
      const EdgeMatrix arriving = product(map.data(), a.matrix);
      for (const PairTerm& b : at_2) {
        if (!reflects(b.matrix)) continue;
        const Complex value = transition(a, b, coupling, 1.0).value + image_part(a, b, coupling, wave, rays);
        add_scaled(product(b.matrix, arriving.data()), a.factor->amplitude * b.factor->amplitude * value,
                   sum);
      }
    }
  }
}

}  // namespace

GrazingReflection grazing_reflection(Complex grazing_constant, double wave_number, double length_m) {
  if (std::isinf(grazing_constant.real())) return {};
  const Complex f = ground_wave(grazing_constant, wave_number, length_m);
  return {2.0 * f, Complex(0.0, 2.0 * wave_number * length_m) * grazing_constant * f};
}

TwoEdgeMatrix two_edge_matrix(const scene::Wedge& first, const scene::Wedge& second, const TwoEdgeRays& rays,
                              const FacetWorld& world, const RadioSurfaces& surfaces,
                              const SpecularShare& share, const BetweenEdges& between) {
  const double wave_number = 2.0 * pi / surfaces.wavelength_m();
  std::vector<CommonFace> common = common_faces(first, second, rays, world);
  const bool apart = common.empty();
  if (apart) common.push_back({});
  TwoEdgeMatrix result;
  for (const CommonFace& face : common) {
    const EdgeTerms at_1 = edge_terms(first, rays.in, rays.between, rays.before_m, rays.between_m, world,
                                      surfaces, share, rays.sides[0], GrazedFace::none, face.first),
                    at_2 = edge_terms(second, rays.between, rays.out, rays.between_m, rays.after_m, world,
                                      surfaces, share, rays.sides[1], face.second, GrazedFace::none);
    // The faces change the terms, but neither the axes nor the coupling.
    result.beta_in = at_1.beta_in, result.phi_in = at_1.phi_in;
    result.beta_out = at_2.beta_out, result.phi_out = at_2.phi_out;
    const Coupling coupling = coupling_of(at_1, at_2, rays, wave_number);
    if (apart)
      add_apart(at_1, at_2, coupling, between, result.matrix);
    else
      add_along(face, at_1, at_2, coupling, rays, surfaces, between, result.matrix);
  }
  return result;
}

}  // namespace greatx::rf
