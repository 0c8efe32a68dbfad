// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Divides a footprint with right angles into wings.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "scene/place/buildings/roofs.h"

namespace greatx::scene::place {

namespace {

constexpr double narrowest_m = 2.0;  // a wing is at least this wide
constexpr size_t most_edges = 24;

/// Returns ascending positions with those nearer than same_line_m merged into their mean.
std::vector<double> lines_of(std::vector<double> positions) {
  std::sort(positions.begin(), positions.end());
  std::vector<double> lines;
  for (size_t i = 0; i < positions.size();) {
    size_t end = i;
    double sum = 0.0;
    while (end < positions.size() && positions[end] - positions[i] < same_line_m) sum += positions[end++];
    lines.push_back(sum / static_cast<double>(end - i));
    i = end;
  }
  return lines;
}

/// WingCells between the lines, and which of them lie in the footprint.
struct WingCells {
  std::vector<double> u, v;
  std::vector<bool> in;
  bool at(size_t i, size_t j) const { return in[j * (u.size() - 1) + i]; }
};

/// A rectangle of cells, [i0, i1) x [j0, j1).
using Block = std::array<size_t, 4>;

std::vector<Block> largest_blocks(const WingCells& cells) {
  const size_t columns = cells.u.size() - 1, rows = cells.v.size() - 1;
  std::vector<Block> blocks;
  for (size_t j0 = 0; j0 < rows; ++j0)
    for (size_t i0 = 0; i0 < columns; ++i0) {
      size_t reach = columns;
      for (size_t j1 = j0; j1 < rows && reach > i0; ++j1) {
        size_t i1 = i0;
        while (i1 < reach && cells.at(i1, j1)) ++i1;
        reach = i1;
        if (reach > i0) blocks.push_back({i0, reach, j0, j1 + 1});
      }
    }
  return blocks;
}

}  // namespace

std::vector<Rectangle> wings(const Polygon& footprint) {
  const Ring& ring = footprint.outer;
  size_t edges = ring.size();
  for (const Ring& hole : footprint.holes) edges += hole.size();
  if (edges > most_edges) return {};
  const Rectangle frame = smallest_rectangle(ring);
  const dvec2 across(-frame.along.y, frame.along.x);
  std::vector<double> u, v;
  double askew = 0.0, total = 0.0;
  const auto visit = [&](const Ring& corners) {
    for (size_t i = 0; i < corners.size(); ++i) {
      const dvec2 edge = corners[(i + 1) % corners.size()] - corners[i];
      const double length = glm::length(edge), x = std::abs(glm::dot(edge, frame.along)),
                   y = std::abs(glm::dot(edge, across));
      total += length;
      if (std::min(x, y) > std::sin(radians(8.0)) * length) askew += length;
      u.push_back(glm::dot(corners[i] - frame.center, frame.along));
      v.push_back(glm::dot(corners[i] - frame.center, across));
    }
  };
  visit(ring);
  for (const Ring& hole : footprint.holes) visit(hole);
  if (askew > 0.05 * total) return {};
  WingCells cells{lines_of(u), lines_of(v), {}};
  if (cells.u.size() < 2 || cells.v.size() < 2) return {};
  for (size_t j = 0; j + 1 < cells.v.size(); ++j)
    for (size_t i = 0; i + 1 < cells.u.size(); ++i)
      cells.in.push_back(contains(footprint, frame.center +
                                                 frame.along * (0.5 * (cells.u[i] + cells.u[i + 1])) +
                                                 across * (0.5 * (cells.v[j] + cells.v[j + 1]))));
  std::vector<Block> blocks = largest_blocks(cells);
  const auto size = [&](const Block& b) {
    return dvec2(cells.u[b[1]] - cells.u[b[0]], cells.v[b[3]] - cells.v[b[2]]);
  };
  std::stable_sort(blocks.begin(), blocks.end(), [&](const Block& a, const Block& b) {
    return size(a).x * size(a).y > size(b).x * size(b).y + 1e-9;
  });
  std::vector<Rectangle> found;
  std::vector<bool> covered(cells.in.size(), false);
  for (const Block& b : blocks) {
    bool adds = false;
    for (size_t j = b[2]; j < b[3]; ++j)
      for (size_t i = b[0]; i < b[1]; ++i) adds = adds || !covered[j * (cells.u.size() - 1) + i];
    if (!adds || std::min(size(b).x, size(b).y) < narrowest_m) continue;
    for (size_t j = b[2]; j < b[3]; ++j)
      for (size_t i = b[0]; i < b[1]; ++i) covered[j * (cells.u.size() - 1) + i] = true;
    const dvec2 center = frame.center + frame.along * (0.5 * (cells.u[b[0]] + cells.u[b[1]])) +
                         across * (0.5 * (cells.v[b[2]] + cells.v[b[3]]));
    const dvec2 half = 0.5 * size(b);
    found.push_back(half.x >= half.y ? Rectangle{center, frame.along, half}
                                     : Rectangle{center, across, {half.y, half.x}});
  }
  return found;
}

}  // namespace greatx::scene::place
