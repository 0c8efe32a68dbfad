// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/check/course_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "core/parallel.h"
#include "sim/check/view_shares.h"
#include "sim/run/sensor_places.h"
#include "sim/world/moment.h"
#include "sim/world/solids.h"

namespace greatx::sim {
namespace {

constexpr double clearance_reach_m = 50.0;
constexpr int64_t view_moments = 8;  ///< of a sequence

/// A point that must be in the open: a sensor, or the middle of a body.
struct Point {
  std::string name;
  uint32_t node = 0, body = 0;
  dvec3 place{0.0};  ///< in the frame of the node
  bool rests = false;
};

/// What a point met, over some ticks.
struct Met {
  uint64_t ticks = 0;
  int64_t first_tick = 0;
  uint32_t first_sequence = 0;
  std::string what;
  void add(uint32_t sequence, int64_t tick, const std::string& met) {
    if (ticks++ > 0) return;
    first_sequence = sequence, first_tick = tick, what = met;
  }
  void add(const Met& later) {
    const uint64_t sum = ticks + later.ticks;
    if (ticks == 0) *this = later;
    ticks = sum;
  }
};

/// What one sequence has.
struct SequenceResult {
  std::vector<Met> inside, passes;  ///< [points]
  std::vector<NodeFigures> nodes;   ///< [nodes]
  std::vector<ViewFigures> views;
};

std::vector<Point> points_of(const Experiment& experiment) {
  std::vector<Point> points;
  const World& world = *experiment.world;
  for (uint32_t i = 0; i < experiment.scenario.nodes.size(); ++i) {
    const NodeConfig& node = experiment.scenario.nodes[i];
    const uint32_t body = world.body_of_node[i];
    const bool rests = std::holds_alternative<StaticTrajectory>(node.trajectory);
    if (body != 0 && !world.scene.bodies[body].bounds.empty())
      points.push_back({node.name, i, body, world.scene.bodies[body].bounds.center(), rests});
    for (const SensorConfig& sensor : node.sensors)
      points.push_back({node.name + "/" + sensor.name, i, body, sensor.mount.position_m, rests});
  }
  return points;
}

/// Follows one sequence.
class SequenceCheck {
 public:
  SequenceCheck(const Experiment& experiment, const std::vector<Point>& points,
                const std::vector<CameraView>& views, uint32_t sequence)
      : scenario_(experiment.scenario),
        world_(*experiment.world),
        points_(points),
        views_(views),
        sequence_(sequence),
        clock_(scenario_.tick_rate_hz),
        courses_(make_courses(scenario_, world_, sequence)) {
    result_.inside.resize(points.size());
    result_.passes.resize(points.size());
    result_.nodes.resize(scenario_.nodes.size());
    for (const CameraView& view : views) result_.views.emplace_back().name = view.name;
    before_.resize(points.size());
  }

  SequenceResult run() {
    for (NodeFigures& node : result_.nodes) node.least_clearance = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < result_.nodes.size(); ++i) result_.nodes[i].draws = courses_.draws[i];
    const int64_t view_step = std::max<int64_t>(1, scenario_.ticks / view_moments);
    for (int64_t tick = 0; tick < scenario_.ticks; ++tick) {
      checkpoint();
      const Moment moment = moment_at(world_, courses_, clock_, tick);
      for (size_t p = 0; p < points_.size(); ++p) place(p, moment.context);
      for (size_t n = 0; n < result_.nodes.size(); ++n) measure(n, moment.context);
      if (tick % view_step == view_step / 2)
        for (size_t v = 0; v < views_.size(); ++v) see(v, moment.context);
    }
    return std::move(result_);
  }

 private:
  void place(size_t index, const TickContext& context) {
    const Point& point = points_[index];
    std::optional<dvec3>& before = before_[index];
    if (point.rests && before && result_.inside[index].ticks == 0) return;
    const dvec3 at = world_.scene.to_local(context.nodes[point.node].pose.apply(point.place));
    const std::string what = within(world_, at, context.body_poses, point.body);
    if (!what.empty()) result_.inside[index].add(sequence_, context.tick, what);
    if (before)
      if (const std::optional<uint32_t> passed = world_.solids().surfaces().first_passed(*before, at))
        result_.passes[index].add(sequence_, context.tick,
                                  fmt::format("'{}'", world_.solids().object_of(*passed)));
    before = at;
  }

  void measure(size_t index, const TickContext& context) {
    if (courses_.nodes[index]->is_static()) return;
    NodeFigures& node = result_.nodes[index];
    const Motion& motion = context.nodes[index];
    node.most_speed = std::max(node.most_speed, glm::length(motion.velocity));
    node.most_acceleration = std::max(node.most_acceleration, glm::length(motion.acceleration));
    const double clear =
        world_.solids().surfaces().distance(world_.scene.to_local(motion.pose.position), clearance_reach_m);
    if (clear < clearance_reach_m) node.least_clearance = std::min(node.least_clearance, clear);
  }

