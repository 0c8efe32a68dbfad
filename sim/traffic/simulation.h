// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Simulates traffic and people on streets in fixed steps. The states of all steps are kept, so that any time
// may be asked in any order; later times are simulated when they are first asked for. What happens depends on
// the streets, the members, the seed and the sequence alone.
//
//   Simulation ─► step 0, 1, 2, ... ─► for each member: place and speed along its way, and the pieces of the
//                                      way ─► TrafficCourse (course.h): poses at any time
//
// Rules, each once for all who move:
// - Everyone follows those ahead by the IDM (followers.h), people with the numbers of people.
// - A vehicle waits at the last gate of its lane until it has, all at once: green, the turn free of vehicles
//   on turns that exclude it, the crossings before and behind the turn free of people, and room on the lane
//   behind them. So nobody stops within a junction or on a crossing, and no two wait for each other. Those
//   who asked first are served first (a reservation in the sense of Dresner and Stone, A multiagent approach
//   to autonomous intersection management, JAIR 31, 2008).
// - People wait at the kerb until no vehicle has the crossing, and with signals until it is their turn and
//   the time is enough. Without signals vehicles let those pass who wait.
// - A driver changes to a neighbouring lane by MOBIL, between junctions, on a curve of degree five.
// - People keep to the right of their walking line. They leave it and join it by right turns only, so that no
//   two paths of people cross.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <vector>

#include "core/random.h"
#include "sim/scenario/traffic.h"
#include "sim/traffic/followers.h"
#include "sim/traffic/streets.h"

namespace greatx::sim {

/// Describes one who moves.
struct TrafficBody {
  TrafficMember::Kind kind = TrafficMember::Kind::vehicle;
  Extent extent;
  double origin_m = 0.0;  ///< from the point that follows the way forward to the node's origin
};

/// A stretch of a member's way: a part of a curve, at an offset.
struct Piece {
  const Curve* curve = nullptr;
  double begin_m = 0.0;   ///< of the whole way, where it begins
  double at_m = 0.0;      ///< the place on the curve there
  double left_m = 0.0;    ///< constant offset to the left
  double change_m = 0.0;  ///< further offset at the begin, which falls to 0 over change_length_m
  double change_length_m = 0.0;
  double travelled_m = 0.0;  ///< the length of everything before it
  int8_t turn_side = 0;      ///< of the turn that it is, or that follows it: DriveWay::side
  double turn_m = 0.0;       ///< of the whole way, where that turn begins
};

/// Where a member is within a step.
struct WayState {
  Piece piece;
  double way_m = 0.0, speed_mps = 0.0, acceleration_mps2 = 0.0;  ///< along the ways' middle lines
  /// What a cyclist has come while pedalling, and its derivatives; of others 0.
  double pedalled_m = 0.0, pedalled_mps = 0.0, pedalled_mps2 = 0.0;
};

/// Returns the side on which a driver indicates: 1 left, -1 right, 0 none. It is that of a turn from 30 m
/// before it to its end, and that of a change of lane while it lasts.
int indicated_side(const WayState& state);

/// A share between 0 and 1 that changes evenly over a step, times the speed, which changes evenly, too.
struct Effort {
  double begin = 1.0, end = 1.0;
};
/// Returns the way during the first `since_s` of a step of `step_s`, and its derivatives: the integral of
/// share times speed, v + a t.
struct EffortWay {
  double way_m = 0.0, speed_mps = 0.0, acceleration_mps2 = 0.0;
};
EffortWay effort_way(const Effort& effort, double speed_mps, double acceleration_mps2, double since_s,
                     double step_s);
/// A cyclist brakes, and so coasts, from this deceleration on. The feet start and stop within effort_s.
inline constexpr double coasting_mps2 = 0.3, effort_s = 0.4;

class Simulation {
 public:
  static constexpr double step_s = 0.1;

  /// Throws UserError at config.where if the streets have no room for the members.
  Simulation(std::shared_ptr<const Streets> streets, std::vector<TrafficBody> bodies,
             const TrafficConfig& config, uint32_t sequence);
  /// Returns the state of a member. Before the warm-up it is that at its begin. Thread-safe.
  WayState at(uint32_t member, double time_s);
  size_t member_count() const { return agents_.size(); }
  const TrafficBody& body(uint32_t member) const { return agents_[member].body; }
  double most_speed_mps(uint32_t member) const { return agents_[member].most_mps; }

  /// What went on, for tests.
  struct Counts {
    uint64_t turns = 0, on_red = 0, lane_changes = 0, crossings = 0, changes_of_mind = 0;
  };
  Counts counts() const;

