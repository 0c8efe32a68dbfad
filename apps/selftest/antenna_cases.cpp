// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Antenna patterns at their poles and under turns that angles describe badly.
#include <algorithm>
#include <cmath>

#include "apps/selftest/catalogue.h"
#include "core/units.h"
#include "rf/antenna/element.h"

namespace greatx::apps::selftest {

namespace {

using rf::Jones;
using rf::Pattern;

double gain(const Jones& field) { return std::norm(field.theta) + std::norm(field.phi); }

Jones turned(const dquat& orientation, const dvec3& direction, Pattern pattern, double slant) {
  Jones field;
  rf::TurnedElement({pattern}, {&slant, 1}, orientation).respond(direction, {&field, 1});
  return field;
}

void n48_poles(const Lab& lab, Rows& rows) {
  const double tilt = lab.given(1.0) - 1.0;  // 0
  for (const double z : {1.0, -1.0}) {
    const std::string pole = z > 0 ? "theta = 0" : "theta = 180 degrees";
    const dvec3 up(tilt, 0.0, z);
    rows.add("gain of an isotropic element at " + pole, host, 1.0,
             gain(rf::element_field({Pattern::isotropic}, 0.3, up)), 1e-15);
    rows.add("|F| of a half-wave dipole at " + pole, host, 0.0,
             std::sqrt(gain(rf::element_field({Pattern::half_wave_dipole}, 0.0, up))), 1e-15);
  }
  const double azimuth = radians(lab.given(65.0));
  rows.add(
      "gain of TR 38.901 at (90, 65) degrees, dBi", host, -4.0,
      decibels(gain(rf::element_field({Pattern::tr38901}, 0.0, {std::cos(azimuth), std::sin(azimuth), 0}))),
      1e-9);
  rows.add("gain of a half-wave dipole across it", host, 1.6409223770,
           gain(rf::element_field({Pattern::half_wave_dipole}, 0.0, {1, 0, 0})), 1e-9);
}

void n49_beside_the_pole(const Lab& lab, Rows& rows) {
  // For theta -> 0, cos(pi/2 cos theta)/sin theta = (pi/4) theta (1 + O(theta^2)).
  double worst = 0.0;
  for (const double theta : {1e-4, 1e-6, 1e-9}) {
    const double at = lab.given(theta);
    const double field = std::abs(rf::element_field({Pattern::half_wave_dipole}, 0.0, {at, 0.0, 1.0}).theta);
    worst = std::max(worst, std::abs(field / (std::sqrt(1.6409223770) * 0.25 * pi * theta) - 1.0));
  }
  rows.add("largest relative error beside the pole of a dipole", host, 0.0, worst, 1e-7);
}

void n50_upright(const Lab& lab, Rows& rows) {
  double worst = 0.0, jump = 0.0;
  RandomStream random(50, 1);
  for (int i = 0; i < 200; ++i) {
    const double yaw = random.uniform(-3, 3), roll = random.uniform(-3, 3);
    const double pitch = i % 2 ? 0.5 * pi : -0.5 * pi;
    const dquat upright = orientation_from_yaw_pitch_roll(yaw, pitch, roll);
    const dmat3 r = lab.given(1.0) * glm::mat3_cast(upright);
    const dmat3 product = glm::transpose(r) * r;
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row)
        worst = std::max(worst, std::abs(product[column][row] - (row == column ? 1.0 : 0.0)));
    const dvec3 direction = random_direction(random);
    if (std::abs(direction.z) > 0.999) continue;
    const dquat beside = orientation_from_yaw_pitch_roll(yaw, pitch * (1.0 - 1e-9), roll);
    const Jones a = turned(upright, direction, Pattern::short_dipole, 0.4),
                b = turned(beside, direction, Pattern::short_dipole, 0.4);
    jump = std::max({jump, std::abs(a.theta - b.theta), std::abs(a.phi - b.phi)});
  }
  rows.add("largest |R^T R - I| at a pitch of 90 degrees", host, 0.0, worst, 1e-6);
  // The step of 1.6e-9 rad changes a field of at most 1.22 by no more than a few times the step, except next
  // to the nulls of the dipole, where theta-hat turns: 1e-5 there.
  rows.add("largest change of the field over 1.6e-9 rad", host, 0.0, jump, 1e-5);
}

void n51_half_turns(const Lab& lab, Rows& rows) {
  for (const dvec3& turn : {dvec3(pi, 0, 0), dvec3(0, pi, 0), dvec3(-pi, 0, pi)}) {
    const dquat orientation = orientation_from_yaw_pitch_roll(turn.x, turn.y, turn.z);
    const double off = 0.1 * (lab.given(1.0) - 1.0) * 1e3;  // 0
    rows.add("gain of TR 38.901 at its back, after a half turn, dBi", host, 8.0,
             decibels(gain(turned(orientation, {-1, off, 0}, Pattern::tr38901, 0.0))), 1e-9);
  }
}

constexpr Case list_of_antenna_cases[] = {
    {48, "poles of patterns", n48_poles},
    {49, "digits beside a pole", n49_beside_the_pole},
    {50, "pitch of 90 degrees", n50_upright},
    {51, "half turns", n51_half_turns},
};

}  // namespace

std::span<const Case> antenna_cases() { return list_of_antenna_cases; }

}  // namespace greatx::apps::selftest
