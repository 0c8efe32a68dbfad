// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Follows everything that moves through all sequences, on the host, and looks where sensors and bodies are at
// every tick.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/check/finding.h"
#include "sim/experiment/experiment.h"

namespace greatx::sim {

/// How a node moves, at the ticks of all sequences.
struct NodeFigures {
  std::string name;
  double most_speed = 0.0;         ///< m/s
  double most_acceleration = 0.0;  ///< m/s^2
  double least_clearance = 0.0;    ///< from its origin to the static world, m; infinity: farther than 50 m
  uint64_t draws = 0;              ///< of its trajectory, by a node that asks for a clearance
};

/// Which shares of the view of a camera are sky and ground, at the moments that were looked at.
struct ViewFigures {
  std::string name;
  uint64_t moments = 0;
  double sky = 0.0, ground = 0.0;          ///< means, 0 to 1
  uint64_t only_sky = 0, only_ground = 0;  ///< moments at which there is nothing else
};

struct CourseFigures {
  uint64_t sequences = 0, ticks = 0;  ///< ticks of all sequences together
  std::vector<NodeFigures> nodes;     ///< those that move
  std::vector<ViewFigures> views;     ///< cameras and event cameras
};

/// Places every sensor, antenna and body at every tick of every sequence:
///   inside_solid    a sensor or the middle of a body is inside a solid, or beneath the ground
///   passes_through  a sensor or the middle of a body passes through a surface of the static world from one
///                   tick to the next (straight)
///   speed           a person is faster than 12 m/s, a vehicle than 70, a drone than 60, others than 350
///   only_sky, only_ground  rays through a grid of 24 x 18 pixels (without distortion) meet nothing else, at
///                   moments spread over the ticks
/// `sequence_done` is called after each sequence, on the calling thread. Throws UserError as make_courses().
std::vector<Finding> check_courses(const Experiment& experiment, CourseFigures& figures,
                                   const std::function<void(uint32_t)>& sequence_done);

}  // namespace greatx::sim