  void see(size_t index, const TickContext& context) {
    const ViewShares shares = view_shares(world_, views_[index], context);
    ViewFigures& view = result_.views[index];
    ++view.moments;
    view.sky += shares.sky, view.ground += shares.ground;
    view.only_sky += shares.sky == 1.0;
    view.only_ground += shares.ground == 1.0;
  }

  const Scenario& scenario_;
  const World& world_;
  const std::vector<Point>& points_;
  const std::vector<CameraView>& views_;
  uint32_t sequence_;
  Clock clock_;
  Courses courses_;
  std::vector<std::optional<dvec3>> before_;
  SequenceResult result_;
};

void add(SequenceResult& sum, const SequenceResult& later) {
  for (size_t p = 0; p < sum.inside.size(); ++p)
    sum.inside[p].add(later.inside[p]), sum.passes[p].add(later.passes[p]);
  for (size_t n = 0; n < sum.nodes.size(); ++n) {
    NodeFigures& node = sum.nodes[n];
    const NodeFigures& other = later.nodes[n];
    node.most_speed = std::max(node.most_speed, other.most_speed);
    node.most_acceleration = std::max(node.most_acceleration, other.most_acceleration);
    node.least_clearance = std::min(node.least_clearance, other.least_clearance);
    node.draws += other.draws;
  }
  for (size_t v = 0; v < sum.views.size(); ++v) {
    ViewFigures& view = sum.views[v];
    const ViewFigures& other = later.views[v];
    view.moments += other.moments, view.sky += other.sky, view.ground += other.ground;
    view.only_sky += other.only_sky, view.only_ground += other.only_ground;
  }
}

/// Returns the speed beyond which a body of a class is in doubt, m/s.
double plausible_speed(const NodeConfig& node) {
  const std::string& kind = node.semantic_class.value_or("");
  return kind == "person" ? 12.0 : kind == "vehicle" ? 70.0 : kind == "uav" ? 60.0 : 350.0;
}

void find_views(const std::vector<ViewFigures>& views, std::vector<Finding>& findings) {
  for (const ViewFigures& view : views) {
    const auto add = [&](const char* kind, uint64_t moments, Severity always, const char* what) {
      if (moments > 0)
        findings.push_back({moments == view.moments ? always : Severity::doubt, kind, view.name,
                            fmt::format("sees only {} at {} of {} moments", what, moments, view.moments)});
    };
    add("only_sky", view.only_sky, Severity::fault, "sky");
    add("only_ground", view.only_ground, Severity::doubt, "ground");
  }
}

}  // namespace

std::vector<Finding> check_courses(const Experiment& experiment, CourseFigures& figures,
                                   const std::function<void(uint32_t)>& sequence_done) {
  const Scenario& scenario = experiment.scenario;
  const std::vector<Point> points = points_of(experiment);
  const std::vector<CameraView> views = camera_views(experiment);
  std::optional<SequenceResult> sum;
  // Sequences are followed side by side, a few at a time, and added in their order.
  const auto together = static_cast<uint32_t>(4 * usable_cores());
  for (uint32_t first = 0; first < scenario.sequences; first += together) {
    const uint32_t count = std::min(together, scenario.sequences - first);
    std::vector<SequenceResult> results(count);
    parallel_for(count, 0, [&](size_t i) {
      results[i] = SequenceCheck(experiment, points, views, first + static_cast<uint32_t>(i)).run();
    });
    for (SequenceResult& result : results) {
      if (sum)
        add(*sum, result);
      else
        sum = std::move(result);
    }
    sequence_done(first + count);
  }
  figures.sequences = scenario.sequences;
  figures.ticks = static_cast<uint64_t>(scenario.ticks) * scenario.sequences;
  std::vector<Finding> findings;
  if (!sum) return findings;
  for (size_t p = 0; p < points.size(); ++p) {
    const auto tell = [&](const Met& met, const char* kind, const std::string& what) {
      if (met.ticks > 0)
        findings.push_back({Severity::fault, kind, points[p].name,
                            fmt::format("{} at {} of {} ticks, first at tick {} of sequence {}", what,
                                        met.ticks, figures.ticks, met.first_tick, met.first_sequence)});
    };
    tell(sum->inside[p], "inside_solid", "is " + sum->inside[p].what);
    tell(sum->passes[p], "passes_through", "passes through " + sum->passes[p].what);
  }
  for (size_t n = 0; n < scenario.nodes.size(); ++n) {
    NodeFigures& node = sum->nodes[n];
    node.name = scenario.nodes[n].name;
    const double plausible = plausible_speed(scenario.nodes[n]);
    if (node.most_speed > plausible)
      findings.push_back(
          {Severity::doubt, "speed", node.name,
           fmt::format("moves at {:.4g} m/s, more than {:g} m/s", node.most_speed, plausible)});
    if (node.most_speed > 0.0) figures.nodes.push_back(node);
  }
  for (ViewFigures& view : sum->views) {
    const double moments = static_cast<double>(std::max<uint64_t>(1, view.moments));
    view.sky /= moments, view.ground /= moments;
  }
  find_views(sum->views, findings);
  figures.views = std::move(sum->views);
  return findings;
}

}  // namespace greatx::sim
