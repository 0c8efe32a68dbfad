// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds another sensor of the node of a sensor, so that a panel can show what both see: the street behind a
// radar's map, the picture behind its detections.
#pragma once

#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "draw/sheet/panels.h"

namespace greatx::io {

/// Holds a sensor of the same node and sequence.
struct Companion {
  PanelSource source;                         ///< its `chosen` is empty
  std::vector<std::optional<IndexRow>> rows;  ///< for each row of the first sensor, its record of that tick
  Pose from_first;                            ///< this sensor's frame from the first sensor's frame
};

/// Returns the first sensor of this kind on the node of `source` that has all of the arrays. Returns nothing
/// if there is none, or if it has no record at any of the chosen ticks.
std::optional<Companion> companion(const PanelSource& source, std::string_view kind,
                                   std::initializer_list<const char*> arrays);

}  // namespace greatx::io
