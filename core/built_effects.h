// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tells which effects of radio this program was built with (CMake's GREATX_EFFECTS). The preset `lean` leaves
// out all but the line of sight, to measure what the others cost a run in which they are off
// (`greatx bench --line-of-sight`). Sources alone include this file, not headers, and their room is named in
// a call of greatx_built_effects().
#pragma once

#ifndef GREATX_BUILDS_ALL_EFFECTS
#error "name this room in greatx_built_effects()"
#endif

namespace greatx {

/// False: the program has the line of sight alone, and make_effect_plan() refuses what calls for more.
constexpr bool all_effects_built = GREATX_BUILDS_ALL_EFFECTS;

}  // namespace greatx
