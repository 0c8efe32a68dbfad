// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/geometry/geometry.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/watch.h"

namespace greatx::rf {
namespace {

constexpr double shortest_line_of_sight_m = 1e-9;

/// Tells whether a path may meet the edge between two facets, where it touches both at one point. Such a path
/// exists (as the limit of paths beside it) only if each facet lies on the reflecting side of the other: in
/// the corner of a room and not at the corner of a house, and never for two facets of one plane.
bool joins_as_corner(const PosedFacet& a, double side_a, const PosedFacet& b, double side_b) {
  return side_a * a.distance(b.centroid) > a.tolerance_m && side_b * b.distance(a.centroid) > b.tolerance_m;
}

bool same_polyline(const GeometricPath& a, const GeometricPath& b) {
  const double tolerance = std::max(1e-6, 1e-9 * a.length_m);
  if (a.vertices.size() != b.vertices.size() || std::abs(a.length_m - b.length_m) > tolerance) return false;
  for (size_t i = 0; i < a.vertices.size(); ++i)
    if (glm::length(a.vertices[i] - b.vertices[i]) > tolerance) return false;
  return true;
}

bool lexicographically_less(const dvec3& a, const dvec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Gives numbers to (parent, facet) pairs in the order in which they first appear. A search has hundreds of
/// thousands of them, and a table without an allocation for each takes a third of std::unordered_map's time.
class ChildTable {
 public:
  explicit ChildTable(size_t expected) : slots_(std::bit_ceil(2 * std::max<size_t>(expected, 8))) {}
  /// Returns the number of a pair, and whether it is new.
  std::pair<uint32_t, bool> number_of(uint32_t parent, uint32_t facet) {
    if (2 * (held_ + size_t{1}) > slots_.size()) grow();
    Slot& slot = place_of(parent, facet);
    const bool is_new = slot.number == free;
    if (is_new) slot = {parent, facet, held_++};
    return {slot.number, is_new};
  }

 private:
  static constexpr uint32_t free = ~0u;
  struct Slot {
    uint32_t parent = 0, facet = 0, number = free;
  };
  Slot& place_of(uint32_t parent, uint32_t facet) {
    // Multiplicative hashing (Knuth, The Art of Computer Programming, vol. 3, section 6.4).
    const uint64_t mixed = ((uint64_t{parent} << 32) | facet) * 0x9e3779b97f4a7c15u;
    for (size_t at = (mixed ^ mixed >> 32) & (slots_.size() - 1);; at = (at + 1) & (slots_.size() - 1)) {
      Slot& slot = slots_[at];
      if (slot.number == free || (slot.parent == parent && slot.facet == facet)) return slot;
    }
  }
  void grow() {
    std::vector<Slot> before(2 * slots_.size());
    before.swap(slots_);
    for (const Slot& slot : before)
      if (slot.number != free) place_of(slot.parent, slot.facet) = slot;
  }

  std::vector<Slot> slots_;
  uint32_t held_ = 0;
};

}  // namespace

void keep_distinct(std::vector<GeometricPath>& paths) {
  const auto less = [](const GeometricPath& a, const GeometricPath& b) {
    return interactions_less(a.interactions, b.interactions);
  };
  const auto less_backwards = [](const GeometricPath& a, const GeometricPath& b) {
    return interactions_less(std::vector(a.interactions.rbegin(), a.interactions.rend()),
                             std::vector(b.interactions.rbegin(), b.interactions.rend()));
  };
  std::sort(paths.begin(), paths.end(), less);
  const bool backwards =
      !paths.empty() && lexicographically_less(paths.front().vertices.back(), paths.front().vertices.front());
  bool exchanged = false;
  size_t kept = 0;
  for (size_t i = 0; i < paths.size(); ++i) {
    const auto known = [&](const GeometricPath& other) { return same_polyline(other, paths[i]); };
    const auto end = paths.begin() + static_cast<ptrdiff_t>(kept);
    if (const auto same = std::find_if(paths.begin(), end, known); same != end) {
      if (!backwards || !less_backwards(paths[i], *same)) continue;
      *same = std::move(paths[i]);
      exchanged = true;
      continue;
    }
    if (kept != i) paths[kept] = std::move(paths[i]);
    ++kept;
  }
  paths.resize(kept);
  if (exchanged) std::sort(paths.begin(), paths.end(), less);
}

ImageTree::ImageTree(const FacetWorld& world, const dvec3& source, const CandidateList& candidates,
                     Source end)
    : world_(&world), source_(source), end_(end) {
  GREATX_CHECK(candidates.is_canonical(), "{} candidate sequences are not in canonical order",
               candidates.size());
  build(candidates);
  mirror(source);
  for (size_t i = 0; i < candidates.windows.size(); ++i)
    if (const uint32_t index = node_of_sequence_[i]; index != none) {
      const PlaneWindow& window = candidates.windows[i];
      Node& node = nodes_[index];
      node.min_u = window.min_u, node.max_u = window.max_u, node.min_v = window.min_v,
      node.max_v = window.max_v;
    }
  build_filter();
}

void ImageTree::build(const CandidateList& candidates) {
  ChildTable node_of(candidates.size());
  nodes_.reserve(candidates.size());
  node_of_sequence_.assign(candidates.size(), none);
  for (size_t i = 0; i < candidates.size(); ++i) {
    checkpoint();
    uint32_t node = none;
    for (const uint32_t facet : candidates.sequence(i)) {
      GREATX_CHECK(facet < world_->facet_count(), "candidate {}: facet {} of {}", i, facet,
                   world_->facet_count());
      const auto [number, is_new] = node_of.number_of(node, facet);
      if (is_new) {
        nodes_.push_back({.slot = facet, .parent = node, .depth = node == none ? 1 : nodes_[node].depth + 1});
        used_facets_.push_back(facet);
      }
      node = number;
    }
    node_of_sequence_[i] = node;
    if (node == none)
      line_of_sight_ = true;
    else
      nodes_[node].candidate = true;
  }
  std::sort(used_facets_.begin(), used_facets_.end());
  used_facets_.erase(std::unique(used_facets_.begin(), used_facets_.end()), used_facets_.end());
  for (Node& node : nodes_)
    node.slot =
        static_cast<uint32_t>(std::ranges::lower_bound(used_facets_, node.slot) - used_facets_.begin());
  images_.resize(nodes_.size());
}

void ImageTree::update(const dvec3& source) {
  mirror(source);
  build_filter();
}

void ImageTree::mirror(const dvec3& source) {
  source_ = source;
  copy_planes();
  for (size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    const PosedFacet& facet = world_->facet(used_facets_[node.slot]);
    const dvec3 before = node.parent == none ? source_ : images_[node.parent];
    const double distance = facet.distance(before);
    images_[i] = before - 2.0 * distance * facet.normal;
    node.distance = -distance;
    const dvec2 at = facet.plane_coordinates(before);  // mirroring does not change them
    node.u = at.x;
    node.v = at.y;
    node.min_u = facet.min_u, node.max_u = facet.max_u, node.min_v = facet.min_v, node.max_v = facet.max_v;
  }
}

uint32_t ImageTree::depth(size_t sequence) const {
  const uint32_t node = node_of_sequence_[sequence];
  return node == none ? 0 : nodes_[node].depth;
}

const dvec3& ImageTree::image(size_t sequence) const {
  const uint32_t node = node_of_sequence_[sequence];
  return node == none ? source_ : images_[node];
}

bool ImageTree::reach(size_t sequence, const dvec3& point, GeometricPath& path) const {
  const uint32_t node = node_of_sequence_[sequence];
  if (node == none) return true;
  // The trace runs from the point back to the source, and thus fills the path from its end.
  const size_t interactions = path.interactions.size(), vertices = path.vertices.size();
  size_t left = nodes_[node].depth;
  path.interactions.resize(interactions + left);
  path.vertices.resize(vertices + left);
  const bool reached = trace(node, point, [&](uint32_t facet, const dvec3& hit) {
    --left;
    path.interactions[interactions + left] = {InteractionType::reflection, facet};
    path.vertices[vertices + left] = hit;
  });
  if (reached) return true;
  path.interactions.resize(interactions);
  path.vertices.resize(vertices);
  return false;
}

/// Returns the width by which a node's window exceeds the test of trace(), so that the window loses no path
/// that exists. Roundings of u and v grow with the distance to the image and not with the facet.
double ImageTree::room(const Node& node, double tolerance_m) {
  return 2.0 * tolerance_m + 1e-12 * (std::abs(node.u) + std::abs(node.v));
}

void ImageTree::build_filter() {
  filtered_.clear();
  filtered_.reserve(nodes_.size());
  std::vector<ImageWindow> windows;
  windows.reserve(nodes_.size());
  for (uint32_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    if (!node.candidate) continue;
    const double wider = room(node, world_->facet(used_facets_[node.slot]).tolerance_m);
    filtered_.push_back(i);
    windows.push_back({node.slot, node.distance, node.u, node.v, node.min_u - wider, node.max_u + wider,
                       node.min_v - wider, node.max_v + wider});
  }
  filter_.build(windows, static_cast<uint32_t>(used_facets_.size()));
}

/// Tells whether the straight line from the node's image to the target passes the window of its facet.
bool ImageTree::may_reach(const Node& node, const TargetInFacet& target) const {
  if (node.distance * target.distance >= 0.0) return false;  // the target is behind the mirror
  const double t = node.distance / (node.distance - target.distance);
  const double u = node.u + t * (target.u - node.u), v = node.v + t * (target.v - node.v);
  const double room = ImageTree::room(node, target.tolerance);
  return u >= node.min_u - room && u <= node.max_u + room && v >= node.min_v - room && v <= node.max_v + room;
}

/// Goes from the target back to the source and intersects the line to each image with the facet of that
/// image. Calls visit(facet, point) for each reflection on the way; the calls mean nothing if it returns
/// false.
template <typename Visit>
bool ImageTree::trace(uint32_t leaf, const dvec3& target, const Visit& visit) const {
  const PosedFacet* previous = nullptr;
  double previous_side = 0.0;
  dvec3 from = target;
  for (uint32_t index = leaf; index != none; index = nodes_[index].parent) {
    const Node& node = nodes_[index];
    const uint32_t facet_index = used_facets_[node.slot];
    const PosedFacet& facet = world_->facet(facet_index);
    const double side = node.distance > 0.0 ? -1.0 : 1.0;  // the path is opposite to the image
    const double behind = std::abs(node.distance);
    double before = side * facet.distance(from);
    if (behind <= facet.tolerance_m) return false;
    if (before < (previous ? -facet.tolerance_m : facet.tolerance_m)) return false;
    before = std::max(before, 0.0);
    const dvec3 image = images_[index];
    const dvec3 hit = image + behind / (behind + before) * (from - image);
    if (!world_->contains(facet_index, facet.plane_coordinates(hit))) return false;
    if (previous && glm::length(hit - from) <= 4.0 * (facet.tolerance_m + previous->tolerance_m) &&
        !joins_as_corner(facet, side, *previous, previous_side))
      return false;
    visit(facet_index, hit);
    from = hit;
    previous = &facet;
    previous_side = side;
  }
  return true;
}

ImageTree::TargetInFacet ImageTree::Plane::locate(const dvec3& target) const {
  return {glm::dot(normal, target) - offset, glm::dot(axis_u, target) - offset_u,
          glm::dot(axis_v, target) - offset_v, tolerance_m};
}

void ImageTree::copy_planes() {
  planes_.clear();
  planes_.reserve(used_facets_.size());
  for (const uint32_t index : used_facets_) {
    const PosedFacet& facet = world_->facet(index);
    planes_.push_back({facet.normal, facet.axis_u, facet.axis_v, facet.offset, facet.offset_u, facet.offset_v,
                       facet.tolerance_m});
  }
}

/// Returns the nodes whose image the target would see through the facet if nothing were in between.
std::vector<uint32_t> ImageTree::seen_from(const dvec3& target) const {
  constexpr uint32_t slots_at_once = 256;
  std::vector<uint32_t> indices, nodes;
  for (uint32_t slot = 0; slot < planes_.size(); ++slot) {
    if (slot % slots_at_once == 0) checkpoint();
    const TargetInFacet seen = planes_[slot].locate(target);
    indices.clear();
    filter_.collect(slot, seen.distance, seen.u, seen.v, indices);
    for (const uint32_t index : indices)
      if (may_reach(nodes_[filtered_[index]], seen)) nodes.push_back(filtered_[index]);
  }
  return nodes;
}

std::vector<GeometricPath> ImageTree::solve(const dvec3& target) const {
  std::vector<GeometricPath> paths;
  const double direct = glm::length(target - source_);
  const bool outwards = end_ == Source::transmitter;
  const dvec3 first = outwards ? source_ : target, last = outwards ? target : source_;
  if (line_of_sight_ && direct > shortest_line_of_sight_m) paths.push_back({{}, {first, last}, direct, 0.0});
  FacetSequence facets;
  std::vector<dvec3> points;
  for (const uint32_t index : seen_from(target)) {
    checkpoint();
    facets.clear();
    points.clear();
    const bool reached = trace(index, target, [&](uint32_t facet, const dvec3& hit) {
      facets.push_back(facet);
      points.push_back(hit);
    });
    if (!reached) continue;
    if (outwards) {  // the trace runs from the target back
      std::reverse(facets.begin(), facets.end());
      std::reverse(points.begin(), points.end());
    }
    GeometricPath path;
    path.vertices.push_back(first);
    for (size_t i = 0; i < facets.size(); ++i) {
      path.interactions.push_back({InteractionType::reflection, facets[i]});
      path.vertices.push_back(points[i]);
    }
    path.vertices.push_back(last);
    path.length_m = glm::length(target - images_[index]);
    paths.push_back(std::move(path));
  }
  keep_distinct(paths);
  return paths;
}

}  // namespace greatx::rf
