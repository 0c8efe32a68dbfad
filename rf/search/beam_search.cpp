// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/beam_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/watch.h"
#include "rf/search/beam_cells.h"

namespace greatx::rf {
namespace {

constexpr uint32_t none = ~0u;
constexpr size_t nodes_at_once = 2048;  ///< expanded before their children are counted; bounds the memory

/// Describes a sequence of facets: the sequence of its parent and one more facet.
struct Node {
  uint32_t parent = none;
  uint32_t facet = none;       ///< facet of the BeamScene
  dvec3 image{0.0};            ///< the source, mirrored at all facets
  std::vector<BeamHit> parts;  ///< lit regions of the facet, for each number of walls passed so far
};

/// Holds the facets and wedges that the beams of a node met.
struct Found {
  std::vector<BeamHit> hits;  ///< their walls count from the source
  std::vector<uint32_t> wedges;
  uint64_t cells = 0, work = 0;
};

/// Sorts hits by facet and then by walls, and merges their regions.
void merge(std::vector<BeamHit>& hits) {
  std::sort(hits.begin(), hits.end(), [](const BeamHit& a, const BeamHit& b) {
    return std::tie(a.facet, a.walls) < std::tie(b.facet, b.walls);
  });
  size_t kept = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    if (kept > 0 && hits[kept - 1].facet == hits[i].facet && hits[kept - 1].walls == hits[i].walls)
      hits[kept - 1].region.add(hits[i].region);
    else
      hits[kept++] = hits[i];
  }
  hits.resize(kept);
}

class Tree {
 public:
  Tree(const BeamScene& scene, const BeamSearchOptions& options, bool wedges, const dvec3& source)
      : scene_(scene), options_(options), wedges_(wedges) {
    nodes_.push_back({none, none, source, {}});
  }

  BeamSearchResult grow();

 private:
  /// Returns the number of walls that may still be passed before the next reflection; < 0 if none can follow.
  int walls_left(uint32_t depth, uint32_t passed) const {
    if (depth >= options_.max_depth) return -1;
    return static_cast<int>(std::min(options_.max_transmissions, options_.max_depth - depth - 1)) -
           static_cast<int>(passed);
  }
  Found expand_root(uint32_t face) const;
  Found expand(uint32_t node, uint32_t depth) const;
  void settle(const Beam& beam, uint32_t depth, uint32_t passed, Found& found) const;
  std::vector<Found> expand_level(size_t first, size_t end, uint32_t depth, WorkStage& stage) const;
  double expected_nodes(size_t expanded, size_t level, size_t level_end, uint32_t depth) const;
  void list_node(uint32_t node, BeamSearchResult& result) const;
  PlaneWindow window_of(const Node& node) const;
  SequenceBeam beam_of(uint32_t node, uint32_t depth) const;

