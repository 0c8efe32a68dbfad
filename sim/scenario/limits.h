// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How large and how small what users give may be, wherever they give it: scenarios, tables, the command line.
#pragma once

#include <cstdint>

namespace greatx::sim {

/// Of every number that is not an integer: what squares and ratios in single precision on the device can hold. Most
/// quantities have nearer ends of their own.
inline constexpr double least_number = 1e-30, most_number = 1e30;
inline constexpr double most_position_m = 1e8;  ///< beyond the geostationary satellites
inline constexpr double most_angle_deg = 1e6;   ///< a sine of more has lost its digits
inline constexpr double most_time_s = 1e9;      ///< thirty years
/// Below, a wave is longer than most scenes; above, light has models of its own.
inline constexpr double least_carrier_hz = 1e6, most_carrier_hz = 1e13;
inline constexpr int64_t most_ticks = 1'000'000'000'000;
inline constexpr uint32_t most_sequences = 1'000'000;

}  // namespace greatx::sim
