// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The clock and the courses of nodes.
#include <algorithm>
#include <cmath>

#include "apps/selftest/catalogue.h"
#include "sim/scenario/clock.h"
#include "sim/scenario/trajectory.h"

namespace greatx::apps::selftest {

namespace {

void n58_an_hour(const Lab& lab, Rows& rows) {
  const sim::Clock clock({1000, 1});
  const auto ticks = static_cast<int64_t>(lab.given(3'600'000.0));
  rows.add("seconds after an hour of ticks of 1 ms", host, 3600.0, clock.seconds(ticks), 0.0);
  rows.add("nanoseconds after an hour of ticks of 1 ms", host, 3.6e12,
           static_cast<double>(clock.nanoseconds(ticks)), 0.0);
}

void n59_thirty_hertz(const Lab& lab, Rows& rows) {
  const sim::SampleTimes times({1000, 1}, {static_cast<int64_t>(lab.given(3000.0)), 100});
  rows.add("samples of 30 Hz in an hour of ticks of 1 ms", host, 108'000.0,
           static_cast<double>(times.first_at_or_after(3'600'000)), 0.0);
  double wrong = 0.0;
  for (int64_t k = 0; k < 1000; ++k) wrong += times.tick_of(k) != (2 * k * 1000 + 30) / 60;
  rows.add("samples that are not at round(k 1000/30)", host, 0.0, wrong, 0.0);
}

void n60_coincident_points(const Lab& lab, Rows& rows) {
  const auto course = [](const std::array<dvec3, 4>& points) {
    sim::Scenario scenario;
    scenario.tick_rate_hz = {100, 1};
    scenario.ticks = 1001;
    sim::NodeConfig node;
    node.name = "node";
    sim::BezierTrajectory trajectory;
    trajectory.control_points = points;
    node.trajectory = trajectory;
    scenario.nodes.push_back(node);
    return std::move(sim::make_node_courses(scenario, 0).courses[0]);
  };
  const dvec3 p(5, 5, 5);
  const Motion start = course({p, p, p + dvec3(lab.given(1.0) - 1.0, 3, 0), p + dvec3(3, 6, 0)})->at(0.0);
  rows.add("forward . y at the start, along P2 - P0", host, 1.0, start.pose.rotate({1, 0, 0}).y, 1e-12);
  rows.add("speed at the start, m/s", host, 0.0, glm::length(start.velocity), 0.0);
  const Motion still = course({p, p, p, p + dvec3(0, 0, 9.0 * (lab.given(1.0) - 1.0))})->at(5.0);
  rows.add("distance from a point of zero length, m", host, 0.0, glm::length(still.pose.position - p), 0.0);
  const dquat& q = still.pose.orientation;
  rows.add("length of the quaternion there", host, 1.0, glm::length(q), 1e-12);
}

constexpr Case list_of_time_cases[] = {
    {58, "an hour of ticks of 1 ms", n58_an_hour},
    {59, "30 Hz on ticks of 1 ms", n59_thirty_hertz},
    {60, "coincident control points", n60_coincident_points},
};

}  // namespace

std::span<const Case> time_cases() { return list_of_time_cases; }

}  // namespace greatx::apps::selftest
