// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/trajectory.h"

#include <algorithm>

#include "core/hash.h"
#include "core/random.h"
#include "sim/scenario/clock.h"
#include "sim/scenario/trajectory_makers.h"

namespace greatx::sim {
namespace {

bool is_drawn(const NodeConfig& node) {
  const auto* bezier = std::get_if<BezierTrajectory>(&node.trajectory);
  return std::holds_alternative<CorridorTrajectory>(node.trajectory) ||
         (bezier != nullptr && !bezier->control_points);
}

/// Makes courses in the order in which they depend on each other.
class PathMaker {
 public:
  PathMaker(const Scenario& scenario, uint32_t sequence, const FreeSpace* space, const TrafficSource* traffic)
      : scenario_(scenario), sequence_(sequence), space_(space), begun_(scenario.nodes.size()) {
    if (scenario.traffic && !scenario.traffic->members.empty()) {
      GREATX_CHECK(traffic != nullptr, "the traffic of scenario '{}' without a world", scenario.name);
      members_ = traffic->courses(sequence);
    }
    GREATX_CHECK(scenario.curve_ticks() > 0, "{} ticks", scenario.curve_ticks());
    const Clock clock(scenario.tick_rate_hz);
    duration_s_ = clock.seconds(scenario.curve_ticks() - 1);
    end_s_ = clock.seconds(std::max<int64_t>(scenario.ticks, 1) - 1);
    made_.courses.resize(scenario.nodes.size());
    made_.draws.resize(scenario.nodes.size());
  }

  NodeCourses make_all() {
    for (const bool drawn : {false, true})
      for (size_t i = 0; i < scenario_.nodes.size(); ++i)
        if (is_drawn(scenario_.nodes[i]) == drawn) make(i);
    return std::move(made_);
  }

 private:
  const Course* make(size_t index) {
    std::unique_ptr<Course>& course = made_.courses[index];
    if (course) return course.get();
    const NodeConfig& node = scenario_.nodes[index];
    GREATX_CHECK(!begun_[index], "the path of node '{}' depends on itself", node.name);
    begun_[index] = true;
    RandomStream random(scenario_.seed, fnv1a32(node.name), sequence_);
    if (const auto* bezier = std::get_if<BezierTrajectory>(&node.trajectory)) {
      const Course* reference =
          bezier->reference_node.empty() ? nullptr : make(index_of(bezier->reference_node));
      course = draw(index, [&] {
        return make_course(EndLimits{node, *bezier, reference}, duration_s_, random);
      });
    } else if (const auto* corridor = std::get_if<CorridorTrajectory>(&node.trajectory)) {
      course = draw(index, [&] { return make_course(*corridor, duration_s_, random); });
    } else if (const auto* points = std::get_if<WayPointTrajectory>(&node.trajectory)) {
      course = make_course(*points);
    } else if (const auto* member = std::get_if<TrafficTrajectory>(&node.trajectory)) {
      course = std::move(members_[member->member]);
    } else if (const auto* track = std::get_if<TrackTrajectory>(&node.trajectory)) {
      course = make_course(*track);
    } else if (const auto* follow = std::get_if<FollowTrajectory>(&node.trajectory)) {
      course = make_course(*follow, *make(index_of(follow->node)));
    } else {
      course = make_course(std::get<StaticTrajectory>(node.trajectory));
    }
    return course.get();
  }

  /// Draws a course until it keeps clear.
  template <typename Draw>
  std::unique_ptr<Course> draw(size_t index, const Draw& drawn) {
    const NodeConfig& node = scenario_.nodes[index];
    std::unique_ptr<Course> course = drawn();
    if (!is_drawn(node)) return course;
    uint32_t& draws = made_.draws[index] = 1;
    const double clearance = clearance_of(node);
    const std::vector<FreeSpace::Neighbour> neighbours = neighbours_of(index, clearance);
    if (clearance <= 0.0 && neighbours.empty()) return course;
    GREATX_CHECK(space_ != nullptr, "the clearance of node '{}' without a world", node.name);
    std::vector<uint32_t> near_nodes(scenario_.nodes.size());
    uint32_t near_world = 0;
    for (;; ++draws) {
      const auto near =
          space_->too_near(static_cast<uint32_t>(index), clearance, *course, neighbours, end_s_);
      if (!near) return course;
      ++(near->node ? near_nodes[*near->node] : near_world);
      if (draws == most_clear_draws) none_clear(node, clearance, near_world, near_nodes);
      course = drawn();
    }
  }

  /// Returns the courses that are made already and have to keep away from this one.
  std::vector<FreeSpace::Neighbour> neighbours_of(size_t index, double clearance) const {
    std::vector<FreeSpace::Neighbour> neighbours;
    for (size_t i = 0; i < made_.courses.size(); ++i) {
      const double other = clearance_of(scenario_.nodes[i]);
      if (i != index && made_.courses[i] && (clearance > 0.0 || other > 0.0))
        neighbours.push_back({static_cast<uint32_t>(i), other, made_.courses[i].get()});
    }
    return neighbours;
  }

  [[noreturn]] void none_clear(const NodeConfig& node, double clearance, uint32_t near_world,
                               const std::vector<uint32_t>& near_nodes) const {
    std::string found = fmt::format("{} come too near to the static world", near_world);
    for (size_t i = 0; i < near_nodes.size(); ++i)
      if (near_nodes[i] > 0)
        found += fmt::format(", {} to node '{}'", near_nodes[i], scenario_.nodes[i].name);
    std::string where = "its corridor";
    if (const auto* t = std::get_if<BezierTrajectory>(&node.trajectory))
      where = fmt::format("its box [{}, {}, {}] .. [{}, {}, {}] m", t->min_m.x, t->min_m.y, t->min_m.z,
                          t->max_m.x, t->max_m.y, t->max_m.z);
    throw_user_error_at(node.where,
                        "node '{}': clearance_m: expected a trajectory in {} that keeps {} m in sequence {}, "
                        "found none in {} draws: {}",
                        node.name, where, clearance, sequence_, most_clear_draws, found);
  }

  size_t index_of(const std::string& name) const {
    for (size_t i = 0; i < scenario_.nodes.size(); ++i)
      if (scenario_.nodes[i].name == name) return i;
    GREATX_CHECK(false, "no node '{}'", name);
    return 0;
  }

  const Scenario& scenario_;
  uint32_t sequence_;
  const FreeSpace* space_;
  std::vector<std::unique_ptr<Course>> members_;  ///< of the traffic, until a node takes them
  double duration_s_ = 0.0, end_s_ = 0.0;
  NodeCourses made_;
  std::vector<bool> begun_;
};

}  // namespace

double clearance_of(const NodeConfig& node) {
  if (const auto* bezier = std::get_if<BezierTrajectory>(&node.trajectory)) return bezier->clearance_m;
  if (const auto* corridor = std::get_if<CorridorTrajectory>(&node.trajectory)) return corridor->clearance_m;
  return 0.0;
}

NodeCourses make_node_courses(const Scenario& scenario, uint32_t sequence, const FreeSpace* space,
                              const TrafficSource* traffic) {
  return PathMaker(scenario, sequence, space, traffic).make_all();
}

}  // namespace greatx::sim
