// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads trajectories of vehicles and people that another program simulated: floating-car data of SUMO
// (Eclipse SUMO, User Documentation, "FCDOutput") and the trajectories of OpenSCENARIO XML (ASAM
// OpenSCENARIO XML 1.2: Trajectory, Polyline, Vertex, WorldPosition).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// One vehicle or person of a file.
struct RecordedTrack {
  std::string id;
  TrafficMember::Kind kind = TrafficMember::Kind::vehicle;
  std::string variant;  ///< chosen from the type, else by the length
  std::vector<WayPointTrajectory> stretches;
  SourceLocation where;
};

struct TrackOptions {
  dvec3 offset_m{0.0};
  double start_s = 0.0;                      ///< of the file, which is t = 0 here
  std::map<std::string, std::string> types;  ///< of the file -> variants of the generator
};

/// Parses <fcd-export>: x and y in metres, the angle clockwise from north in degrees. The position of a
/// vehicle is the middle of its front; that of a person its middle. One who is missing for more than one and
/// a half steps is absent. Throws UserError with file and line.
std::vector<RecordedTrack> parse_fcd(std::string_view text, const std::string& name,
                                     const TrackOptions& options);
/// Parses every Trajectory with a Polyline of an .xosc file: the name of the trajectory is the id, h is the
/// heading counter-clockwise from east in rad, and the position is the middle of the rear axle, 1.4 m behind
/// the middle. Throws UserError with file and line.
std::vector<RecordedTrack> parse_xosc(std::string_view text, const std::string& name,
                                      const TrackOptions& options);

}  // namespace greatx::sim
