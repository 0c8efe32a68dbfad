// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/edge_behind_patch.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "core/watch.h"
#include "rf/edges/diffraction.h"
#include "rf/paths/edge_share.h"
#include "rf/paths/indirect_light.h"
#include "rf/paths/scatter_draw.h"

namespace greatx::rf {

namespace {

/// Separates these draws from every other use of the seed of the run.
constexpr uint64_t edge_draws = 0x656467652d64726dull;
constexpr uint32_t candidates_of_draw = 8, most_candidates = 1u << 18;

/// An edge that the target sees, with the sum of the weights of all edges up to it.
struct SeenEdge {
  uint32_t index = 0;
  scene::Wedge wedge;
  EdgeView view;
  BoundaryShare boundaries;
  double sum = 0.0, weight = 0.0;
};

/// An edge and a patch, which one or more of the draws have met.
struct Candidate {
  const SeenEdge* edge = nullptr;
  uint32_t lit = 0;  ///< index into the patches that the source lights
  dvec3 point{0.0};
  double estimate = 0.0;  ///< of the power
  double weight = 0.0;    ///< sum of the inverse probabilities
  double squares = 0.0;   ///< sum of their squares
  bool same_pair(const Candidate& other) const { return edge == other.edge && lit == other.lit; }
};

class EdgesBehindPatches {
 public:
  EdgesBehindPatches(const RadioModel& model, const PathLimits& limits, const Scatterers& scatterers,
                     const ImageTree& tree, const dvec3& target, std::span<const uint32_t> edges)
      : model_(model),
        limits_(limits),
        scatterers_(scatterers),
        tree_(tree),
        target_(target),
        wave_number_(2.0 * pi / model.surfaces.wavelength_m()) {
    constexpr double room_m = 3.0;
    double sum = 0.0;
    for (const uint32_t index : edges) {
      const scene::Wedge wedge = posed(model.wedges[index], model.facets);
      if (!in_exterior(wedge, target)) continue;
      const EdgeView view = view_of(wedge, target);
      const double weight = view.angle / (room_m + view.from_edge_m);
      if (!(weight > 0.0)) continue;  // the target is on the edge's line
      sum += weight;
      seen_.push_back({index, wedge, view, {wedge, target, wave_number_}, sum, weight});
    }
  }

  void draw(std::vector<GeometricPath>& paths) const {
    if (seen_.empty() || scatterers_.lit().empty()) return;
    const std::vector<Candidate> candidates = draw_candidates();
    const uint64_t seed = RandomStream(model_.effects.field.seed ^ edge_draws, 1).bits();
    std::vector<SingleScattering> singles;
    for (const Candidate& one : candidates) {
      const LitPatch& lit = scatterers_.lit().patches()[one.lit];
      const Patch& patch = scatterers_.patches()[lit.patch];
      const uint64_t key = RandomStream(seed, one.edge->index, scatterers_.reflections_to(lit)).bits();
      singles.push_back(
          {one.estimate * one.weight,
           lit.length_m + glm::distance(lit.position, one.point) + glm::distance(one.point, target_),
           -std::log(1.0 - RandomStream(key, patch.facet, patch.number).uniform())});
    }
    const uint32_t before = strata_before(paths);
    GeometricPath path;
    for (const ScatterDraw& draw : draw_scatterings({}, target_, singles, two_bend_budget(limits_), {})) {
      const Candidate& one = candidates[draw.index];
      if (!assemble(one, path)) continue;
      path.patch_area_m2 *= draw.factor * one.weight;
      path.draw_variance = one.squares / (one.weight * one.weight) / draw.factor;
      if (draw.stratum > 0) path.stratum = before + draw.stratum;
      if (tree_.end() == Source::receiver) turn_to_transmitter(path);
      paths.push_back(path);
    }
  }

