// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the streets of a place, on which traffic moves, from the ways of its sources.
//
//   ways on the ground, split where they meet ─► edges; short ones between junctions become part of them
//     ─► lanes to the right of the edges' middle lines, turns over junctions, loops at the border
//     ─► walking lines: narrow closed bands along both sides of the edges and along footways
#pragma once

#include <functional>

#include "scene/network/network.h"
#include "scene/place/config/place_config.h"
#include "scene/place/ground/areas.h"
#include "scene/place/input/box.h"
#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

/// Returns the streets. `height` gives the ground within `rectangle`; nobody walks where `built` is true. The
/// rules are those of docs/traffic.md: vehicles drive on the right, junctions have no signals, and bridges,
/// tunnels and private ways carry no traffic. Without any way the network is empty.
StreetNetwork place_streets(const PlaceInput& input, const GroundPlan& ground, const Box& rectangle,
                            const std::function<double(const dvec2&)>& height,
                            const std::function<bool(const dvec2&)>& built);

}  // namespace greatx::scene::place
