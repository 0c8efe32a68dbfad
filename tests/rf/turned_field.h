// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the field of a single turned element.
#pragma once

#include "rf/antenna/element.h"

namespace greatx::rf::testing {

/// Returns the field pattern of one polarization of an element that `orientation` (world_from_antenna) turns,
/// resolved on the world's (theta, phi).
inline Jones turned_field(const ElementPattern& pattern, double slant, const dquat& orientation,
                          const dvec3& world_direction) {
  Jones field;
  TurnedElement(pattern, {&slant, 1}, orientation).respond(world_direction, {&field, 1});
  return field;
}

}  // namespace greatx::rf::testing
