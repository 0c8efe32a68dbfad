// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/edges/utd.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr Complex j{0.0, 1.0};

double error(Complex found, Complex expected) { return std::abs(found - expected); }

/// Returns Kouyoumjian and Pathak's transition function for x >= 0, F(x) = 2j sqrt(x) e^{jx}
/// int_{sqrt(x)}^inf e^{-j t^2} dt = sqrt(pi x) e^{j pi/4} erfcx(e^{j pi/4} sqrt(x)).
Complex transition_function(double x) {
  const double w = std::sqrt(x);
  return std::polar(std::sqrt(pi) * w, 0.25 * pi) * erfcx_on_diagonal(w);
}

/// Holds one value per polarization: E in the plane of the edge and the ray (soft), or along phi (hard).
struct SoftHard {
  Complex soft{0.0}, hard{0.0};
};
constexpr SoftHard conductor_reflection{-1.0, 1.0};

/// Returns D_{s,h} = D1 + D2 + R_n D3 + R_0 D4 in sqrt(m) (Luebbers; R = -+1 gives Kouyoumjian and Pathak's
/// eq. 25) from the terms of the engine.
SoftHard utd_coefficients(const UtdAngles& angles, double wave_number, double distance_m, double sin_beta0,
                          const SoftHard& reflection_0, const SoftHard& reflection_n) {
  const UtdTerms terms = utd_terms(angles, wave_number, distance_m);
  const double scale = std::sqrt(distance_m) / sin_beta0;
  const Complex incident = terms[UtdTerm::shadow_n] + terms[UtdTerm::shadow_0];
  const Complex face_0 = terms[UtdTerm::reflection_0], face_n = terms[UtdTerm::reflection_n];
  return {scale * (incident + reflection_n.soft * face_n + reflection_0.soft * face_0),
          scale * (incident + reflection_n.hard * face_n + reflection_0.hard * face_0)};
}

/// Returns int_0^x e^{-j t^2} dt by Gauss-Legendre quadrature with five points per panel, independently of
/// the code under test.
Complex fresnel_integral(double x) {
  constexpr double node[3] = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr double weight[3] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const int panels = 20 + static_cast<int>(40.0 * x * x);
  const double half = 0.5 * x / panels;
  Complex sum = 0.0;
  for (int panel = 0; panel < panels; ++panel) {
    const double middle = (2 * panel + 1) * half;
    for (int k = 0; k < 3; ++k) {
      for (const double t : {middle - half * node[k], middle + half * node[k]}) {
        sum += (k == 0 ? 0.5 : 1.0) * weight[k] * half * std::polar(1.0, -t * t);
      }
    }
  }
  return sum;
}

/// Returns Sommerfeld's solution for a half-plane: the field is u(phi - phi') -+ u(phi + phi') with u(beta) =
/// e^{jk rho cos(beta)} (e^{j pi/4}/sqrt(pi)) int_{-sqrt(2 k rho) cos(beta/2)}^inf e^{-j t^2} dt (Born and
/// Wolf, Principles of Optics, 7th ed., 11.5).
Complex sommerfeld(double k_rho, double incident, double observed, double hard) {
  const auto part = [&](double beta) {
    const double c = std::cos(0.5 * beta), x = std::sqrt(2.0 * k_rho) * std::abs(c);
    const Complex half_line = 0.5 * std::sqrt(pi) * std::polar(1.0, -0.25 * pi);
    const Complex tail = half_line + (c > 0.0 ? 1.0 : -1.0) * fresnel_integral(x);
    return std::polar(1.0, k_rho * std::cos(beta)) * std::polar(1.0 / std::sqrt(pi), 0.25 * pi) * tail;
  };
  return part(observed - incident) + hard * part(observed + incident);
}

