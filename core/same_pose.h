// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/vec.h"

namespace greatx {

/// Returns whether two poses have the same numbers: what was computed for one holds for the other to the bit.
inline bool same_pose(const Pose& a, const Pose& b) {
  return a.position == b.position && a.orientation == b.orientation;
}

}  // namespace greatx
