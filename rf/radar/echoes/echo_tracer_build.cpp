// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Builds the trees of EchoTracer.
#include <algorithm>
#include <cmath>

#include "core/largest.h"
#include "rf/radar/echoes/echo_tracer.h"

namespace greatx::rf {
namespace {

double area_of(const scene::Bounds& bounds) {
  const dvec3 size = bounds.size();
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

}  // namespace

struct EchoTracer::Build {
  std::vector<Piece> pieces;
  std::vector<scene::Bounds> bounds;  ///< [pieces]
  std::vector<uint32_t> order;
};

EchoTracer::Piece EchoTracer::piece_of(const scene::Facet& facet, FacetPiece index,
                                       std::span<const dvec3> corners) {
  Piece piece{facet.normal,
              facet.offset,
              index.facet,
              index.piece,
              static_cast<uint32_t>(sides_.size()),
              static_cast<uint32_t>(corners.size())};
  for (size_t i = 0; i < corners.size(); ++i) {
    const dvec3 along = corners[(i + 1) % corners.size()] - corners[i];
    const dvec3 inwards = glm::normalize(glm::cross(facet.normal, along));
    sides_.push_back({inwards, -glm::dot(inwards, corners[i])});
    piece.room = std::max({piece.room, 1e-9 * glm::length(along), 1e-13 * largest(corners[i])});
  }
  return piece;
}

EchoTracer::EchoTracer(const scene::Scene& scene, const FacetTrees& trees,
                       const std::function<bool(uint32_t facet)>& takes) {
  uint32_t facet = 0;  // the facets of a body are a range
  for (uint32_t body = 0; body < scene.bodies.size(); ++body) {
    Build work;
    Tree tree{0, body, scene.owner_of(body), {}};
    for (; facet < scene.facets.size() && scene.facets[facet].body == body; ++facet) {
      if (takes && !takes(facet)) continue;
      for (const uint32_t index : trees.pieces(facet)) {
        const std::span<const dvec3> corners = trees.corners(index);
        scene::Bounds bounds;
        for (const dvec3& corner : corners) bounds.add(corner);
        // Boxes are tested in fp32, so they are widened by more than the rounding errors.
        const double room = 1e-6 * std::max(largest(bounds.min), largest(bounds.max)) + 1e-6;
        bounds.min -= room, bounds.max += room;
        tree.bounds.add(bounds);
        work.order.push_back(static_cast<uint32_t>(work.pieces.size()));
        work.pieces.push_back(piece_of(scene.facets[facet], {facet, index}, corners));
        work.bounds.push_back(bounds);
      }
    }
    if (work.pieces.empty()) continue;
    tree.root = build(work, 0, static_cast<uint32_t>(work.order.size()));
    trees_.push_back(tree);
  }
}

/// Partitions [first, first + count) of `order` at the best cut. Returns the number of entries before the
/// cut, or half of `count` if all centres coincide.
static uint32_t cut_by_area(std::vector<uint32_t>& order, const std::vector<scene::Bounds>& bounds,
                            uint32_t first, uint32_t count, uint32_t bins) {
  scene::Bounds centers;
  for (uint32_t i = 0; i < count; ++i) centers.add(bounds[order[first + i]].center());
  const dvec3 size = centers.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  if (!(size[axis] > 0.0)) return count / 2;
  const auto bin_of = [&](uint32_t i) {
    const double share = (bounds[i].center()[axis] - centers.min[axis]) / size[axis];
    return std::min(bins - 1, static_cast<uint32_t>(share * bins));
  };
  std::vector<scene::Bounds> box(bins);
  std::vector<uint32_t> held(bins, 0);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t bin = bin_of(order[first + i]);
    box[bin].add(bounds[order[first + i]]);
    ++held[bin];
  }
  std::vector<double> above(bins, 0.0);  // [bins] cost of this bin and all bins after it
  scene::Bounds sum;
  uint32_t in = 0;
  for (uint32_t bin = bins; bin-- > 1;) {
    if (!box[bin].empty()) sum.add(box[bin]);
    in += held[bin];
    above[bin] = in == 0 ? 0.0 : in * area_of(sum);
  }
  double least = 1e300;
  uint32_t best = 0;
  sum = {}, in = 0;
  for (uint32_t bin = 1; bin < bins; ++bin) {
    if (!box[bin - 1].empty()) sum.add(box[bin - 1]);
    in += held[bin - 1];
    if (in == 0 || in == count) continue;
    const double cost = in * area_of(sum) + above[bin];
    if (cost < least) least = cost, best = bin;
  }
  const auto middle = std::stable_partition(order.begin() + first, order.begin() + first + count,
                                            [&](uint32_t i) { return bin_of(i) < best; });
  return static_cast<uint32_t>(middle - order.begin()) - first;
}

uint32_t EchoTracer::build(Build& work, uint32_t first, uint32_t count) {
  struct Range {
    uint32_t first, count;
    double area;
  };
  const auto range_of = [&](uint32_t from, uint32_t held) {
    scene::Bounds box;
    for (uint32_t i = 0; i < held; ++i) box.add(work.bounds[work.order[from + i]]);
    return Range{from, held, area_of(box)};
  };
  std::array<Range, wide> ranges{range_of(first, count)};
  uint32_t used = 1;
  while (used < wide) {  // the range that most rays meet is cut next
    uint32_t widest = wide;
    for (uint32_t i = 0; i < used; ++i)
      if (ranges[i].count > leaf_size && (widest == wide || ranges[i].area > ranges[widest].area)) widest = i;
    if (widest == wide) break;
    const Range range = ranges[widest];
    const uint32_t left = cut_by_area(work.order, work.bounds, range.first, range.count, bins);
    ranges[widest] = range_of(range.first, left);
    ranges[used++] = range_of(range.first + left, range.count - left);
  }
  const uint32_t index = static_cast<uint32_t>(nodes_.size());
  nodes_.emplace_back();
  for (uint32_t k = 0; k < wide; ++k) {
    scene::Bounds box;
    uint32_t child = 0, held = 0;
    if (k < used) {
      for (uint32_t i = 0; i < ranges[k].count; ++i) box.add(work.bounds[work.order[ranges[k].first + i]]);
      if (ranges[k].count <= leaf_size) {
        child = static_cast<uint32_t>(pieces_.size()), held = ranges[k].count;
        for (uint32_t i = 0; i < held; ++i) pieces_.push_back(work.pieces[work.order[ranges[k].first + i]]);
      } else {
        child = build(work, ranges[k].first, ranges[k].count);
      }
    }
    Node& node = nodes_[index];
    for (int axis = 0; axis < 3; ++axis) {
      node.box[axis][0][k] = k < used ? static_cast<float>(box.min[axis]) : 1e30f;
      node.box[axis][1][k] = k < used ? static_cast<float>(box.max[axis]) : -1e30f;
    }
    node.child[k] = child, node.count[k] = held;
  }
  return index;
}

}  // namespace greatx::rf
