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

std::vector<CommonFace> common_faces(const scene::Wedge& first, const scene::Wedge& second, const dvec3& ray,
                                     double between_m, const FacetWorld& world) {
  constexpr GrazedFace both[2] = {GrazedFace::face_0, GrazedFace::face_n};
  const auto runs_along = [&](const scene::Wedge& wedge, GrazedFace which, const dvec3& normal,
                              const dvec3& away) {
    const double off = std::abs(glm::dot(normal, away));
    if (off > coplanar_rad && off * between_m > coplanar_m) return false;
    const dvec3 edge = glm::normalize(wedge.b - wedge.a);
    const dvec3 face = which == GrazedFace::face_0 ? glm::cross(normal, edge) : glm::cross(edge, normal);
    return glm::dot(face, away) > 0.0;
  };
  std::vector<CommonFace> found;
  for (const GrazedFace a : both) {
    const WedgeFace at_first = face_of(first, a, world);
    if (!runs_along(first, a, at_first.normal, ray)) continue;
    for (const GrazedFace b : both) {
      const WedgeFace at_second = face_of(second, b, world);
      if (glm::length(glm::cross(at_first.normal, at_second.normal)) > parallel_rad) continue;
      if (glm::dot(at_first.normal, at_second.normal) < 0.0) continue;
      if (runs_along(second, b, at_second.normal, -ray)) found.push_back({a, b, at_first});
    }
  }
  return found;
}

/// Holds what both edges have in common, and the map of field components from one to the other.
template <typename R>
struct Coupling {
  R wave_number = 0.0;
  R rho = 0.0, sine = 1.0;
  R distance_m[2] = {0.0, 0.0};  ///< L
  R height_m[2] = {0.0, 0.0};    ///< modulus of y / u, and of y / v
};

template <typename R>
Coupling<R> coupling_of(const EdgeTermsOf<R>& first, const EdgeTermsOf<R>& second,
                        const TwoEdgeRaysOf<R>& rays, const R& wave_number) {
  using std::sqrt;
  const R r_1 = rays.before_m, r_2 = rays.between_m, r_3 = rays.after_m, sum = r_1 + r_2 + r_3;
  const R joint = (r_1 + r_2) * (r_2 + r_3), share = r_1 / joint * r_3;
  const R turn = dot(first.phi_out, second.phi_in), off = length(cross(first.phi_out, second.phi_in));
  const R rest = r_2 / joint * sum + share * off * off;  // 1 - rho^2
  Coupling<R> coupling{wave_number, turn * sqrt(share), sqrt(rest)};
  const R l_1 = rest * r_1 * ((r_2 + r_3) / sum), l_2 = rest * r_3 * ((r_1 + r_2) / sum);
  coupling.distance_m[0] = l_1 * first.sin_in * first.sin_out;
  coupling.distance_m[1] = l_2 * second.sin_in * second.sin_out;
  coupling.height_m[0] = sqrt(2.0 * l_1 / wave_number);
  coupling.height_m[1] = sqrt(2.0 * l_2 / wave_number);
  return coupling;
}

/// Returns the map from (beta, phi) behind the first edge to (beta', phi') of the second. If `only` is not
/// zero, it maps just the component along this unit vector.
template <typename R>
EdgeMatrixOf<R> between_edges(const EdgeTermsOf<R>& first, const EdgeTermsOf<R>& second,
                              const BetweenEdgesOf<R>& between, const Vec3Of<R>& only) {
  EdgeMatrixOf<R> map{};
  const Vec3Of<R> basis[2] = {first.beta_out, first.phi_out};
  for (int column = 0; column < 2; ++column) {
    FieldVectorOf<R> field;
    if (value_of(only) == dvec3(0.0))
      field.add(1.0, basis[column]);
    else
      field.add(dot(basis[column], only), only);
    if (between) field = between(field);
    map[column] = field.along(second.beta_in);
    map[2 + column] = field.along(second.phi_in);
  }
  return map;
}

/// Describes one term at one edge, as one of a pair.
template <typename R>
struct PairTerm {
  const UtdFactorOf<R>* factor = nullptr;
  const ComplexOf<R>* matrix = nullptr;
  double towards = 1.0;  ///< the shadow grows with phi (+1) or against it, turned over on the lit side
};

template <typename R>
PairTerm<R> at_first(const EdgeTermsOf<R>& terms, UtdTerm term) {
  const UtdFactorOf<R>& factor = terms.factors[term];
  return {&factor, terms.matrix(term), darkens_with_observer(term) != factor.lit ? 1.0 : -1.0};
}

template <typename R>
PairTerm<R> at_second(const EdgeTermsOf<R>& terms, UtdTerm term) {
  const UtdFactorOf<R>& factor = terms.factors[term];
  return {&factor, terms.matrix(term), darkens_with_source(term) != factor.lit ? 1.0 : -1.0};
}

