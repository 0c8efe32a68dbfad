// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Vehicles and cyclists of the simulation.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/traffic/simulation.h"

namespace greatx::sim {
namespace {

constexpr double comfortable_mps2 = 2.0;
constexpr double look_ahead_m = 60.0;
/// Between one who waits behind a junction and the end of what must stay free.
constexpr double behind_m = 1.0;

}  // namespace

/// Draws the way on: straight on straight_share times as often as each turn, unless the street ends there
/// without another junction.
uint32_t Simulation::choice(Agent& agent, const DriveWay& lane) const {
  const std::vector<uint32_t>& next = lane.nexts(agent.size());
  constexpr double straight_share = 3.0;
  const std::vector<DriveWay>& ways = streets_->ways();
  const auto share = [&](uint32_t way) {
    if (!ways[way].turn() || !ways[way].straight_on) return 1.0;
    const std::vector<uint32_t>& then = ways[ways[way].next[0]].next;
    return !then.empty() && ways[then[0]].turn() ? straight_share : 1.0;
  };
  double sum = 0.0;
  for (const uint32_t way : next) sum += share(way);
  double at = agent.random.uniform() * sum;
  for (const uint32_t way : next) {
    if (at < share(way)) return way;
    at -= share(way);
  }
  return next.back();
}

/// Enters a lane or a turn, whose begin is at agent.begin_m.
void Simulation::enter(Agent& agent, uint32_t index) {
  const DriveWay& way = streets_->ways()[index];
  agent.on = index;
  agent.gate = 0;
  agent.asked_s.reset();
  if (way.turn()) {
    ++counts_.turns;
    if (streets_->light(way, now_s_) == Light::red) {
      // The signal counts at the stop line, which the front passed before. One who stops stands up to a
      // decimetre beyond it.
      constexpr double beyond_m = 0.3;
      const DriveWay& lane = streets_->ways()[way.from];
      const double passed_m = agent.begin_m - (lane.curve.length() - lane.gates.back().stop_m) -
                              agent.body.extent.front_m + beyond_m;
      const auto passed = std::ranges::lower_bound(agent.ways_m, passed_m);
      const double passed_s = begin_s_ + step_s * static_cast<double>(passed - agent.ways_m.begin());
      if (streets_->light(way, passed_s) == Light::red) ++counts_.on_red;
    }
    agent.next = way.next[0];
  } else {
    agent.granted = false;
    for (Hold& hold : agent.holds) hold.last_grant = false;
    agent.next = choice(agent, way);
  }
  start_piece(agent, way.curve, 0.0);
}

// ------------------------------------------------------------------------------------------------- following

double Simulation::term(const Agent& agent, const Leader& leader) const {
  return interaction(agent.follower, agent.speed_mps, leader.gap_m, leader.speed_mps);
}

/// Returns the next one ahead of a place on a way.
Simulation::Leader Simulation::leader_on(uint32_t way, double place, const Agent& of, uint32_t index) const {
  Leader leader;
  for (const Entry& entry : on_way_[way]) {
    if (entry.agent == index || entry.place < place || (entry.place == place && entry.agent < index))
      continue;
    const Agent& other = agents_[entry.agent];
    leader = {entry.place - other.body.extent.rear_m - place - of.body.extent.front_m, other.speed_mps};
    break;
  }
  return leader;
}

/// Returns the one ahead that asks for the most braking: on the way, on the turn and the lane that follow, on
/// other turns of the same lane as long as they are in the way, and on the lane that is being left.
Simulation::Leader Simulation::leader_ahead(uint32_t index) const {
  const Agent& agent = agents_[index];
  const std::vector<DriveWay>& ways = streets_->ways();
  const DriveWay& way = ways[agent.on];
  Leader worst = leader_on(agent.on, agent.place(), agent, index);
  const auto consider = [&](const Leader& leader) {
    if (leader.gap_m < 1e8 && term(agent, leader) < (worst.gap_m < 1e8 ? term(agent, worst) : 0.0))
      worst = leader;
  };
  if (agent.ghost) consider(leader_on(agent.ghost->way, agent.place() + agent.ghost->shift_m, agent, index));
  double before_m = way.curve.length() - agent.place();  // to the begin of the way that is looked at
  uint32_t next = agent.next;
  for (int ways_ahead = 0; ways_ahead < 2 && worst.gap_m > 1e8 && before_m < look_ahead_m; ++ways_ahead) {
    Leader leader = leader_on(next, -1e3, agent, index);
    leader.gap_m += before_m - 1e3;
    consider(leader);
    before_m += ways[next].curve.length();
    if (!ways[next].turn()) break;
    next = ways[next].next[0];
  }
  // Turns that part from the one that is taken.
  const uint32_t turn = way.turn() ? agent.on : agent.next;
  if (!ways[turn].turn()) return worst;
  const double to_turn_m = way.turn() ? -agent.place() : way.curve.length() - agent.place();
  for (const uint32_t other : ways[ways[turn].from].next) {
    if (other == turn) continue;
    for (const Entry& entry : on_way_[other]) {
      const Agent& leader = agents_[entry.agent];
      const std::optional<double> up_to = streets_->excludes(other, leader.size(), turn, agent.size());
      if (!up_to || entry.agent == index || entry.place > *up_to) break;
      if (entry.place + to_turn_m <= 0.0) continue;
      consider({to_turn_m + entry.place - leader.body.extent.rear_m - agent.body.extent.front_m,
                leader.speed_mps});
      break;
    }
  }
  return worst;
}

/// Returns the desired speed, so low that the one allowed on what follows is met by gentle braking.
double Simulation::allowed_speed(const Agent& agent) const {
  constexpr double gentle_mps2 = 1.5;
  const std::vector<DriveWay>& ways = streets_->ways();
  const auto own = [&](double limit) { return std::min(limit * agent.factor, agent.most_mps); };
  double allowed = own(ways[agent.on].speed_mps);
  double before_m = ways[agent.on].curve.length() - agent.place();
  uint32_t next = agent.next;
  for (int i = 0; i < 2; ++i) {
    const double then = own(ways[next].speed_mps);
    allowed = std::min(allowed, std::sqrt(then * then + 2.0 * gentle_mps2 * std::max(before_m, 0.0)));
    before_m += ways[next].curve.length();
    if (!ways[next].turn()) break;
    next = ways[next].next[0];
  }
  return std::max(allowed, 0.5);
}

double Simulation::vehicle_acceleration(uint32_t index) const {
  const Agent& agent = agents_[index];
  double wanted = 0.0;
  const Leader leader = leader_ahead(index);
  if (leader.gap_m < 1e8) wanted = term(agent, leader);
  const DriveWay& way = streets_->ways()[agent.on];
  if (!way.turn() && !agent.granted) {
    // Fronts stop at the line itself, without the gap to a vehicle.
    const double left_m = way.gates[agent.gate].stop_m - agent.place() - agent.body.extent.front_m;
    wanted = std::min(wanted, term(agent, {left_m + agent.follower.gap_m, 0.0}));
  }
  return free_acceleration(agent.follower, agent.speed_mps, allowed_speed(agent)) + wanted;
}

// ----------------------------------------------------------------------------------------------------- gates

bool Simulation::first_to_ask(const Agent& agent, uint32_t index) const {
  for (const Entry& entry : on_way_[agent.on]) {
    if (entry.agent == index || entry.place <= agent.place()) continue;
    const Agent& ahead = agents_[entry.agent];
    if (entry.ghost || !(ahead.granted || ahead.gate > agent.gate)) return false;
  }
  return true;
}

/// Asks for all who come near their gates, those first who have waited the longest.
void Simulation::ask_all() {
  std::vector<uint32_t> asking;
  for (uint32_t i = 0; i < agents_.size(); ++i) {
    Agent& agent = agents_[i];
    if (agent.walks() || agent.granted || agent.ghost) continue;
    const DriveWay& way = streets_->ways()[agent.on];
    if (way.turn()) continue;
    const double left_m = way.gates[agent.gate].stop_m - agent.place() - agent.body.extent.front_m;
    const double v = agent.speed_mps;
    if (left_m > v * v / (2.0 * comfortable_mps2) + 1.5 * v + 6.0 || !first_to_ask(agent, i)) continue;
    if (!agent.asked_s) agent.asked_s = now_s_;
    asking.push_back(i);
  }
  std::ranges::stable_sort(asking, {}, [&](uint32_t i) { return *agents_[i].asked_s; });
  std::vector<uint32_t> older;  // those who wait for others to pass
  for (const uint32_t i : asking) {
    const Answer answer = ask(i, older);
    if (answer == Answer::excluded) older.push_back(i);
    if (answer != Answer::granted) continue;
    Agent& agent = agents_[i];
    const DriveWay& way = streets_->ways()[agent.on];
    take(agent, way.gates[agent.gate]);
    if (way.gates[agent.gate].turn)
      agent.granted = true;
    else
      ++agent.gate;
    agent.asked_s.reset();
  }
}

bool Simulation::crossing_free(uint32_t crossing, double waited_s) const {
  if (walkers_on_[crossing] > 0) return false;
  constexpr double seen_s = 0.5, patience_s = 25.0;
  const bool someone_waits = now_s_ - walker_waits_since_[crossing] >= seen_s;
  const double walk_s = streets_->walk_time(crossing, now_s_);
  return !someone_waits || waited_s > patience_s || walk_s <= 5.0;
}

Simulation::Answer Simulation::ask(uint32_t index, const std::vector<uint32_t>& older) {
  const Agent& agent = agents_[index];
  const std::vector<DriveWay>& ways = streets_->ways();
  const Gate& gate = ways[agent.on].gates[agent.gate];
  const double waited_s = now_s_ - *agent.asked_s;
  const auto free = [&](const CrossingOnWay& on) { return crossing_free(on.crossing, waited_s); };
  if (!std::ranges::all_of(gate.crossings, free)) return Answer::no;
  if (!gate.turn) return Answer::granted;
  const DriveWay& turn = ways[agent.next];
  if (!turn.turn()) return std::ranges::all_of(turn.exit, free) ? Answer::granted : Answer::no;
  if (streets_->light(turn, now_s_) != Light::green) return Answer::no;
  if (!std::ranges::all_of(ways[turn.next[0]].exit, free) || !has_room(agent, turn.next[0]))
    return Answer::no;
  for (const uint32_t waiting : older) {
    const uint32_t other = agents_[waiting].next;
    if (ways[other].junction == turn.junction && ways[other].from != turn.from &&
        streets_->excludes(agent.next, agent.size(), other, agents_[waiting].size()))
      return Answer::excluded;
  }
  for (const Agent& other : agents_)
    for (const Hold& hold : other.holds) {
      if (hold.crossing || ways[hold.index].junction != turn.junction || ways[hold.index].from == turn.from)
        continue;
      const std::optional<double> up_to =
          streets_->excludes(hold.index, other.size(), agent.next, agent.size());
      if (up_to && other.way_m - hold.begin_m < *up_to) return Answer::excluded;
    }
  return Answer::granted;
}

/// Whether a lane has room for the vehicle behind the crossings at its begin, whoever stops there.
bool Simulation::has_room(const Agent& agent, uint32_t lane) const {
  const DriveWay& way = streets_->ways()[lane];
  constexpr double hard_braking_mps2 = 4.0;
  double end_m = way.gates.front().stop_m;
  if (!on_way_[lane].empty()) {
    const Entry& last = on_way_[lane].front();
    const Agent& ahead = agents_[last.agent];
    const double v = ahead.speed_mps;
    end_m = std::min(end_m, last.place - ahead.body.extent.rear_m + v * v / (2.0 * hard_braking_mps2) -
                                ahead.follower.gap_m);
  }
  for (const Agent& other : agents_)
    for (const Hold& hold : other.holds)
      if (!hold.crossing && streets_->ways()[hold.index].next[0] == lane && other.on != lane)
        end_m -= other.body.extent.front_m + other.body.extent.rear_m + other.follower.gap_m + behind_m;
  return end_m - agent.body.extent.front_m - agent.body.extent.rear_m - behind_m >= way.clear_m;
}

void Simulation::take(Agent& agent, const Gate& gate) {
  const double rear = agent.body.extent.rear_m;
  for (const CrossingOnWay& on : gate.crossings)
    agent.holds.push_back(
        {true, on.crossing, agent.begin_m, agent.begin_m + on.to_m + rear + 0.3, gate.turn});
  if (!gate.turn) return;
  const DriveWay& next = streets_->ways()[agent.next];
  double begin_m = agent.begin_m + streets_->ways()[agent.on].curve.length();
  const DriveWay* lane = &next;
  if (next.turn()) {
    lane = &streets_->ways()[next.next[0]];
    const double length = next.curve.length();
    agent.holds.push_back({false, agent.next, begin_m, begin_m + length + lane->swept_m + rear + 1.0, true});
    begin_m += length;
  }
  for (const CrossingOnWay& on : lane->exit)
    agent.holds.push_back({true, on.crossing, begin_m, begin_m + on.to_m + rear + 0.3, true});
}

// ---------------------------------------------------------------------------------------------- lane changes

void Simulation::weigh_lane_change(uint32_t index) {
  Agent& agent = agents_[index];
  const std::vector<DriveWay>& ways = streets_->ways();
  const DriveWay& way = ways[agent.on];
  if (way.turn() || agent.ghost || agent.granted || !agent.holds.empty() ||
      agent.body.kind == TrafficMember::Kind::cyclist || agent.speed_mps < 2.0)
    return;
  constexpr double change_s = 2.5, least_m = 12.0, before_gate_m = 6.0;
  const double length = std::max(least_m, change_s * agent.speed_mps), place = agent.place();
  if (place - agent.body.extent.rear_m < way.clear_m + 1.0 ||
      place + length + agent.body.extent.front_m > way.gates[agent.gate].stop_m - before_gate_m)
    return;
  const auto follows = [&](const Agent& who, const Leader& leader) {
    return free_acceleration(who.follower, who.speed_mps, allowed_speed(who)) +
           (leader.gap_m < 1e8 ? term(who, leader) : 0.0);
  };
  const auto gap_behind = [&](const Agent& follower, double follower_place) {
    return place - agent.body.extent.rear_m - follower_place - follower.body.extent.front_m;
  };
  for (const std::optional<uint32_t>& side : {way.left, way.right}) {
    if (!side || !ways[*side].goes_on(agent.size()) || ways[*side].turn()) continue;
    const DriveWay& lane = ways[*side];
    const CurvePlace here = way.curve.at(place), there = lane.curve.at(place);
    const double offset = glm::dot(here.position - there.position, there.left());
    const bool beside = glm::distance(here.position, there.position + offset * there.left()) < 0.3;
    if (!beside || glm::dot(here.tangent, there.tangent) < 0.99999) continue;
    LaneChange change;
    change.own = follows(agent, leader_on(agent.on, place, agent, index));
    const Leader ahead = leader_on(*side, place, agent, index);
    if (ahead.gap_m < agent.follower.gap_m) continue;
    change.own_after = follows(agent, ahead);
    bool safe = true;
    // Those behind on the other lane, also on turns that lead to it.
    const auto behind = [&](const Agent& follower, uint32_t who, double follower_place) {
      const double gap = gap_behind(follower, follower_place);
      if (gap < follower.follower.gap_m) safe = false;
      const Leader before = leader_on(*side, follower_place, follower, who);
      change.new_follower = follows(follower, before);
      change.new_follower_after = follows(follower, {gap, agent.speed_mps});
    };
    bool found = false;
    for (size_t k = on_way_[*side].size(); k-- > 0 && !found;) {
      const Entry& entry = on_way_[*side][k];
      if (entry.place > place) continue;
      behind(agents_[entry.agent], entry.agent, entry.place);
      found = true;
    }
    for (uint32_t other = 0; other < agents_.size() && !found; ++other)
      for (const Hold& hold : agents_[other].holds)
        if (!hold.crossing && ways[hold.index].next[0] == *side && agents_[other].on != *side) {
          const double to_lane_m = hold.begin_m + ways[hold.index].curve.length() - agents_[other].way_m;
          behind(agents_[other], other, -to_lane_m);
        }
    for (size_t k = on_way_[agent.on].size(); k-- > 0;) {
      const Entry& entry = on_way_[agent.on][k];
      if (entry.place >= place || entry.agent == index) continue;
      const Agent& follower = agents_[entry.agent];
      change.old_follower = follows(follower, {gap_behind(follower, entry.place), agent.speed_mps});
      change.old_follower_after = follows(follower, leader_on(agent.on, place, follower, index));
      break;
    }
    if (!safe || !changes_lane(change)) continue;
    // It is on the new lane at once, and keeps a place on the old one until it has left it.
    agent.ghost = Ghost{agent.on, 0.0, agent.way_m + length};
    agent.on = *side;
    agent.next = choice(agent, lane);
    agent.gate = std::min(agent.gate, lane.gates.size() - 1);
    start_piece(agent, lane.curve, place, offset, length);
    ++counts_.lane_changes;
    list_all();
    return;
  }
}

}  // namespace greatx::sim
