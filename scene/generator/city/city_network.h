// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The streets of the generated city as data for traffic: lanes, turns at junctions, crossings, walking lines.
#pragma once

#include "scene/generator/city/city_plan.h"
#include "scene/network/network.h"

namespace greatx::scene::generator {

/// Returns the network. Traffic keeps to the right. An avenue has two lanes in each direction, another street
/// one, whose middle keeps clear of the cars parked on the right kerb in the direction of increasing x and y.
/// Junctions of avenues have signals. Each block has one walking line, 2.0 m from the kerb (avenues 3.1 m,
/// the edge of the model 1.0 m).
StreetNetwork city_network(const CityPlan& plan);

}  // namespace greatx::scene::generator