/// Returns w of a term at the first edge (0) or at the second (1).
template <typename R>
R argument(const PairTerm<R>& term, const Coupling<R>& coupling, int edge) {
  using std::sqrt;
  return sqrt(2.0 * coupling.wave_number * coupling.distance_m[edge]) * term.factor->half_sine;
}

template <typename R>
DoubleFresnelOf<R> transition(const PairTerm<R>& a, const PairTerm<R>& b, const Coupling<R>& coupling,
                              double sign) {
  return double_fresnel<R>(argument(a, coupling, 0), argument(b, coupling, 1),
                           sign * a.towards * b.towards * coupling.rho, coupling.sine);
}

template <typename R>
void add_scaled(const EdgeMatrixOf<R>& matrix, const Given<ComplexOf<R>>& by, ComplexOf<R>* sum) {
  for (int i = 0; i < 4; ++i) sum[i] += by * matrix[i];
}

/// Tells whether the matrix of a term adds nothing, whatever the parameters.
template <typename R>
bool vanishes(const ComplexOf<R>* matrix) {
  return always_zero(matrix[0]) && always_zero(matrix[1]) && always_zero(matrix[3]);
}

/// Adds all pairs of terms of edges without a common face.
template <typename R>
void add_apart(const EdgeTermsOf<R>& first, const EdgeTermsOf<R>& second, const Coupling<R>& coupling,
               const BetweenEdgesOf<R>& between, ComplexOf<R>* sum) {
  constexpr UtdTerm all[4] = {UtdTerm::shadow_n, UtdTerm::shadow_0, UtdTerm::reflection_n,
                              UtdTerm::reflection_0};
  const EdgeMatrixOf<R> map = between_edges<R>(first, second, between, dvec3(0.0));
  for (const UtdTerm i : all) {
    const PairTerm<R> a = at_first(first, i);
    if (vanishes<R>(a.matrix)) continue;
    const EdgeMatrixOf<R> arriving = product<R>(map.data(), a.matrix);
    for (const UtdTerm m : all) {
      const PairTerm<R> b = at_second(second, m);
      if (vanishes<R>(b.matrix)) continue;
      const ComplexOf<R> value = transition(a, b, coupling, 1.0).value;
      add_scaled<R>(product<R>(b.matrix, arriving.data()), a.factor->amplitude * b.factor->amplitude * value,
                    sum);
    }
  }
}

/// Returns D of a face.
template <typename C>
C grazing_constant(const C& reflection, double cosine) {
  const C below = 1.0 + reflection;
  if (std::abs(value_of(below)) < 1e-13) return std::numeric_limits<double>::infinity();
  return cosine * (1.0 - reflection) / below;
}

/// Returns Norton's F = 1 - sqrt(pi) z erfcx(z).
Complex norton(const Complex& z) {
  if (std::abs(z) > 1e3) return 1.0 / (2.0 * z * z);  // the difference cancels; F = 1/(2 z^2) - ...
  return 1.0 - std::sqrt(pi) * z * erfcx(z);
}
/// F' = (F - 1 + 2 z^2 F)/z. Far out its terms cancel, and the derivative of the asymptotic series of F,
/// -sum (-1)^k (2k - 1)!!/(2 z^2)^k, is taken term by term.
DualComplex norton(const DualComplex& z) {
  const Complex at = z.value(), value = norton(at);
  if (std::abs(at) < 6.0 || at.real() < 0.0)
    return z.mapped(value, (value - 1.0 + 2.0 * at * at * value) / at);
  const Complex step = -0.5 / (at * at);
  Complex term = -1.0, sum = 0.0;
  for (int k = 1; k < 30; ++k) {
    term *= (2.0 * k - 1.0) * step;
    sum += -2.0 * k * term;
  }
  return z.mapped(value, sum / at);
}
/// Returns F for z = e^{j pi/4} sqrt(k r/2) D.
template <typename R>
ComplexOf<R> ground_wave(const ComplexOf<R>& constant, const R& wave_number, const R& length_m) {
  using std::sqrt, std::polar;
  return norton(polar(R(sqrt(0.5 * wave_number * length_m)), R(0.25 * pi)) * constant);
}

/// Describes the reflection of one polarization in the common face.
template <typename R>
struct GrazingWave {
  ComplexOf<R> reflected = -1.0;  ///< as of a plane wave
  ComplexOf<R> ground = 0.0;      ///< of the wave along the surface, which no ray has
  ComplexOf<R> slope = 0.0;       ///< with the heights of the apertures
};

/// Holds the angles at which the ends of the path stand above the common face, negative below it, as seen
/// from the farther edge. Small angles are meant: sines.
template <typename R>
struct Elevations {
  R before = 0.0, after = 0.0;
};

