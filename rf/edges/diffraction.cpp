// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/edges/diffraction.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

dvec3 edge_direction(const scene::Wedge& wedge) { return glm::normalize(wedge.b - wedge.a); }

/// Tells whether `at`, across the edge, lies on that face: in its plane and on the face's side of the edge.
/// The second bound is needed very near the edge, where the tolerance would allow any angle.
bool on_face(const dvec2& face, const dvec2& at, double tolerance) {
  const double off = std::abs(face.x * at.y - face.y * at.x);
  return off <= tolerance && off <= 0.05 * glm::dot(face, at);
}

/// Holds the reflection of one face between the unit vectors of the edge.
template <typename R>
struct FaceReflection {
  ComplexOf<R> beta_beta, beta_phi, phi_beta, phi_phi;
};

/// Returns the specular reflection of a ray that meets a face at `angle` about the edge. `cos_beta0` is the
/// cosine between the ray and the edge from a to b, with phi counted from that face. With N = sqrt(cos^2
/// angle + cos^2 beta_0 sin^2 angle), s = k x n is (-cos angle, cos beta_0 sin angle)/N on (beta_0', phi')
/// and (cos angle, cos beta_0 sin angle)/N on (beta_0, phi); p = k x s.
template <typename R>
FaceReflection<R> face_reflection(const R& angle, const R& cos_beta0, const ReflectionCoefficientsOf<R>& r) {
  using std::cos, std::sin, std::hypot;
  R c = cos(angle), d = cos_beta0 * sin(angle);
  const R norm = hypot(c, d);
  // At normal incidence r_TE = -r_TM, and any s gives the same result.
  if (norm < 1e-8) {
    c = 1.0, d = 0.0;
  } else {
    c /= norm, d /= norm;
  }
  const ComplexOf<R> mixed = (r.r_te + r.r_tm) * (c * d);
  return {r.r_tm * (d * d) - r.r_te * (c * c), mixed, -mixed, r.r_te * (d * d) - r.r_tm * (c * c)};
}

template <typename R>
ReflectionCoefficientsOf<R> fresnel(const WedgeFace& face, const R& cos_theta,
                                    const RadioSurfacesOf<R>& surfaces, const SpecularShareOf<R>& share) {
  const R cosine = std::clamp(cos_theta, R(0.0), R(1.0));  // removes only rounding
  ReflectionCoefficientsOf<R> r = surfaces.reflect(face.material, face.from_front, cosine);
  const R kept = share ? share(face.material, cosine) : R(1.0);
  r.r_te *= kept;
  r.r_tm *= kept;
  return r;
}

}  // namespace

double edge_tolerance_m(const scene::Wedge& wedge) {
  const double length = glm::distance(wedge.a, wedge.b);
  return 1e-9 * length + 1e-13 * (glm::length(wedge.a) + length);
}

scene::Wedge posed(const scene::Wedge& wedge, const FacetWorld& world) {
  if (wedge.body == 0) return wedge;
  const Pose& pose = world.motion(wedge.body).pose;
  scene::Wedge moved = wedge;
  moved.a = pose.apply(wedge.a);
  moved.b = pose.apply(wedge.b);
  moved.tangent_0 = pose.rotate(wedge.tangent_0);
  moved.normal_0 = pose.rotate(wedge.normal_0);
  return moved;
}

std::optional<dvec3> keller_point(const scene::Wedge& wedge, const dvec3& before, const dvec3& after,
                                  KellerRefusal* why) {
  const dvec3 edge = edge_direction(wedge), from = before - wedge.a, to = after - wedge.a;
  const double length = glm::distance(wedge.a, wedge.b), tolerance = edge_tolerance_m(wedge);
  const double z_before = glm::dot(from, edge), z_after = glm::dot(to, edge);
  const double d_before = glm::length(from - z_before * edge), d_after = glm::length(to - z_after * edge);
  KellerRefusal refusal = KellerRefusal::none;
  double z = 0.0;
  if (d_before <= tolerance || d_after <= tolerance) {
    refusal = KellerRefusal::on_the_line;
  } else {
    z = (z_before * d_after + z_after * d_before) / (d_before + d_after);
    if (!(z >= -tolerance && z <= length + tolerance)) {
      refusal = KellerRefusal::beyond_the_edge;
    } else if (!in_exterior(wedge, before) || !in_exterior(wedge, after)) {
      refusal = KellerRefusal::not_outside;
    }
  }
  if (why) *why = refusal;
  if (refusal != KellerRefusal::none) return std::nullopt;
  return wedge.a + z * edge;
}

