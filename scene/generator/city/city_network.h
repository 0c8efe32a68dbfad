// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The streets of the generated city as data for traffic: lanes, turns at junctions, crossings, walking lines.
#pragma once

#include <optional>

#include "scene/generator/city/city_plan.h"
#include "scene/network/network.h"

namespace greatx::scene::generator {

/// Returns the network. Traffic keeps to the right. An avenue has two lanes in each direction, another street
/// one, whose middle keeps clear of the cars parked on the right kerb in the direction of increasing x and y.
/// Junctions of avenues have signals. Each block has one walking line, 2.0 m from the kerb (avenues 3.1 m,
/// the edge of the model 1.0 m).
StreetNetwork city_network(const CityPlan& plan);

/// What is at one end of a block's edge: the junction at the corner and the zebra over the street there.
struct EdgeEnd {
  std::optional<uint32_t> junction;  ///< if it has signals
  uint32_t group = 0;                ///< of vehicles that come along the edge
  bool zebra = false;
};
/// Returns what is at the start (Block::edge_start) or the end of an edge along which a street runs.
EdgeEnd edge_end(const CityPlan& plan, const Block& block, int edge, bool start);

}  // namespace greatx::scene::generator