/// Where an end is above the face, other paths hold its wave and its reflection at that angle. At the plane
/// of the face, for either end, the sum with them is continuous.
template <typename R>
GrazingWave<R> grazing_wave(const ComplexOf<R>& constant, const R& wave_number, const R& length_m,
                            const Elevations<R>& at) {
  using std::abs;
  if (std::isinf(value_of(constant).real())) return {};
  const R above = std::max(R(0.0), at.before) + std::max(R(0.0), at.after);
  const GrazingReflectionOf<R> below = grazing_reflection<R>(constant, wave_number, length_m);
  if (above == 0.0) return {-1.0, below.ground, below.slope};
  if (value_of(constant) == 0.0) return {1.0, 0.0, 0.0};
  const R nearer = std::min(R(abs(at.before)), R(abs(at.after)));
  const ComplexOf<R> fading = constant / (constant + above) *
                              grazing_reflection<R>(constant + above, wave_number, length_m).ground /
                              below.ground;
  return {(nearer - constant) / (nearer + constant), below.ground * fading, below.slope * fading};
}

/// Continues a function of both edges to the lit sides of their boundaries: `both`, and those of each edge
/// alone.
template <typename C>
C continued(const C& both, const C& first, const C& second, const C& none, bool lit_1, bool lit_2) {
  if (lit_1 && lit_2) return 4.0 * none - 2.0 * first - 2.0 * second + both;
  if (lit_1) return 2.0 * second - both;
  if (lit_2) return 2.0 * first - both;
  return both;
}

/// Returns the part of a pair that the common face reflects, without amplitudes.
template <typename R>
ComplexOf<R> image_part(const PairTerm<R>& a, const PairTerm<R>& b, const Coupling<R>& coupling,
                        const GrazingWave<R>& wave, const TwoEdgeRaysOf<R>& rays) {
  using C = ComplexOf<R>;
  const DoubleFresnelOf<R> image = transition(a, b, coupling, -1.0);
  const bool lit_1 = a.factor->lit, lit_2 = b.factor->lit;
  const double side = lit_1 != lit_2 ? -1.0 : 1.0;
  // Of each edge alone: without the factor 1 - rho^2 of L.
  const R w_1 = argument(a, coupling, 0) / coupling.sine, w_2 = argument(b, coupling, 1) / coupling.sine;
  const C e_1 = erfcx_on_diagonal<R>(w_1), e_2 = erfcx_on_diagonal<R>(w_2);
  static const Complex diagonal = std::polar(1.0, 0.25 * pi);
  const auto moment = [&](const R& w, const C& e) -> C {
    return (1.0 / std::sqrt(pi) - diagonal * w * e) / coupling.sine;
  };
  const C ground = continued<C>(image.value, e_1, e_2, 1.0, lit_1, lit_2);
  // The wave of one edge alone meets the face at the angle of the other aperture as its end sees it.
  const R seen_1 = rays.between_m / (rays.between_m + rays.after_m),
          seen_2 = rays.between_m / (rays.before_m + rays.between_m);
  const C m_1 = lit_2 ? C(2.0 * seen_1 * moment(w_1, e_1) - image.moment_1) : image.moment_1,
          m_2 = lit_1 ? C(2.0 * seen_2 * moment(w_2, e_2) - image.moment_2) : image.moment_2;
  const C theta =
      std::conj(diagonal) / rays.between_m * (coupling.height_m[0] * m_1 + coupling.height_m[1] * m_2);
  // The amplitudes carry the signs of both sides.
  return wave.reflected * image.value + side * (wave.ground * ground + wave.slope * theta);
}

