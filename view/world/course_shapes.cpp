// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/world/course_shapes.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "sim/world/moment.h"
#include "view/overlay/shape_parts.h"

namespace greatx::view {

namespace {

/// Faint ahead: a blend with the grey of the scene.
io::Color faint_of(io::Color color) {
  const auto part = [](uint8_t c) { return static_cast<uint8_t>(40 + c * 2 / 5); };
  return {part(color.r), part(color.g), part(color.b)};
}

}  // namespace

SampledCourses sample_courses(const sim::Experiment& experiment, uint32_t sequence, size_t points,
                              size_t most_nodes) {
  GREATX_CHECK(points >= 2, "{} points", points);
  const sim::Scenario& scenario = experiment.scenario;
  SampledCourses sampled;
  sampled.sequence = sequence;
  sampled.duration_s = sim::Clock(scenario.tick_rate_hz).seconds(std::max<int64_t>(scenario.ticks - 1, 0));
  for (size_t i = 0; i < points; ++i)
    sampled.times_s.push_back(sampled.duration_s * static_cast<double>(i) / static_cast<double>(points - 1));
  const sim::Courses made = sim::make_courses(scenario, *experiment.world, sequence);
  const std::vector<std::unique_ptr<sim::Course>>& courses = made.nodes;
  for (size_t node = 0; node < courses.size(); ++node) {
    if (courses[node]->is_static()) continue;
    if (sampled.nodes.size() == most_nodes) {
      ++sampled.left_out;
      continue;
    }
    SampledCourses::Node& added = sampled.nodes.emplace_back();
    added.number = static_cast<uint32_t>(node);
    added.name = printable(scenario.nodes[node].name);
    for (const double time_s : sampled.times_s)
      added.positions.push_back(courses[node]->at(time_s).pose.position);
  }
  return sampled;
}

Shapes course_shapes(const SampledCourses& courses, double now_s) {
  Shapes shapes;
  for (const SampledCourses::Node& node : courses.nodes) {
    const io::Color color = io::color_of_series(node.number);
    double length_m = 0.0;
    for (size_t i = 0; i + 1 < node.positions.size(); ++i)
      length_m += glm::distance(node.positions[i], node.positions[i + 1]);
    const uint32_t row = shapes.add_row(
        fmt::format("the way of {}\n{:.1f} m in {:.2f} s", node.name, length_m, courses.duration_s),
        row_id("node", node.number));
    for (size_t i = 0; i + 1 < node.positions.size(); ++i) {
      const dvec3 &a = node.positions[i], &b = node.positions[i + 1];
      if (a == b) continue;
      const double from_s = courses.times_s[i], to_s = courses.times_s[i + 1];
      if (now_s <= from_s || now_s >= to_s) {
        const bool ahead = now_s <= from_s;
        shapes.lines.push_back({a, b, ahead ? faint_of(color) : color, ahead ? 1.0f : 2.0f, row});
        continue;
      }
      const dvec3 now = glm::mix(a, b, (now_s - from_s) / (to_s - from_s));
      shapes.lines.push_back({a, now, color, 2.0f, row});
      shapes.lines.push_back({now, b, faint_of(color), 1.0f, row});
    }
  }
  shapes.note(fmt::format("ways: {:.2f} of {:.2f} s of the scenario, {} node{}", now_s, courses.duration_s,
                          courses.nodes.size(), courses.nodes.size() == 1 ? "" : "s"));
  if (courses.left_out > 0) shapes.note(fmt::format("ways: {} more nodes without theirs", courses.left_out));
  return shapes;
}

}  // namespace greatx::view
