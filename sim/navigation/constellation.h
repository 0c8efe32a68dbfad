// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Places the satellites of a nominal GPS constellation.
#pragma once

#include <array>
#include <string>

#include "core/vec.h"

namespace greatx::navigation {

inline constexpr size_t satellite_count = 24;

/// Holds the place of a satellite in Earth-centred, Earth-fixed axes and its velocity in them.
struct Satellite {
  dvec3 position_m{0.0};
  dvec3 velocity{0.0};  ///< m/s
};

/// Returns the satellites at an instant, seconds since 1970 (UTC): the 24 slots of the reference orbits of
/// the GPS SPS Performance Standard (October 2001, table 3-1; E. D. Kaplan, C. J. Hegarty, Understanding GPS,
/// 2nd ed. 2006, table 3.1), in the order A1, A2, ..., F4. The orbits are circles of 26 559.7 km, inclined by
/// 55 degrees. A satellite passes its orbit twice in a sidereal day, so that its ground track repeats.
///
/// This is the plan of the constellation, and not an almanac: on a given day the real satellites are other
/// ones at other places (31 of them, eccentricities up to 0.02), with about the same geometry.
std::array<Satellite, satellite_count> nominal_constellation(double unix_s);

/// Returns the name of a slot, "A1".
std::string slot_name(size_t satellite);

}  // namespace greatx::navigation
