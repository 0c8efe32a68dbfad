// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the values of a scenario that have a type of the simulator's own.
#pragma once

#include <string>

#include "core/fields/field.h"
#include "sim/scenario/limits.h"
#include "sim/scenario/rational.h"
#include "sim/scenario/rotation.h"

namespace greatx::sim {

/// Returns a positive rational number, from a number or a text such as 30000/1001. Throws "expected
/// `expected`" for any other value.
Rational rational_of(const Field& field, const std::string& expected);
/// Returns the same with a sign, '-' or none.
TurnRate turn_rate_of(const Field& field, const std::string& expected);
/// Returns a position in the world, or a way or an extent in it, in metres.
dvec3 position_of(const Field& field);
/// Reads yaw, pitch and roll in degrees. Returns them in rad.
dvec3 angles_of(const Field& field);

}  // namespace greatx::sim
