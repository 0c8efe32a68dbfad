// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/city/city_plan.h"

#include <algorithm>
#include <cmath>

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

namespace {

/// The middle line of a street: x = at + tilt y (or y = at + tilt x), or the edge of the model with no width.
struct Line {
  double at = 0.0, tilt = 0.0, half_width = 0.0;
  bool avenue = false;
  double side(double sign) const { return at + sign * half_width * std::sqrt(1.0 + tilt * tilt); }
};

std::vector<Line> make_lines(double half, int blocks, RandomStream& random) {
  const double pitch = 2.0 * half / blocks;
  std::vector<Line> lines{{-half, 0.0, 0.0, false}};
  for (int i = 1; i < blocks; ++i) {
    const bool avenue = i == blocks / 2;
    const double nominal = -half + pitch * i;
    // Tilt and shift move a line by at most a tenth of the pitch together, so that neighbours never meet.
    const double tilt = random.uniform(-0.03, 0.03);
    const double shift = random.uniform(-0.08, 0.08) * pitch;
    lines.push_back({avenue ? 0.0 : nominal + shift, avenue ? 0.3 * tilt : tilt * std::min(1.0, 150.0 / half),
                     avenue ? 7.0 : random.uniform(3.9, 4.8), avenue});
  }
  lines.push_back({half, 0.0, 0.0, false});
  return lines;
}

/// Returns the point where x = a + t y meets y = b + s x.
dvec2 meet(double a, double t, double b, double s) {
  const double x = (a + t * b) / (1.0 - t * s);
  return snap(dvec2(x, b + s * x));
}

/// Rounds a corner with a quadratic Bezier curve from `radius` before the corner to `radius` after it.
std::vector<dvec2> rounded(const dvec2& before, const dvec2& corner, const dvec2& after, double radius) {
  const dvec2 start = corner + radius * glm::normalize(before - corner);
  const dvec2 end = corner + radius * glm::normalize(after - corner);
  std::vector<dvec2> points;
  for (const double t : {0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0})
    points.push_back(snap((1 - t) * (1 - t) * start + 2 * t * (1 - t) * corner + t * t * end));
  return points;
}

Block make_block(const std::vector<Line>& across, const std::vector<Line>& along, int column, int row) {
  const size_t c = static_cast<size_t>(column), r = static_cast<size_t>(row);
  const Line &west = across[c], &east = across[c + 1], &south = along[r], &north = along[r + 1];
  Block block{.column = column, .row = row, .street = {}, .pavement_m = {}, .sharp = {}, .corners = {}};
  block.sharp = {meet(west.side(1), west.tilt, south.side(1), south.tilt),
                 meet(east.side(-1), east.tilt, south.side(1), south.tilt),
                 meet(east.side(-1), east.tilt, north.side(-1), north.tilt),
                 meet(west.side(1), west.tilt, north.side(-1), north.tilt)};
  const std::array<const Line*, 4> edges{&south, &east, &north, &west};
  for (size_t i = 0; i < 4; ++i) {
    block.street[i] = edges[i]->half_width > 0.0;
    block.pavement_m[i] = edges[i]->avenue ? 4.0 : edges[i]->half_width > 0.0 ? 3.0 : 2.0;
  }
  for (size_t i = 0; i < 4; ++i) {
    const bool both = block.street[i] && block.street[(i + 3) % 4];
    block.corners[i] = both ? rounded(block.sharp[(i + 3) % 4], block.sharp[i], block.sharp[(i + 1) % 4], 6.0)
                            : std::vector<dvec2>{block.sharp[i]};
  }
  return block;
}

std::vector<dvec2> junction_outline(const CityPlan& plan, int i, int j) {
  // The outline is counter-clockwise around the junction and hence clockwise around the corner of each block.
  std::vector<dvec2> outline;
  const auto add = [&](const Block& block, size_t corner) {
    const std::vector<dvec2>& arc = block.corners[corner];
    outline.insert(outline.end(), arc.rbegin(), arc.rend());
  };
  add(plan.at(i - 1, j - 1), 2);
  add(plan.at(i, j - 1), 3);
  add(plan.at(i, j), 0);
  add(plan.at(i - 1, j), 1);
  return outline;
}

}  // namespace

std::vector<dvec2> Block::outline() const {
  std::vector<dvec2> points;
  for (const auto& corner : corners) points.insert(points.end(), corner.begin(), corner.end());
  return points;
}

std::vector<double> Block::outline_insets() const {
  std::vector<double> widths;
  for (size_t i = 0; i < 4; ++i) {
    // The edges of the arc take a width between those of the two sides. The last point starts edge i.
    for (size_t k = 0; k + 1 < corners[i].size(); ++k) {
      const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(corners[i].size() - 1);
      widths.push_back((1.0 - t) * pavement_m[(i + 3) % 4] + t * pavement_m[i]);
    }
    widths.push_back(pavement_m[i]);
  }
  return widths;
}

CityPlan plan_city(double size_m, uint64_t seed) {
  RandomStream random(seed, 1);
  CityPlan plan;
  plan.half_m = snap(0.5 * size_m);
  plan.blocks = 2 * std::max(1, static_cast<int>(std::lround(size_m / 150.0)));
  const std::vector<Line> across = make_lines(plan.half_m, plan.blocks, random);
  const std::vector<Line> along = make_lines(plan.half_m, plan.blocks, random);
  const int n = plan.blocks;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) plan.block.push_back(make_block(across, along, column, row));

  for (int i = 1; i < n; ++i)
    for (int row = 0; row < n; ++row) {  // northwards
      const Block &west = plan.at(i - 1, row), &east = plan.at(i, row);
      plan.streets.push_back({{west.edge_start(1), west.edge_end(1)},
                              {east.edge_end(3), east.edge_start(3)},
                              across[static_cast<size_t>(i)].avenue,
                              {row > 0, row + 1 < n},
                              {}});
    }
  for (int j = 1; j < n; ++j)
    for (int column = 0; column < n; ++column) {  // eastwards
      const Block &south = plan.at(column, j - 1), &north = plan.at(column, j);
      plan.streets.push_back({{north.edge_start(0), north.edge_end(0)},
                              {south.edge_end(2), south.edge_start(2)},
                              along[static_cast<size_t>(j)].avenue,
                              {column > 0, column + 1 < n},
                              {}});
    }
  RandomStream crossings(seed, 2);
  for (Street& street : plan.streets)
    for (const int end : {0, 1})
      street.crossing[end] = street.junction[end] && (street.avenue || crossings.uniform() >= 0.5);
  for (int i = 1; i < n; ++i)
    for (int j = 1; j < n; ++j) plan.junctions.push_back(junction_outline(plan, i, j));
  return plan;
}

}  // namespace greatx::scene::generator
