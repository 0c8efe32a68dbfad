// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The whole way of every node through a sequence, as the scenario has it. It needs no record, so that it
// shows where nodes will go before they have gone there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/experiment/experiment.h"
#include "view/overlay/shapes.h"

namespace greatx::view {

/// The ways of all nodes that move, at even times.
struct SampledCourses {
  uint32_t sequence = 0;
  double duration_s = 0.0;  ///< from the first tick to the last
  std::vector<double> times_s;
  struct Node {
    uint32_t number = 0;  ///< in the scenario, which gives its colour
    std::string name;
    std::vector<dvec3> positions;  ///< [times] world, m
  };
  std::vector<Node> nodes;
  size_t left_out = 0;  ///< nodes that move beyond the first `most_nodes`
};

/// Samples the courses of a sequence. Throws UserError like sim::make_courses().
SampledCourses sample_courses(const sim::Experiment& experiment, uint32_t sequence, size_t points = 200,
                              size_t most_nodes = 500);

/// Lines through the samples: bright up to `now_s`, faint after it.
Shapes course_shapes(const SampledCourses& courses, double now_s);

}  // namespace greatx::view