/// Returns the total field of a plane wave on a wedge, geometrical optics and diffraction, at k rho from the
/// edge.
Complex total(const UtdAngles& angles, double k_rho, const Complex& reflection_0,
              const Complex& reflection_n) {
  const double phi = angles.observed, incident = angles.incident, wide = 2.0 * angles.n * pi;
  Complex field = 0.0;
  const auto delta = [&](UtdTerm term) { return angles.delta[static_cast<uint32_t>(term)]; };
  if (!angles.in_shadow()) field += std::polar(1.0, k_rho * std::cos(phi - incident));
  if (incident <= pi && (phi + incident < 0.5 * pi || delta(UtdTerm::reflection_0) <= 0.0))
    field += reflection_0 * std::polar(1.0, k_rho * std::cos(phi + incident));
  const double sum_n = wide - phi - incident;
  if (sum_n < 0.5 * pi || (sum_n < 1.5 * pi && delta(UtdTerm::reflection_n) >= 0.0))
    field += reflection_n * std::polar(1.0, k_rho * std::cos(sum_n));
  const SoftHard d = utd_coefficients(angles, 1.0, k_rho, 1.0, {reflection_0, 0.0}, {reflection_n, 0.0});
  return field + d.soft * std::polar(1.0 / std::sqrt(k_rho), -k_rho);
}

TEST(Utd, ErfcxOnTheDiagonal) {
  // The figures were computed with 40 digits (mpmath).
  const struct {
    double w;
    Complex value;
  } figures[] = {{0.0, 1.0},
                 {0.001, {0.999202115970620388, -0.000796885092725693289}},
                 {0.03125, {0.975081869979983307, -0.0239735568404703372}},
                 {0.25, {0.807091689102628738, -0.145111679141588313}},
                 {0.5, {0.642609486892740807, -0.210932268694862921}},
                 {1.0, {0.415588095907848661, -0.23031978755491064}},
                 {1.5, {0.287652896723371504, -0.20267203461777164}},
                 {2.0, {0.214047883076770138, -0.171245895871775809}},
                 {2.5, {0.16880796639533707, -0.145143147702850754}},
                 {3.25, {0.12761756429783038, -0.116343509230338763}},
                 {4.75, {0.085714056040207868, -0.0820182289883884342}},
                 {6.0, {0.0673729938601953283, -0.0655313198195318216}},
                 {6.5, {0.0620749003178855392, -0.060625245525938491}},
                 {10.0, {0.040090635040567875, -0.0396918421287333517}},
                 {100.0, {0.00398962224522637892, -0.00398922330296093782}},
                 {65536.0, {6.0873761054668529e-6, -6.08737610404952521e-6}},
                 {1e30, {3.98942280401432678e-31, -3.98942280401432678e-31}}};
  for (const auto& figure : figures)
    EXPECT_LT(error(erfcx_on_diagonal(figure.w), figure.value), 1e-15 * std::abs(figure.value)) << figure.w;
  EXPECT_LT(std::abs(erfcx_on_diagonal(1e200)), 1e-199);
}

TEST(Utd, ErfcxIsSmoothWhereTheFormulaChanges) {
  // The formula drops the term of the pole near w = 4.5, and t^4 relative to w^4 at w = 1e5. Neither change
  // causes a step.
  for (const double w : {40.0 / (std::sqrt(2.0) * pi) * std::sqrt(pi / 12.5), 1e5}) {
    const Complex below = erfcx_on_diagonal(w * (1.0 - 1e-15)), above = erfcx_on_diagonal(w * (1.0 + 1e-15));
    EXPECT_LT(error(above, below), 5e-15 * std::abs(below));
  }
}

TEST(Utd, TransitionFunction) {
  EXPECT_LT(error(transition_function(0.01), {0.124205185773763675, 0.106578973791882783}), 2e-16);
  EXPECT_LT(error(transition_function(1.0), {0.809525481747408844, 0.232199390055264606}), 1e-15);
  EXPECT_LT(error(transition_function(100.0), {0.999925065463363614, 0.0049981279426342198}), 1e-15);
  EXPECT_EQ(transition_function(0.0), Complex(0.0));
  EXPECT_LT(error(transition_function(1e12), 1.0), 1e-12);
  // F -> sqrt(pi x) e^{j pi/4} for x -> 0.
  EXPECT_LT(error(transition_function(1e-12) / 1e-6, std::sqrt(pi) * std::polar(1.0, 0.25 * pi)), 3e-6);
}

