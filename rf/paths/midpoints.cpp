// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/midpoints.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.h"
#include "core/parallel.h"
#include "core/watch.h"
#include "rf/field/diffraction.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

namespace {

struct Triangle {
  dvec3 corners[3];
};

/// Returns a lower bound of the number of pieces of a triangle, from its area and from its longest side.
double least_pieces(const scene::FacetTriangle& triangle, double side_m) {
  const dvec3 &a = triangle.corners[0], &b = triangle.corners[1], &c = triangle.corners[2];
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)}),
               area = 0.5 * glm::length(glm::cross(b - a, c - a));
  const double of_area =
      area / (0.25 * std::sqrt(3.0)) / side_m / side_m;  // the largest piece is equilateral
  return std::max(of_area, longest / side_m);
}

[[noreturn]] void too_many_patches(double side_m, size_t most) {
  throw_user_error("scattering_patch_m: {} m makes more than {} patches of this scene; expected a larger one",
                   side_m, most);
}

/// Checks that a number fits into 32 bits and returns it. Throws UserError if it does not fit.
uint32_t number_of(size_t count, const char* what) {
  if (count > ~0u)
    throw_user_error("paths: {} {}, expected at most {}; a smaller max_depth, a larger scattering_patch_m",
                     count, what, ~0u);
  return static_cast<uint32_t>(count);
}

/// Halves the longest side until no side is longer than `side_m`. Appends the pieces in order, first half
/// first.
void cut(const Triangle& triangle, double side_m, uint32_t facet, std::vector<Patch>& patches, size_t first,
         size_t most) {
  int longest = 0;
  double length = 0.0;
  for (int side = 0; side < 3; ++side) {
    const double l = glm::length(triangle.corners[(side + 1) % 3] - triangle.corners[side]);
    if (l > length) longest = side, length = l;
  }
  const dvec3 &a = triangle.corners[longest], &b = triangle.corners[(longest + 1) % 3],
              &c = triangle.corners[(longest + 2) % 3];
  if (length > side_m) {
    const dvec3 middle = 0.5 * (a + b);
    cut({{a, middle, c}}, side_m, facet, patches, first, most);
    cut({{middle, b, c}}, side_m, facet, patches, first, most);
    return;
  }
  if (patches.size() >= most) too_many_patches(side_m, most);
  patches.push_back({facet, static_cast<uint32_t>(patches.size() - first), (a + b + c) / 3.0,
                     0.5 * glm::length(glm::cross(b - a, c - a))});
}

/// Turns a path that runs from the receiver, because the search did, into one from the transmitter.
void reverse(GeometricPath& path) {
  std::reverse(path.interactions.begin(), path.interactions.end());
  std::reverse(path.vertices.begin(), path.vertices.end());
  path.from_receiver = true;
}

Source opposite(Source end) { return end == Source::transmitter ? Source::receiver : Source::transmitter; }

}  // namespace

std::vector<Patch> scattering_patches(const scene::Scene& scene, const FacetKinds& kinds, double side_m,
                                      size_t most) {
  std::vector<Patch> patches;
  for (uint32_t index = 0; index < scene.facets.size(); ++index) {
    const scene::Facet& facet = scene.facets[index];
    const scene::Material& material = scene.materials[facet.material];
    const bool hard = kinds[index] == FacetKind::opaque || kinds[index] == FacetKind::wall;
    if (!hard || !material.radio || material.radio->scattering_coefficient == 0.0) continue;
    const size_t first = patches.size();
    for (uint32_t t = 0; t < facet.triangle_count; ++t) {
      const scene::FacetTriangle& triangle = scene.facet_triangles[facet.first_triangle + t];
      // The bound is tested before the triangle is cut, because halving would not end before fp64 underflows.
      if (!(least_pieces(triangle, side_m) <= static_cast<double>(most))) too_many_patches(side_m, most);
      cut({{triangle.corners[0], triangle.corners[1], triangle.corners[2]}}, side_m, index, patches, first,
          most);
    }
    std::erase_if(patches, [](const Patch& patch) { return patch.area_m2 == 0.0; });
  }
  return patches;
}

