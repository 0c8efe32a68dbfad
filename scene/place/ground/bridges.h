// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/place/ground/areas.h"
#include "scene/place/ground/terrain.h"

namespace greatx::scene::place {

/// A deck: cross sections along the line of a bridge.
struct Deck {
  struct Section {
    dvec2 left, right;  ///< of the way
    double z = 0.0;     ///< of the upper face
  };
  std::vector<Section> sections;
  double thickness_m = 1.0;
  double lift_m = 0.0;  ///< by which the middle was raised
};

/// Returns the deck of a bridge. It runs straight from the ground at one end to the ground at the other one.
/// Where that leaves less than 5 m per layer above the lowest ground below, the middle is raised, with ramps
/// over the first and the last 40 % of the length, at most 60 m: the sources do not say the height of a deck.
Deck make_deck(const Bridge& bridge, const GroundLevel& level);

}  // namespace greatx::scene::place
