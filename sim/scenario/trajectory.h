// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "sim/scenario/gait.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Represents a node's way through the world as a function of time. Pose, velocity and acceleration come
/// from the curve's derivatives.
class Course {
 public:
  virtual ~Course() = default;
  virtual Motion at(double time_s) const = 0;
  virtual bool is_static() const { return false; }
  /// Returns a bound of the speed at any time, m/s; it is reached unless the edges of a curve differ.
  virtual double most_speed() const = 0;
  /// Returns the length of the way from time 0, negative before it, and its derivatives. Something absent
  /// travels nowhere.
  virtual Travel travel(double time_s) const = 0;
  /// Returns the part of travel() that a cyclist has pedalled. Those of the simulated traffic coast when they
  /// brake; others pedal all the way.
  virtual Travel pedalled(double time_s) const { return travel(time_s); }
  /// Returns the side on which a driver indicates: 1 left, -1 right, 0 none. Only the simulated traffic does.
  virtual int indicated_side(double /*time_s*/) const { return 0; }
};

/// Makes the courses of members of the traffic. A world does it (sim/world/traffic.h).
class TrafficSource {
 public:
  virtual ~TrafficSource() = default;
  /// Starts the traffic of a sequence. Returns [TrafficConfig::members] courses, which may outlive this.
  virtual std::vector<std::unique_ptr<Course>> courses(uint32_t sequence) const = 0;
};

/// Judges drawn trajectories. A world does it (sim/world/free_space.h).
class FreeSpace {
 public:
  struct Neighbour {
    uint32_t node = 0;
    double clearance_m = 0.0;  ///< that this node asks for
    const Course* course = nullptr;
  };
  /// What a course comes too near to: a node, or the static world.
  struct Obstacle {
    std::optional<uint32_t> node;
  };
  virtual ~FreeSpace() = default;
  /// Returns what the course of `node` comes nearer to than `clearance_m`, or than the clearance of a
  /// neighbour, from time 0 to `end_s`; nothing: it keeps clear.
  virtual std::optional<Obstacle> too_near(uint32_t node, double clearance_m, const Course& course,
                                           std::span<const Neighbour> neighbours, double end_s) const = 0;
};

/// The courses of every node of a sequence; the index is the node.
struct NodeCourses {
  std::vector<std::unique_ptr<Course>> courses;
  std::vector<uint32_t> draws;  ///< how often each was drawn until it kept clear; 0: it is not drawn
};

/// The draws after which a trajectory that keeps no clearance is an error.
inline constexpr uint32_t most_clear_draws = 10'000;

/// Returns the velocities of a smooth way at its points, m/s; there are at least two points. Each is the
/// derivative of the parabola through a point and its neighbours: Catmull-Rom for uneven times. At an end it
/// is the parabola through the three points there. The velocities are exact for constant acceleration.
std::vector<dvec3> way_point_velocities(const std::vector<WayPoint>& points);

/// Makes the courses of every node of one sequence; the index is the node. Random ones are drawn from (seed,
/// node's name, sequence), so other nodes change nothing. Bezier curves and corridors last from tick 0 to the
/// last tick, T = (curve_ticks - 1) / tick_rate, with u = t / T. Beyond that they go straight on. Way-points
/// have their own times and hold before and after.
///
/// A drawn course is drawn again, from the same stream, as long as it comes too near to something that
/// `space` knows: to the static world if its node asks for a clearance, and to the courses that are made
/// before it if one of the two nodes does. Courses that are not drawn are made first, then the others in the
/// order of the scenario, each behind the node that it refers to. Without clearances no other node matters.
///
/// Throws UserError naming the node if the limits cannot be met (e.g. if no point of the box is within
/// d_min..d_max, or most_clear_draws courses keep no clearance). `space` may be null if no node asks for a
/// clearance, and `traffic` if the scenario has none.
NodeCourses make_node_courses(const Scenario& scenario, uint32_t sequence, const FreeSpace* space = nullptr,
                              const TrafficSource* traffic = nullptr);

/// Returns the clearance that a node asks for, m; 0: none.
double clearance_of(const NodeConfig& node);

}  // namespace greatx::sim
