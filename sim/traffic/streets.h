// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The streets of a scene, prepared for a simulation: smooth ways, the places where one waits, which turns
// exclude each other, the paths of pedestrians. docs/traffic.md describes the rules.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/network/network.h"
#include "sim/scenario/traffic.h"
#include "sim/traffic/curve.h"

namespace greatx::sim {

/// The size of one who moves, along its way: from the point that follows the way (the middle of the rear axle
/// of a vehicle, the middle of a person).
struct Extent {
  double front_m = 2.0, rear_m = 0.8, width_m = 1.8;
};

/// Vehicles of more than longer_than_m (buses, lorries) keep to ways on which their body stays.
enum class VehicleSize : uint8_t { ordinary, longer };
inline VehicleSize size_of(const Extent& extent) {
  return extent.front_m + extent.rear_m > longer_than_m ? VehicleSize::longer : VehicleSize::ordinary;
}

/// The sizes of the largest vehicles: of ordinary ones, and of longer ones if there are any.
struct LargestVehicles {
  LargestVehicles(const Extent& of_ordinary, const std::optional<Extent>& of_longer = std::nullopt)
      : ordinary(of_ordinary), longer(of_longer) {}
  Extent ordinary;
  std::optional<Extent> longer;
};

/// A rectangle on the ground.
struct GroundBox {
  dvec2 middle{0.0}, forward{1.0, 0.0};
  double half_length = 0.0, half_width = 0.0;
};
/// Whether two rectangles overlap (separating axes).
bool overlap(const GroundBox& a, const GroundBox& b);
/// Returns the rectangle of one whose point is at `s` of a curve.
GroundBox box_at(const Curve& curve, double s, const Extent& extent);

/// Returns how far the body of one whose rear axle follows a curve, and then goes straight on, gets from the
/// curve. On a circle of radius R it is sqrt((R + w/2)^2 + f^2) - R with the width w and the front f, if that
/// is more than w/2. The curve is taken as chords of half a metre, which errs by 0.03 m / R at most.
double reach_beside(const Curve& curve, const Extent& extent);

/// A crossing on a lane of the carriageway.
struct CrossingOnWay {
  uint32_t crossing = 0;
  double from_m = 0.0, to_m = 0.0;
};

/// A place where vehicles wait until they may go on.
struct Gate {
  double stop_m = 0.0;                   ///< of the fronts
  std::vector<CrossingOnWay> crossings;  ///< behind it, on the same lane
  bool turn = false;                     ///< the last gate of a lane: a turn or the next lane follows
};

/// A lane or a turn.
struct DriveWay {
  Curve curve;
  double width_m = 3.0;
  double speed_mps = 0.0;  ///< allowed; in bends the lateral acceleration is at most most_lateral_mps2
  std::vector<uint32_t> next;
  std::vector<uint32_t> next_longer;  ///< of those, where longer vehicles go
  std::optional<uint32_t> left, right;
  std::optional<uint32_t> junction;  ///< of a turn
  uint32_t group = 0;
  uint32_t from = 0;                ///< of a turn: the lane that leads to it
  std::vector<Gate> gates;          ///< of a lane
  std::vector<CrossingOnWay> exit;  ///< crossings at its beginning, which belong to the turn before it
  double clear_m = 0.5;             ///< rears beyond it are clear of the junction before it
  double swept_m = 0.0;         ///< of a lane: up to here longer vehicles sweep over it that turn into others
  bool swings = false;          ///< of a turn: longer vehicles reach beyond it, onto other lanes
  bool endless = false;         ///< whether one can go on from it for ever
  bool endless_longer = false;  ///< whether a longer vehicle can
  bool straight_on = true;      ///< of a turn: it changes the direction by less than 45 degrees
  int8_t side = 0;              ///< of another turn: 1 to the left, -1 to the right
  const std::vector<uint32_t>& nexts(VehicleSize size) const {
    return size == VehicleSize::longer ? next_longer : next;
  }
  bool goes_on(VehicleSize size) const { return size == VehicleSize::longer ? endless_longer : endless; }
  bool turn() const { return junction.has_value(); }
};

/// The path of pedestrians over a crossing, from the right side of one walking line to that of the other.
struct CrossingPath {
  Curve curve;
  uint32_t crossing = 0, from_walk = 0, to_walk = 0;
  double leave_m = 0.0, join_m = 0.0;  ///< where it leaves and joins the right sides of the walking lines
  double wait_m = 0.0;                 ///< on the path: where people wait for the crossing
  double across_m = 0.0;               ///< on the path: from here on they are off the carriageway
  double merge_m = 0.0;                ///< on the path: where people wait for a gap before they join
};

/// The two sides of a walking line; one keeps to the right.
struct WalkRing {
  Curve right, left;  ///< right: with the carriageway on its right; left: the other direction
  std::vector<uint32_t> leaving, joining;  ///< crossing paths
};

/// Comfort on streets of low speed. The AASHTO's Green Book designs turning roads of 15 to 20 mph with a side
/// friction of 0.32 to 0.27.
inline constexpr double most_lateral_mps2 = 3.0;
/// Of people from their walking line, and from the middle of a zebra.
inline constexpr double walk_side_m = 0.33, zebra_side_m = 0.75;

/// The tightest circle of the rear axle of a longer vehicle: a city bus of 12 m whose turning circle has a
/// diameter of 21.4 m (manufacturers' data sheets, from memory) runs its rear axle on one of 5.1 m.
inline constexpr double tightest_longer_m = 5.0;

/// The end of a lane at a junction.
struct LaneMouth {
  dvec2 place{0.0}, inwards{1.0, 0.0};  ///< the direction into the junction
  double width_m = 3.0, length_m = 0.0;
};
/// Returns whether the body of one who takes a turn, the rear axle on its line, stays on the lanes that lead
/// to its junction and away from it, or within `beside_m` of the turn's own width. The lanes count on into
/// the junction, so that the corners of blocks are left out, as far as the lanes' mouths reach (their convex
/// hull).
bool stays_on_lanes(const Curve& turn, double width_m, double beside_m, const Extent& extent,
                    const std::vector<LaneMouth>& at_junction);

using scene::Light;

class Streets {
 public:
  /// `largest` are the sizes with which the turns that exclude each other are found, and for the longer ones
  /// the ways that they take. Throws UserError, beginning with `name`, if lanes or crossings do
  /// not fit.
  Streets(const scene::StreetNetwork& network, const LargestVehicles& largest, const std::string& name);