  const BeamScene& scene_;
  const BeamSearchOptions& options_;
  bool wedges_;
  std::vector<Node> nodes_;
};

void Tree::settle(const Beam& beam, uint32_t depth, uint32_t passed, Found& found) const {
  // A thread keeps the memory of its view and its cells from beam to beam.
  thread_local std::optional<BeamView> view;
  thread_local BeamCells cells;
  if (!view || &view->scene() != &scene_) view.emplace(scene_);
  const uint64_t cells_before = cells.cells(), pairs_before = cells.pairs();
  const uint32_t carrier = depth == 0 && options_.source_body != 0 ? options_.source_body : none;
  view->look(beam, options_.clearance_m, carrier, wedges_ && depth < options_.wedge_depth);
  const size_t first = found.hits.size();
  cells.settle(*view, static_cast<uint32_t>(walls_left(depth, passed)), found.hits, found.wedges);
  for (size_t i = first; i < found.hits.size(); ++i) found.hits[i].walls += passed;
  found.cells += cells.cells() - cells_before;
  found.work += view->examined() + cells.pairs() - pairs_before;
}

Found Tree::expand_root(uint32_t face) const {
  static constexpr int axes[6][3] = {{1, 2, 0}, {1, 2, 0}, {2, 0, 1}, {2, 0, 1}, {0, 1, 2}, {0, 1, 2}};
  Beam beam;
  beam.apex = nodes_[0].image;
  beam.right[axes[face][0]] = 1.0;
  beam.up[axes[face][1]] = 1.0;
  beam.forward[axes[face][2]] = face % 2 == 0 ? 1.0 : -1.0;
  const double side = 1.0 + 1e-9;  // neighbours overlap by more than their roundings
  beam.window = {-side, side, -side, side};
  Found found;
  settle(beam, 0, 0, found);
  return found;
}

Found Tree::expand(uint32_t index, uint32_t depth) const {
  const Node& node = nodes_[index];
  const BeamFacet& facet = scene_.facet(node.facet);
  Beam beam;
  beam.apex = node.image;
  const double behind = glm::dot(facet.normal, node.image) - facet.offset;
  beam.near_m = std::abs(behind);
  beam.forward = behind > 0.0 ? -facet.normal : facet.normal;
  beam.right = facet.axis_a;
  beam.up = facet.axis_b;
  beam.mirror = node.facet;
  const double apex_a = glm::dot(facet.axis_a, node.image) - facet.offset_a;
  const double apex_b = glm::dot(facet.axis_b, node.image) - facet.offset_b;
  Found found;
  for (const BeamHit& part : node.parts) {
    if (walls_left(depth, part.walls) < 0) continue;
    const FacetRegion& region = part.region;
    beam.window = {(region.min_a - apex_a) / beam.near_m, (region.max_a - apex_a) / beam.near_m,
                   (region.min_b - apex_b) / beam.near_m, (region.max_b - apex_b) / beam.near_m};
    beam.min_sum = (region.min_sum - apex_a - apex_b) / beam.near_m;
    beam.max_sum = (region.max_sum - apex_a - apex_b) / beam.near_m;
    beam.min_difference = (region.min_difference - apex_a + apex_b) / beam.near_m;
    beam.max_difference = (region.max_difference - apex_a + apex_b) / beam.near_m;
    settle(beam, depth, part.walls, found);
  }
  return found;
}

/// Expands the nodes [first, end) of one depth. The results are in the order of the nodes.
std::vector<Found> Tree::expand_level(size_t first, size_t end, uint32_t depth, WorkStage& stage) const {
  std::vector<Found> found(end - first);
  if (depth == 0) {
    std::vector<Found> faces(6);
    parallel_for(6, options_.threads,
                 [&](size_t face) { faces[face] = expand_root(static_cast<uint32_t>(face)); });
    for (const Found& face : faces) {
      found[0].hits.insert(found[0].hits.end(), face.hits.begin(), face.hits.end());
      found[0].wedges.insert(found[0].wedges.end(), face.wedges.begin(), face.wedges.end());
      found[0].cells += face.cells;
      found[0].work += face.work;
    }
  } else {
    parallel_for(end - first, options_.threads, [&](size_t i) {
      found[i] = expand(static_cast<uint32_t>(first + i), depth);
      stage.add(1);
    });
  }
  for (Found& node : found) {
    merge(node.hits);
    std::sort(node.wedges.begin(), node.wedges.end());
    node.wedges.erase(std::unique(node.wedges.begin(), node.wedges.end()), node.wedges.end());
  }
  return found;
}

/// Returns a window around all parts, in the plane coordinates of the world's facet.
PlaneWindow Tree::window_of(const Node& node) const {
  const BeamFacet& facet = scene_.facet(node.facet);
  const PosedFacet& posed = scene_.world().facet(facet.index);
  FacetRegion all;
  for (const BeamHit& part : node.parts) all.add(part.region);
  PlaneWindow window{1e300, -1e300, 1e300, -1e300};
  for (const double a : {all.min_a, all.max_a})
    for (const double b : {all.min_b, all.max_b}) {
      const double from_a = a + facet.offset_a, from_b = b + facet.offset_b;
      const double u =
          glm::dot(posed.axis_u, facet.axis_a) * from_a + glm::dot(posed.axis_u, facet.axis_b) * from_b;
      const double v =
          glm::dot(posed.axis_v, facet.axis_a) * from_a + glm::dot(posed.axis_v, facet.axis_b) * from_b;
      window.min_u = std::min(window.min_u, u - posed.offset_u),
      window.max_u = std::max(window.max_u, u - posed.offset_u);
      window.min_v = std::min(window.min_v, v - posed.offset_v),
      window.max_v = std::max(window.max_v, v - posed.offset_v);
    }
  const double room = 2.0 * facet.tolerance_m;
  return {std::max(window.min_u, posed.min_u) - room, std::min(window.max_u, posed.max_u) + room,
          std::max(window.min_v, posed.min_v) - room, std::min(window.max_v, posed.max_v) + room};
}

/// Returns a beam around the parts after which the sequence can go on.
SequenceBeam Tree::beam_of(uint32_t index, uint32_t depth) const {
  const Node& node = nodes_[index];
  SequenceBeam beam;
  beam.image = node.image;
  if (node.parent == none) {
    beam.walls = 0;
    return beam;
  }
  FacetRegion all;
  for (const BeamHit& part : node.parts) {
    if (walls_left(depth, part.walls) < 0) continue;
    all.add(part.region);
    beam.walls = std::min(beam.walls, part.walls);
  }
  if (beam.walls == SequenceBeam::none) return beam;
  const BeamFacet& facet = scene_.facet(node.facet);
  beam.half_a = 0.5 * (all.max_a - all.min_a) * facet.axis_a;
  beam.half_b = 0.5 * (all.max_b - all.min_b) * facet.axis_b;
  beam.center = facet.reference + 0.5 * (all.min_a + all.max_a) * facet.axis_a +
                0.5 * (all.min_b + all.max_b) * facet.axis_b;
  return beam;
}

void Tree::list_node(uint32_t index, BeamSearchResult& result) const {
  std::vector<uint32_t> sequence;
  for (uint32_t node = index; nodes_[node].parent != none; node = nodes_[node].parent)
    sequence.push_back(scene_.facet(nodes_[node].facet).index);
  std::reverse(sequence.begin(), sequence.end());
  result.list.add(sequence);
  result.list.windows.push_back(index == 0 ? PlaneWindow{0.0, 0.0, 0.0, 0.0} : window_of(nodes_[index]));
}

/// Estimates the number of nodes that the whole search will expand, if each level grows by the factor of the
/// present level. The nodes of this level are [level, level_end); `expanded` nodes are done.
double Tree::expected_nodes(size_t expanded, size_t level, size_t level_end, uint32_t depth) const {
  const auto of_level = static_cast<double>(level_end - level);
  const double growth = static_cast<double>(nodes_.size() - level_end) /
                        static_cast<double>(std::max<size_t>(1, expanded - level));
  double expected = static_cast<double>(level_end), next = of_level;
  for (uint32_t more = depth + 1; more < std::min(options_.max_depth, options_.stop_depth); ++more)
    expected += next *= growth;
  return std::min(expected, static_cast<double>(options_.capacity));
}

BeamSearchResult Tree::grow() {
  WorkStage stage("search");
  BeamSearchResult result;
  const uint32_t last_depth = std::min(options_.max_depth, options_.stop_depth);
  if (wedges_) result.list.wedge_offsets.push_back(0);
  list_node(0, result);
  if (options_.max_depth > 0) result.beams.push_back(beam_of(0, 0));
  result.found = 1;
  size_t level = 0;
  for (uint32_t depth = 0; depth < last_depth; ++depth) {
    const size_t level_end = nodes_.size();
    for (size_t first = level; first < level_end; first += nodes_at_once) {
      const size_t end = std::min(level_end, first + nodes_at_once);
      const std::vector<Found> found = expand_level(first, end, depth, stage);
      for (size_t i = first; i < end; ++i) {
        checkpoint();
        const Found& from = found[i - first];
        result.cells += from.cells;
        result.work += from.work;
        if (wedges_) {
          result.list.wedges.insert(result.list.wedges.end(), from.wedges.begin(), from.wedges.end());
          if (result.list.wedges.size() > ~0u)
            throw_user_error(
                "search: {} sequences lead to wedges {} times, expected at most {}; a smaller "
                "max_depth has fewer",
                result.found, result.list.wedges.size(), ~0u);
          result.list.wedge_offsets.push_back(static_cast<uint32_t>(result.list.wedges.size()));
        }
        for (size_t h = 0; h < from.hits.size();) {
          Node child{static_cast<uint32_t>(i), from.hits[h].facet, {}, {}};
          for (; h < from.hits.size() && from.hits[h].facet == child.facet; ++h)
            child.parts.push_back(from.hits[h]);
          if (++result.found > options_.capacity) continue;
          const BeamFacet& facet = scene_.facet(child.facet);
          const dvec3& image = nodes_[i].image;
          child.image = image - 2.0 * (glm::dot(facet.normal, image) - facet.offset) * facet.normal;
          nodes_.push_back(std::move(child));
          const uint32_t made = static_cast<uint32_t>(nodes_.size() - 1);
          list_node(made, result);
          if (depth + 1 < options_.max_depth) result.beams.push_back(beam_of(made, depth + 1));
          if (depth + 1 == last_depth) nodes_.pop_back();  // nothing follows; most nodes are of this depth
        }
      }
      if (depth > 0) stage.expect(expected_nodes(end, level, level_end, depth));
    }
    level = level_end;
    if (result.found > options_.capacity) break;
  }
  if (wedges_)
    result.list.wedge_offsets.resize(result.list.size() + 1,
                                     static_cast<uint32_t>(result.list.wedges.size()));
  return result;
}

}  // namespace

