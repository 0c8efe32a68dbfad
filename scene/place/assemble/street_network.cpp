// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/assemble/street_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "scene/network/ways.h"
#include "scene/place/assemble/polyline.h"
#include "scene/place/assemble/walking_lines.h"
#include "scene/place/input/osm_values.h"

namespace greatx::scene::place {
namespace {

constexpr double short_edge_m = 24.0;    // shorter ones become part of a junction
constexpr double least_lane_m = 14.0;    // a vehicle waits on it with room on both sides
constexpr double most_trim_share = 0.3;  // of an edge at each of its ends
constexpr double loop_reach_m = 7.0;
constexpr double pavement_m = 2.1;  // of the walking line's middle from the edge of the carriageway

struct SpeedRule {
  std::string_view highway;
  double kmph;
};
/// Where maxspeed is not given.
constexpr std::array speed_rules{SpeedRule{"motorway", 120}, SpeedRule{"trunk", 100},
                                 SpeedRule{"residential", 30}, SpeedRule{"living_street", 10},
                                 SpeedRule{"service", 20}};

double cross_of(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

struct Edge {
  std::vector<dvec2> line;
  size_t nodes[2] = {0, 0};
  double width_m = 5.5, speed_mps = 8.3;
  int lanes[2] = {1, 1};          ///< along the line, against it
  std::vector<uint32_t> made[2];  ///< lanes of the network, [0] the outermost one
  bool gone = false;
};
/// One end of an edge at a junction.
struct Arm {
  size_t edge = 0;
  int end = 0;
  dvec2 out{1.0, 0.0};  ///< away from the junction
};

class PlaceStreets {
 public:
  PlaceStreets(const PlaceInput& input, const GroundPlan& ground, const Box& rectangle,
               const std::function<double(const dvec2&)>& height,
               const std::function<bool(const dvec2&)>& built)
      : ground_(ground), rectangle_(rectangle), height_(height), built_(built) {
    for (const Feature& feature : input.features) features_[{feature.source, feature.id}] = &feature;
  }

  StreetNetwork make() {
    split_roads();
    join_in_twos();
    contract();
    for (const auto& [node, arms] : arms_of_nodes()) make_junction(arms);
    trim_and_make_lanes();
    for (const auto& [node, arms] : arms_of_nodes()) make_turns(arms);
    make_walks();
    return std::move(network_);
  }

 private:
  using Key = std::pair<int64_t, int64_t>;
  static Key key_of(const dvec2& p) { return {std::llround(p.x * 100.0), std::llround(p.y * 100.0)}; }
  const Feature* feature_of(const GroundLine& line) const {
    const auto found = features_.find({line.source, line.id});
    return found == features_.end() ? nullptr : found->second;
  }
  static std::string value(const Feature& feature, const char* key) {
    const std::string* text = feature.tag(key);
    return text ? *text : std::string();
  }
  bool drivable(const GroundLine& line) const {
    const Feature* feature = feature_of(line);
    if (line.cover != Cover::road || !feature) return false;
    const std::string service = value(*feature, "service"), access = value(*feature, "access");
    return service.empty() && access != "private" && access != "no" &&
           std::ranges::all_of(line.line, [&](const dvec2& p) { return rectangle_.holds(p); });
  }

  Edge edge_of(const GroundLine& line) const {
    const Feature& feature = *feature_of(line);
    Edge edge;
    edge.width_m = line.width_m;
    const std::string highway = value(feature, "highway"), oneway = value(feature, "oneway");
    double kmph = 50.0;
    for (const SpeedRule& rule : speed_rules)
      if (rule.highway == highway) kmph = rule.kmph;
    if (const std::string* most = feature.tag("maxspeed")) {
      const bool miles = most->ends_with("mph");
      const auto number = parse_levels(most->substr(0, most->find(' ')));
      if (number && *number >= 5.0 && *number <= 150.0) kmph = *number * (miles ? 1.609344 : 1.0);
    }
    edge.speed_mps = kmph / 3.6;
    int lanes = 0;
    if (const std::string* text = feature.tag("lanes"))
      if (const auto number = parse_levels(*text)) lanes = static_cast<int>(std::clamp(*number, 0.0, 12.0));
    const bool against = oneway == "-1";
    if (against || means_yes(oneway) || value(feature, "junction") == "roundabout" || highway == "motorway") {
      edge.lanes[against ? 1 : 0] = std::max(lanes, 1);
      edge.lanes[against ? 0 : 1] = 0;
    } else {
      edge.lanes[0] = edge.lanes[1] = std::max(lanes / 2, 1);
    }
    return edge;
  }

  size_t node_at(const dvec2& point) {
    const auto [found, added] = nodes_.try_emplace(key_of(point), nodes_.size());
    if (added) merged_.push_back(found->second);
    return found->second;
  }
  size_t node_of(const Edge& edge, int end) const {
    size_t node = edge.nodes[end];
    while (merged_[node] != node) node = merged_[node];
    return node;
  }

  void split_roads() {
    std::map<Key, int> uses;
    for (const GroundLine& line : ground_.lines)
      if (drivable(line))
        for (size_t i = 0; i < line.line.size(); ++i)
          uses[key_of(line.line[i])] += i == 0 || i + 1 == line.line.size() ? 1 : 2;
    for (const GroundLine& line : ground_.lines) {
      if (!drivable(line)) continue;
      const Edge whole = edge_of(line);
      Edge edge = whole;
      for (size_t i = 0; i < line.line.size(); ++i) {
        const dvec2& point = line.line[i];
        if (edge.line.empty() || glm::distance(edge.line.back(), point) > 0.05) edge.line.push_back(point);
        const bool ends = i + 1 == line.line.size() || (i > 0 && uses[key_of(point)] > 2);
        if (!ends || edge.line.size() < 2) continue;
        edge.nodes[0] = node_at(edge.line.front());
        edge.nodes[1] = node_at(edge.line.back());
        edges_.push_back(edge);
        edge = whole;
        edge.line = {point};
      }
    }
  }

  std::map<size_t, std::vector<Arm>> arms_of_nodes() const {
    std::map<size_t, std::vector<Arm>> arms;
    for (size_t i = 0; i < edges_.size(); ++i) {
      if (edges_[i].gone) continue;
      const std::vector<dvec2>& line = edges_[i].line;
      arms[node_of(edges_[i], 0)].push_back({i, 0, glm::normalize(line[1] - line[0])});
      const size_t n = line.size();
      arms[node_of(edges_[i], 1)].push_back({i, 1, glm::normalize(line[n - 2] - line[n - 1])});
    }
    return arms;
  }

  static void reverse(Edge& edge) {
    std::ranges::reverse(edge.line);
    std::swap(edge.nodes[0], edge.nodes[1]);
    std::swap(edge.lanes[0], edge.lanes[1]);
  }

  /// Joins two edges that alone meet at a node and have the same lanes.
  void join_in_twos() {
    for (const auto& [node, at] : arms_of_nodes()) {
      std::vector<Arm> arms;  // as they are now
      for (const Arm& arm : at)
        if (!edges_[arm.edge].gone) arms.push_back(arm);
      for (size_t i = 0; i < edges_.size() && arms.size() < at.size(); ++i)
        for (const int end : {0, 1})
          if (!edges_[i].gone && edges_[i].nodes[end] == node &&
              std::ranges::none_of(arms, [&](const Arm& arm) { return arm.edge == i; }))
            arms.push_back({i, end, {}});
      if (arms.size() != 2 || arms[0].edge == arms[1].edge) continue;
      Edge &first = edges_[arms[0].edge], &second = edges_[arms[1].edge];
      Edge tail = second;
      if (first.nodes[1] != node) reverse(first);
      if (tail.nodes[0] != node) reverse(tail);
      if (first.nodes[1] != node || first.lanes[0] != tail.lanes[0] || first.lanes[1] != tail.lanes[1])
        continue;
      first.line.insert(first.line.end(), tail.line.begin() + 1, tail.line.end());
      first.nodes[1] = tail.nodes[1];
      first.speed_mps = std::min(first.speed_mps, tail.speed_mps);
      first.width_m = std::min(first.width_m, tail.width_m);
      second.gone = true;
    }
  }

  /// Makes short edges between junctions part of one junction, since vehicles have no room to wait on them.
  void contract() {
    std::map<size_t, size_t> degree;
    for (const auto& [node, arms] : arms_of_nodes()) degree[node] = arms.size();
    for (Edge& edge : edges_) {
      if (edge.gone || line_length(edge.line) >= short_edge_m) continue;
      if (degree[edge.nodes[0]] > 1 && degree[edge.nodes[1]] > 1)
        merged_[std::max(node_of(edge, 0), node_of(edge, 1))] = std::min(node_of(edge, 0), node_of(edge, 1));
      edge.gone = true;
    }
  }

  /// Finds how much of each edge lies within the junction: to where its carriageway is clear of the others'.
  void make_junction(const std::vector<Arm>& arms) {
    for (const Arm& arm : arms) {
      double trim = 0.0;
      for (const Arm& other : arms) {
        if (&other == &arm) continue;
        const double half = std::sqrt(std::max(0.5 - 0.5 * glm::dot(arm.out, other.out), 0.02));
        const double widths = 0.5 * (edges_[arm.edge].width_m + edges_[other.edge].width_m);
        trim = std::max(trim, 2.0 + (widths + 1.5) / (2.0 * half));
      }
      trims_[{arm.edge, arm.end}] =
          arms.size() < 2 ? 0.0 : std::min(trim, most_trim_share * line_length(edges_[arm.edge].line));
    }
  }

  void trim_and_make_lanes() {
    for (size_t i = 0; i < edges_.size(); ++i) {
      Edge& edge = edges_[i];
      if (edge.gone) continue;
      const double from_m = trims_[{i, 0}], to_m = line_length(edge.line) - trims_[{i, 1}];
      if (to_m - from_m < least_lane_m) {
        edge.gone = true;
        continue;
      }
      edge.line = without_corners(part_of_line(edge.line, from_m, to_m));
      const double lane_m = edge.width_m / (edge.lanes[0] + edge.lanes[1]);
      for (const int side : {0, 1}) {
        std::vector<dvec2> middle = edge.line;
        if (side == 1) std::ranges::reverse(middle);
        for (int k = 0; k < edge.lanes[side]; ++k) {
          const double right_m = 0.5 * edge.width_m - (k + 0.5) * lane_m;
          StreetLane lane;
          lane.line = on_ground(moved_right(middle, right_m));
          lane.width_m = std::max(lane_m, 0.5);
          lane.speed_mps = edge.speed_mps;
          lane.stop_m = 1.0;
          if (k > 0) {
            lane.right = edge.made[side].back();
            network_.lanes[*lane.right].left = static_cast<uint32_t>(network_.lanes.size());
          }
          edge.made[side].push_back(static_cast<uint32_t>(network_.lanes.size()));
          network_.lanes.push_back(std::move(lane));
        }
      }
    }
  }

  dvec2 start(uint32_t lane) const { return dvec2(network_.lanes[lane].line.front()); }
  dvec2 end(uint32_t lane) const { return dvec2(network_.lanes[lane].line.back()); }
  dvec2 start_direction(uint32_t lane) const {
    return glm::normalize(dvec2(network_.lanes[lane].line[1]) - start(lane));
  }
  dvec2 end_direction(uint32_t lane) const {
    const auto& line = network_.lanes[lane].line;
    return glm::normalize(end(lane) - dvec2(line[line.size() - 2]));
  }

  void make_turns(const std::vector<Arm>& arms) {
    if (arms.size() == 1) {
      make_loop(arms.front());
      return;
    }
    const auto junction = static_cast<uint32_t>(network_.junctions.size());
    network_.junctions.emplace_back();
    for (const Arm& in : arms)
      for (const Arm& out : arms) {
        const std::vector<uint32_t>& from = edges_[in.edge].made[in.end == 1 ? 0 : 1];
        const std::vector<uint32_t>& to = edges_[out.edge].made[out.end == 0 ? 0 : 1];
        if (&in == &out || from.empty() || to.empty()) continue;
        const double sine = cross_of(end_direction(from[0]), start_direction(to[0]));
        const double cosine = glm::dot(end_direction(from[0]), start_direction(to[0]));
        if (cosine < -0.8) continue;  // too sharp
        if (std::abs(sine) < 0.5 && cosine > 0.0) {
          for (size_t k = 0; k < std::min(from.size(), to.size()); ++k) add_turn(junction, from[k], to[k]);
        } else if (sine < 0.0) {
          add_turn(junction, from.front(), to.front());
        } else {
          add_turn(junction, from.back(), to.back());
        }
      }
  }

  void add_turn(uint32_t junction, uint32_t from, uint32_t to) {
    StreetLane turn;
    turn.junction = junction;
    turn.width_m = std::min(network_.lanes[from].width_m, network_.lanes[to].width_m);
    turn.speed_mps = std::min(network_.lanes[from].speed_mps, network_.lanes[to].speed_mps);
    turn.next = {to};
    turn.line = on_ground(turn_line(end(from), end_direction(from), start(to), start_direction(to)));
    network_.lanes[from].next.push_back(static_cast<uint32_t>(network_.lanes.size()));
    network_.lanes.push_back(std::move(turn));
  }

  /// Where a road ends, a loop leads back, unless houses stand in its way.
  void make_loop(const Arm& arm) {
    const Edge& edge = edges_[arm.edge];
    const std::vector<uint32_t>& from = edge.made[arm.end == 1 ? 0 : 1];
    const std::vector<uint32_t>& to = edge.made[arm.end == 1 ? 1 : 0];
    if (from.empty() || to.empty()) return;
    const std::vector<dvec2> line =
        loop_line(end(from[0]), start(to[0]), end_direction(from[0]), loop_reach_m);
    if (std::ranges::any_of(points_along(line, 1.0), built_)) return;
    StreetLane loop;
    loop.width_m = network_.lanes[from[0]].width_m;
    loop.speed_mps = network_.lanes[from[0]].speed_mps;
    loop.next = {to[0]};
    loop.line = on_ground(line);
    network_.lanes[from[0]].next.push_back(static_cast<uint32_t>(network_.lanes.size()));
    network_.lanes[from[0]].stop_m = 0.0;
    network_.lanes.push_back(std::move(loop));
  }

  /// Gives a line the heights of the ground, at points at most 6 m apart.
  std::vector<dvec3> on_ground(const std::vector<dvec2>& line) const {
    std::vector<dvec3> points;
    for (const dvec2& p : points_along(line, 6.0)) {
      const dvec2 within = glm::clamp(p, rectangle_.low + 0.01, rectangle_.high - 0.01);
      points.emplace_back(p, height_(within));
    }
    return points;
  }

  void make_walks() {
    WalkingLines walks(rectangle_, height_, built_);
    for (const GroundLine& line : ground_.lines)
      if (line.cover == Cover::road) walks.keep_off(line.line, 0.5 * line.width_m);
    for (const Edge& edge : edges_) {
      if (edge.gone || edge.line.size() < 2) continue;
      for (const double side : {1.0, -1.0})
        walks.add(moved_right(edge.line, side * (0.5 * edge.width_m + pavement_m)));
    }
    for (const GroundLine& line : ground_.lines)
      if (const Feature* feature = feature_of(line); feature && line.line.size() > 1) {
        const std::string highway = value(*feature, "highway");
        if (highway == "footway" || highway == "pedestrian" || highway == "path")
          walks.add(without_corners(line.line));
      }
    network_.walks = walks.take();
  }

  const GroundPlan& ground_;
  Box rectangle_;
  const std::function<double(const dvec2&)>& height_;
  const std::function<bool(const dvec2&)>& built_;
  std::map<std::pair<std::string, std::string>, const Feature*> features_;
  std::map<Key, size_t> nodes_;
  std::vector<size_t> merged_;
  std::vector<Edge> edges_;
  std::map<std::pair<size_t, int>, double> trims_;
  StreetNetwork network_;
};

}  // namespace

StreetNetwork place_streets(const PlaceInput& input, const GroundPlan& ground, const Box& rectangle,
                            const std::function<double(const dvec2&)>& height,
                            const std::function<bool(const dvec2&)>& built) {
  return PlaceStreets(input, ground, rectangle, height, built).make();
}

}  // namespace greatx::scene::place
