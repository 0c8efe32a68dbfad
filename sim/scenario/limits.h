// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines bounds on the values that users give, wherever they give them: scenarios, tables, the command line.
#pragma once

#include <cstdint>

namespace greatx::sim {

inline constexpr double most_position_m = 1e8;  ///< beyond the geostationary satellites
inline constexpr double most_angle_deg = 1e6;   ///< the sine of a larger angle has lost its digits
inline constexpr double most_time_s = 1e9;      ///< thirty years
/// A lower frequency has a wave longer than most scenes. For a higher one, light has models of its own.
inline constexpr double least_carrier_hz = 1e6, most_carrier_hz = 1e13;
inline constexpr int64_t most_ticks = 1'000'000'000'000;
inline constexpr uint32_t most_sequences = 1'000'000;

}  // namespace greatx::sim