 private:
  /// Returns the candidates in the order of edges and patches, each pair once.
  std::vector<Candidate> draw_candidates() const {
    const uint32_t count =
        std::min(two_bend_budget(limits_), most_candidates / candidates_of_draw) * candidates_of_draw;
    const uint64_t seed = RandomStream(model_.effects.field.seed ^ edge_draws, 0).bits();
    const double offset = RandomStream(seed, count).uniform();
    std::vector<Candidate> all;
    for (uint32_t i = 0; i < count; ++i) {
      if (i % 256 == 0) checkpoint();
      RandomStream random(seed, i, 1);
      const double mark = (i + offset) / count * seen_.back().sum;
      const auto edge = std::upper_bound(seen_.begin(), seen_.end(), mark,
                                         [](double at, const SeenEdge& one) { return at < one.sum; });
      if (edge != seen_.end()) add(*edge, count, random, all);
    }
    std::ranges::stable_sort(all, [](const Candidate& a, const Candidate& b) {
      return a.edge != b.edge ? a.edge < b.edge : a.lit < b.lit;
    });
    std::vector<Candidate> pairs;
    for (const Candidate& one : all) {
      if (pairs.empty() || !pairs.back().same_pair(one)) {
        pairs.push_back(one);
        continue;
      }
      pairs.back().weight += one.weight;
      pairs.back().squares += one.squares;
    }
    return pairs;
  }

  /// Draws a place on an edge, the more densely the nearer it is to the target's foot, and a patch, and adds
  /// them if they may carry power.
  void add(const SeenEdge& edge, uint32_t count, RandomStream& random, std::vector<Candidate>& all) const {
    const dvec3 along = glm::normalize(edge.wedge.b - edge.wedge.a);
    const double place_m =
        edge.view.foot_m + edge.view.away_m * std::tan(edge.view.first + edge.view.angle * random.uniform());
    const dvec3 place = edge.wedge.a + place_m * along;
    const ScatterTree& sources = scatterers_.lit();
    const ScatterTree::Descent found = sources.descend(
        [&](const ScatterTree::Node& node) {
          return sources.to(node, place) * edge.boundaries.of(node.center, node.radius_m);
        },
        random.uniform());
    if (found.patch == ScatterTree::none) return;
    const LitPatch& lit = sources.patches()[found.patch];
    if (scatterers_.reflections_to(lit) + 2 > limits_.max_depth) return;
    const std::optional<dvec3> point = keller_point(edge.wedge, lit.position, target_);
    if (!point) return;
    const PosedFacet& facet = model_.facets.facet(lit.facet);
    if (std::abs(facet.distance(*point)) <= facet.tolerance_m) return;
    if (!model_.effects.diffraction_lit_region && !in_shadow(edge.wedge, lit.position, target_)) return;
    const double before_m = glm::distance(lit.position, *point), after_m = glm::distance(*point, target_);
    const double estimate = scattered_power(lit, (*point - lit.position) / before_m, before_m + after_m) *
                            edge_share(edge.wedge, lit.position, *point, target_, wave_number_);
    if (!(estimate > 0.0)) return;
    const double weight = seen_.back().sum / (edge.weight * found.probability * count);
    all.push_back({&edge, found.patch, *point, estimate, weight, weight * weight});
  }

  bool assemble(const Candidate& candidate, GeometricPath& path) const {
    const LitPatch& lit = scatterers_.lit().patches()[candidate.lit];
    const Patch& patch = scatterers_.patches()[lit.patch];
    path.clear();
    path.vertices.push_back(tree_.source());
    scatterers_.append_way(lit, path);
    path.interactions.push_back({InteractionType::scattering, patch.facet, patch.number});
    path.interactions.push_back({InteractionType::diffraction, candidate.edge->index});
    path.vertices.push_back(lit.position);
    path.vertices.push_back(candidate.point);
    path.vertices.push_back(target_);
    path.patch_area_m2 = patch.area_m2;
    path.length_m =
        lit.length_m + glm::distance(lit.position, candidate.point) + glm::distance(candidate.point, target_);
    return candidate.point != target_;
  }

  const RadioModel& model_;
  const PathLimits& limits_;
  const Scatterers& scatterers_;
  const ImageTree& tree_;
  dvec3 target_;
  double wave_number_;
  std::vector<SeenEdge> seen_;
};

}  // namespace

void scatter_over_edges(const RadioModel& model, const PathLimits& limits, const Scatterers& scatterers,
                        const ImageTree& tree, const dvec3& target, std::span<const uint32_t> edges,
                        std::vector<GeometricPath>& paths) {
  GREATX_CHECK(limits.scattering_budget > 0, "paths with two bends are drawn, and there is no budget");
  if (limits.max_depth < 2) return;
  EdgesBehindPatches(model, limits, scatterers, tree, target, edges).draw(paths);
}

}  // namespace greatx::rf
