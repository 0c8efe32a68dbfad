// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

namespace greatx {

inline constexpr double pi = std::numbers::pi;
/// Speed of light in vacuum, m/s (exact, SI).
inline constexpr double speed_of_light = 299792458.0;
/// Vacuum permittivity, F/m (CODATA 2018).
inline constexpr double vacuum_permittivity = 8.8541878128e-12;

constexpr double radians(double degrees) { return degrees * (pi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / pi); }
inline double decibels(double power_ratio) { return 10.0 * std::log10(power_ratio); }
inline double from_decibels(double db) { return std::pow(10.0, db / 10.0); }

}  // namespace greatx
