// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Places on a member's way.
#pragma once

#include "sim/traffic/simulation.h"

namespace greatx::sim {

/// A place on a way at its offset, with derivatives by the length of the middle line as seen from above.
struct WayPlace {
  dvec3 position{0.0}, first{1.0, 0.0, 0.0}, second{0.0};
  double heading = 0.0, heading_first = 0.0, heading_second = 0.0;  ///< rad, of `first` as seen from above
};
WayPlace place_on(const Piece& piece, double way_m);

/// Returns the length of a piece between two places of the whole way, m: that which a wheel rolls.
double length_between(const Piece& piece, double from_m, double to_m);

}  // namespace greatx::sim
