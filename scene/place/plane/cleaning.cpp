// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/plane/cleaning.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "scene/place/plane/cells.h"
#include "scene/place/plane/noding.h"

namespace greatx::scene::place {

namespace {

constexpr int most_rounds = 6;

void drop_repeated(Edges& edges) {
  for (auto& edge : edges)
    if (edge[1] < edge[0]) std::swap(edge[0], edge[1]);
  std::erase_if(edges, [](const auto& edge) { return edge[0] == edge[1]; });
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

/// The corners of edges, ascending, and how many edges each has.
struct Corners {
  std::vector<GridPoint> points;
  std::vector<uint32_t> degree;
  explicit Corners(const Edges& edges) {
    for (const auto& edge : edges) points.insert(points.end(), edge.begin(), edge.end());
    std::sort(points.begin(), points.end());
    for (size_t i = 0; i < points.size();) {
      size_t end = i;
      while (end < points.size() && points[end] == points[i]) ++end;
      degree.push_back(static_cast<uint32_t>(end - i));
      i = end;
    }
    points.erase(std::unique(points.begin(), points.end()), points.end());
  }
};

/// Moves every corner to one with more edges within the distance, if there is one.
bool weld_corners(Edges& edges, double distance_m) {
  const Corners corners(edges);
  std::vector<uint32_t> order(corners.points.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return corners.degree[a] > corners.degree[b]; });
  Cells kept(1.0);
  std::map<GridPoint, GridPoint> moved;
  for (const uint32_t i : order) {
    const dvec2 p = to_metres(corners.points[i]);
    double least = distance_m;
    uint32_t best = i;
    kept.near(p - distance_m, p + distance_m, [&](uint32_t other) {
      const double off = glm::distance(p, to_metres(corners.points[other]));
      if (off < least || (off == least && best != i && other < best)) {
        least = off;
        best = other;
      }
    });
    if (best == i)
      kept.add(p, p, i);
    else
      moved[corners.points[i]] = corners.points[best];
  }
  if (moved.empty()) return false;
  for (auto& edge : edges)
    for (GridPoint& p : edge)
      if (const auto found = moved.find(p); found != moved.end()) p = found->second;
  drop_repeated(edges);
  return true;
}

/// Leads every edge through the corners that it passes within the distance.
bool weld_edges(Edges& edges, double distance_m) {
  const Corners corners(edges);
  Cells cells(4.0);
  for (uint32_t i = 0; i < corners.points.size(); ++i) {
    const dvec2 p = to_metres(corners.points[i]);
    cells.add(p, p, i);
  }
  Edges result;
  bool changed = false;
  for (const auto& edge : edges) {
    const dvec2 a = to_metres(edge[0]), b = to_metres(edge[1]);
    const double length = glm::distance(a, b);
    const dvec2 along = (b - a) / length;
    std::vector<std::pair<double, uint32_t>> between;
    cells.near(glm::min(a, b) - distance_m, glm::max(a, b) + distance_m, [&](uint32_t i) {
      if (corners.points[i] == edge[0] || corners.points[i] == edge[1]) return;
      const dvec2 q = to_metres(corners.points[i]) - a;
      const double at = glm::dot(q, along), off = std::abs(along.x * q.y - along.y * q.x);
      if (at > 0.0 && at < length && off < distance_m) between.emplace_back(at, i);
    });
    std::sort(between.begin(), between.end());
    GridPoint last = edge[0];
    for (const auto& [at, i] : between) {
      result.push_back({last, corners.points[i]});
      last = corners.points[i];
      changed = true;
    }
    result.push_back({last, edge[1]});
  }
  edges = std::move(result);
  drop_repeated(edges);
  return changed;
}

/// Keeps the corners of a chain that a line within the tolerance needs (Douglas and Peucker).
void keep_needed(const std::vector<GridPoint>& chain, size_t first, size_t last, double tolerance_m,
                 std::vector<bool>& keep) {
  keep[first] = keep[last] = true;
  if (last < first + 2) return;
  const dvec2 a = to_metres(chain[first]), b = to_metres(chain[last]);
  const double length = glm::distance(a, b);
  double worst = tolerance_m;
  size_t which = 0;
  for (size_t i = first + 1; i < last; ++i) {
    const dvec2 q = to_metres(chain[i]) - a;
    const double at = length > 0.0 ? std::clamp(glm::dot(q, b - a) / (length * length), 0.0, 1.0) : 0.0;
    if (const double off = glm::length(q - (b - a) * at); off > worst) {
      worst = off;
      which = i;
    }
  }
  if (which == 0) return;
  keep_needed(chain, first, which, tolerance_m, keep);
  keep_needed(chain, which, last, tolerance_m, keep);
}

bool straighten(Edges& edges, double tolerance_m) {
  std::map<GridPoint, std::vector<GridPoint>> neighbours;
  for (const auto& edge : edges) {
    neighbours[edge[0]].push_back(edge[1]);
    neighbours[edge[1]].push_back(edge[0]);
  }
  std::map<std::array<GridPoint, 2>, bool> done;
  const auto key = [](const GridPoint& a, const GridPoint& b) {
    return std::array{std::min(a, b), std::max(a, b)};
  };
  Edges result;
  bool changed = false;
  const auto finish = [&](const std::vector<GridPoint>& chain) {
    std::vector<bool> keep(chain.size(), false);
    size_t last = chain.size() - 1;
    if (chain.front() == chain.back()) {
      // A ring without a junction: the corner farthest from its first one stays.
      size_t far = 0;
      for (size_t i = 1; i < last; ++i)
        if (glm::distance(to_metres(chain[i]), to_metres(chain[0])) >
            glm::distance(to_metres(chain[far]), to_metres(chain[0])))
          far = i;
      keep_needed(chain, 0, far, tolerance_m, keep);
      keep_needed(chain, far, last, tolerance_m, keep);
      // A ring of two corners has no area; it stays as it is.
      if (std::count(keep.begin(), keep.end(), true) < 4) std::fill(keep.begin(), keep.end(), true);
    } else {
      keep_needed(chain, 0, last, tolerance_m, keep);
    }
    GridPoint before = chain.front();
    for (size_t i = 1; i < chain.size(); ++i) {
      if (!keep[i]) {
        changed = true;
        continue;
      }
      result.push_back({before, chain[i]});
      before = chain[i];
    }
  };
  const auto walk = [&](const GridPoint& start, const GridPoint& next) {
    if (done[key(start, next)]) return;
    std::vector<GridPoint> chain{start, next};
    done[key(start, next)] = true;
    while (neighbours[chain.back()].size() == 2 && chain.back() != start) {
      const auto& options = neighbours[chain.back()];
      const GridPoint on = options[0] == chain[chain.size() - 2] ? options[1] : options[0];
      done[key(chain.back(), on)] = true;
      chain.push_back(on);
    }
    finish(chain);
  };
  for (const auto& [p, others] : neighbours)
    if (others.size() != 2)
      for (const GridPoint& other : others) walk(p, other);
  for (const auto& [p, others] : neighbours)
    for (const GridPoint& other : others) walk(p, other);  // rings that no other line meets
  edges = std::move(result);
  drop_repeated(edges);
  return changed;
}

Edges noded_again(const Edges& edges, double grid_m) {
  std::vector<Segment> segments;
  for (const auto& edge : edges) segments.push_back({to_metres(edge[0]), to_metres(edge[1])});
  return node(segments, grid_m);
}

}  // namespace

Edges cleaned(Edges edges, const CleaningOptions& options) {
  for (int round = 0; round < most_rounds; ++round) {
    bool changed = options.weld_m > 0.0 && weld_corners(edges, options.weld_m);
    changed = (options.weld_m > 0.0 && weld_edges(edges, options.weld_m)) || changed;
    changed = (options.straighten_m > 0.0 && straighten(edges, options.straighten_m)) || changed;
    if (!changed) break;
    edges = noded_again(edges, options.grid_m);
  }
  return edges;
}

double largest_distance(const std::vector<dvec2>& points, const Edges& edges, double most_m) {
  Cells cells(4.0);
  for (uint32_t i = 0; i < edges.size(); ++i) {
    const dvec2 a = to_metres(edges[i][0]), b = to_metres(edges[i][1]);
    cells.add(glm::min(a, b), glm::max(a, b), i);
  }
  double largest = 0.0;
  for (const dvec2& p : points) {
    double least = most_m;
    cells.near(p - most_m, p + most_m, [&](uint32_t i) {
      const dvec2 a = to_metres(edges[i][0]), along = to_metres(edges[i][1]) - a;
      const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
      least = std::min(least, glm::distance(p, a + along * t));
    });
    largest = std::max(largest, least);
  }
  return largest;
}

}  // namespace greatx::scene::place
