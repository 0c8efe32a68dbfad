// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

/// Joins what neighbours mean to share: a corner within `distance_m` of an earlier one moves there, and a
/// wall within `distance_m` of a corner gets that corner. Rings keep their order. Returns how many corners
/// moved or came.
size_t weld(std::span<Ring* const> rings, double distance_m);

}  // namespace greatx::scene::place
