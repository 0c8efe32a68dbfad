// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Diffraction at edges, against exact solutions.
#include <algorithm>
#include <cmath>
#include <complex>

#include "apps/selftest/catalogue.h"
#include "core/units.h"
#include "rf/edges/utd.h"
#include "scene/description/wedges.h"

namespace greatx::apps::selftest {

namespace {

using rf::Complex;
using rf::UtdTerm;

/// Returns D1 + D2 +- (D3 + D4) of a perfect conductor, times sin(beta_0)/sqrt(L): - soft, + hard.
Complex conductor_sum(const rf::UtdAngles& angles, double kl, double sign) {
  const rf::UtdTerms d = rf::utd_terms(angles, kl, 1.0);
  return d[UtdTerm::shadow_n] + d[UtdTerm::shadow_0] +
         sign * (d[UtdTerm::reflection_n] + d[UtdTerm::reflection_0]);
}

void n44_transition(const Lab& lab, Rows& rows) {
  // F(x) = sqrt(pi x) e^{j pi/4} erfcx(e^{j pi/4} sqrt(x)), Kouyoumjian and Pathak's transition function.
  const auto transition = [](double x) {
    return std::polar(std::sqrt(pi * x), 0.25 * pi) * rf::erfcx_on_diagonal(std::sqrt(x));
  };
  const Complex small = transition(lab.given(0.01)), one = transition(lab.given(1.0));
  rows.add("Re F(0.01)", host, 0.124205185774, small.real(), 1e-12);
  rows.add("Im F(0.01)", host, 0.106578973792, small.imag(), 1e-12);
  rows.add("Re F(1)", host, 0.809525481747, one.real(), 1e-12);
  rows.add("Im F(1)", host, 0.232199390055, one.imag(), 1e-12);
}

void n44_on_the_boundary(const Lab& lab, Rows& rows) {
  // A plane wave from 45 degrees on a conducting corner, n = 3/2. The shadow begins at 225 degrees. Exactly
  // there the diffracted field is half of the incident one, plus the small terms of the other boundaries.
  const double incident = radians(45.0), boundary = incident + pi, kl = 1e4;
  const rf::UtdTerms on = rf::utd_terms(rf::utd_angles(1.5, incident, lab.given(boundary)), kl, 1.0);
  rows.add("|D2| exactly on the shadow boundary", host, 0.5, std::abs(on[UtdTerm::shadow_0]), 1e-12);
  const double step = 1e-9;
  const Complex lit =
      1.0 + conductor_sum(rf::utd_angles(1.5, incident, boundary - step), kl, -1.0) - (lab.given(1.0) - 1.0);
  const Complex dark = conductor_sum(rf::utd_angles(1.5, incident, boundary + step), kl, -1.0);
  // The total field changes by about sqrt(2 kL/pi) step = 8e-8 of the incident one over the step.
  rows.add("jump of the total field over the boundary", host, 0.0, std::abs(lit - dark), 1e-6);
}

/// Returns int_x^inf e^{-j t^2} dt e^{j x^2} for 0 <= x <= 20. The path is turned, t = x + s e^{-j pi/4}, so
/// that the integrand falls as e^{-s^2}. The sum is the trapezoidal rule with two terms of Euler and
/// Maclaurin at s = 0; the third is below h^6 (2 x)^5/30240 = 3e-15.
Complex fresnel_tail(double x) {
  const Complex turn = std::polar(1.0, -0.25 * pi);
  const double step = 1.0 / 1024.0;
  Complex sum = 0.0;
  for (int i = 0; i <= 1024 * 8; ++i) {
    const double s = i * step;
    // e^{-j (x + s turn)^2} e^{j x^2} = e^{-2 j x s turn} e^{-s^2}
    const Complex value = std::exp(Complex(0.0, -2.0 * x * s) * turn - s * s);
    sum += (i == 0 ? 0.5 : 1.0) * value;
  }
  const Complex slope = Complex(0.0, -2.0 * x) * turn;
  const Complex third = slope * slope * slope - 6.0 * slope;
  return turn * (step * sum + step * step / 12.0 * slope - std::pow(step, 4) / 720.0 * third);
}

void n44_half_plane(const Lab& lab, Rows& rows) {
  // Sommerfeld's field of a half-plane, soft, plane wave: u(phi - phi') - u(phi + phi'), with u(b) =
  // e^{j pi/4}/sqrt(pi) e^{j k rho cos b} int_{-sqrt(2 k rho) cos(b/2)}^inf e^{-j t^2} dt. Behind the screen
  // both limits are positive, and the field is the diffracted one alone.
  const double k_rho = 100.0, incident = radians(60.0);
  double worst = 0.0;
  for (const double degrees_observed : {245.0, 270.0, 300.0, 350.0}) {
    const double observed = radians(degrees_observed);
    const auto half = [&](double angle) {
      const double limit = -std::sqrt(2.0 * k_rho) * std::cos(0.5 * angle);
      // e^{j k rho cos b} e^{-j limit^2} = e^{-j k rho}, since limit^2 = k rho (1 + cos b)
      return std::polar(1.0 / std::sqrt(pi), 0.25 * pi - k_rho) * fresnel_tail(std::abs(limit)) *
             Complex(limit >= 0.0 ? 1.0 : std::nan(""));
    };
    const Complex exact =
        half(observed - incident) -
        (std::cos(0.5 * (observed + incident)) < 0.0 ? half(observed + incident) : Complex(std::nan("")));
    const Complex got = conductor_sum(rf::utd_angles(2.0, incident, observed), lab.given(k_rho), -1.0) *
                        std::polar(1.0, -k_rho);
    worst = std::max(worst, std::abs(got - exact));
  }
  rows.add("largest error against Sommerfeld's half-plane", host, 0.0, worst, 1e-12);
}

void n45_grazing_the_edge(const Lab& lab, Rows& rows) {
  // kL -> 0: each term tends to +-1/2 of its side (the edge is too near to diffract).
  const rf::UtdTerms d = rf::utd_terms(rf::utd_angles(1.5, radians(45.0), radians(200.0)), 1.0,
                                       lab.given(1.0) == 1.0 ? 0.0 : 1.0);
  double finite = 0.0;
  for (const Complex& term : d.d) finite += std::isfinite(std::abs(term));
  rows.add("finite terms at kL = 0", host, 4.0, finite, 0.0);
  // d = -+ (1/2) sgn(delta) |sinc(delta/2)| (y cot y), y = delta/2n, at w = 0; delta = -25 degrees for D2.
  const double delta = radians(-25.0), y = delta / 3.0;
  rows.add("|D2| at kL = 0, 25 degrees before the shadow", host,
           0.5 * std::abs(std::sin(0.5 * delta) / (0.5 * delta) * y / std::tan(y)),
           std::abs(d[UtdTerm::shadow_0]), 1e-12);
}

void n46_two_faces(const Lab& lab, Rows& rows) {
  double worst = 0.0;
  for (const double incident : {20.0, 80.0, 130.0})
    for (const double observed : {10.0, 100.0, 210.0, 300.0})
      for (const double sign : {-1.0, 1.0}) {
        const Complex one =
            conductor_sum(rf::utd_angles(2.0, radians(incident), radians(observed)), lab.given(50.0), sign);
        const Complex other = conductor_sum(
            rf::utd_angles(2.0, radians(360.0 - incident), radians(360.0 - observed)), 50.0, sign);
        worst = std::max(worst, std::abs(one - other));
      }
  rows.add("change by swapping the faces of a half-plane", host, 0.0, worst, 1e-12);
  Stage stage = lab.stage();
  stage.object("flat")
      .quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0})
      .quad({4, 0, 0}, {8, 0, 0}, {8, 4, 0}, {4, 4, 0});
  stage.object("house").box({20, 0, 0}, {24, 4, 3});
  const std::vector<scene::Wedge> wedges = scene::find_wedges(stage.build());
  rows.add("edges of a box, and none of a flat seam", host, 12.0, static_cast<double>(wedges.size()), 0.0);
}