/// Describes a prefix and a suffix that meet.
struct Midpoints::Chain {
  const ImageTree& tree;
  const ImageTree& suffixes;
  uint32_t prefix = 0, suffix = 0;

  /// Sets `path` to source, prefix, `middle` at `point`, suffix and target. Returns false if either side does
  /// not reach `point`. `back` is room for the suffix.
  bool assemble(const Interaction& middle, const dvec3& point, GeometricPath& path,
                GeometricPath& back) const {
    path.clear();
    path.vertices.push_back(tree.source());
    if (!tree.reach(prefix, point, path)) return false;
    path.interactions.push_back(middle);
    path.vertices.push_back(point);
    back.clear();
    if (!suffixes.reach(suffix, point, back)) return false;
    path.interactions.insert(path.interactions.end(), back.interactions.rbegin(), back.interactions.rend());
    path.vertices.insert(path.vertices.end(), back.vertices.rbegin(), back.vertices.rend());
    path.vertices.push_back(suffixes.source());
    path.length_m = glm::length(point - tree.image(prefix)) + glm::length(point - suffixes.image(suffix));
    return true;
  }
};

/// Joins the chains of one wedge. It keeps the memory of a chain that was refused for the next one.
struct Midpoints::WedgeJoin {
  scene::Wedge wedge;
  uint32_t index = 0;
  GeometricPath path = {}, back = {};
};

Midpoints::Midpoints(const RadioModel& model, const PathLimits& limits, bool moving_bodies,
                     std::shared_ptr<EdgeSearch> shared)
    : model_(&model), limits_(limits), moving_bodies_(moving_bodies) {
  if (model.effects.scattering) patches_ = scattering_patches(*model.scene, model.kinds, limits.patch_m);
  if (!model.effects.diffraction || limits.max_depth == 0) return;
  search_target_ = limits.max_reflections_beside_diffraction > 0 && limits.max_depth > 1;
  edges_ = std::move(shared);
  if (!edges_ && search_target_) edges_ = std::make_shared<EdgeSearch>(model, limits, moving_bodies);
}

/// Finds the sequences that lead to facets. A candidate sequence that ends with a facet shows that the
/// sequence without this facet leads to the facet. `windows`: [sequences of the result], the part of the
/// facet that the sequence reaches; or empty.
Midpoints::Arrivals Midpoints::arrivals_at_facets(const CandidateList& candidates, uint32_t most_reflections,
                                                  std::vector<PlaneWindow>& windows) const {
  struct Pair {
    uint32_t facet, prefix, sequence;
  };
  std::vector<Pair> pairs;
  // In the canonical order a sequence comes after its prefix without the last facet, and the prefixes have
  // the same order as the sequences. One pass therefore finds all prefixes.
  uint32_t prefix = 0;
  for (uint32_t i = 0; i < candidates.size(); ++i) {
    const auto facets = candidates.sequence(i);
    if (facets.empty() || facets.size() > limits_.max_depth || facets.size() - 1 > most_reflections) continue;
    const auto shorter = facets.first(facets.size() - 1);
    while (prefix < i && sequence_less(candidates.sequence(prefix), shorter)) ++prefix;
    if (std::ranges::equal(candidates.sequence(prefix), shorter)) pairs.push_back({facets.back(), prefix, i});
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return a.facet != b.facet ? a.facet < b.facet : a.prefix < b.prefix;
  });
  Arrivals arrivals;
  arrivals.offsets.assign(model_->kinds.size() + 1, 0);
  windows.clear();
  for (const Pair& pair : pairs) {
    ++arrivals.offsets[pair.facet + 1];
    arrivals.sequences.push_back(pair.prefix);
    if (!candidates.windows.empty()) windows.push_back(candidates.windows[pair.sequence]);
  }
  for (size_t i = 1; i < arrivals.offsets.size(); ++i) arrivals.offsets[i] += arrivals.offsets[i - 1];
  return arrivals;
}

