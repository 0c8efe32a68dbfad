// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Switches the lamps of a world (scene/description/lamps.h).
//
//   signals    as the phases of their junction say (scene/network/network.h), whether there is traffic or not
//   stop lamps while a vehicle slows down or stands on its brake
//   indicators before turns and while a vehicle of the simulated traffic changes its lane
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/description/lamps.h"
#include "scene/network/network.h"

namespace greatx::sim {

struct Courses;
class Course;

/// The heads of signals of the scene's objects, and their junctions.
struct SignalHeads {
  std::vector<scene::StreetJunction> junctions;
  std::vector<scene::StreetSignal> heads;  ///< by the names of their instances
};
/// Adds those of an object. `object` is its name, before those of its nodes; it may be empty.
void add_signals(SignalHeads& signals, const std::string& object, const scene::StreetNetwork& streets);

/// A stop lamp lights from this deceleration on. UN Regulation 13-H asks for it above 1.3 m/s^2, and forbids
/// it below 0.7 m/s^2. It stays lit for stop_hold_s, so that it does not flicker.
inline constexpr double stop_mps2 = 1.0, stop_hold_s = 0.3;
/// Whether one who moves on a course shows stop lamps: it slowed down within the last stop_hold_s, or stands.
bool stop_lamps_lit(const Course& course, double time_s);
/// What tail lamps, the same lamps without braking, shine of that.
inline constexpr float tail_share = 1.0f / 9.0f;
/// Indicators flash 90 times a minute (UN Regulation 48: 90 +- 30), lit for half of the time.
inline constexpr double indicator_hz = 1.5;
/// Whether a flash of the vehicle is lit. Vehicles do not flash in time: `name` gives the phase.
bool indicator_lit(const std::string& name, double time_s);
/// Signals without phases are out of service: amber flashes at this rate.
inline constexpr double idle_hz = 1.0;

class Lamps {
 public:
  Lamps() = default;
  Lamps(const scene::Scene& scene, const std::vector<uint32_t>& node_of_body, const SignalHeads& signals);
  bool empty() const { return lamps_.empty(); }
  /// Returns the factors of emission, in the order of scene::switched_lamps(): 1 lit, 0 dark.
  std::vector<float> factors(const Courses& courses, double time_s) const;

 private:
  static constexpr uint32_t none = ~0u;
  struct Lamp {
    scene::LampRole role = scene::LampRole::red;
    uint32_t node = none;  ///< of a lamp on a body
    uint32_t head = none;  ///< of a signal, among signals_.heads
  };
  std::vector<Lamp> lamps_;
  std::vector<std::string> names_;  ///< [lamps] of their instances
  SignalHeads signals_;
};

}  // namespace greatx::sim
