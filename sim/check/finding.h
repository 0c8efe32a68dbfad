// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines what `greatx check` finds in a scenario before hours are spent on it:
//
//   check_scene    the scene as a whole                                              host
//   check_courses  every tick of every sequence: who is inside what, and how fast    host
//   look           some moments are simulated: pictures, links                       device
//
// Each gives findings, which follow from the scenario alone, and figures for people to look at.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace greatx::sim {

/// Names how bad a finding is. `fault`: the data would be of no use. `doubt`: a person should look at it.
enum class Severity { doubt, fault };

struct Finding {
  Severity severity = Severity::doubt;
  std::string kind;     ///< a name for programs: inside_solid, passes_through, speed, on_its_side, ...
  std::string subject;  ///< the sensor, node or channel, as the scenario names it; "scene"
  std::string text;     ///< one clause without a subject, as in "is inside 'house' at 27 of 200 ticks"
};

}  // namespace greatx::sim
