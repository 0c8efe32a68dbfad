// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/traffic/simulation.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/error.h"
#include "sim/traffic/pieces.h"

namespace greatx::sim {

Simulation::Simulation(std::shared_ptr<const Streets> streets, std::vector<TrafficBody> bodies,
                       const TrafficConfig& config, uint32_t sequence)
    : streets_(std::move(streets)), where_(config.where) {
  begin_s_ = -std::ceil(config.warm_up_s / step_s - 1e-9) * step_s;
  now_s_ = begin_s_;
  on_way_.resize(streets_->ways().size());
  on_right_.resize(streets_->rings().size());
  on_left_.resize(streets_->rings().size());
  on_path_.resize(streets_->paths().size());
  held_by_vehicle_.resize(streets_->crossing_count());
  walkers_on_.resize(streets_->crossing_count());
  walker_waits_since_.resize(streets_->crossing_count());
  constexpr uint32_t streams = 0x74726166;  // of traffic, apart from those of nodes' names
  for (uint32_t i = 0; i < bodies.size(); ++i)
    draw(agents_.emplace_back(bodies[i], RandomStream(config.seed, streams + i, sequence)));
  for (uint32_t i = 0; i < agents_.size(); ++i) agents_[i].walks() ? place_walker(i) : place_vehicle(i);
  for (Agent& agent : agents_) append(agent);
}

WayState Simulation::at(uint32_t member, double time_s) {
  const double steps = std::max((time_s - begin_s_) / step_s, 0.0);
  const auto step = static_cast<size_t>(steps);
  const auto state = [&] {
    const Agent& agent = agents_[member];
    const double since_s = std::clamp((steps - static_cast<double>(step)) * step_s, 0.0, step_s);
    WayState result;
    const double speed = agent.speeds_mps[step];
    result.acceleration_mps2 = (agent.speeds_mps[step + 1] - speed) / step_s;
    result.speed_mps = speed + result.acceleration_mps2 * since_s;
    result.way_m = agent.ways_m[step] + 0.5 * (speed + result.speed_mps) * since_s;
    const auto after =
        std::upper_bound(agent.pieces.begin() + 1, agent.pieces.end(), result.way_m,
                         [](double way_m, const Piece& piece) { return way_m < piece.begin_m; });
    result.piece = *(after - 1);
    if (time_s < begin_s_) result.acceleration_mps2 = 0.0;
    if (!agent.efforts.empty()) {
      const EffortWay part = effort_way({agent.efforts[step], agent.efforts[step + 1]}, speed,
                                        result.acceleration_mps2, since_s, step_s);
      result.pedalled_m = agent.pedalled_m[step] + part.way_m;
      result.pedalled_mps = part.speed_mps;
      result.pedalled_mps2 = part.acceleration_mps2;
    }
    return result;
  };
  {
    const std::shared_lock lock(mutex_);
    if (step < steps_) return state();
  }
  const std::unique_lock lock(mutex_);
  advance_to(step + 20);
  return state();
}

Simulation::Counts Simulation::counts() const {
  const std::shared_lock lock(mutex_);
  return counts_;
}

void Simulation::advance_to(size_t steps) {
  while (steps_ < steps) step();
}

void Simulation::append(Agent& agent) {
  agent.ways_m.push_back(agent.way_m);
  agent.speeds_mps.push_back(agent.speed_mps);
  if (agent.body.kind != TrafficMember::Kind::cyclist) return;
  if (agent.efforts.empty()) {
    agent.efforts.push_back(1.0);
    agent.pedalled_m.push_back(0.0);
    return;
  }
  constexpr double most_change = step_s / effort_s;
  const double before = agent.efforts.back(), wanted = agent.acceleration_mps2 < -coasting_mps2 ? 0.0 : 1.0;
  const double effort = std::clamp(wanted, before - most_change, before + most_change);
  const double speed = agent.speeds_mps[agent.speeds_mps.size() - 2];
  const double acceleration = (agent.speed_mps - speed) / step_s;
  agent.pedalled_m.push_back(agent.pedalled_m.back() +
                             effort_way({before, effort}, speed, acceleration, step_s, step_s).way_m);
  agent.efforts.push_back(effort);
}

EffortWay effort_way(const Effort& effort, double speed_mps, double acceleration_mps2, double since_s,
                     double step_s) {
  const double t = since_s, v = speed_mps, a = acceleration_mps2, w = effort.begin,
               rate = (effort.end - effort.begin) / step_s;
  return {t * (w * v + t * (0.5 * (w * a + rate * v) + t * rate * a / 3.0)), (w + rate * t) * (v + a * t),
          (w + rate * t) * a + rate * (v + a * t)};
}

int indicated_side(const WayState& state) {
  constexpr double before_turn_m = 30.0;
  const Piece& piece = state.piece;
  if (piece.change_m != 0.0 && state.way_m < piece.begin_m + piece.change_length_m)
    return piece.change_m > 0.0 ? -1 : 1;  // it comes from the left, or from the right
  return state.way_m > piece.turn_m - before_turn_m ? piece.turn_side : 0;
}

/// Starts a piece of the way at the agent's present place, or at the end of what it is on.
void Simulation::start_piece(Agent& agent, const Curve& curve, double at_m, double change_m,
                             double change_length_m) {
  // Cyclists ride on the right of the lane, within the width that a car takes.
  const double left_m = agent.body.kind == TrafficMember::Kind::cyclist ? -0.65 : 0.0;
  Piece piece{&curve, agent.begin_m + at_m, at_m, left_m, change_m, change_length_m};
  if (agent.ground == Ground::way) {
    const DriveWay &way = streets_->ways()[agent.on], &next = streets_->ways()[agent.next];
    piece.turn_side = way.turn() ? way.side : next.side;
    piece.turn_m = way.turn() ? agent.begin_m : agent.begin_m + way.curve.length();
  }
  if (!agent.pieces.empty()) {
    const Piece& before = agent.pieces.back();
    piece.travelled_m = before.travelled_m + length_between(before, before.begin_m, piece.begin_m);
  }
  agent.pieces.push_back(piece);
}

void Simulation::list_all() {
  for (auto* lines : {&on_way_, &on_right_, &on_left_, &on_path_})
    for (Line& line : *lines) line.clear();
  for (uint32_t i = 0; i < agents_.size(); ++i) {
    const Agent& agent = agents_[i];
    Line& line = agent.ground == Ground::way          ? on_way_[agent.on]
                 : agent.ground == Ground::right_ring ? on_right_[agent.on]
                 : agent.ground == Ground::left_ring  ? on_left_[agent.on]
                                                      : on_path_[agent.on];
    line.push_back({agent.place(), i, false});
    if (agent.ghost) on_way_[agent.ghost->way].push_back({agent.place() + agent.ghost->shift_m, i, true});
  }
  for (auto* lines : {&on_way_, &on_right_, &on_left_, &on_path_})
    for (Line& line : *lines)
      std::ranges::sort(line, [](const Entry& a, const Entry& b) {
        return a.place != b.place ? a.place < b.place : a.agent < b.agent;
      });
}

/// Gives up what has been passed, and turns that cannot be reached any more.
void Simulation::release() {
  for (Agent& agent : agents_) {
    std::erase_if(agent.holds, [&](const Hold& hold) { return agent.way_m > hold.until_m; });
    if (agent.ghost && agent.way_m > agent.ghost->until_m) agent.ghost.reset();
    if (!agent.granted || agent.ground != Ground::way) continue;
    const DriveWay& way = streets_->ways()[agent.on];
    const DriveWay& next = streets_->ways()[agent.next];
    if (way.turn() || !next.turn() || streets_->light(next, now_s_) == Light::green) continue;
    const double left_m = way.gates.back().stop_m - agent.place() - agent.body.extent.front_m;
    constexpr double firm_braking_mps2 = 3.0;
    if (left_m < 0.5 + agent.speed_mps * agent.speed_mps / (2.0 * firm_braking_mps2)) continue;
    agent.granted = false;
    ++counts_.changes_of_mind;
    std::erase_if(agent.holds, [](const Hold& hold) { return hold.last_grant; });
  }
}

void Simulation::count_claims() {
  std::ranges::fill(held_by_vehicle_, 0);
  std::ranges::fill(walkers_on_, 0);
  std::ranges::fill(walker_waits_since_, 1e18);
  for (const Agent& agent : agents_) {
    for (const Hold& hold : agent.holds)
      if (hold.crossing) held_by_vehicle_[hold.index] = 1;
    if (agent.ground != Ground::path) continue;
    const CrossingPath& path = streets_->paths()[agent.on];
    if (agent.granted && agent.place() < path.across_m + agent.body.extent.rear_m)
      ++walkers_on_[path.crossing];
    else if (!agent.granted && agent.asked_s)
      walker_waits_since_[path.crossing] = std::min(walker_waits_since_[path.crossing], *agent.asked_s);
  }
}

void Simulation::step() {
  list_all();
  release();
  count_claims();
  for (uint32_t i = 0; i < agents_.size(); ++i)
    if (agents_[i].walks()) decide(agents_[i], i), let_walk(i);
  ask_all();
  for (uint32_t i = 0; i < agents_.size(); ++i)
    if (!agents_[i].walks() && (steps_ + i) % 10 == 0) weigh_lane_change(i);
  for (uint32_t i = 0; i < agents_.size(); ++i) {
    const double wanted = agents_[i].walks() ? walker_acceleration(i) : vehicle_acceleration(i);
    agents_[i].acceleration_mps2 = std::max(wanted, -most_braking_mps2);
  }
  for (Agent& agent : agents_) {
    const Progress to = advanced({agent.way_m, agent.speed_mps}, agent.acceleration_mps2, step_s);
    agent.way_m = to.place_m;
    agent.speed_mps = to.speed_mps;
    if (agent.walks()) {
      move_walker(agent);
    } else {
      while (agent.place() >= streets_->ways()[agent.on].curve.length()) {
        agent.begin_m += streets_->ways()[agent.on].curve.length();
        enter(agent, agent.next);
      }
    }
    append(agent);
  }
  ++steps_;
  now_s_ = begin_s_ + static_cast<double>(steps_) * step_s;
}

}  // namespace greatx::sim
