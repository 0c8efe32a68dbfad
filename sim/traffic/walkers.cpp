// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// People of the simulation. They follow each other in single files, by the IDM with numbers of people.
#include <algorithm>
#include <cmath>

#include "sim/traffic/simulation.h"

namespace greatx::sim {
namespace {

constexpr double decide_m = 3.0;     ///< before the place where a path leaves the walking line
constexpr double decided_m = 2.0;    ///< there it is too late
constexpr double cross_share = 0.5;  ///< of those who could cross
constexpr double leaving_m = 1.8;    ///< of a path: so long one is in the way of those who stay on the line
constexpr double walk_ahead_m = 15.0;

/// Returns the way forward from one place of a ring to another.
double ahead(const Curve& ring, double from, double to) {
  const double length = ring.length();
  const double way = std::fmod(to - from, length);
  return way < 0.0 ? way + length : way;
}

}  // namespace

/// Chooses, shortly before a path leaves the walking line, whether to take it.
void Simulation::decide(Agent& agent, uint32_t) {
  if (agent.ground != Ground::right_ring || agent.exit) return;
  const WalkRing& ring = streets_->rings()[agent.on];
  for (const uint32_t path : ring.leaving) {
    const double way = ahead(ring.right, agent.place(), streets_->paths()[path].leave_m);
    if (way < decided_m || way > decide_m) continue;
    if (agent.passed == path) return;
    agent.passed = path;
    const bool wants = agent.random.uniform() < cross_share;
    constexpr double least_green_s = 3.0;  // of the time that is left
    if (wants && path_free(path) &&
        walk_time(agent, streets_->paths()[path], 0.0) + least_green_s <
            streets_->longest_walk_time(streets_->paths()[path].crossing))
      agent.exit = path;
    return;
  }
}

/// Returns the time that a person needs to get over a crossing from a place on the path.
double Simulation::walk_time(const Agent& agent, const CrossingPath& path, double place) const {
  constexpr double spare_s = 1.0;
  return (path.across_m - std::max(place, path.wait_m)) / agent.follower.desired_mps + spare_s;
}

/// Whether the place at the kerb is free. One person waits there at a time.
bool Simulation::path_free(uint32_t path) const {
  for (const Agent& agent : agents_) {
    if (agent.exit == path) return false;
    if (agent.ground == Ground::path && agent.on == path &&
        (!agent.granted || agent.place() < streets_->paths()[path].wait_m + 1.5))
      return false;
  }
  return true;
}

/// Lets a person step onto the crossing, and from it into the file on the other side.
void Simulation::let_walk(uint32_t index) {
  Agent& agent = agents_[index];
  if (agent.ground != Ground::path) return;
  const CrossingPath& path = streets_->paths()[agent.on];
  if (!agent.granted) {
    constexpr double near_m = 1.2;
    if (path.wait_m - agent.place() > near_m) return;
    if (!agent.asked_s) agent.asked_s = now_s_;
    if (held_by_vehicle_[path.crossing] != 0 ||
        streets_->walk_time(path.crossing, now_s_) < walk_time(agent, path, agent.place()))
      return;
    // Nobody stops on the carriageway: those ahead must have left it, or be walking.
    for (const Entry& entry : on_path_[agent.on])
      if (entry.place > agent.place() + 0.01 && entry.place > path.wait_m &&
          agents_[entry.agent].speed_mps < 0.3)
        return;
    agent.granted = true;
    agent.asked_s.reset();
    ++walkers_on_[path.crossing];
    ++counts_.crossings;
  }
  if (agent.granted && !agent.merging && path.merge_m - agent.place() < 1.5)
    agent.merging = gap_to_join(path, index);
}

/// Whether the file on the other side leaves a gap: nobody there, or near enough behind to be hindered.
bool Simulation::gap_to_join(const CrossingPath& path, uint32_t) const {
  const Curve& ring = streets_->rings()[path.to_walk].right;
  constexpr double join_room_m = 1.4, behind_s = 2.5;
  for (const Entry& entry : on_right_[path.to_walk]) {
    const double before = ahead(ring, entry.place, path.join_m);
    const double after = ring.length() - before;
    if (after < join_room_m) return false;
    const Agent& other = agents_[entry.agent];
    const double speed = std::max(other.speed_mps, 0.5 * other.follower.desired_mps);
    if (before < join_room_m + behind_s * speed) return false;
  }
  return true;
}

double Simulation::walker_acceleration(uint32_t index) const {
  const Agent& agent = agents_[index];
  const Follower& follower = agent.follower;
  double worst = 0.0;
  const auto follow = [&](double distance, const Agent& leader) {
    const double gap = distance - agent.body.extent.front_m - leader.body.extent.rear_m;
    worst = std::min(worst, interaction(follower, agent.speed_mps, gap, leader.speed_mps));
  };
  // A place to stop at, exactly, with the middle of the body.
  const auto stop_at = [&](double distance) {
    worst = std::min(worst, interaction(follower, agent.speed_mps, distance + follower.gap_m, 0.0));
  };
  const double place = agent.place();
  const auto follow_file = [&](const Line& line, const Curve& curve, double from, double offset,
                               double most) {
    double nearest = most;
    const Agent* leader = nullptr;
    for (const Entry& entry : line) {
      if (entry.agent == index) continue;
      const double way = ahead(curve, from, entry.place);
      if (way >= nearest || (way == 0.0 && entry.agent < index)) continue;
      nearest = way;
      leader = &agents_[entry.agent];
    }
    if (leader != nullptr) follow(offset + nearest, *leader);
  };
  if (agent.ground == Ground::left_ring) {
    follow_file(on_left_[agent.on], streets_->rings()[agent.on].left, place, 0.0, walk_ahead_m);
  } else if (agent.ground == Ground::right_ring) {
    const WalkRing& ring = streets_->rings()[agent.on];
    double most = walk_ahead_m;
    if (agent.exit) {
      const CrossingPath& path = streets_->paths()[*agent.exit];
      const double to_path = ahead(ring.right, place, path.leave_m);
      most = to_path + leaving_m;
      if (!on_path_[*agent.exit].empty()) {
        const Entry& last = on_path_[*agent.exit].front();
        follow(to_path + last.place, agents_[last.agent]);
      }
    }
    follow_file(on_right_[agent.on], ring.right, place, 0.0, most);
    for (const uint32_t path : ring.leaving)
      for (const Entry& entry : on_path_[path]) {
        const double way = ahead(ring.right, place, streets_->paths()[path].leave_m) + entry.place;
        if (entry.place < leaving_m && way < walk_ahead_m) follow(way, agents_[entry.agent]);
      }
    for (const uint32_t path : ring.joining)
      for (const Entry& entry : on_path_[path]) {
        const Agent& other = agents_[entry.agent];
        const CrossingPath& of = streets_->paths()[path];
        // One who joins is ahead of those who have not come so far.
        const double way = ahead(ring.right, place, of.join_m) - (of.curve.length() - entry.place);
        if (other.merging && way > 0.0 && way < walk_ahead_m) follow(way, other);
      }
  } else {
    const CrossingPath& path = streets_->paths()[agent.on];
    for (const Entry& entry : on_path_[agent.on])
      if (entry.agent != index && (entry.place > place || (entry.place == place && entry.agent > index))) {
        follow(entry.place - place, agents_[entry.agent]);
        break;
      }
    if (place < leaving_m) {
      const Curve& ring = streets_->rings()[path.from_walk].right;
      for (const Entry& entry : on_right_[path.from_walk]) {
        const double way = ahead(ring, path.leave_m, entry.place) - place;
        if (way > 0.0 && way < leaving_m) follow(way, agents_[entry.agent]);
      }
    }
    if (!agent.granted) stop_at(path.wait_m - place);
    if (!agent.merging)
      stop_at(path.merge_m - place);
    else
      follow_file(on_right_[path.to_walk], streets_->rings()[path.to_walk].right, path.join_m,
                  path.curve.length() - place, 4.0);
  }
  return free_acceleration(follower, agent.speed_mps, follower.desired_mps) + worst;
}

/// Goes on from one curve to the next one.
void Simulation::move_walker(Agent& agent) {
  if (agent.ground == Ground::path) {
    const CrossingPath& path = streets_->paths()[agent.on];
    const double over = agent.place() - path.curve.length();
    if (over < 0.0) return;
    agent.ground = Ground::right_ring;
    agent.on = path.to_walk;
    agent.exit.reset();
    agent.passed.reset();
    agent.granted = agent.merging = false;
    // The piece begins where the path joins the ring.
    agent.begin_m = agent.way_m - over - path.join_m;
    start_piece(agent, streets_->rings()[agent.on].right, path.join_m);
    return;
  }
  const WalkRing& ring = streets_->rings()[agent.on];
  const Curve& curve = agent.ground == Ground::right_ring ? ring.right : ring.left;
  if (agent.exit) {
    const CrossingPath& path = streets_->paths()[*agent.exit];
    const double past = ahead(curve, path.leave_m, agent.place());
    if (past < 0.5 * curve.length()) {
      agent.ground = Ground::path;
      agent.on = *agent.exit;
      agent.exit.reset();
      agent.begin_m = agent.way_m - past;
      start_piece(agent, path.curve, 0.0);
      return;
    }
  }
  if (agent.place() >= curve.length()) {
    agent.begin_m += curve.length();
    start_piece(agent, curve, 0.0);
  }
}

}  // namespace greatx::sim