TEST(Utd, SameAsCotTimesF) {
  // The expected value is the original form of Kouyoumjian and Pathak, away from its poles.
  RandomStream random(11, 0);
  for (int i = 0; i < 2000; ++i) {
    const double n = random.uniform(1.05, 2.0), incident = random.uniform(0.0, n * pi),
                 observed = random.uniform(0.0, n * pi);
    const double k = random.uniform(1.0, 100.0), distance = random.uniform(0.1, 10.0),
                 sine = random.uniform(0.1, 1.0);
    const Complex r0(random.uniform(-1, 1), 0.3), rn(random.uniform(-1, 1), -0.2);
    Complex sum = 0.0;
    bool near_pole = false;
    for (const double beta : {observed - incident, observed + incident}) {
      for (const double sign : {1.0, -1.0}) {
        const double turns = std::nearbyint((beta + sign * pi) / (2 * n * pi));
        const double c = std::cos(0.5 * (2 * n * pi * turns - beta)),
                     cotangent = 1.0 / std::tan((pi + sign * beta) / (2 * n));
        near_pole = near_pole || std::abs(c) < 1e-3;
        const Complex weight = beta == observed - incident ? 1.0 : sign > 0.0 ? rn : r0;
        sum += weight * cotangent * transition_function(2.0 * k * distance * c * c);
      }
    }
    if (near_pole) continue;
    const Complex expected = -std::polar(1.0, -0.25 * pi) / (2.0 * n * std::sqrt(2.0 * pi * k) * sine) * sum;
    const SoftHard found =
        utd_coefficients(utd_angles(n, incident, observed), k, distance, sine, {r0, 0.0}, {rn, 0.0});
    EXPECT_LT(error(found.soft, expected), 1e-11 * (1.0 + std::abs(expected)))
        << n << ' ' << incident << ' ' << observed;
  }
}

TEST(Utd, ConductingHalfPlaneIsSommerfelds) {
  // For a plane wave on a half-plane the uniform theory is exact.
  RandomStream random(12, 0);
  double worst = 0.0;
  for (const double k_rho : {0.01, 0.3, 1.0, 7.0, 50.0, 1000.0}) {
    for (int i = 0; i < (k_rho > 100.0 ? 15 : 60); ++i) {
      const double incident = random.uniform(0.0, pi), observed = random.uniform(0.0, 2.0 * pi);
      for (const double r : {-1.0, 1.0})
        worst = std::max(worst, error(total(utd_angles(2.0, incident, observed), k_rho, r, r),
                                      sommerfeld(k_rho, incident, observed, r)));
    }
  }
  EXPECT_LT(worst, 1e-12);
  RecordProperty("worst", fmt::format("{:.1e}", worst));
}

/// Returns the exact field of a conducting wedge in a plane wave (D. S. Jones, "The Theory of
/// Electromagnetism", 9.19): (2/n) sum eps_m j^{m/n} J_{m/n}(k rho) cos cos, or 4/n sum j^{m/n} J sin sin.
Complex wedge_series(double n, double k_rho, double incident, double observed, bool hard) {
  Complex sum = hard ? Complex(0.5 * std::cyl_bessel_j(0.0, k_rho)) : Complex(0.0);
  for (int m = 1; m / n < 2.0 * k_rho + 60.0; ++m) {
    const double order = m / n;
    const double angular = hard ? std::cos(order * incident) * std::cos(order * observed)
                                : std::sin(order * incident) * std::sin(order * observed);
    sum += std::polar(1.0, 0.5 * pi * order) * std::cyl_bessel_j(order, k_rho) * angular;
  }
  return 4.0 / n * sum;
}

TEST(Utd, ConductingWedge) {
  const Complex exact = wedge_series(1.5, 100.0, radians(45.0), radians(240.0), false);
  const Complex found = total(utd_angles(1.5, radians(45.0), radians(240.0)), 100.0, -1.0, -1.0);
  EXPECT_LT(error(exact, {0.108257, -0.009321}), 1e-6);
  EXPECT_LT(error(found, {0.108274, -0.009396}), 1e-6);
  // At all angles, the error of the theory falls as (k rho)^{-3/2}.
  RandomStream random(13, 0);
  for (const double n : {1.25, 1.5, 1.75, 1.95}) {
    for (const double k_rho : {20.0, 100.0}) {
      for (int i = 0; i < 15; ++i) {
        const double incident = random.uniform(0.0, n * pi), observed = random.uniform(0.0, n * pi);
        for (const double r : {-1.0, 1.0}) {
          EXPECT_LT(error(total(utd_angles(n, incident, observed), k_rho, r, r),
                          wedge_series(n, k_rho, incident, observed, r > 0.0)),
                    0.4 / std::pow(k_rho, 1.5))
              << n << ' ' << incident << ' ' << observed << ' ' << r;
        }
      }
    }
  }
}

