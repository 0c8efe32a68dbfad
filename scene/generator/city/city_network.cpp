// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/city/city_network.h"

#include <algorithm>
#include <cmath>

#include "scene/generator/city/city_ground.h"
#include "scene/generator/mesh/mesh_builder.h"
#include "scene/network/ways.h"

namespace greatx::scene::generator {
namespace {

constexpr double avenue_speed_mps = 50.0 / 3.6, street_speed_mps = 30.0 / 3.6;
/// The zebras and stop lines that city_ground.cpp paints, from the end of a street.
constexpr double zebra_middle_m = 2.2, stop_line_m = 5.9, no_zebra_stop_m = 1.5;
/// Parked cars stand within this of the right kerb.
constexpr double parked_m = 2.3;

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Junctions lie at the crossings i, j of the lines between the blocks.
int junction_number(const CityPlan& plan, int i, int j) {
  const int n = plan.blocks;
  return i > 0 && i < n && j > 0 && j < n ? (i - 1) * (n - 1) + j - 1 : -1;
}

/// The avenues' junctions have signals.
bool signals_at(const CityPlan& plan, int i, int j) { return i == plan.blocks / 2 || j == plan.blocks / 2; }

constexpr uint32_t group_of(bool northwards) { return northwards ? 0 : 1; }

/// Lanes of one direction of a street, [0] the outermost one, as indices of the network.
using Side = std::vector<uint32_t>;

struct StreetLanes {
  Side sides[2];                ///< [0] towards increasing x or y, [1] against it
  int junctions[2] = {-1, -1};  ///< at the start and at the end
  bool northwards = false;
};

class NetworkMaker {
 public:
  explicit NetworkMaker(const CityPlan& plan) : plan_(plan) {}

  StreetNetwork make() {
    add_junctions();
    add_walks();
    const int n = plan_.blocks;
    size_t street = 0;
    for (int i = 1; i < n; ++i)
      for (int row = 0; row < n; ++row, ++street)
        add_street(plan_.streets[street], true, junction_at(i, row), junction_at(i, row + 1),
                   {block_at(i - 1, row), block_at(i, row)});
    for (int j = 1; j < n; ++j)
      for (int column = 0; column < n; ++column, ++street)
        add_street(plan_.streets[street], false, junction_at(column, j), junction_at(column + 1, j),
                   {block_at(column, j), block_at(column, j - 1)});
    for (int junction = 0; junction < (n - 1) * (n - 1); ++junction) add_turns(junction);
    for (const StreetLanes& lanes : streets_) add_loops(lanes);
    return std::move(network_);
  }

 private:
  int junction_at(int i, int j) const { return junction_number(plan_, i, j); }
  uint32_t block_at(int column, int row) const { return static_cast<uint32_t>(row * plan_.blocks + column); }

  /// Signals have one phase for streets that run east, and one for those that run north.
  void add_junctions() {
    const int middle = plan_.blocks / 2;
    for (int i = 1; i < plan_.blocks; ++i)
      for (int j = 1; j < plan_.blocks; ++j) {
        StreetJunction junction;
        if (signals_at(plan_, i, j))
          junction.phases = {{{group_of(false)}, j == middle ? 16.0 : 12.0, 3.0, 2.0},
                             {{group_of(true)}, i == middle ? 16.0 : 12.0, 3.0, 2.0}};
        network_.junctions.push_back(std::move(junction));
      }
  }

  void add_walks() {
    for (const Block& block : plan_.block) {
      Block walking = block;
      for (double& depth : walking.pavement_m) depth = depth >= 4.0 ? 3.1 : depth >= 3.0 ? 2.0 : 1.0;
      StreetWalk walk;
      for (const dvec2& point : inset(block.outline(), walking.outline_insets()))
        walk.line.emplace_back(point, pavement_height_m);
      network_.walks.push_back(std::move(walk));
    }
  }

  void add_street(const Street& street, bool northwards, int start, int end,
                  const std::array<uint32_t, 2>& blocks) {
    StreetLanes lanes;
    lanes.northwards = northwards;
    lanes.junctions[0] = start;
    lanes.junctions[1] = end;
    const double width = glm::distance(street.left[0], street.right[0]);
    const auto lane = [&](bool forward, double kerb_m, double lane_m) {
      StreetLane made;
      const double share = kerb_m / width;
      const auto point = [&](size_t k) {
        const dvec2 &kerb = forward ? street.right[k] : street.left[k],
                    &other = forward ? street.left[k] : street.right[k];
        return dvec3(glm::mix(kerb, other, share), 0.0);
      };
      made.line = forward ? std::vector{point(0), point(1)} : std::vector{point(1), point(0)};
      made.width_m = lane_m;
      made.speed_mps = street.avenue ? avenue_speed_mps : street_speed_mps;
      made.stop_m = street.crossing[forward ? 1 : 0] ? stop_line_m : no_zebra_stop_m;
      lanes.sides[forward ? 0 : 1].push_back(static_cast<uint32_t>(network_.lanes.size()));
      network_.lanes.push_back(std::move(made));
    };
    const double room = width - parked_m;
    for (const bool forward : {true, false}) {
      if (street.avenue) {  // the dashed lines stand at 0.27 of the width
        lane(forward, 0.135 * width, 0.27 * width);
        lane(forward, 0.385 * width, 0.23 * width);
        const uint32_t outer = lanes.sides[forward ? 0 : 1][0];
        network_.lanes[outer].left = outer + 1;
        network_.lanes[outer + 1].right = outer;
      } else if (forward) {
        lane(forward, parked_m + 0.23 * room, 0.45 * room);
      } else {
        lane(forward, 0.27 * room, 0.5 * room);
      }
    }
    for (size_t k = 0; k < 2; ++k)
      if (street.crossing[k]) add_crossing(street, k, lanes, blocks);
    streets_.push_back(std::move(lanes));
  }