dvec3 Midpoints::center(const Patch& patch) const {
  const uint32_t body = model_->facets.facet(patch.facet).body;
  return body == 0 ? patch.center : model_->facets.motion(body).pose.apply(patch.center);
}

Midpoints::PatchArrivals Midpoints::arrivals_at_patches(const Arrivals& at_facets,
                                                        const std::vector<PlaneWindow>& windows,
                                                        const ImageTree& tree) const {
  PatchArrivals at_patches;
  at_patches.offsets.push_back(0);
  GeometricPath path;
  for (const Patch& patch : patches_) {
    checkpoint();
    const PosedFacet& facet = model_->facets.facet(patch.facet);
    const dvec3 point = center(patch);
    const dvec2 at = facet.plane_coordinates(point);
    const double room = 2.0 * facet.tolerance_m;
    const auto outside = [&](const PlaneWindow& window) {
      return at.x < window.min_u - room || at.x > window.max_u + room || at.y < window.min_v - room ||
             at.y > window.max_v + room;
    };
    for (uint32_t i = at_facets.offsets[patch.facet]; i < at_facets.offsets[patch.facet + 1]; ++i) {
      if (!windows.empty() && outside(windows[i])) continue;
      const uint32_t sequence = at_facets.sequences[i];
      path.interactions.clear();
      path.vertices.clear();
      if (!tree.reach(sequence, point, path)) continue;
      at_patches.arrivals.push_back({static_cast<uint32_t>(at_patches.facets.size()),
                                     static_cast<uint32_t>(path.interactions.size()),
                                     path.vertices.empty() ? tree.source() : path.vertices.back(),
                                     glm::length(point - tree.image(sequence))});
      for (const Interaction& reflection : path.interactions) at_patches.facets.push_back(reflection.element);
      at_patches.points.insert(at_patches.points.end(), path.vertices.begin(), path.vertices.end());
    }
    at_patches.offsets.push_back(number_of(at_patches.arrivals.size(), "sequences that lead to patches"));
    number_of(at_patches.facets.size(), "reflections before patches");
  }
  return at_patches;
}

/// Returns an arrival at every patch, for a point without a search: it may see any patch.
Midpoints::PatchArrivals Midpoints::straight_to_patches(const dvec3& from) const {
  PatchArrivals at_patches;
  at_patches.offsets.push_back(0);
  for (const Patch& patch : patches_) {
    at_patches.arrivals.push_back({0, 0, from, glm::length(center(patch) - from)});
    at_patches.offsets.push_back(static_cast<uint32_t>(at_patches.arrivals.size()));
  }
  return at_patches;
}

void Midpoints::set_candidates(const CandidateList& candidates, const ImageTree& tree) {
  edge_tree_.reset();
  edge_left_out_ = {};
  if (edges_) edges_->move();
  if (model_->effects.diffraction) {
    at_wedges_ = WedgeArrivals(candidates, model_->wedges);
    at_wedges_.place(tree, model_->wedges);
  }
  if (!model_->effects.scattering) return;
  std::vector<PlaneWindow> windows;
  at_facets_ = arrivals_at_facets(candidates, limits_.max_reflections_before_scattering, windows);
  at_patches_ = arrivals_at_patches(at_facets_, windows, tree);
}

void Midpoints::find_edge_ways(const ImageTree& tree, uint32_t body, uint32_t threads) {
  GREATX_CHECK(edges_, "no search for the ways to wedges");
  const auto ways = edges_->from(tree.source(), body, threads, true);
  edge_left_out_ = ways->left_out;
  edge_tree_.emplace(model_->facets, tree.source(), ways->list, tree.end());
  at_wedges_ = WedgeArrivals(ways->list, model_->wedges);
  at_wedges_.place(*edge_tree_, model_->wedges);
}