/// Adds a plate from `corner` along u and v, cut into `us` x `vs` quads.
void add_cut_plate(Stage& stage, const dvec3& corner, const dvec3& u, const dvec3& v, int us, int vs) {
  const auto at = [&](int i, int j) {
    return corner + (static_cast<double>(i) / us) * u + (static_cast<double>(j) / vs) * v;
  };
  for (int i = 0; i < us; ++i)
    for (int j = 0; j < vs; ++j) stage.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
}

void n47_split_edge(const Lab& lab, Rows& rows) {
  // A block whose faces have no common corners but the block's own: two pieces of one face and three of the
  // other meet at each edge. The edge beside which the path passes is cut just where the path touches it.
  const dvec3 low(-2, -3, 0), x(4, 0, 0), y(0, 6, 0), z(0, 0, 5);
  Stage split = lab.stage(), whole = lab.stage();
  split.object("block");
  add_cut_plate(split, low, y, x, 3, 2);
  add_cut_plate(split, low + z, x, y, 5, 7);
  add_cut_plate(split, low, x, z, 1, 1);
  add_cut_plate(split, low + y, z, x, 3, 4);
  add_cut_plate(split, low, z, y, 2, 6);
  add_cut_plate(split, low + x, y, z, 2, 1);
  whole.object("block").box(low, low + x + y + z);
  const scene::Scene cut = split.build(), plain = whole.build();
  const std::vector<scene::Wedge> wedges = scene::find_wedges(cut);
  double length = 0.0;
  for (const scene::Wedge& wedge : wedges) length += glm::length(wedge.b - wedge.a);
  rows.add("edges of a block of many triangles", host, 12.0, static_cast<double>(wedges.size()), 0.0);
  rows.add("their length, m", host, 4.0 * (4.0 + 6.0 + 5.0), length, 1e-9);

  // The edge at (-2, 3) is 5 m from both ends, whose heights differ by 1 m. Unfolded, the path has 10 m by
  // 1 m and meets the edge at 2.5 m. No other edge is seen from both ends.
  const dvec3 from(-6, 0, 2), to(2.8, 4.4, 3);
  Links of_cut(lab, cut, {.edges = true}), of_plain(lab, plain, {.edges = true});
  const std::vector<rf::Path> paths = of_cut.solve(from, lab.given(to)), known = of_plain.solve(from, to);
  rows.add("paths round a split edge", lab.host_and_tracer(), 1.0, static_cast<double>(paths.size()), 0.0);
  const bool found = paths.size() == 1 && known.size() == 1;
  rows.add("length of the path, m", host, std::sqrt(101.0), found ? paths[0].length_m : std::nan(""), 1e-12);
  double change = found ? 0.0 : std::nan(""), largest = 0.0;
  for (int i = 0; found && i < 4; ++i) {
    change = std::max(change, std::abs(paths[0].transfer[i] - known[0].transfer[i]));
    largest = std::max(largest, std::abs(known[0].transfer[i]));
  }
  rows.add("change of its field by the cuts, of its largest part", host, 0.0, change / largest, 1e-12);
}

constexpr Case list_of_edge_cases[] = {
    {44, "transition function", n44_transition},
    {44, "exactly on a shadow boundary", n44_on_the_boundary},
    {44, "Sommerfeld's half-plane", n44_half_plane},
    {45, "ends next to the edge", n45_grazing_the_edge},
    {46, "faces of a half-plane, flat seams", n46_two_faces},
    {47, "edge and faces in many pieces", n47_split_edge},
};

}  // namespace

std::span<const Case> edge_cases() { return list_of_edge_cases; }

}  // namespace greatx::apps::selftest