 private:
  /// What a vehicle has taken for itself until it has passed.
  struct Hold {
    bool crossing = false;  ///< otherwise a turn
    uint32_t index = 0;
    double begin_m = 0.0, until_m = 0.0;  ///< of its whole way
    bool last_grant = false;              ///< can be given back
  };
  /// The place that a vehicle still has on the lane that it leaves.
  struct Ghost {
    uint32_t way = 0;
    double shift_m = 0.0, until_m = 0.0;
  };
  enum class Ground : uint8_t { way, right_ring, left_ring, path };
  struct Agent {
    Agent(const TrafficBody& of, const RandomStream& stream) : body(of), random(stream) {}
    TrafficBody body;
    Follower follower;
    double factor = 1.0, most_mps = 0.0;
    RandomStream random;
    Ground ground = Ground::way;
    uint32_t on = 0;       ///< index of the way, ring or path
    double begin_m = 0.0;  ///< of the whole way: where that begins
    double way_m = 0.0, speed_mps = 0.0, acceleration_mps2 = 0.0;
    // vehicles
    uint32_t next = 0;
    size_t gate = 0;
    bool granted = false;
    std::optional<double> asked_s;  ///< since when it waits for the gate, or a person at the kerb
    std::vector<Hold> holds;
    std::optional<Ghost> ghost;
    // people
    std::optional<uint32_t> exit;    ///< the path that it will take
    std::optional<uint32_t> passed;  ///< the path that it has decided not to take
    bool merging = false;
    // history
    std::vector<double> ways_m, speeds_mps;
    std::vector<double> pedalled_m, efforts;  ///< of cyclists
    std::vector<Piece> pieces;
    double place() const { return way_m - begin_m; }
    VehicleSize size() const { return size_of(body.extent); }
    bool walks() const { return body.kind == TrafficMember::Kind::pedestrian; }
  };
  /// One on a way at a place, in order of place.
  struct Entry {
    double place = 0.0;
    uint32_t agent = 0;
    bool ghost = false;
  };
  using Line = std::vector<Entry>;

  void draw(Agent& agent);
  void place_vehicle(uint32_t index);
  void place_walker(uint32_t index);
  [[noreturn]] void no_room(const char* whom, size_t found) const;

  void advance_to(size_t step);
  void step();
  void list_all();
  void release();
  void count_claims();
  void start_piece(Agent& agent, const Curve& curve, double at_m, double change_m = 0.0,
                   double change_length_m = 0.0);
  void append(Agent& agent);

  // vehicles
  uint32_t choice(Agent& agent, const DriveWay& lane) const;
  void enter(Agent& agent, uint32_t way);
  void ask_all();
  bool first_to_ask(const Agent& agent, uint32_t index) const;
  enum class Answer : uint8_t { granted, no, excluded };
  Answer ask(uint32_t index, const std::vector<uint32_t>& older);
  bool crossing_free(uint32_t crossing, double waited_s) const;
  bool has_room(const Agent& agent, uint32_t lane) const;
  void take(Agent& agent, const Gate& gate);
  double vehicle_acceleration(uint32_t index) const;
  double allowed_speed(const Agent& agent) const;
  void weigh_lane_change(uint32_t index);
  struct Leader {
    double gap_m = 1e9, speed_mps = 0.0;
  };
  Leader leader_on(uint32_t way, double place, const Agent& of, uint32_t index) const;
  Leader leader_ahead(uint32_t index) const;
  double term(const Agent& agent, const Leader& leader) const;

  // people
  void decide(Agent& agent, uint32_t index);
  double walk_time(const Agent& agent, const CrossingPath& path, double place) const;
  bool path_free(uint32_t path) const;
  void let_walk(uint32_t index);
  bool gap_to_join(const CrossingPath& path, uint32_t index) const;
  double walker_acceleration(uint32_t index) const;
  void move_walker(Agent& agent);

  std::shared_ptr<const Streets> streets_;
  SourceLocation where_;
  double begin_s_ = 0.0;
  double now_s_ = 0.0;
  size_t steps_ = 0;  ///< done
  mutable std::shared_mutex mutex_;
  std::deque<Agent> agents_;
  std::vector<Line> on_way_, on_right_, on_left_, on_path_;
  std::vector<uint8_t> held_by_vehicle_;    ///< [crossings]
  std::vector<uint32_t> walkers_on_;        ///< [crossings]
  std::vector<double> walker_waits_since_;  ///< [crossings], when the first one began to wait; 1e18: none
  Counts counts_;
};

}  // namespace greatx::sim