void Midpoints::move(const ImageTree& tree) {
  if (model_->effects.diffraction) at_wedges_.place(tree, model_->wedges);
  if (edges_) edges_->move();
  if (model_->effects.scattering) at_patches_ = arrivals_at_patches(at_facets_, {}, tree);
}

bool Midpoints::diffract(const Chain& chain, WedgeJoin& join) const {
  const std::optional<dvec3> point =
      keller_point(join.wedge, chain.tree.image(chain.prefix), chain.suffixes.image(chain.suffix));
  GeometricPath& path = join.path;
  if (!point || !chain.assemble({InteractionType::diffraction, join.index}, *point, path, join.back))
    return false;
  const size_t middle = chain.tree.depth(chain.prefix) + 1;
  if (!in_exterior(join.wedge, path.vertices[middle - 1]) ||
      !in_exterior(join.wedge, path.vertices[middle + 1]))
    return false;
  return model_->effects.diffraction_lit_region ||
         in_shadow(join.wedge, chain.tree.image(chain.prefix), chain.suffixes.image(chain.suffix));
}

/// Returns the number of reflections that may come before a wedge with `after` behind it.
uint32_t Midpoints::most_before(uint32_t after) const {
  return std::min(limits_.max_depth - 1 - after, limits_.max_reflections_beside_diffraction);
}

