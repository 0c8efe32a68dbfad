// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Closed bands along lines: decks of bridges, hedges.
#pragma once

#include <functional>

#include "scene/place/assemble/objects.h"
#include "scene/place/assemble/place_mesh.h"
#include "scene/place/ground/bridges.h"
#include "scene/place/surfaces/material_table.h"

namespace greatx::scene::place {

/// Returns a closed band: its upper face with one material, sides, lower face and ends with another one. A
/// band of fewer than two sections is empty.
PlaceMesh band_mesh(const Deck& deck, int top, int side, const MaterialTable& table);

/// Returns a hedge as a band that follows the ground, with a cross section every 5 m. It reaches 0.5 m into
/// the ground.
Deck hedge_band(const Hedge& hedge, const std::function<double(const dvec2&)>& ground);

}  // namespace greatx::scene::place