BeamSearch::BeamSearch(const FacetWorld& world, const FacetKinds& kinds, std::span<const scene::Wedge> wedges,
                       const BeamSearchOptions& options)
    : world_(&world), kinds_(&kinds), wedges_(wedges), with_wedges_(!wedges.empty()), options_(options) {
  check();
}

BeamSearch::BeamSearch(std::shared_ptr<const BeamScene> scene, const BeamSearchOptions& options, bool wedges)
    : with_wedges_(wedges), options_(options), scene_(std::move(scene)) {
  check();
}

void BeamSearch::check() const {
  GREATX_CHECK(options_.max_depth <= 64, "beams to depth {}", options_.max_depth);
  GREATX_CHECK(options_.capacity > 0, "capacity {}", options_.capacity);
}

BeamSearchResult BeamSearch::search(const dvec3& source) const {
  GREATX_CHECK(std::isfinite(source.x) && std::isfinite(source.y) && std::isfinite(source.z),
               "source at ({}, {}, {})", source.x, source.y, source.z);
  if (!options_.moving_bodies && scene_ == nullptr)
    scene_ = std::make_shared<const BeamScene>(*world_, *kinds_, wedges_, false);
  if (scene_) return Tree(*scene_, options_, with_wedges_, source).grow();
  const BeamScene scene(*world_, *kinds_, wedges_, true);
  return Tree(scene, options_, with_wedges_, source).grow();
}

uint32_t BeamSearchResult::complete_depth() const {
  if (overflow() == 0) return ~0u;
  // The next sequence in the order was left out. It may have as many facets as the last one that fits.
  const auto last = static_cast<uint32_t>(list.sequence(list.size() - 1).size());
  return std::max(last, 1u) - 1;
}

std::string BeamSearch::guarantee(uint64_t left_out, uint32_t complete_depth) const {
  const std::string walls =
      options_.max_transmissions > 0
          ? fmt::format(" and walls passed (walls: at most {})", options_.max_transmissions)
          : std::string();
  const std::string clear = options_.clearance_m > 0.0
                                ? fmt::format(" and is {:g} mm clear of edges", 1e3 * options_.clearance_m)
                                : std::string();
  const std::string more =
      left_out > 0
          ? fmt::format("; of longer ones {} at least are left out, beyond the {} that a search keeps",
                        left_out, options_.capacity)
          : std::string();
  return fmt::format(
      "beams: no facet sequence is left out that has a path of up to {} reflections{}{}, whatever the "
      "receiver{}",
      std::min(options_.max_depth, complete_depth), walls, clear, more);
}

}  // namespace greatx::rf