TEST(Utd, SoftFieldVanishesOnTheFaces) {
  for (const double n : {1.1, 1.5, 2.0}) {
    for (const double incident : {0.3, 1.0, 2.0, 3.0}) {
      for (const double observed : {0.0, n * pi}) {
        const SoftHard d = utd_coefficients(utd_angles(n, incident, observed), 70.0, 3.0, 0.8,
                                            conductor_reflection, conductor_reflection);
        EXPECT_LT(std::abs(d.soft), 1e-14);
        EXPECT_GT(std::abs(d.hard), 1e-4);
      }
    }
  }
}

TEST(Utd, ConductorIsReciprocal) {
  RandomStream random(14, 0);
  for (int i = 0; i < 500; ++i) {
    const double n = random.uniform(1.01, 2.0), a = random.uniform(0.0, n * pi),
                 b = random.uniform(0.0, n * pi);
    const SoftHard there =
        utd_coefficients(utd_angles(n, a, b), 60.0, 2.0, 0.9, conductor_reflection, conductor_reflection);
    const SoftHard back =
        utd_coefficients(utd_angles(n, b, a), 60.0, 2.0, 0.9, conductor_reflection, conductor_reflection);
    EXPECT_LT(error(there.soft, back.soft), 1e-13);
    EXPECT_LT(error(there.hard, back.hard), 1e-13);
  }
}

TEST(UtdHardCase, N44_ContinuousAcrossEveryBoundary) {
  // Compares the total field on each boundary with that 1e-12 and 1e-5 rad beside the boundary. Its slope
  // there is about sqrt(k rho) per radian.
  const Complex r0(-0.6, 0.1), rn(0.35, -0.2);
  for (const double n : {1.2, 1.5, 1.9, 2.0}) {
    for (const double incident : {0.4, 0.9 * (n - 1.0) * pi, 0.5 * n * pi, 0.7 * n * pi}) {
      for (const double boundary :
           {incident + pi, incident - pi, pi - incident, (2.0 * n - 1.0) * pi - incident}) {
        if (boundary < 1e-3 || boundary > n * pi - 1e-3) continue;
        for (const double k_rho : {1.0, 1e2, 1e4, 1e6}) {
          const Complex at = total(utd_angles(n, incident, boundary), k_rho, r0, rn);
          ASSERT_TRUE(std::isfinite(at.real()) && std::isfinite(at.imag()));
          for (const double beside : {-1e-12, 1e-12, -1e-5, 1e-5}) {
            const Complex near = total(utd_angles(n, incident, boundary + beside), k_rho, r0, rn);
            // The phase of waves that cross the boundary at an angle turns by k rho times this angle.
            EXPECT_LT(error(near, at), 4.0 * (k_rho + 1.0) * std::abs(beside) + 1e-14 * (k_rho + 10.0))
                << n << ' ' << incident << ' ' << boundary << ' ' << k_rho << ' ' << beside;
          }
        }
      }
    }
  }
}

