// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the ends of a radar for ClutterPatches while it covers surfaces (clutter_patches.cpp) and times the
// scatterers (clutter_tracks.cpp).
#pragma once

#include <optional>

#include "rf/antenna/element.h"
#include "rf/radar/echoes/clutter_patches.h"

namespace greatx::rf {

struct ClutterPatches::Ends {
  Pose transmitter, receiver;
  const ClutterSight& sight;
  dmat3 turn{1.0};                       ///< local axes from those of the transmitter
  double cell_rad = 0.1;                 ///< width of a resolution cell
  std::optional<TurnedElement> sender;   ///< the transmitter's; empty if its field is kept by cells
  std::optional<TurnedElement> element;  ///< the receiver's; empty if it is the transmitter's
};

}  // namespace greatx::rf