bool in_exterior(const scene::Wedge& wedge, const dvec3& point) {
  const dvec2 at = across(wedge, point - wedge.a);
  if (at.y >= 0.0 && wedge.n >= 1.0) return true;  // within pi of face 0
  const double angle = std::atan2(at.y, at.x), wide = wedge.n * pi;
  if ((angle < 0.0 ? angle + 2.0 * pi : angle) <= wide) return true;
  const double tolerance = edge_tolerance_m(wedge) + 1e-13 * glm::length(point);
  return on_face({1.0, 0.0}, at, tolerance) || on_face(face_n_direction(wedge), at, tolerance);
}

bool in_shadow(const scene::Wedge& wedge, const dvec3& source, const dvec3& observer) {
  return utd_angles(wedge.n, across(wedge, source - wedge.a), across(wedge, observer - wedge.a)).in_shadow();
}

EdgeSides near_boundaries(const scene::Wedge& wedge, const dvec3& before, const dvec3& at, const dvec3& after,
                          double room_m) {
  const dvec2 source = across(wedge, before - at), observer = across(wedge, after - at);
  const double nearer = std::min(glm::length(source), glm::length(observer));
  const UtdAngles angles = utd_angles(wedge.n, source, observer);
  const auto near = [&](UtdTerm term) {
    const double past = std::abs(angles.delta[static_cast<uint32_t>(term)]);
    return past < 1e-3 && past * nearer <= room_m;
  };
  EdgeSides sides;
  sides.incident = near(UtdTerm::shadow_0) || near(UtdTerm::shadow_n);
  sides.reflected_0 = near(UtdTerm::reflection_0);
  sides.reflected_n = near(UtdTerm::reflection_n);
  return sides;
}

WedgeFace face_of(const scene::Wedge& wedge, GrazedFace which, const FacetWorld& world) {
  GREATX_CHECK(which != GrazedFace::none, "no face");
  const bool first = which == GrazedFace::face_0;
  const dvec3 normal = first ? wedge.normal_0 : face_n_normal(wedge);
  const uint32_t facet = first || wedge.facet_n == scene::no_facet ? wedge.facet_0 : wedge.facet_n;
  const PosedFacet& posed_facet = world.facet(facet);
  return {posed_facet.material, glm::dot(posed_facet.normal, normal) > 0.0, posed_facet.tolerance_m, normal};
}