  void add_crossing(const Street& street, size_t end, const StreetLanes& lanes,
                    const std::array<uint32_t, 2>& blocks) {
    const double length = 0.5 * (glm::distance(street.left[0], street.left[1]) +
                                 glm::distance(street.right[0], street.right[1]));
    const double share = end == 0 ? zebra_middle_m / length : 1.0 - zebra_middle_m / length;
    StreetCrossing crossing;
    crossing.from = dvec3(glm::mix(street.left[0], street.left[1], share), 0.0);
    crossing.to = dvec3(glm::mix(street.right[0], street.right[1], share), 0.0);
    crossing.walks[0] = blocks[0];
    crossing.walks[1] = blocks[1];
    const auto junction = static_cast<uint32_t>(lanes.junctions[end]);
    if (!network_.junctions[junction].phases.empty()) {
      crossing.junction = junction;
      crossing.group = group_of(lanes.northwards);
    }
    network_.crossings.push_back(crossing);
  }

  void add_turns(int junction) {
    for (const StreetLanes& from : streets_)
      for (const int in : {0, 1})  // lanes of side 0 arrive at the end, those of side 1 at the start
        if (from.junctions[1 - in] == junction)
          for (const StreetLanes& to : streets_)
            for (const int out : {0, 1})
              if (to.junctions[out] == junction && (&to != &from || in == out))
                add_turns(junction, from, from.sides[in], to.sides[out]);
  }

  dvec2 start(uint32_t lane) const { return dvec2(network_.lanes[lane].line.front()); }
  dvec2 end(uint32_t lane) const { return dvec2(network_.lanes[lane].line.back()); }
  dvec2 direction(uint32_t lane) const { return glm::normalize(end(lane) - start(lane)); }

  /// The outer lane leads straight on and to the right, the inner one straight on and to the left.
  void add_turns(int junction, const StreetLanes& street, const Side& from, const Side& to) {
    const double turn = cross(direction(from[0]), direction(to[0]));
    if (std::abs(turn) < 0.5) {
      if (glm::dot(direction(from[0]), direction(to[0])) < 0.0) return;
      for (size_t k = 0; k < std::min(from.size(), to.size()); ++k)
        add_turn(junction, street, from[k], to[k]);
    } else if (turn < 0.0) {
      add_turn(junction, street, from.front(), to.front());
    } else {
      add_turn(junction, street, from.back(), to.back());
    }
  }

  /// Where a street ends at the model's edge, its outermost lane goes on in a loop beyond the edge, which
  /// leads back onto the street's other side. Whoever leaves the model comes back, and nobody appears within.
  void add_loops(const StreetLanes& street) {
    for (const int out : {0, 1}) {
      if (street.junctions[1 - out] >= 0) continue;
      const uint32_t from = street.sides[out].front(), to = street.sides[1 - out].front();
      const bool avenue = street.sides[out].size() > 1;
      StreetLane loop;
      loop.width_m = avenue ? 12.0 : network_.lanes[from].width_m;  // room for the front of a bus that turns
      loop.speed_mps = network_.lanes[from].speed_mps;
      loop.next = {to};
      for (const dvec2& point : loop_line(end(from), start(to), direction(from), avenue ? 10.0 : 7.0))
        loop.line.emplace_back(point, 0.0);
      network_.lanes[from].stop_m = 0.0;
      network_.lanes[from].next.push_back(static_cast<uint32_t>(network_.lanes.size()));
      network_.lanes.push_back(std::move(loop));
    }
  }

  void add_turn(int junction, const StreetLanes& street, uint32_t from, uint32_t to) {
    StreetLane turn;
    turn.junction = static_cast<uint32_t>(junction);
    turn.group = group_of(street.northwards);
    turn.width_m = std::min(network_.lanes[from].width_m, network_.lanes[to].width_m);
    turn.speed_mps = std::min(network_.lanes[from].speed_mps, network_.lanes[to].speed_mps);
    turn.next = {to};
    for (const dvec2& point : turn_line(end(from), direction(from), start(to), direction(to)))
      turn.line.emplace_back(point, 0.0);
    network_.lanes[from].next.push_back(static_cast<uint32_t>(network_.lanes.size()));
    network_.lanes.push_back(std::move(turn));
  }

  const CityPlan& plan_;
  StreetNetwork network_;
  std::vector<StreetLanes> streets_;
};

}  // namespace

EdgeEnd edge_end(const CityPlan& plan, const Block& block, int edge, bool start) {
  const int corner = (edge + (start ? 0 : 1)) % 4;
  const bool east = corner == 1 || corner == 2, north = corner >= 2, northwards = edge % 2 == 1;
  const int n = plan.blocks, i = block.column + (east ? 1 : 0), j = block.row + (north ? 1 : 0);
  EdgeEnd end;
  end.group = group_of(northwards);
  if (const int junction = junction_number(plan, i, j); junction >= 0 && signals_at(plan, i, j))
    end.junction = static_cast<uint32_t>(junction);
  // The streets that run north come first (CityPlan).
  const int street = northwards ? (i - 1) * n + block.row : (n - 1) * n + (j - 1) * n + block.column;
  end.zebra = plan.streets[static_cast<size_t>(street)].crossing[(northwards ? north : east) ? 1 : 0];
  return end;
}

StreetNetwork city_network(const CityPlan& plan) { return NetworkMaker(plan).make(); }

}  // namespace greatx::scene::generator