TEST(UtdHardCase, N44_ExactlyOnABoundary) {
  // For vectors, the direction of the boundary itself gives delta = 0 exactly, and one half on either side.
  const auto delta = [](const UtdAngles& angles, UtdTerm term) {
    return angles.delta[static_cast<uint32_t>(term)];
  };
  const dvec2 source(3.7, 1.1);
  for (const double n : {1.5, 2.0}) {
    const UtdAngles shadow = utd_angles(n, source, -source);
    EXPECT_EQ(delta(shadow, UtdTerm::shadow_0), 0.0);
    EXPECT_FALSE(shadow.in_shadow());
    EXPECT_EQ(utd_terms(shadow, 50.0, 7.0)[UtdTerm::shadow_0], Complex(-0.5));
    const UtdAngles mirror = utd_angles(n, source, {-source.x, source.y});
    EXPECT_EQ(delta(mirror, UtdTerm::reflection_0), 0.0);
    EXPECT_EQ(utd_terms(mirror, 50.0, 7.0)[UtdTerm::reflection_0], Complex(-0.5));
    // One part in 1e15 to either side determines the sign; the magnitude is one half.
    const UtdAngles past = utd_angles(n, source, -source + dvec2(1e-15, -4e-15)),
                    before = utd_angles(n, source, -source + dvec2(-1e-15, 4e-15));
    EXPECT_GT(delta(past, UtdTerm::shadow_0), 0.0);
    EXPECT_TRUE(past.in_shadow());
    EXPECT_LT(delta(before, UtdTerm::shadow_0), 0.0);
    EXPECT_LT(error(utd_terms(past, 50.0, 7.0)[UtdTerm::shadow_0], 0.5), 1e-12);
    EXPECT_LT(error(utd_terms(before, 50.0, 7.0)[UtdTerm::shadow_0], -0.5), 1e-12);
  }
  // Angles and vectors give the same result.
  RandomStream random(15, 0);
  for (int i = 0; i < 1000; ++i) {
    const double n = random.uniform(1.05, 2.0), a = random.uniform(0.0, n * pi),
                 b = random.uniform(0.0, n * pi);
    const UtdAngles angles = utd_angles(n, a, b);
    const UtdAngles vectors =
        utd_angles(n, 3.0 * dvec2(std::cos(a), std::sin(a)), 0.2 * dvec2(std::cos(b), std::sin(b)));
    EXPECT_EQ(angles.in_shadow(), vectors.in_shadow());
    EXPECT_EQ(angles.in_shadow(), std::abs(a - b) > pi);
    for (int term = 0; term < 4; ++term) EXPECT_NEAR(angles.delta[term], vectors.delta[term], 1e-14);
  }
}

TEST(UtdHardCase, N45_GrazingTheEdgeIsFinite) {
  // For L -> 0 (sin beta_0 -> 0 or s -> 0), each dimensionless term tends to its value on the boundary, 1/2
  // times the angular factor. sqrt(L)/sin(beta_0) = sqrt(s s'/(s + s')) has no pole either.
  const UtdAngles angles = utd_angles(1.5, 0.7, 3.0);
  const UtdTerms none = utd_terms(angles, 100.0, 0.0);
  for (const double distance : {1e-300, 1e-30, 1e-12}) {
    const UtdTerms little = utd_terms(angles, 100.0, distance);
    for (int term = 0; term < 4; ++term) {
      ASSERT_TRUE(std::isfinite(none.d[term].real()) && std::isfinite(none.d[term].imag()));
      EXPECT_LT(error(little.d[term], none.d[term]), 2.0 * std::sqrt(2.0 * 100.0 * distance) + 1e-15);
    }
  }
  const double s = 4.0, before = 6.0;
  Complex last = 0.0;
  for (const double sine : {1e-3, 1e-6, 1e-9}) {
    const SoftHard d = utd_coefficients(angles, 100.0, s * before / (s + before) * sine * sine, sine,
                                        conductor_reflection, conductor_reflection);
    if (last != Complex(0.0)) {
      EXPECT_LT(error(d.soft, last), 0.1 * std::abs(last));
    }
    last = d.soft;
  }
}

