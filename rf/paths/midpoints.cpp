// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/midpoints.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "core/watch.h"
#include "rf/edges/diffraction.h"
#include "rf/paths/edge_behind_patch.h"
#include "rf/paths/two_edge_paths.h"

namespace greatx::rf {

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
    : model_(&model), limits_(limits) {
  if (model.effects.scattering) scatterers_.emplace(model, limits, moving_bodies);
  scatter_beside_edges_ = scatterers_ && model.effects.diffraction && limits.max_depth > 1 &&
                          limits.scattering_beside_diffraction;
  if (scatter_beside_edges_ || (scatterers_ && limits.max_scatterings > 1))
    indirect_ = std::make_unique<IndirectLight>(model, limits);
  if (!model.effects.diffraction || limits.max_depth == 0) return;
  if (model.effects.corner_diffraction)
    most_excess_m_ = largest_excess_m(limits.corner_step_db, 2.0 * pi / model.surfaces.wavelength_m());
  two_edges_ = limits.max_diffractions > 1 && limits.max_depth > 1;
  search_target_ = two_edges_ || scatter_beside_edges_ ||
                   (limits.max_reflections_beside_diffraction > 0 && limits.max_depth > 1);
  edges_ = std::move(shared);
  if (!edges_ && search_target_) edges_ = std::make_shared<EdgeSearch>(model, limits, moving_bodies);
}

void Midpoints::set_candidates(const CandidateList& candidates, const ImageTree& tree) {
  edge_tree_.reset();
  edge_left_out_ = {};
  if (edges_) edges_->move();
  if (model_->effects.diffraction) {
    at_wedges_ = WedgeArrivals(candidates, model_->wedges);
    at_wedges_.place(tree, model_->wedges);
  }
  if (scatterers_) scatterers_->set_candidates(candidates, tree);
  if (indirect_) indirect_->forget();
}

void Midpoints::find_edge_ways(const ImageTree& tree, uint32_t body, uint32_t threads) {
  GREATX_CHECK(edges_, "no search for the ways to wedges");
  const auto ways = edges_->from(tree.source(), body, threads, true);
  edge_left_out_ = ways->left_out;
  edge_tree_.emplace(model_->facets, tree.source(), ways->list, tree.end());
  at_wedges_ = WedgeArrivals(ways->list, model_->wedges);
  at_wedges_.place(*edge_tree_, model_->wedges);
  if (indirect_) indirect_->forget();
}

void Midpoints::move(const ImageTree& tree) {
  if (model_->effects.diffraction) at_wedges_.place(tree, model_->wedges);
  if (edges_) edges_->move();
  if (scatterers_) scatterers_->move(tree);
  if (indirect_) indirect_->forget();
}

/// Sets the path over Keller's point. Returns false if there is none.
bool Midpoints::diffract(const Chain& chain, WedgeJoin& join) const {
  const std::optional<dvec3> point =
      keller_point(join.wedge, chain.tree.image(chain.prefix), chain.suffixes.image(chain.suffix));
  return point && bend(chain, {InteractionType::diffraction, join.index}, *point, join);
}

/// Sets the path over an end of the edge. Returns false if there is none.
bool Midpoints::diffract_at(const Chain& chain, Corner corner, WedgeJoin& join) const {
  if (!model_->corners.open(join.index, corner)) return false;
  const dvec3 &before = chain.tree.image(chain.prefix), &after = chain.suffixes.image(chain.suffix);
  const auto place = corner_place(join.wedge, corner, before, after);
  if (!place || place->excess_m > most_excess_m_) return false;
  if (!in_exterior(join.wedge, before) || !in_exterior(join.wedge, after)) return false;
  const dvec3& at = corner_point(join.wedge, corner);
  if (!bend(chain, {InteractionType::diffraction, join.index, static_cast<uint32_t>(corner)}, at, join))
    return false;
  // The faces that meet in the corner do not reflect a wave that starts there.
  const std::vector<Interaction>& list = join.path.interactions;
  const size_t middle = chain.tree.depth(chain.prefix);
  const auto holds = [&](size_t i) {
    return std::abs(model_->facets.facet(list[i].element).distance(at)) <= corner_weld_m;
  };
  return !(middle > 0 && holds(middle - 1)) && !(middle + 1 < list.size() && holds(middle + 1));
}

bool Midpoints::bend(const Chain& chain, const Interaction& middle, const dvec3& point,
                     WedgeJoin& join) const {
  GeometricPath& path = join.path;
  if (!chain.assemble(middle, point, path, join.back)) return false;
  const size_t at = chain.tree.depth(chain.prefix) + 1;
  if (!in_exterior(join.wedge, path.vertices[at - 1]) || !in_exterior(join.wedge, path.vertices[at + 1]))
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

/// Returns the ways from a target to wedges.
std::shared_ptr<const EdgeWays> Midpoints::ways_to_edges(const Target& target, uint32_t threads) const {
  if (search_target_) return edges_->from(target.position, target.body, threads, target.keep);
  EdgeWays straight;
  straight.list.add({});
  return std::make_shared<const EdgeWays>(std::move(straight));
}

void Midpoints::solve_wedges(const ImageTree& tree, const Target& target, const EdgeWays& ways,
                             uint32_t threads, std::vector<GeometricPath>& paths) const {
  const ImageTree images(model_->facets, target.position, ways.list, opposite(tree.end()));
  const std::vector<Meeting> all = meetings(ways.list);
  constexpr size_t meetings_at_once = 1024;
  std::vector<std::vector<GeometricPath>> found((all.size() + meetings_at_once - 1) / meetings_at_once);
  parallel_for(found.size(), threads, [&](size_t i) {
    const size_t first = i * meetings_at_once;
    join_at(std::span(all).subspan(first, std::min(meetings_at_once, all.size() - first)), tree, images,
            found[i]);
  });
  for (std::vector<GeometricPath>& some : found) std::ranges::move(some, std::back_inserter(paths));
  if (two_edges_) add_over_two_edges(tree, images, ways, threads, paths);
}

/// Appends the paths with a scattering and another bend. `ways`: those of the target to wedges, null without
/// diffraction.
void Midpoints::scatter_and_bend(const ImageTree& tree, const Target& target, const EdgeWays* ways,
                                 std::vector<GeometricPath>& paths) const {
  const bool edges = scatter_beside_edges_ && ways != nullptr;
  indirect_->solve({*scatterers_, tree, edge_tree_ ? *edge_tree_ : tree, edges ? &at_wedges_ : nullptr},
                   target.position, paths);
  if (edges)
    scatter_over_edges(*model_, limits_, *scatterers_, tree, target.position, ways->list.wedges_of(0), paths);
}

void Midpoints::add_over_two_edges(const ImageTree& tree, const ImageTree& images, const EdgeWays& ways,
                                   uint32_t threads, std::vector<GeometricPath>& paths) const {
  WedgeArrivals at_target(ways.list, model_->wedges, limits_.max_depth - 2);
  at_target.place(images, model_->wedges);
  const size_t first = paths.size();
  join_two_edges(*model_, limits_, edges_->pairs(), {tree, at_wedges_}, {images, at_target}, threads, paths);
  if (tree.end() == Source::receiver)
    for (size_t i = first; i < paths.size(); ++i) turn_to_transmitter(paths[i]);
}

/// Joins every prefix with the suffix of each meeting.
void Midpoints::join_at(std::span<const Meeting> at, const ImageTree& tree, const ImageTree& suffixes,
                        std::vector<GeometricPath>& paths) const {
  std::vector<uint32_t> from;
  WedgeJoin join;
  join.index = ~0u;
  for (const auto& [index, suffix] : at) {
    at_wedges_.joined(index, suffixes.image(suffix), most_before(suffixes.depth(suffix)), most_excess_m_,
                      from);
    if (from.empty()) continue;
    if (join.index != index) join.wedge = posed(model_->wedges[index], model_->facets);
    join.index = index;
    const auto keep = [&] {
      paths.push_back(join.path);
      if (tree.end() == Source::receiver) turn_to_transmitter(paths.back());
    };
    for (const uint32_t prefix : from) {
      const Chain chain{tree, suffixes, prefix, suffix};
      if (diffract(chain, join)) keep();
      if (most_excess_m_ == 0.0) continue;
      for (const Corner corner : both_corners)
        if (diffract_at(chain, corner, join)) keep();
    }
  }
}

LeftOut Midpoints::solve(const ImageTree& tree, const Target& target, uint32_t threads,
                         std::vector<GeometricPath>& paths) const {
  LeftOut left_out = edge_left_out_;
  std::shared_ptr<const EdgeWays> ways;
  if (model_->effects.diffraction && limits_.max_depth > 0) {
    ways = ways_to_edges(target, threads);
    solve_wedges(edge_tree_ ? *edge_tree_ : tree, target, *ways, threads, paths);
    left_out.add(ways->left_out);
  }
  if (scatterers_) left_out.add(scatterers_->solve(tree, target.position, target.body, threads, paths));
  if (indirect_) scatter_and_bend(tree, target, ways.get(), paths);
  return left_out;
}

}  // namespace greatx::rf