  const std::vector<DriveWay>& ways() const { return ways_; }
  const std::vector<CrossingPath>& paths() const { return paths_; }
  const std::vector<WalkRing>& rings() const { return rings_; }
  size_t crossing_count() const { return crossings_.size(); }
  const std::string& name() const { return name_; }

  /// Returns up to which place on turn `turn` a vehicle of a size excludes those of another size from
  /// `other`; nothing: never.
  std::optional<double> excludes(uint32_t turn, VehicleSize size, uint32_t other,
                                 VehicleSize other_size) const;
  /// Returns the signal of a turn.
  Light light(const DriveWay& turn, double time_s) const;
  /// Returns the time that people who step onto a crossing now have to cross it, s; 0: they may not. Without
  /// signals it is long.
  double walk_time(uint32_t crossing, double time_s) const;
  double longest_walk_time(uint32_t crossing) const;
  bool has_signals(uint32_t crossing) const;

 private:
  void make_ways(const scene::StreetNetwork& network);
  void find_crossings(const scene::StreetNetwork& network);
  void make_gates(const scene::StreetNetwork& network);
  void find_endless(const LargestVehicles& largest);
  bool longer_may(const DriveWay& way, const Extent& longer) const;
  void find_exclusions(const LargestVehicles& largest);
  void keep_stops_clear(const LargestVehicles& largest);
  void find_swept(const LargestVehicles& largest);
  void make_rings(const scene::StreetNetwork& network);
  void make_paths(const scene::StreetNetwork& network);
  void make_path(const scene::StreetCrossing& crossing, uint32_t index, bool back);

  std::string name_;
  std::vector<DriveWay> ways_;
  std::vector<std::vector<CrossingOnWay>> crossings_of_;  ///< [ways]
  std::vector<WalkRing> rings_;
  std::vector<CrossingPath> paths_;
  std::vector<scene::StreetJunction> junctions_;
  std::vector<scene::StreetCrossing> crossings_;
  struct Exclusion {
    VehicleSize size = VehicleSize::ordinary;
    uint32_t other = 0;
    VehicleSize other_size = VehicleSize::ordinary;
    double up_to_m = 0.0;
  };
  std::vector<std::vector<Exclusion>> excludes_;  ///< [ways]
};

}  // namespace greatx::sim
