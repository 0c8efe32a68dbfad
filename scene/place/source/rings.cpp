// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/rings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "scene/place/input/area_test.h"

namespace greatx::scene::place {

namespace {

/// A chain under construction: its nodes, and the places in it at which ways meet.
class Chain {
 public:
  void append(const NodeIds& way, bool backwards, std::vector<NodeIds>& closed) {
    NodeIds nodes = way;
    if (backwards) std::ranges::reverse(nodes);
    if (nodes_.empty()) {
      nodes_ = std::move(nodes);
      junctions_ = {0};
    } else {
      junctions_.push_back(nodes_.size() - 1);
      nodes_.insert(nodes_.end(), nodes.begin() + 1, nodes.end());
    }
    close_loop(closed);
  }
  bool empty() const { return nodes_.size() < 2; }
  int64_t end() const { return nodes_.back(); }
  int64_t begin() const { return nodes_.front(); }
  void reverse() {
    std::ranges::reverse(nodes_);
    for (size_t& at : junctions_) at = nodes_.size() - 1 - at;
    std::ranges::reverse(junctions_);
    // The begin of the chain is a junction; its former begin is now its end.
    if (junctions_.empty() || junctions_.front() != 0) junctions_.insert(junctions_.begin(), 0);
    if (junctions_.back() == nodes_.size() - 1) junctions_.pop_back();
  }
  NodeIds nodes() const { return nodes_; }

 private:
  void close_loop(std::vector<NodeIds>& closed) {
    for (size_t i = junctions_.size(); i-- > 0;) {
      if (nodes_[junctions_[i]] != nodes_.back()) continue;
      const auto first = nodes_.begin() + static_cast<std::ptrdiff_t>(junctions_[i]);
      closed.emplace_back(first, nodes_.end() - 1);
      nodes_.erase(first + 1, nodes_.end());
      junctions_.resize(i);
      if (junctions_.empty()) junctions_ = {0};
      return;
    }
  }
  NodeIds nodes_;
  std::vector<size_t> junctions_;
};

/// The ways that are left, by the nodes at their ends.
class LooseEnds {
 public:
  explicit LooseEnds(std::span<const NodeIds> ways) : ways_(ways), used_(ways.size(), false) {
    for (size_t i = 0; i < ways.size(); ++i) {
      if (ways[i].size() < 2) {
        used_[i] = true;
        continue;
      }
      at_[ways[i].front()].push_back(i);
      at_[ways[i].back()].push_back(i);
    }
  }
  std::optional<size_t> take_first() {
    while (first_ < ways_.size() && used_[first_]) ++first_;
    if (first_ == ways_.size()) return std::nullopt;
    used_[first_] = true;
    return first_;
  }
  std::optional<size_t> take_at(int64_t node) {
    const auto found = at_.find(node);
    if (found == at_.end()) return std::nullopt;
    for (const size_t way : found->second)
      if (!used_[way]) {
        used_[way] = true;
        return way;
      }
    return std::nullopt;
  }

 private:
  std::span<const NodeIds> ways_;
  std::vector<bool> used_;
  std::map<int64_t, std::vector<size_t>> at_;
  size_t first_ = 0;
};

double area_of(const Ring& ring) {
  double twice = 0.0;
  for (size_t i = 0, before = ring.size() - 1; i < ring.size(); before = i++)
    twice += ring[before].x * ring[i].y - ring[before].y * ring[i].x;
  return std::abs(twice) / 2.0;
}

}  // namespace

JoinedRings join_ways(std::span<const NodeIds> ways) {
  JoinedRings joined;
  LooseEnds left(ways);
  while (const auto first = left.take_first()) {
    Chain chain;
    chain.append(ways[*first], false, joined.closed);
    for (int end = 0; end < 2 && !chain.empty(); ++end) {
      while (!chain.empty()) {
        const auto next = left.take_at(chain.end());
        if (!next) break;
        chain.append(ways[*next], ways[*next].front() != chain.end(), joined.closed);
      }
      if (end == 0 && !chain.empty()) chain.reverse();
    }
    if (!chain.empty()) joined.open.push_back(chain.nodes());
  }
  return joined;
}

std::vector<Polygon> nest_rings(std::vector<Ring> outer, std::vector<Ring> inner, std::vector<size_t>& lost) {
  std::vector<Polygon> polygons(outer.size());
  std::vector<double> areas;
  for (size_t i = 0; i < outer.size(); ++i) {
    areas.push_back(area_of(outer[i]));
    polygons[i].outer = std::move(outer[i]);
  }
  for (size_t k = 0; k < inner.size(); ++k) {
    std::optional<size_t> home;
    for (size_t i = 0; i < polygons.size(); ++i) {
      const Polygon shell{polygons[i].outer, {}};
      const auto within = std::ranges::count_if(inner[k], [&](const dvec2& p) { return contains(shell, p); });
      if (2 * static_cast<size_t>(within) > inner[k].size() && (!home || areas[i] < areas[*home])) home = i;
    }
    if (home)
      polygons[*home].holes.push_back(std::move(inner[k]));
    else
      lost.push_back(k);
  }
  return polygons;
}

size_t drop_repeated(Ring& ring) {
  const size_t before = ring.size();
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return before - ring.size();
}

size_t distinct_corners(std::span<const dvec2> points) {
  std::vector<dvec2> sorted(points.begin(), points.end());
  const auto less = [](const dvec2& a, const dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
  std::ranges::sort(sorted, less);
  return static_cast<size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
}

}  // namespace greatx::scene::place
