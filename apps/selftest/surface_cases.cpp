// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reflection and transmission of plane waves. The figures of concrete at 3.5 GHz (eta = 5.24 - 0.632143j)
// were recomputed from Table 3 of ITU-R P.2040-4 independently of this program.
#include <array>
#include <cmath>
#include <complex>

#include "apps/selftest/catalogue.h"
#include "core/error.h"
#include "core/units.h"
#include "rf/surface/fresnel.h"

namespace greatx::apps::selftest {

namespace {

using rf::Complex;
using rf::FresnelCoefficients;

constexpr Complex concrete{5.24, -0.632143};

/// Adds both parts of a complex figure.
void add_complex(Rows& rows, const std::string& figure, Complex expected, Complex got, double tolerance) {
  rows.add("Re " + figure, host, expected.real(), got.real(), tolerance);
  rows.add("Im " + figure, host, expected.imag(), got.imag(), tolerance);
}

void n26_concrete(const Lab& lab, Rows& rows) {
  const Complex eta =
      lab.given(1.0) * scene::relative_permittivity(*scene::itu_medium("concrete"), 3.5e9, "concrete");
  const FresnelCoefficients at_45 = rf::half_space(eta, std::sqrt(0.5));
  add_complex(rows, "r_TE of concrete at 45 degrees", {-0.511723497, 0.024481843}, at_45.r_te, 1e-9);
  add_complex(rows, "r_TM of concrete at 45 degrees", {0.261261576, -0.025055869}, at_45.r_tm, 1e-9);
  const FresnelCoefficients slab = rf::slab({eta, 0.1}, speed_of_light / 3.5e9, 1.0);
  add_complex(rows, "R of 0.1 m of concrete, normal incidence", {-0.422222101, -0.007580311}, slab.r_te,
              1e-8);
  add_complex(rows, "T of 0.1 m of concrete, normal incidence", {-0.136274648, 0.270959987}, slab.t_te, 1e-8);
  const FresnelCoefficients normal = rf::half_space(eta, 1.0);
  rows.add("|r_TE + r_TM| at normal incidence", host, 0.0, std::abs(normal.r_te + normal.r_tm), 1e-15);
}

void n27_grazing(const Lab& lab, Rows& rows) {
  const FresnelCoefficients r = rf::half_space(concrete, lab.given(1.0) - 1.0);
  add_complex(rows, "r_TE at 90 degrees", -1.0, r.r_te, 1e-15);
  add_complex(rows, "r_TM at 90 degrees", -1.0, r.r_tm, 1e-15);
  rows.add("|t_TE| at 90 degrees", host, 0.0, std::abs(r.t_te), 1e-15);
}

void n28_brewster(const Lab& lab, Rows& rows) {
  // tan(theta_B) = sqrt(eta): cos(theta_B) = 1/sqrt(1 + eta), 66.401791 degrees.
  const double cosine = 1.0 / std::sqrt(1.0 + 5.24);
  rows.add("Brewster angle, degrees", host, 66.401791, degrees(std::acos(cosine)), 1e-6);
  rows.add("|r_TM| at Brewster's angle", host, 0.0, std::abs(rf::half_space(lab.given(5.24), cosine).r_tm),
           1e-7);
}

void n29_almost_vacuum(const Lab& lab, Rows& rows) {
  // For eta -> 1, r_TE = -(eta - 1)/(4 C^2) (1 + O(eta - 1)).
  const double excess = 0x1p-40, cosine = 0.5;
  const double r = rf::half_space(1.0 + lab.given(excess), cosine).r_te.real();
  rows.add("r_TE / (-(eta - 1)/4C^2) at eta = 1 + 2^-40", host, 1.0, r / (-excess / (4 * cosine * cosine)),
           1e-10);
}

void n30_conductor(const Lab& lab, Rows& rows) {
  // Copper-like metal of P.2040 (1e7 S/m) at 3.5 GHz and 89.9 degrees: r_TM = (eta C - A)/(eta C + A) with A
  // = sqrt(eta - 1 + C^2), in 64 bits of mantissa.
  using Wide = std::complex<long double>;
  const double omega = 2.0 * pi * 3.5e9, cosine = std::cos(radians(89.9));
  const Wide eta(1.0L, -static_cast<long double>(1e7 / (omega * vacuum_permittivity)));
  Wide root = std::sqrt(eta - 1.0L + Wide(static_cast<long double>(cosine) * cosine));
  if (root.imag() > 0) root = -root;
  const Wide expected =
      (eta * static_cast<long double>(cosine) - root) / (eta * static_cast<long double>(cosine) + root);
  const Complex got =
      rf::half_space(Complex(1.0, -1e7 / (omega * vacuum_permittivity)), lab.given(cosine)).r_tm;
  add_complex(rows, "r_TM of metal at 89.9 degrees",
              {static_cast<double>(expected.real()), static_cast<double>(expected.imag())}, got, 1e-12);
}

void n31_total_reflection(const Lab& lab, Rows& rows) {
  // From vacuum into eta = 0.25 (a plasma) beyond the critical angle, cos < sqrt(1 - 0.25).
  double worst = 0.0;
  for (const double cosine : {0.05, 0.3, 0.6, 0.85}) {
    const FresnelCoefficients r = rf::half_space({0.25, lab.given(1.0) == 1.0 ? 0.0 : -0.01}, cosine);
    worst = std::max({worst, std::abs(std::abs(r.r_te) - 1.0), std::abs(std::abs(r.r_tm) - 1.0)});
  }
  rows.add("largest ||r| - 1| in total reflection", host, 0.0, worst, 1e-6);
  const FresnelCoefficients thick = rf::slab({concrete, 1e4}, 0.01, 0.5);
  const FresnelCoefficients face = rf::half_space(concrete, 0.5);
  rows.add("|T| of 10 km of concrete", host, 0.0, std::abs(thick.t_te), 1e-300);
  rows.add("|R - r| of 10 km of concrete", host, 0.0, std::abs(thick.r_te - face.r_te), 1e-15);
}

void n32_half_wave_slab(const Lab& lab, Rows& rows) {
  // A lossless slab of d = lambda/(2 A) has R = 0, at 89.999 degrees as well, where |r| is almost 1: the
  // transmission is |T| = 1. A = sqrt(eta - sin^2).
  const double cosine = std::cos(radians(89.999)), wavelength = 0.1, eta = 4.0;
  const double normal = std::sqrt(eta - 1.0 + cosine * cosine);
  const FresnelCoefficients slab = rf::slab({eta, lab.given(0.5 * wavelength / normal)}, wavelength, cosine);
  rows.add("|T_TE| of a half-wave slab at 89.999 degrees", host, 1.0, std::abs(slab.t_te), 1e-6);
  rows.add("|T_TM| of a half-wave slab at 89.999 degrees", host, 1.0, std::abs(slab.t_tm), 1e-6);
}

void n33_energy(const Lab& lab, Rows& rows) {
  RandomStream random(33, 1);
  double lossless = 0.0, gained = -1.0;
  for (int i = 0; i < 2000; ++i) {
    std::array<rf::DielectricLayer, 3> layers, lossy;
    for (size_t l = 0; l < layers.size(); ++l) {
      const double eta = random.uniform(1.0, 10.0), d = random.uniform(0.0005, 0.05);
      layers[l] = {Complex(eta, 1.0 - lab.given(1.0)), d};
      lossy[l] = {Complex(eta, -random.uniform(0.0, 3.0)), d};
    }
    const double cosine = random.uniform(0.01, 1.0);
    const FresnelCoefficients a = rf::multilayer(layers, 0.03, cosine),
                              b = rf::multilayer(lossy, 0.03, cosine);
    lossless = std::max({lossless, std::abs(std::norm(a.r_te) + std::norm(a.t_te) - 1.0),
                         std::abs(std::norm(a.r_tm) + std::norm(a.t_tm) - 1.0)});
    gained = std::max(
        {gained, std::norm(b.r_te) + std::norm(b.t_te) - 1.0, std::norm(b.r_tm) + std::norm(b.t_tm) - 1.0});
  }
  rows.add("largest ||R|^2 + |T|^2 - 1| of lossless walls", host, 0.0, lossless, 1e-6);
  rows.add("largest energy gained by a lossy wall", host, 0.0, std::max(gained, 0.0), 1e-12);
}

void n34_vacuum_wall(const Lab& lab, Rows& rows) {
  // A wall of vacuum, drawn as a sheet, changes no path through it.
  Stage with = lab.stage(), without = lab.stage();
  const uint32_t vacuum = with.material(lab.given(1.0), 0.0, 0.25);
  with.object("wall", vacuum).quad({5, -9, -9}, {5, 9, -9}, {5, 9, 9}, {5, -9, 9});
  without.object("nothing");
  const scene::Scene a = with.build(), b = without.build();
  const rf::ChannelGrid grid{28e9, 120e3, 1, 1, 1e-3};
  Links through(lab, a, {.carrier_hz = 28e9, .max_depth = 1, .walls = true});
  Links free(lab, b, {.carrier_hz = 28e9, .max_depth = 1, .walls = true});
  const dvec3 from(0.0), to(10, 3, 2);
  const auto walled = rf::frequency_response_fp64(through.solve(from, to), antenna(), antenna(), grid);
  const auto open = rf::frequency_response_fp64(free.solve(from, to), antenna(), antenna(), grid);
  rows.add("change of H by a wall of vacuum", lab.host_and_tracer(), 0.0,
           std::abs(walled[0] - open[0]) / std::abs(open[0]), 1e-12);
}

void n35_gap(const Lab& lab, Rows& rows) {
  // P.2040-4 lists marble to 60 GHz and from 100 GHz on: 80 GHz is in the gap.
  const scene::RadioMedium marble = *scene::itu_medium("marble");
  double refused = 0.0;
  try {
    (void)scene::relative_permittivity(marble, lab.given(1.0) == 1.0 ? 80e9 : 50e9, "marble");
  } catch (const UserError&) {
    refused = 1.0;
  }
  rows.add("marble at 80 GHz, in a gap of the table: refused", host, 1.0, refused, 0.0);
  rows.add("eta' of marble at 9 GHz", host, 7.074, scene::relative_permittivity(marble, 9e9, "marble").real(),
           1e-12);
}

constexpr Case list_of_surface_cases[] = {
    {26, "concrete, normal incidence and 45 degrees", n26_concrete},
    {27, "reflection at 90 degrees", n27_grazing},
    {28, "Brewster's angle", n28_brewster},
    {29, "permittivity near 1", n29_almost_vacuum},
    {30, "conductor near grazing", n30_conductor},
    {31, "total reflection and thick slabs", n31_total_reflection},
    {32, "half-wave slab near grazing", n32_half_wave_slab},
    {33, "energy of walls", n33_energy},
    {34, "wall of vacuum", n34_vacuum_wall},
    {35, "frequency in a gap of the table", n35_gap},
};

}  // namespace

std::span<const Case> surface_cases() { return list_of_surface_cases; }

}  // namespace greatx::apps::selftest
