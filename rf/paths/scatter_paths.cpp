// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Joins what the source lights with the ways from a target: all of them, or draws.
#include <algorithm>
#include <bit>
#include <cmath>

#include "core/random.h"
#include "core/watch.h"
#include "rf/paths/scatterers.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

Scatterers::Suffix Scatterers::suffix_of(const PatchArrivals& suffixes, const PatchArrival& after) {
  return {std::span(suffixes.facets).subspan(after.first, after.depth),
          std::span(suffixes.points).subspan(after.first, after.depth), after.from, after.length_m};
}

Scatterers::Suffix Scatterers::straight_from(const dvec3& target, const LitPatch& lit) const {
  return {{}, {}, target, glm::length(target - lit.position)};
}

/// Appends the path of a prefix and a suffix that meet at a patch, if both reach its centre from the same
/// side.
void Scatterers::join(const ImageTree& tree, const dvec3& target, size_t number, const PatchArrival& before,
                      const Suffix& after, std::vector<GeometricPath>& paths) const {
  const Patch& patch = patches_[number];
  const PosedFacet& facet = model_->facets.facet(patch.facet);
  const double to = facet.distance(after.from);
  if (std::abs(to) <= facet.tolerance_m) return;
  const size_t count = before.depth + 1 + after.facets.size();
  if (count > limits_.max_depth) return;
  const double from = facet.distance(before.from);
  if (std::abs(from) <= facet.tolerance_m || from * to < 0.0) return;
  GeometricPath& path = paths.emplace_back();
  path.interactions.reserve(count);
  path.vertices.reserve(count + 2);
  path.vertices.push_back(tree.source());
  for (uint32_t i = before.first; i < before.first + before.depth; ++i) {
    path.interactions.push_back({InteractionType::reflection, at_patches_.facets[i]});
    path.vertices.push_back(at_patches_.points[i]);
  }
  path.interactions.push_back({InteractionType::scattering, patch.facet, patch.number});
  path.vertices.push_back(center(patch));
  for (size_t i = after.facets.size(); i-- > 0;) {
    path.interactions.push_back({InteractionType::reflection, after.facets[i]});
    path.vertices.push_back(after.points[i]);
  }
  path.vertices.push_back(target);
  path.length_m = before.length_m + after.length_m;
  path.patch_area_m2 = patch.area_m2;
  if (tree.end() == Source::receiver) turn_to_transmitter(path);
}

/// Returns the most reflections behind a scattering that a path has room for.
uint32_t Scatterers::most_after() const {
  return std::min(limits_.max_reflections_after, std::max(1u, limits_.max_depth) - 1);
}

/// Searches for the sequences of at most `most_facets` facets that lead outwards from a target, to reflect
/// what patches send. A path may pass walls behind its scattering, too.
CandidateList Scatterers::ways_from(const dvec3& target, uint32_t body, uint32_t most_facets,
                                    uint32_t threads, LeftOut& left_out) const {
  BeamSearchOptions search;
  search.max_transmissions = model_->effects.transmission ? limits_.max_transmissions : 0;
  search.max_depth = std::min(limits_.max_depth, most_after() + 1 + search.max_transmissions);
  search.stop_depth = most_facets;
  search.moving_bodies = moving_bodies_;
  search.source_body = body;
  search.threads = threads;
  BeamSearchResult result = beams_ ? BeamSearch(beams_, search).search(target)
                                   : BeamSearch(model_->facets, model_->kinds, {}, search).search(target);
  left_out.add({result.overflow(), result.complete_depth()});
  return std::move(result.list);
}

/// Searches for the ways from a target to patches.
Scatterers::PatchArrivals Scatterers::ways_to(const ImageTree& tree, const dvec3& target, uint32_t body,
                                              uint32_t threads, LeftOut& left_out) const {
  const CandidateList list = ways_from(target, body, most_after() + 1, threads, left_out);
  std::vector<PlaneWindow> windows;
  const Arrivals facets = arrivals_at_facets(list, most_after(), windows);
  return arrivals_at_patches(facets, windows, ImageTree(model_->facets, target, list, opposite(tree.end())));
}

/// Lists the lit patches together with each way with reflections that leads from the target to them.
std::vector<SingleScattering> Scatterers::bounces(const PatchArrivals& suffixes,
                                                  std::vector<Bounce>& pairs) const {
  std::vector<SingleScattering> all;
  if (suffixes.arrivals.empty()) return all;
  for (uint32_t i = 0; i < tree_.patches().size(); ++i) {
    const LitPatch& lit = tree_.patches()[i];
    const uint32_t before = at_patches_.arrivals[lit.arrival].depth;
    for (uint32_t s = suffixes.offsets[lit.patch]; s < suffixes.offsets[lit.patch + 1]; ++s) {
      const PatchArrival& after = suffixes.arrivals[s];
      if (after.depth == 0 || before + 1 + after.depth > limits_.max_depth || after.from == lit.position)
        continue;
      const dvec3 out = glm::normalize(after.from - lit.position);
      double power = scattered_power(lit, out, after.length_m);
      if (!(power > 0.0)) continue;
      uint64_t key = std::bit_cast<uint64_t>(lit.clock);
      dvec3 from = lit.position;
      for (uint32_t k = after.first + after.depth; k-- > after.first;) {
        const dvec3& to = suffixes.points[k];
        if (to != from) power *= reflected(suffixes.facets[k], glm::normalize(to - from));
        from = to;
        key = RandomStream(key, suffixes.facets[k], k - after.first).bits();
      }
      all.push_back(
          {power, lit.length_m + after.length_m, -std::log(1.0 - RandomStream(key, lit.facet).uniform())});
      pairs.push_back({i, s});
    }
  }
  return all;
}

