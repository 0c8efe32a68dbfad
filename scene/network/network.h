// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the streets of a scene in its glTF file, as extras of the glTF scene: lanes, junctions with their
// signals, zebra crossings, and the lines on which people walk. docs/traffic.md describes it for users.
//
//   "scenes": [{"extras": {"greatx_streets": {
//     "lanes": [{"line": [[x, y, z], ...], "width_m": 3.2, "speed_mps": 13.9, "next": [4, 5], "stop_m": 5.8,
//                "left": 1, "right": 0},
//               {"turn": true, "junction": 0, "group": 0, "line": [...], "next": [7], ...}, ...],
//     "junctions": [{"phases": [{"groups": [0], "green_s": 18, "amber_s": 3, "clear_s": 2}, ...]}, ...],
//     "walks": [{"line": [[x, y, z], ...]}, ...],
//     "crossings": [{"from": [x, y, z], "to": [x, y, z], "width_m": 3, "walks": [0, 3], "junction": 0,
//                    "group": 0}, ...],
//     "signals": [{"node": "signal_000", "junction": 0, "group": 0},
//                 {"node": "walk_signal_000", "junction": 0, "group": 0, "walk": true}, ...]}}}]
//
//   writer     street_network_json() -> io::GlbWriter::finish()
//   loader     load_model() -> street_network_of_document() -> Model::streets -> sim/traffic
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/vec.h"

namespace greatx::scene {

/// A lane of a street, or the way over a junction from one lane to another (a turn).
struct StreetLane {
  std::vector<dvec3> line;  ///< the middle line in the direction of travel, m; two points or more
  double width_m = 3.0, speed_mps = 13.9;
  std::vector<uint32_t> next;           ///< of a street's lane: turns, or a lane that continues it
  std::optional<uint32_t> left, right;  ///< neighbours of the same direction, for changes of the lane
  double stop_m = 0.0;                  ///< fronts that wait stop this far before the end
  std::optional<uint32_t> junction;     ///< of a turn
  uint32_t group = 0;                   ///< of a turn: its group of signals in the junction
  bool turn() const { return junction.has_value(); }
};

struct StreetPhase {
  std::vector<uint32_t> groups;  ///< those that have green
  double green_s = 18.0, amber_s = 3.0, clear_s = 2.0;
};

struct StreetJunction {
  std::vector<StreetPhase> phases;  ///< one after the other, over and over; none: no signals
};

/// A closed line on a pavement around a block. The carriageway lies on its right.
struct StreetWalk {
  std::vector<dvec3> line;  ///< the last point joins the first one
};

/// A zebra crossing from one kerb to the other.
struct StreetCrossing {
  dvec3 from{0.0}, to{0.0};
  double width_m = 3.0;
  uint32_t walks[2] = {0, 0};        ///< that it joins, at `from` and at `to`
  std::optional<uint32_t> junction;  ///< whose signals it has; none: no signals
  uint32_t group = 0;                ///< people go while this group, and only it, has red
};

/// A head of signals: a glTF node of the scene with switched lamps (scene/description/lamps.h).
struct StreetSignal {
  std::string node;
  uint32_t junction = 0;
  /// The group whose turns it speaks to. A signal for people (`walk`) is green while people may step onto the
  /// crossings of this group.
  uint32_t group = 0;
  bool walk = false;
};

/// What one sees of a signal.
enum class Light : uint8_t { green, amber, red };
/// Returns what a group's turns, or the people on its crossings, see at a time. A junction without phases is
/// green. Time 0 is the beginning of the first phase.
Light light_of(const StreetJunction& junction, uint32_t group, double time_s);
Light walk_light_of(const StreetJunction& junction, uint32_t group, double time_s);
/// The phase at a time, and how long it has lasted. The junction has phases.
struct PhaseNow {
  size_t index = 0;
  double since_s = 0.0;
};
PhaseNow phase_of(const StreetJunction& junction, double time_s);

struct StreetNetwork {
  std::vector<StreetLane> lanes;
  std::vector<StreetJunction> junctions;
  std::vector<StreetWalk> walks;
  std::vector<StreetCrossing> crossings;
  std::vector<StreetSignal> signals;
};

/// Returns one JSON object. Coordinates are rounded to 0.1 mm.
std::string street_network_json(const StreetNetwork& network);
/// The name of the block among the extras of a glTF scene.
inline constexpr const char* street_network_key = "greatx_streets";

/// Returns the streets of the default scene of a glTF document (its JSON), or nothing if it has none. Throws
/// UserError "FILE: scenes[0].extras.greatx_streets.lanes[3].next[0]: expected ..., found ...".
std::optional<StreetNetwork> street_network_of_document(std::string json, const SourceLocation& where);

/// Returns the network, placed in the world by a pose.
StreetNetwork placed(StreetNetwork network, const Pose& pose);

}  // namespace greatx::scene