/// Adds the pairs of terms of edges with a common face. Of each two terms that are images of each other in
/// that face, one is in the list: the wave past the edge, and the reflection by the edge's other face.
template <typename R>
void add_along(const CommonFace& common, const EdgeTermsOf<R>& first, const EdgeTermsOf<R>& second,
               const Coupling<R>& coupling, const TwoEdgeRaysOf<R>& rays, const RadioSurfacesOf<R>& surfaces,
               const BetweenEdgesOf<R>& between, ComplexOf<R>* sum) {
  constexpr double near_grazing = 1e-3;
  const ReflectionCoefficientsOf<R> r =
      surfaces.reflect(common.face.material, common.face.from_front, near_grazing);
  const Vec3Of<R> normal =
      normalize(common.face.normal - dot(common.face.normal, rays.between) * rays.between);
  const Vec3Of<R> axes[2] = {cross(rays.between, normal), normal};  // TE, TM
  const ComplexOf<R> constants[2] = {grazing_constant(r.r_te, near_grazing),
                                     grazing_constant(r.r_tm, near_grazing)};
  const Elevations<R> elevations{-dot(rays.in, normal) * rays.before_m / (rays.before_m + rays.between_m),
                                 dot(rays.out, normal) * rays.after_m / (rays.between_m + rays.after_m)};
  const bool first_0 = common.first == GrazedFace::face_0, second_0 = common.second == GrazedFace::face_0;
  const PairTerm<R> at_1[2] = {at_first(first, first_0 ? UtdTerm::shadow_n : UtdTerm::shadow_0),
                               at_first(first, first_0 ? UtdTerm::reflection_n : UtdTerm::reflection_0)};
  const PairTerm<R> at_2[2] = {at_second(second, second_0 ? UtdTerm::shadow_0 : UtdTerm::shadow_n),
                               at_second(second, second_0 ? UtdTerm::reflection_n : UtdTerm::reflection_0)};
  for (int polarization = 0; polarization < 2; ++polarization) {
    const GrazingWave<R> wave =
        grazing_wave<R>(constants[polarization], coupling.wave_number, rays.between_m, elevations);
    const EdgeMatrixOf<R> map = between_edges<R>(first, second, between, axes[polarization]);
    for (const PairTerm<R>& a : at_1) {
      if (vanishes<R>(a.matrix)) continue;
      const EdgeMatrixOf<R> arriving = product<R>(map.data(), a.matrix);
      for (const PairTerm<R>& b : at_2) {
        if (vanishes<R>(b.matrix)) continue;
        const ComplexOf<R> value =
            transition(a, b, coupling, 1.0).value + image_part(a, b, coupling, wave, rays);
        add_scaled<R>(product<R>(b.matrix, arriving.data()),
                      a.factor->amplitude * b.factor->amplitude * value, sum);
      }
    }
  }
}

}  // namespace

template <typename R>
GrazingReflectionOf<R> grazing_reflection(const ComplexOf<R>& grazing_constant, const Given<R>& wave_number,
                                          const Given<R>& length_m) {
  if (std::isinf(value_of(grazing_constant).real())) return {};
  const ComplexOf<R> f = ground_wave<R>(grazing_constant, wave_number, length_m);
  return {2.0 * f, ComplexOf<R>(0.0, 2.0 * wave_number * length_m) * grazing_constant * f};
}

template <typename R>
TwoEdgeMatrixOf<R> two_edge_matrix(const scene::Wedge& first, const scene::Wedge& second,
                                   const TwoEdgeRaysOf<Given<R>>& rays, const FacetWorld& world,
                                   const RadioSurfacesOf<Given<R>>& surfaces,
                                   const SpecularShareOf<Given<R>>& share,
                                   const BetweenEdgesOf<Given<R>>& between) {
  const R wave_number = 2.0 * pi / surfaces.wavelength_m();
  std::vector<CommonFace> common =
      common_faces(first, second, value_of(rays.between), value_of(rays.between_m), world);
  const bool apart = common.empty();
  if (apart) common.push_back({});
  TwoEdgeMatrixOf<R> result;
  for (const CommonFace& face : common) {
    const EdgeTermsOf<R> at_1 =
                             edge_terms<R>(first, rays.in, rays.between, rays.before_m, rays.between_m, world,
                                           surfaces, share, rays.sides[0], GrazedFace::none, face.first),
                         at_2 = edge_terms<R>(second, rays.between, rays.out, rays.between_m, rays.after_m,
                                              world, surfaces, share, rays.sides[1], face.second,
                                              GrazedFace::none);
    // The faces change the terms, but neither the axes nor the coupling.
    result.beta_in = at_1.beta_in, result.phi_in = at_1.phi_in;
    result.beta_out = at_2.beta_out, result.phi_out = at_2.phi_out;
    const Coupling<R> coupling = coupling_of<R>(at_1, at_2, rays, wave_number);
    if (apart)
      add_apart<R>(at_1, at_2, coupling, between, result.matrix);
    else
      add_along<R>(face, at_1, at_2, coupling, rays, surfaces, between, result.matrix);
  }
  return result;
}

// The templates of this file, for doubles and for dual numbers.
#define GREATX_FOR(R)                                                                             \
  template GrazingReflectionOf<R> grazing_reflection<R>(const ComplexOf<R>&, const R&, const R&); \
  template TwoEdgeMatrixOf<R> two_edge_matrix<R>(                                                 \
      const scene::Wedge&, const scene::Wedge&, const TwoEdgeRaysOf<R>&, const FacetWorld&,       \
      const RadioSurfacesOf<R>&, const SpecularShareOf<R>&, const BetweenEdgesOf<R>&);
GREATX_FOR(double)
GREATX_FOR(Dual)
#undef GREATX_FOR

}  // namespace greatx::rf