TEST(UtdHardCase, N46_SwappingTheFacesOfAHalfPlaneChangesNothing) {
  RandomStream random(16, 0);
  for (int i = 0; i < 1000; ++i) {
    const double n = i % 2 == 0 ? 2.0 : random.uniform(1.05, 2.0);
    const double a = i % 3 == 0 ? 0.5 * n * pi : random.uniform(0.0, n * pi), b = random.uniform(0.0, n * pi);
    const UtdAngles angles = utd_angles(n, a, b), swapped = utd_angles(n, n * pi - a, n * pi - b);
    const UtdTerms terms = utd_terms(angles, 30.0, 5.0), other = utd_terms(swapped, 30.0, 5.0);
    EXPECT_LT(error(terms[UtdTerm::shadow_0], other[UtdTerm::shadow_n]), 1e-12);
    EXPECT_LT(error(terms[UtdTerm::shadow_n], other[UtdTerm::shadow_0]), 1e-12);
    EXPECT_LT(error(terms[UtdTerm::reflection_0], other[UtdTerm::reflection_n]), 1e-12);
    EXPECT_LT(error(terms[UtdTerm::reflection_n], other[UtdTerm::reflection_0]), 1e-12);
    const FaceAngles at = luebbers_angles(angles), then = luebbers_angles(swapped);
    EXPECT_NEAR(at.face_0, then.face_n, 1e-12);
    EXPECT_NEAR(at.face_n, then.face_0, 1e-12);
    EXPECT_EQ(angles.in_shadow(), swapped.in_shadow());
  }
}

TEST(Utd, LuebbersAnglesAreTheReflectionsOnTheirBoundaries) {
  for (const double n : {1.2, 1.5, 2.0}) {
    for (const double incident : {0.2, 0.4 * n * pi, 0.6 * n * pi, 0.9 * n * pi}) {
      if (incident < pi) {
        EXPECT_NEAR(std::sin(luebbers_angles(utd_angles(n, incident, pi - incident)).face_0),
                    std::sin(incident), 1e-12);
      }
      const double from_n = n * pi - incident, boundary = (2.0 * n - 1.0) * pi - incident;
      if (from_n < pi && boundary <= n * pi) {
        EXPECT_NEAR(luebbers_angles(utd_angles(n, incident, boundary)).face_n, from_n, 1e-12);
      }
    }
  }
  // Luebbers' own choice is R_0 at phi' and R_n at n pi - phi.
  const FaceAngles own = luebbers_angles(utd_angles(1.5, 0.3, 4.0));
  EXPECT_EQ(own.face_0, 0.3);
  EXPECT_NEAR(std::sin(own.face_n), std::sin(1.5 * pi - 4.0), 1e-14);
  // In the extended plane of the far face, (n - 1) pi, there is no grazing incidence.
  EXPECT_EQ(luebbers_angles(utd_angles(1.5, 0.3, 0.5 * pi)).face_n, 0.5 * pi);
}

TEST(Utd, KnifeEdge) {
  // A distant absorbing half-plane is the knife edge of Fresnel and Kirchhoff with the loss 20 log10 |(1 +
  // j)/2 int_nu^inf e^{-j pi t^2/2}| (Rec. ITU-R P.526): 6.0206 dB at nu = 0, 13.8641 dB at nu = 1, and a
  // gain of 1.0010 dB at nu = -1.
  const double k_distance = 1e9;
  for (const auto& [nu, loss_db] :
       {std::pair{0.0, 6.0206}, std::pair{1.0, 13.8641}, std::pair{-1.0, -1.0010}}) {
    const double delta = nu * std::sqrt(pi / k_distance);  // w = sqrt(pi/2) nu = sqrt(2kL) delta/2
    const Complex d =
        utd_coefficients(utd_angles(2.0, 0.5 * pi, 1.5 * pi + delta), 1.0, k_distance, 1.0, {}, {}).soft /
        std::sqrt(k_distance);
    // The direct wave is ahead of the diffracted wave by w^2.
    const double ahead = 0.5 * pi * nu * nu;
    const Complex sum = d + (nu <= 0.0 ? std::polar(1.0, ahead) : Complex(0.0));
    EXPECT_NEAR(-20.0 * std::log10(std::abs(sum)), loss_db, 1e-3) << nu;
  }
}

TEST(Utd, RefusesWhatIsNoWedge) {
  EXPECT_THROW(utd_angles(1.0, 0.5, 0.5), ContractError);
  EXPECT_THROW(utd_angles(0.5, 0.5, 0.5), ContractError);
  EXPECT_THROW(utd_angles(2.5, 0.5, 0.5), ContractError);
  EXPECT_THROW(utd_angles(1.5, 0.5, 1.6 * pi), ContractError);
  EXPECT_THROW(utd_terms(utd_angles(1.5, 0.5, 0.6), 0.0, 1.0), ContractError);
}

}  // namespace
}  // namespace greatx::rf
