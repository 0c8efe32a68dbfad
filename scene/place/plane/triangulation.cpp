// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/plane/triangulation.h"

#include <algorithm>

#include "core/error.h"

namespace greatx::scene::place {

namespace {

constexpr uint32_t next(uint32_t corner) { return corner == 2 ? 0 : corner + 1; }
constexpr uint32_t previous(uint32_t corner) { return corner == 0 ? 2 : corner - 1; }

}  // namespace

Triangulation::Triangulation(const GridPoint& low, const GridPoint& high) {
  const int64_t most = to_grid(most_extent_m);
  if (high.x <= low.x || high.y <= low.y || high.x - low.x > most || high.y - low.y > most)
    throw_user_error("place: extent: expected up to {} m on each side, found {:.0f} m x {:.0f} m",
                     most_extent_m, to_metres(high.x - low.x), to_metres(high.y - low.y));
  points_ = {low, {high.x, low.y}, high, {low.x, high.y}};
  for (uint32_t i = 0; i < 4; ++i) index_of_.emplace(points_[i], i);
  triangles_ = {{{0, 1, 2}, {none, 1, none}, {true, false, true}},
                {{0, 2, 3}, {none, none, 0}, {true, true, false}}};
  triangle_of_ = {0, 0, 0, 1};
  is_changed_.assign(2, false);
  changed(0);
  changed(1);
}

void Triangulation::changed(uint32_t triangle) {
  if (is_changed_.size() < triangles_.size()) is_changed_.resize(triangles_.size(), false);
  if (is_changed_[triangle]) return;
  is_changed_[triangle] = true;
  changed_.push_back(triangle);
}

std::vector<uint32_t> Triangulation::take_changed() {
  std::vector<uint32_t> result = std::move(changed_);
  changed_.clear();
  for (const uint32_t triangle : result) is_changed_[triangle] = false;
  std::sort(result.begin(), result.end());
  return result;
}

uint32_t Triangulation::find(const GridPoint& point) const { return find(point, last_); }

uint32_t Triangulation::find(const GridPoint& point, uint32_t start) const {
  // The walk leaves a triangle through an edge that has the point on its far side. The side to begin with
  // rotates, because in a triangulation that is not Delaunay everywhere a fixed order could circle.
  uint32_t at = start, turn = 0;
  for (;;) {
    const Triangle& triangle = triangles_[at];
    uint32_t out = none;
    for (uint32_t k = 0; k < 3 && out == none; ++k) {
      const uint32_t side = (k + turn) % 3;
      if (orientation(points_[triangle.corners[next(side)]], points_[triangle.corners[previous(side)]],
                      point) < 0)
        out = side;
    }
    if (out == none) break;
    turn = (turn + 1) % 3;
    at = triangle.across[out];
    GREATX_CHECK(at != none, "point ({}, {}) m lies outside the triangulation", to_metres(point.x),
                 to_metres(point.y));
  }
  last_ = at;
  return at;
}

uint32_t Triangulation::side_towards(uint32_t triangle, uint32_t other) const {
  const auto& across = triangles_[triangle].across;
  return static_cast<uint32_t>(std::find(across.begin(), across.end(), other) - across.begin());
}

void Triangulation::link(uint32_t triangle, uint32_t side, uint32_t other, uint32_t other_side) {
  triangles_[triangle].across[side] = other;
  if (other != none) triangles_[other].across[other_side] = triangle;
}

uint32_t Triangulation::add(const GridPoint& point) {
  const auto [found, is_new] = index_of_.try_emplace(point, static_cast<uint32_t>(points_.size()));
  if (!is_new) return found->second;
  const uint32_t triangle = find(point, last_);
  const uint32_t index = found->second;
  points_.push_back(point);
  triangle_of_.push_back(triangle);
  for (uint32_t side = 0; side < 3; ++side) {
    const auto& corners = triangles_[triangle].corners;
    if (orientation(points_[corners[next(side)]], points_[corners[previous(side)]], point) != 0) continue;
    split_edge(triangle, side, index);
    return index;
  }
  split_triangle(triangle, index);
  return index;
}

std::optional<uint32_t> Triangulation::divide(uint32_t triangle, uint32_t side, const GridPoint& point) {
  const Triangle& near = triangles_[triangle];
  const GridPoint a = points_[near.corners[next(side)]], b = points_[near.corners[previous(side)]];
  const auto turns_left = [&](const GridPoint& from, const GridPoint& to) {
    return orientation(from, to, point) > 0;
  };
  const GridPoint apex = points_[near.corners[side]];
  if (!turns_left(b, apex) || !turns_left(apex, a)) return std::nullopt;
  if (const uint32_t other = near.across[side]; other == none) {
    if (orientation(a, b, point) != 0) return std::nullopt;
  } else {
    const GridPoint far = points_[triangles_[other].corners[side_towards(other, triangle)]];
    if (!turns_left(a, far) || !turns_left(far, b)) return std::nullopt;
  }
  const auto [found, is_new] = index_of_.try_emplace(point, static_cast<uint32_t>(points_.size()));
  if (!is_new) return std::nullopt;
  const uint32_t index = found->second;
  points_.push_back(point);
  triangle_of_.push_back(triangle);
  split_edge(triangle, side, index);
  return index;
}

void Triangulation::split_triangle(uint32_t triangle, uint32_t point) {
  const Triangle old = triangles_[triangle];
  const std::array<uint32_t, 3> parts{triangle, static_cast<uint32_t>(triangles_.size()),
                                      static_cast<uint32_t>(triangles_.size() + 1)};
  std::array<uint32_t, 3> other_sides{};
  for (uint32_t side = 0; side < 3; ++side)
    if (old.across[side] != none) other_sides[side] = side_towards(old.across[side], triangle);
  triangles_.resize(triangles_.size() + 2);
  std::vector<std::array<uint32_t, 2>> doubtful;
  for (uint32_t side = 0; side < 3; ++side) {
    // Part `side` keeps the edge opposite corner `side`; the new point is its corner 0.
    const uint32_t a = old.corners[next(side)], b = old.corners[previous(side)];
    Triangle& part = triangles_[parts[side]];
    part.corners = {point, a, b};
    part.fixed = {old.fixed[side], false, false};
    part.across = {none, parts[next(side)], parts[previous(side)]};
    link(parts[side], 0, old.across[side], other_sides[side]);
    triangle_of_[a] = parts[side];
    changed(parts[side]);
    doubtful.push_back({parts[side], 0});
  }
  triangle_of_[point] = triangle;
  legalise(std::move(doubtful));
}

void Triangulation::split_edge(uint32_t triangle, uint32_t side, uint32_t point) {
  // The edge a-b belongs to `triangle` (apex c) and perhaps to `other` (apex d).
  const Triangle near = triangles_[triangle];
  const uint32_t other = near.across[side];
  const uint32_t c = near.corners[side], a = near.corners[next(side)], b = near.corners[previous(side)];
  const bool fixed = near.fixed[side];
  const uint32_t near_b = static_cast<uint32_t>(triangles_.size());
  triangles_.emplace_back();
  std::vector<std::array<uint32_t, 2>> doubtful;
  // c-a-point takes the place of the old triangle; c-point-b is new.
  const uint32_t out_a = near.across[previous(side)], out_b = near.across[next(side)];
  const uint32_t out_a_side = out_a == none ? 0 : side_towards(out_a, triangle);
  const uint32_t out_b_side = out_b == none ? 0 : side_towards(out_b, triangle);
  triangles_[triangle] = {{point, c, a}, {out_a, none, near_b}, {near.fixed[previous(side)], fixed, false}};
  triangles_[near_b] = {{point, b, c}, {out_b, triangle, none}, {near.fixed[next(side)], false, fixed}};
  link(triangle, 0, out_a, out_a_side);
  link(near_b, 0, out_b, out_b_side);
  triangle_of_[a] = triangle;
  triangle_of_[c] = triangle;
  triangle_of_[b] = near_b;
  triangle_of_[point] = triangle;
  changed(triangle);
  changed(near_b);
  doubtful.push_back({triangle, 0});
  doubtful.push_back({near_b, 0});
  if (other != none) {
    const Triangle far = triangles_[other];
    const uint32_t far_side = static_cast<uint32_t>(
        std::find_if(far.corners.begin(), far.corners.end(), [&](uint32_t v) { return v != a && v != b; }) -
        far.corners.begin());
    const uint32_t d = far.corners[far_side];
    const uint32_t far_a = static_cast<uint32_t>(triangles_.size());
    triangles_.emplace_back();
    // In `far` the edge runs from b to a: corners d, b, a.
    const uint32_t out_da = far.across[next(far_side)], out_db = far.across[previous(far_side)];
    const uint32_t out_da_side = out_da == none ? 0 : side_towards(out_da, other);
    const uint32_t out_db_side = out_db == none ? 0 : side_towards(out_db, other);
    triangles_[other] = {
        {point, d, b}, {out_db, near_b, far_a}, {far.fixed[previous(far_side)], fixed, false}};
    triangles_[far_a] = {{point, a, d}, {out_da, other, triangle}, {far.fixed[next(far_side)], false, fixed}};
    link(other, 0, out_db, out_db_side);
    link(far_a, 0, out_da, out_da_side);
    link(triangle, 1, far_a, 2);
    link(near_b, 2, other, 1);
    triangle_of_[d] = other;
    changed(other);
    changed(far_a);
    doubtful.push_back({other, 0});
    doubtful.push_back({far_a, 0});
  }
  legalise(std::move(doubtful));
}

void Triangulation::flip(uint32_t triangle, uint32_t side) {
  // triangle = (p, a, b) with p opposite the edge; other = (q, b, a). They become (p, a, q) and (p, q, b).
  const Triangle near = triangles_[triangle];
  const uint32_t other = near.across[side];
  const Triangle far = triangles_[other];
  const uint32_t far_side = side_towards(other, triangle);
  const uint32_t p = near.corners[side], a = near.corners[next(side)], b = near.corners[previous(side)],
                 q = far.corners[far_side];
  const uint32_t pa = near.across[previous(side)], bp = near.across[next(side)],
                 aq = far.across[next(far_side)], qb = far.across[previous(far_side)];
  const uint32_t bp_side = bp == none ? 0 : side_towards(bp, triangle);
  const uint32_t aq_side = aq == none ? 0 : side_towards(aq, other);
  triangles_[triangle] = {
      {p, a, q}, {aq, other, pa}, {far.fixed[next(far_side)], false, near.fixed[previous(side)]}};
  triangles_[other] = {
      {p, q, b}, {qb, bp, triangle}, {far.fixed[previous(far_side)], near.fixed[next(side)], false}};
  link(triangle, 0, aq, aq_side);
  link(other, 1, bp, bp_side);
  triangle_of_[p] = triangle;
  triangle_of_[a] = triangle;
  triangle_of_[q] = other;
  triangle_of_[b] = other;
  changed(triangle);
  changed(other);
}

void Triangulation::legalise(std::vector<std::array<uint32_t, 2>> edges) {
  while (!edges.empty()) {
    const auto [triangle, side] = edges.back();
    edges.pop_back();
    const Triangle& near = triangles_[triangle];
    const uint32_t other = near.across[side];
    if (other == none || near.fixed[side]) continue;
    const uint32_t far_side = side_towards(other, triangle);
    const auto& c = near.corners;
    if (!in_circle(points_[c[0]], points_[c[1]], points_[c[2]], points_[triangles_[other].corners[far_side]]))
      continue;
    flip(triangle, side);
    // The four edges around the flipped one may have lost the property.
    edges.push_back({triangle, 0});
    edges.push_back({triangle, 2});
    edges.push_back({other, 0});
    edges.push_back({other, 1});
  }
}

template <typename Visit>
void Triangulation::turn_around(uint32_t corner, const Visit& visit) const {
  // Turns counter-clockwise; if the border of the rectangle stops it, clockwise from the start.
  const uint32_t first = triangle_of_[corner];
  for (const bool forwards : {true, false}) {
    uint32_t at = first;
    do {
      const Triangle& triangle = triangles_[at];
      const uint32_t k = static_cast<uint32_t>(
          std::find(triangle.corners.begin(), triangle.corners.end(), corner) - triangle.corners.begin());
      if (visit(at, k)) return;
      at = triangle.across[forwards ? next(k) : previous(k)];
    } while (at != none && at != first);
    if (at == first) return;
  }
}

std::optional<Triangulation::Side> Triangulation::side_between(uint32_t a, uint32_t b) const {
  std::optional<Side> found;
  turn_around(a, [&](uint32_t at, uint32_t k) {
    if (triangles_[at].corners[next(k)] == b) found = Side{at, previous(k)};
    if (triangles_[at].corners[previous(k)] == b) found = Side{at, next(k)};
    return found.has_value();
  });
  return found;
}

void Triangulation::force(uint32_t from, uint32_t to) {
  while (from != to) from = force_step(from, to);
}

void Triangulation::fix(const Side& edge) {
  triangles_[edge.triangle].fixed[edge.side] = true;
  const uint32_t other = triangles_[edge.triangle].across[edge.side];
  if (other != none) triangles_[other].fixed[side_towards(other, edge.triangle)] = true;
}

/// Forces the edge from `from` up to the first point on the line, and returns that point.
uint32_t Triangulation::force_step(uint32_t from, uint32_t to) {
  // The triangle at `from` through which the line leaves.
  Side out{none, 0};
  turn_around(from, [&](uint32_t at, uint32_t k) {
    const auto& corners = triangles_[at].corners;
    if (orientation(points_[from], points_[corners[next(k)]], points_[to]) < 0 ||
        orientation(points_[from], points_[to], points_[corners[previous(k)]]) < 0)
      return false;
    out = {at, k};
    return true;
  });
  GREATX_CHECK(out.triangle != none, "no triangle of point {} lies towards point {}", from, to);
  for (const uint32_t k : {next(out.side), previous(out.side)}) {
    const uint32_t corner = triangles_[out.triangle].corners[k];
    if (corner != to && orientation(points_[from], points_[to], points_[corner]) != 0) continue;
    fix({out.triangle, 3 - out.side - k});  // the line runs along an edge
    return corner;
  }
  const auto [end, crossed] = edges_across(out, from, to);
  restore(clear(crossed, from, end), from, end);
  fix(*side_between(from, end));
  return end;
}

std::pair<uint32_t, std::vector<Triangulation::Ends>> Triangulation::edges_across(Side out, uint32_t from,
                                                                                  uint32_t to) const {
  std::vector<Ends> crossed;
  for (;;) {
    const Triangle& triangle = triangles_[out.triangle];
    if (triangle.fixed[out.side])
      throw_user_error("place: outlines cross near ({:.3f}, {:.3f}) m", to_metres(points_[from].x),
                       to_metres(points_[from].y));
    crossed.push_back({triangle.corners[previous(out.side)], triangle.corners[next(out.side)]});
    const uint32_t other = triangle.across[out.side], apex_side = side_towards(other, out.triangle);
    const uint32_t apex = triangles_[other].corners[apex_side];
    const int64_t turn = orientation(points_[from], points_[to], points_[apex]);
    if (apex == to || turn == 0) return {apex, crossed};
    // The ends of the crossed edge follow the apex: first the one on the left of the line. If the apex is on
    // the left, too, the line leaves between the apex and the right end, opposite the left one.
    out = {other, turn > 0 ? next(apex_side) : previous(apex_side)};
  }
}

/// Flips edges until none crosses the line, and returns the edges that this made.
std::vector<Triangulation::Ends> Triangulation::clear(std::vector<Ends> crossed, uint32_t from, uint32_t to) {
  std::vector<Ends> made;
  for (size_t head = 0; head < crossed.size(); ++head) {
    const Ends ends = crossed[head];
    const Side edge = *side_between(ends[0], ends[1]);
    const auto [p, a, b, q] = around(edge);
    if (orientation(points_[p], points_[a], points_[q]) <= 0 ||
        orientation(points_[p], points_[q], points_[b]) <= 0) {
      crossed.push_back(ends);  // the two triangles are not convex together yet
      continue;
    }
    flip(edge.triangle, edge.side);
    const int64_t p_turn = orientation(points_[from], points_[to], points_[p]),
                  q_turn = orientation(points_[from], points_[to], points_[q]);
    const bool crosses = (p_turn > 0 && q_turn < 0) || (p_turn < 0 && q_turn > 0);
    (crosses ? crossed : made).push_back({p, q});
  }
  return made;
}

/// Flips the edges that are not Delaunay, except the one that is being forced.
void Triangulation::restore(std::vector<Ends> edges, uint32_t from, uint32_t to) {
  for (bool flipped = true; flipped;) {
    flipped = false;
    for (Ends& ends : edges) {
      if ((ends[0] == from && ends[1] == to) || (ends[0] == to && ends[1] == from)) continue;
      const std::optional<Side> edge = side_between(ends[0], ends[1]);
      if (!edge || triangles_[edge->triangle].fixed[edge->side] ||
          triangles_[edge->triangle].across[edge->side] == none)
        continue;
      const auto [p, a, b, q] = around(*edge);
      if (!in_circle(points_[p], points_[a], points_[b], points_[q])) continue;
      flip(edge->triangle, edge->side);
      ends = {p, q};
      flipped = true;
    }
  }
}

std::array<uint32_t, 4> Triangulation::around(const Side& edge) const {
  const Triangle& near = triangles_[edge.triangle];
  const uint32_t other = near.across[edge.side];
  return {near.corners[edge.side], near.corners[next(edge.side)], near.corners[previous(edge.side)],
          triangles_[other].corners[side_towards(other, edge.triangle)]};
}

std::vector<uint32_t> Triangulation::regions(uint32_t* count) const {
  std::vector<uint32_t> region(triangles_.size(), none), stack;
  uint32_t regions = 0;
  for (uint32_t seed = 0; seed < triangles_.size(); ++seed) {
    if (region[seed] != none) continue;
    region[seed] = regions;
    stack.push_back(seed);
    while (!stack.empty()) {
      const Triangle& triangle = triangles_[stack.back()];
      stack.pop_back();
      for (uint32_t side = 0; side < 3; ++side) {
        const uint32_t other = triangle.across[side];
        if (triangle.fixed[side] || other == none || region[other] != none) continue;
        region[other] = regions;
        stack.push_back(other);
      }
    }
    ++regions;
  }
  if (count) *count = regions;
  return region;
}

}  // namespace greatx::scene::place
