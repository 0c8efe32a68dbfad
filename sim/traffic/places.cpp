// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where everyone is when the simulation begins, and how fast they like to go.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/traffic/simulation.h"

namespace greatx::sim {
namespace {

constexpr int most_tries = 2000;

/// Returns the index of a part of a length, and the place in it.
template <typename Lengths>
std::pair<uint32_t, double> pick(const Lengths& lengths, double share) {
  double total = 0.0;
  for (const double length : lengths) total += length;
  double at = share * total;
  for (uint32_t i = 0; i < lengths.size(); ++i) {
    if (at < lengths[i]) return {i, at};
    at -= lengths[i];
  }
  return {static_cast<uint32_t>(lengths.size() - 1), 0.0};
}

}  // namespace

/// Draws the person's own numbers.
void Simulation::draw(Agent& agent) {
  RandomStream& random = agent.random;
  // The sum of twelve uniform numbers less six is close to a normal one.
  double normal = -6.0;
  for (int i = 0; i < 12; ++i) normal += random.uniform();
  switch (agent.body.kind) {
    case TrafficMember::Kind::vehicle: {
      const bool heavy = agent.body.extent.front_m + agent.body.extent.rear_m > 7.0;
      agent.follower = {13.9, heavy ? 0.9 : 1.5, 2.0, 1.2, 2.0};
      agent.factor = std::clamp(0.97 + 0.06 * normal, 0.8, 1.1);
      agent.most_mps = heavy ? 22.0 : 50.0;
      break;
    }
    case TrafficMember::Kind::cyclist:
      agent.follower = {5.0, 0.8, 1.5, 1.0, 1.2};
      agent.most_mps = std::clamp(5.0 + 0.8 * normal, 3.5, 8.0);
      break;
    case TrafficMember::Kind::pedestrian:
      // Weidmann, Transporttechnik der Fussgaenger (1993): 1.34 m/s, standard deviation 0.26 m/s.
      agent.follower = {std::clamp(1.34 + 0.26 * normal, 0.8, 1.9), 0.7, 1.2, 0.5, 0.35};
      agent.most_mps = agent.follower.desired_mps;
      break;
  }
}

void Simulation::no_room(const char* whom, size_t found) const {
  throw_user_error_at(where_,
                      "traffic: expected at most as many {} as the streets of {} have room for, about "
                      "{}, found more",
                      whom, streets_->name(), found);
}

void Simulation::place_vehicle(uint32_t index) {
  Agent& agent = agents_[index];
  std::vector<double> lengths;
  for (const DriveWay& way : streets_->ways())
    lengths.push_back(way.goes_on(agent.size()) && !way.turn() && way.gates.back().stop_m > 12.0
                          ? way.curve.length()
                          : 0.0);
  const bool any = std::ranges::any_of(lengths, [](double length) { return length > 0.0; });
  if (!any && agent.size() == VehicleSize::longer)
    throw_user_error_at(where_,
                        "traffic: expected vehicles whose bodies stay in their lanes, found one of {:.1f} m, "
                        "for which the streets of {} have no way: leave it out of 'mix'",
                        agent.body.extent.front_m + agent.body.extent.rear_m, streets_->name());
  for (int tries = 0; any && tries < most_tries; ++tries) {
    const auto [way, place] = pick(lengths, agent.random.uniform());
    const DriveWay& lane = streets_->ways()[way];
    if (place - agent.body.extent.rear_m < lane.clear_m + 1.0 ||
        place + agent.body.extent.front_m > lane.gates.back().stop_m - 1.0)
      continue;
    // Behind every gate in the middle of the lane that it stands over, it would hold no crossing.
    const bool over = std::ranges::any_of(lane.gates, [&](const Gate& gate) {
      return !gate.turn && place + agent.body.extent.front_m > gate.stop_m - 1.0 &&
             place - agent.body.extent.rear_m < gate.crossings.back().to_m + 1.0;
    });
    const bool taken = std::ranges::any_of(on_way_[way], [&](const Entry& entry) {
      const Extent& other = agents_[entry.agent].body.extent;
      const double room = entry.place > place ? agent.body.extent.front_m + other.rear_m
                                              : agent.body.extent.rear_m + other.front_m;
      return std::abs(entry.place - place) < room + 2.5;
    });
    if (over || taken) continue;
    agent.ground = Ground::way;
    agent.begin_m = -place;
    enter(agent, way);
    agent.pieces.clear();
    start_piece(agent, lane.curve, 0.0);
    while (!lane.gates[agent.gate].turn && lane.gates[agent.gate].stop_m < place) ++agent.gate;
    on_way_[way].push_back({place, index, false});
    counts_ = {};
    return;
  }
  size_t found = 0;
  for (uint32_t i = 0; i < index; ++i) found += agents_[i].walks() ? 0 : 1;
  no_room("vehicles and cyclists", found);
}

void Simulation::place_walker(uint32_t index) {
  Agent& agent = agents_[index];
  std::vector<double> lengths;
  for (const WalkRing& ring : streets_->rings()) {
    // There are more people where there are more crossings.
    const double weight = 0.3 + 0.35 * static_cast<double>(ring.leaving.size());
    lengths.push_back(weight * ring.right.length());
    lengths.push_back(weight * ring.left.length());
  }
  for (int tries = 0; !lengths.empty() && tries < most_tries; ++tries) {
    const auto [side, weighted] = pick(lengths, agent.random.uniform());
    const bool right = side % 2 == 0;
    Line& line = (right ? on_right_ : on_left_)[side / 2];
    const WalkRing& ring = streets_->rings()[side / 2];
    const double length = (right ? ring.right : ring.left).length();
    const double place = weighted * length / lengths[side];
    const bool taken = std::ranges::any_of(line, [&](const Entry& entry) {
      const double apart = std::abs(entry.place - place);
      return std::min(apart, length - apart) < 1.6;
    });
    if (taken) continue;
    agent.ground = right ? Ground::right_ring : Ground::left_ring;
    agent.on = side / 2;
    agent.begin_m = -place;
    start_piece(agent, right ? ring.right : ring.left, 0.0);
    line.push_back({place, index, false});
    return;
  }
  size_t found = 0;
  for (uint32_t i = 0; i < index; ++i) found += agents_[i].walks() ? 1 : 0;
  no_room("pedestrians", found);
}

}  // namespace greatx::sim