template <typename R>
EdgeTermsOf<R> edge_terms(const scene::Wedge& wedge, const Vec3Of<R>& in, const Vec3Of<R>& out,
                          const Given<R>& before_m, const Given<R>& after_m, const FacetWorld& world,
                          const RadioSurfacesOf<Given<R>>& surfaces, const SpecularShareOf<Given<R>>& share,
                          const EdgeSides& sides, GrazedFace in_along, GrazedFace out_along,
                          AtKeller at_keller) {
  using std::abs, std::sin, std::sqrt;
  const dvec3 edge = edge_direction(wedge);
  const Vec3Of<R> turn_in = cross(edge, in), turn_out = cross(edge, out);
  EdgeTermsOf<R> terms;
  terms.sin_in = length(turn_in), terms.sin_out = length(turn_out);
  GREATX_CHECK(terms.sin_in > 0.0 && terms.sin_out > 0.0 && before_m > 0.0 && after_m > 0.0 &&
                   (at_keller == AtKeller::no || abs(dot(in - out, edge)) < 1e-3),
               "diffraction from cos(beta_0) {} to {}, {} m before, {} m after", value_of(dot(in, edge)),
               value_of(dot(out, edge)), value_of(before_m), value_of(after_m));
  terms.phi_in = -turn_in / terms.sin_in;
  terms.beta_in = cross(terms.phi_in, in);
  terms.phi_out = turn_out / terms.sin_out;
  terms.beta_out = cross(terms.phi_out, out);

  const dvec2 face_0(1.0, 0.0), face_n = face_n_direction(wedge);
  const auto direction = [&](GrazedFace along, const Vec2Of<R>& free) -> Vec2Of<R> {
    return along == GrazedFace::none     ? free
           : along == GrazedFace::face_0 ? Vec2Of<R>(face_0)
                                         : Vec2Of<R>(face_n);
  };
  const Vec2Of<R> source = direction(in_along, -across<R>(wedge, in)),
                  observer = direction(out_along, across<R>(wedge, out));
  const UtdAnglesOf<R> angles = utd_angles<R>(wedge.n, source, observer);
  terms.factors = utd_factors<R>(angles, sides);
  for (const UtdTerm term : {UtdTerm::shadow_n, UtdTerm::shadow_0})
    terms.matrix(term)[0] = terms.matrix(term)[3] = -1.0;

  const R cos_beta0 = 0.5 * dot(in + out, edge), sin_beta0 = sqrt(terms.sin_in * terms.sin_out);
  const FaceAnglesOf<R> at = luebbers_angles<R>(angles);
  const auto add = [&](UtdTerm term, GrazedFace which, const dvec2& along, const R& angle, const R& towards) {
    if (which == in_along || which == out_along) return;
    const WedgeFace face = face_of(wedge, which, world);
    if (on_face(along, value_of(before_m) * value_of(source), face.tolerance_m) ||
        on_face(along, value_of(after_m) * value_of(observer), face.tolerance_m))
      return;
    const FaceReflection<R> m =
        face_reflection<R>(angle, towards, fresnel<R>(face, sin_beta0 * sin(angle), surfaces, share));
    ComplexOf<R>* matrix = terms.matrix(term);
    matrix[0] = m.beta_beta, matrix[1] = m.beta_phi, matrix[2] = m.phi_beta, matrix[3] = m.phi_phi;
  };
  add(UtdTerm::reflection_0, GrazedFace::face_0, face_0, at.face_0, cos_beta0);
  // As seen from face n the edge runs in the opposite direction.
  add(UtdTerm::reflection_n, GrazedFace::face_n, face_n, at.face_n, -cos_beta0);
  const ComplexOf<R>*m_0 = terms.matrix(UtdTerm::reflection_0), *m_n = terms.matrix(UtdTerm::reflection_n);
  if (!reflects<R>(m_0) || !reflects<R>(m_n)) return terms;
  // The wave meets the nearer face first.
  const EdgeMatrixOf<R> twice = at.near_0 ? product<R>(m_n, m_0) : product<R>(m_0, m_n);
  ComplexOf<R>* far = terms.matrix(at.near_0 ? UtdTerm::shadow_n : UtdTerm::shadow_0);
  for (int i = 0; i < 4; ++i) far[i] = -twice[i];
  return terms;
}

template <typename R>
EdgeDyadicOf<R> edge_dyadic(const scene::Wedge& wedge, const Vec3Of<R>& in, const Vec3Of<R>& out,
                            const Given<R>& before_m, const Given<R>& after_m, const FacetWorld& world,
                            const RadioSurfacesOf<Given<R>>& surfaces, const SpecularShareOf<Given<R>>& share,
                            const EdgeSides& sides) {
  const EdgeTermsOf<R> terms =
      edge_terms<R>(wedge, in, out, before_m, after_m, world, surfaces, share, sides);
  const R wave_number = 2.0 * pi / surfaces.wavelength_m(),
          distance = before_m / (before_m + after_m) * after_m * terms.sin_in * terms.sin_out;  // L
  EdgeDyadicOf<R> dyadic{terms.beta_in, terms.phi_in, terms.beta_out, terms.phi_out};
  for (uint32_t term = 0; term < 4; ++term) {
    const ComplexOf<R> d = utd_value<R>(terms.factors.factors[term], wave_number, distance);
    for (int i = 0; i < 4; ++i) dyadic.matrix[i] += d * terms.matrices[term][i];
  }
  return dyadic;
}

// The templates of this file, for doubles and for dual numbers.
#define GREATX_FOR(R)                                                                                        \
  template EdgeTermsOf<R> edge_terms<R>(const scene::Wedge&, const Vec3Of<R>&, const Vec3Of<R>&, const R&,   \
                                        const R&, const FacetWorld&, const RadioSurfacesOf<R>&,              \
                                        const SpecularShareOf<R>&, const EdgeSides&, GrazedFace, GrazedFace, \
                                        AtKeller);                                                           \
  template EdgeDyadicOf<R> edge_dyadic<R>(const scene::Wedge&, const Vec3Of<R>&, const Vec3Of<R>&, const R&, \
                                          const R&, const FacetWorld&, const RadioSurfacesOf<R>&,            \
                                          const SpecularShareOf<R>&, const EdgeSides&);
GREATX_FOR(double)
GREATX_FOR(Dual)
#undef GREATX_FOR

}  // namespace greatx::rf