double Scatterers::sight_from(const dvec3& target, const LitPatch& patch) const {
  return passes_what_rests({.a = patch.position,
                            .b = target,
                            .facet_a = patch.facet,
                            .walls = walls_allowed(*model_, limits_, 1)});
}

/// Returns the share of the power that passes what rests on the way from a patch to the first reflection. The
/// search has looked at what is behind that.
double Scatterers::sight_over(const ReflectedTarget& views, uint32_t view, const LitPatch& patch) const {
  GeometricPath way;
  if (!views.reach(view, patch, way)) return 1.0;
  return passes_what_rests({.a = patch.position,
                            .b = way.vertices.back(),
                            .facet_a = patch.facet,
                            .facet_b = way.interactions.back().element,
                            .walls = walls_allowed(*model_, limits_, way.interactions.size() + 1)});
}

/// Appends the paths of the draws for a target. Patches send to it straight and on the ways of `suffixes`
/// with reflections.
void Scatterers::draw(const ImageTree& tree, const dvec3& target, const PatchArrivals& suffixes,
                      std::vector<GeometricPath>& paths) const {
  std::vector<Bounce> pairs;
  const std::vector<SingleScattering> singles = bounces(suffixes, pairs);
  const size_t straight = tree_.patches().size();
  const auto sight = [&](const LitPatch& patch, uint32_t) { return sight_from(target, patch); };
  for (const ScatterDraw& draw : draw_scatterings(tree_, target, singles, limits_.scattering_budget, sight)) {
    const bool bent = draw.index >= straight;
    const Bounce pair = bent ? pairs[draw.index - straight] : Bounce{draw.index};
    const LitPatch& lit = tree_.patches()[pair.patch];
    const size_t known = paths.size();
    join(tree, target, lit.patch, at_patches_.arrivals[lit.arrival],
         bent ? suffix_of(suffixes, suffixes.arrivals[pair.suffix]) : straight_from(target, lit), paths);
    if (paths.size() == known) continue;
    paths.back().patch_area_m2 *= draw.factor;
    paths.back().stratum = draw.stratum;
  }
}

/// Does the same with all reflections that the views show.
void Scatterers::draw(const ImageTree& tree, const dvec3& target, const ReflectedTarget& views,
                      std::vector<GeometricPath>& paths) const {
  const auto sight = [&](const LitPatch& patch, uint32_t view) {
    return view == 0 ? sight_from(target, patch) : sight_over(views, view - 1, patch);
  };
  GeometricPath way;
  std::vector<uint32_t> facets;
  for (const ScatterDraw& draw : draw_scatterings(tree_, target, views, limits_.scattering_budget, sight)) {
    const LitPatch& lit = tree_.patches()[draw.index];
    Suffix after = straight_from(target, lit);
    if (draw.view > 0) {
      if (!views.reach(draw.view - 1, lit, way)) continue;
      facets.clear();
      for (const Interaction& reflection : way.interactions) facets.push_back(reflection.element);
      after = {facets, way.vertices, way.vertices.back(),
               glm::length(views.image(draw.view - 1) - lit.position)};
    }
    const size_t known = paths.size();
    join(tree, target, lit.patch, at_patches_.arrivals[lit.arrival], after, paths);
    if (paths.size() == known) continue;
    paths.back().patch_area_m2 *= draw.factor;
    paths.back().stratum = draw.stratum;
    paths.back().draw_variance = draw.variance;
  }
}

LeftOut Scatterers::solve(const ImageTree& tree, const dvec3& target, uint32_t target_body, uint32_t threads,
                          std::vector<GeometricPath>& paths) const {
  LeftOut left_out;
  if (at_patches_.arrivals.empty()) return left_out;
  const bool bent = most_after() > 0;
  if (at_rest_ && bent) {
    const ReflectedTarget views(*model_, *shares_,
                                ways_from(target, target_body, most_after(), threads, left_out), target,
                                opposite(tree.end()), limits_.max_depth);
    const size_t straight = tree_.patches().size(), budget = limits_.scattering_budget;
    if (straight > budget || views.sees_more(tree_, budget - straight)) {
      draw(tree, target, views, paths);
      return left_out;
    }
  }
  PatchArrivals suffixes;
  if (bent)
    suffixes = ways_to(tree, target, target_body, threads, left_out);
  else if (!at_rest_)
    suffixes = straight_to_patches(target);
  if (at_rest_) {
    draw(tree, target, suffixes, paths);
    return left_out;
  }
  for (size_t patch = 0; patch < patches_.size(); ++patch) {
    checkpoint();
    for (const PatchArrival& after : suffixes.of(patch))
      for (const PatchArrival& before : at_patches_.of(patch))
        join(tree, target, patch, before, suffix_of(suffixes, after), paths);
  }
  return left_out;
}

}  // namespace greatx::rf