/// Returns the wedges at which a prefix and a suffix may meet. Without a search at the target, it may reach
/// every wedge on a straight line.
std::vector<Midpoints::Meeting> Midpoints::meetings(const CandidateList& suffixes) const {
  std::vector<Meeting> all;
  if (!search_target_)
    for (const uint32_t wedge : at_wedges_.wedges()) all.push_back({wedge, 0});
  for (uint32_t i = 0; i < suffixes.size(); ++i) {
    const auto sequence = suffixes.sequence(i);
    const uint32_t before = most_before(static_cast<uint32_t>(sequence.size()));
    for (const uint32_t wedge : suffixes.wedges_of(i)) {
      if (at_wedges_.least_depth(wedge) <= before && leads_to(sequence, model_->wedges[wedge]))
        all.push_back({wedge, i});
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

LeftOut Midpoints::solve_wedges(const ImageTree& tree, const Target& target, uint32_t threads,
                                std::vector<GeometricPath>& paths) const {
  std::shared_ptr<const EdgeWays> ways;
  if (search_target_) {
    ways = edges_->from(target.position, target.body, threads, target.keep);
  } else {
    EdgeWays straight;
    straight.list.add({});
    ways = std::make_shared<const EdgeWays>(std::move(straight));
  }
  const ImageTree images(model_->facets, target.position, ways->list, opposite(tree.end()));
  const std::vector<Meeting> all = meetings(ways->list);
  constexpr size_t meetings_at_once = 1024;
  std::vector<std::vector<GeometricPath>> found((all.size() + meetings_at_once - 1) / meetings_at_once);
  parallel_for(found.size(), threads, [&](size_t i) {
    const size_t first = i * meetings_at_once;
    join_at(std::span(all).subspan(first, std::min(meetings_at_once, all.size() - first)), tree, images,
            found[i]);
  });
  for (std::vector<GeometricPath>& some : found) std::ranges::move(some, std::back_inserter(paths));
  return ways->left_out;
}

/// Joins every prefix with the suffix of each meeting.
void Midpoints::join_at(std::span<const Meeting> at, const ImageTree& tree, const ImageTree& suffixes,
                        std::vector<GeometricPath>& paths) const {
  std::vector<uint32_t> from;
  WedgeJoin join;
  join.index = ~0u;
  for (const auto& [index, suffix] : at) {
    at_wedges_.joined(index, suffixes.image(suffix), most_before(suffixes.depth(suffix)), from);
    if (from.empty()) continue;
    if (join.index != index) join.wedge = posed(model_->wedges[index], model_->facets);
    join.index = index;
    for (const uint32_t prefix : from)
      if (diffract({tree, suffixes, prefix, suffix}, join)) {
        paths.push_back(join.path);
        if (tree.end() == Source::receiver) reverse(paths.back());
      }
  }
}

/// Joins every prefix with every suffix at a patch whose centre both reach from the same side.
void Midpoints::scatter(const ImageTree& tree, const dvec3& target, size_t number,
                        const PatchArrivals& suffixes, std::vector<GeometricPath>& paths) const {
  const Patch& patch = patches_[number];
  const PosedFacet& facet = model_->facets.facet(patch.facet);
  const dvec3 point = center(patch);
  for (const PatchArrival& after : suffixes.of(number)) {
    checkpoint();
    const double to = facet.distance(after.from);
    if (std::abs(to) <= facet.tolerance_m) continue;
    for (const PatchArrival& before : at_patches_.of(number)) {
      const size_t count = before.depth + 1 + after.depth;
      if (count > limits_.max_depth) continue;
      const double from = facet.distance(before.from);
      if (std::abs(from) <= facet.tolerance_m || from * to < 0.0) continue;
      GeometricPath& path = paths.emplace_back();
      path.interactions.reserve(count);
      path.vertices.reserve(count + 2);
      path.vertices.push_back(tree.source());
      for (uint32_t i = before.first; i < before.first + before.depth; ++i) {
        path.interactions.push_back({InteractionType::reflection, at_patches_.facets[i]});
        path.vertices.push_back(at_patches_.points[i]);
      }
      path.interactions.push_back({InteractionType::scattering, patch.facet, patch.number});
      path.vertices.push_back(point);
      for (uint32_t i = after.first + after.depth; i-- > after.first;) {
        path.interactions.push_back({InteractionType::reflection, suffixes.facets[i]});
        path.vertices.push_back(suffixes.points[i]);
      }
      path.vertices.push_back(target);
      path.length_m = before.length_m + after.length_m;
      path.patch_area_m2 = patch.area_m2;
      if (tree.end() == Source::receiver) reverse(path);
    }
  }
}

LeftOut Midpoints::solve_patches(const ImageTree& tree, const Target& to, uint32_t threads,
                                 std::vector<GeometricPath>& paths) const {
  const dvec3& target = to.position;
  LeftOut left_out;
  PatchArrivals at_patches;
  if (limits_.max_reflections_after > 0) {
    BeamSearchOptions search;
    search.max_depth = limits_.max_reflections_after + 1;
    search.max_transmissions = model_->effects.transmission ? limits_.max_transmissions : 0;
    search.moving_bodies = moving_bodies_;
    search.source_body = to.body;
    search.threads = threads;
    const BeamSearchResult result = BeamSearch(model_->facets, model_->kinds, {}, search).search(target);
    left_out = {result.overflow(), result.complete_depth()};
    std::vector<PlaneWindow> windows;
    const Arrivals facets = arrivals_at_facets(result.list, limits_.max_reflections_after, windows);
    const ImageTree suffixes(model_->facets, target, result.list, opposite(tree.end()));
    at_patches = arrivals_at_patches(facets, windows, suffixes);
  } else {
    at_patches = straight_to_patches(target);
  }
  for (size_t patch = 0; patch < patches_.size(); ++patch) scatter(tree, target, patch, at_patches, paths);
  return left_out;
}

LeftOut Midpoints::solve(const ImageTree& tree, const Target& target, uint32_t threads,
                         std::vector<GeometricPath>& paths) const {
  LeftOut left_out = edge_left_out_;
  if (model_->effects.diffraction && limits_.max_depth > 0)
    left_out.add(solve_wedges(edge_tree_ ? *edge_tree_ : tree, target, threads, paths));
  if (!patches_.empty() && !at_patches_.arrivals.empty())
    left_out.add(solve_patches(tree, target, threads, paths));
  return left_out;
}

}  // namespace greatx::rf
