// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/indirect_light.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/units.h"
#include "core/watch.h"
#include "rf/edges/diffraction.h"
#include "rf/paths/edge_share.h"
#include "rf/paths/scatter_draw.h"

namespace greatx::rf {

namespace {

/// Separates these draws from every other use of the seed of the run.
constexpr uint64_t indirect_draws = 0x696e642d6c696774ull;
constexpr size_t edges_offered = 64;
/// Tries of all patches for each scattering of the budget, and of one patch and kind at most.
constexpr double tries_of_budget = 32.0, most_tries = 64.0;
constexpr size_t lit_at_once = 64;

}  // namespace

/// Holds what the patches of one thread are lit by, and room for the tries of one.
struct IndirectLight::Work {
  std::vector<Lit> lit = {}, tries = {};
  std::vector<Offer> offers = {};
  GeometricPath way = {};
};

uint32_t strata_before(const std::vector<GeometricPath>& paths) {
  uint32_t most = 0;
  for (const GeometricPath& path : paths) most = std::max(most, path.stratum);
  return most + most % 2;
}

IndirectLight::IndirectLight(const RadioModel& model, const PathLimits& limits)
    : model_(&model), limits_(limits) {
  GREATX_CHECK(limits.scattering_budget > 0, "paths with two bends are drawn, and there is no budget");
}

void IndirectLight::forget() { ready_ = false; }

/// Lists the ways to edges. Near edges and long ones send more.
void IndirectLight::list_edges(const Origin& origin) {
  edge_ways_.clear();
  wedges_.clear();
  if (origin.edges == nullptr || limits_.max_depth < 2) return;
  const uint32_t most = std::min({limits_.max_reflections_beside_diffraction,
                                  limits_.max_reflections_before_scattering, limits_.max_depth - 2});
  wedges_.resize(model_->wedges.size());
  double sum = 0.0;
  for (const uint32_t wedge : origin.edges->wedges()) {
    const scene::Wedge& edge = wedges_[wedge] = posed(model_->wedges[wedge], model_->facets);
    for (const uint32_t sequence : origin.edges->of(wedge)) {
      const uint32_t depth = origin.edge_tree.depth(sequence);
      if (depth > most) continue;
      constexpr double room_m = 5.0, of_reflection = 0.2;
      const EdgeView view = view_of(edge, origin.edge_tree.image(sequence));
      const double away_m = room_m + view.from_edge_m;
      const double weight = std::pow(of_reflection, depth) * view.angle / away_m;
      if (!(weight > 0.0)) continue;  // the image is on the edge's line
      sum += weight;
      edge_ways_.push_back({wedge, sequence, sum, weight});
    }
  }
}

/// Draws the first stage.
void IndirectLight::light(const Origin& origin) {
  list_edges(origin);
  const std::vector<Patch>& patches = origin.scatterers.patches();
  const double of_patch =
      tries_of_budget * limits_.scattering_budget / std::max(1.0, static_cast<double>(patches.size()));
  tries_ = static_cast<uint32_t>(std::clamp(of_patch, 2.0, most_tries));
  chance_ = std::min(1.0, of_patch / tries_);
  const uint64_t seed = RandomStream(model_->effects.field.seed ^ indirect_draws, 0).bits();
  std::vector<Work> works((patches.size() + lit_at_once - 1) / lit_at_once);
  parallel_for(works.size(), 0, [&](size_t chunk) {
    const size_t last = std::min(patches.size(), (chunk + 1) * lit_at_once);
    for (size_t i = chunk * lit_at_once; i < last; ++i)
      light_patch(origin, static_cast<uint32_t>(i), seed, works[chunk]);
  });
  std::vector<LitPatch> lit;
  bends_.clear();
  for (const Work& work : works)
    for (const Lit& one : work.lit) {
      lit.push_back(one.patch);
      lit.back().arrival = static_cast<uint32_t>(bends_.size());
      bends_.push_back(one.bend);
    }
  tree_ = ScatterTree(std::move(lit));
}

/// Tries what lights a patch.
void IndirectLight::light_patch(const Origin& origin, uint32_t number, uint64_t seed, Work& work) const {
  checkpoint();
  const Patch& patch = origin.scatterers.patches()[number];
  RandomStream random(seed, patch.facet, patch.number);
  if (random.uniform() >= chance_) return;
  const size_t known = work.lit.size();
  work.tries.clear();
  for (uint32_t i = 0; i < tries_ && limits_.max_scatterings > 1; ++i)
    light_by_patch(origin, number, random.uniform(), work);
  add_mean(work.lit.size(), work.tries, work.lit);
  work.tries.clear();
  for (uint32_t i = 0; i < tries_ && !edge_ways_.empty(); ++i) {
    const double of_offers = random.uniform(), of_choice = random.uniform();
    light_by_edge(origin, number, of_offers, of_choice, work);
  }
  add_mean(work.lit.size(), work.tries, work.lit);
  for (size_t i = known; i < work.lit.size(); ++i)
    work.lit[i].patch.clock = -std::log(1.0 - random.uniform());
}

/// Appends the mean of the tries of one patch and kind to `lit`, from `first` on: each bend once.
void IndirectLight::add_mean(size_t first, std::vector<Lit>& tries, std::vector<Lit>& lit) const {
  const double count = tries_;
  double all = 0.0;
  for (Lit& one : tries) {
    one.bend.weight /= count * chance_, one.patch.power /= count * chance_;
    all += one.patch.power;
    const double square = one.patch.power * one.patch.power;
    const auto same = std::find_if(lit.begin() + static_cast<ptrdiff_t>(first), lit.end(), [&](const Lit& b) {
      return b.bend.element == one.bend.element && b.bend.sequence == one.bend.sequence;
    });
    if (same == lit.end()) {
      lit.push_back(one);
      lit.back().bend.variance = square;
    } else {
      same->patch.power += one.patch.power;
      same->bend.weight += one.bend.weight;
      same->bend.variance += square;
    }
  }
  // The variance of a mean, (sum of squares - square of the sum / count)/(count - 1) with the tries divided
  // by the count, and that of leaving out the patch. Each bend has its part.
  for (size_t i = first; i < lit.size(); ++i) {
    const double power = lit[i].patch.power;
    lit[i].bend.variance =
        chance_ * count / (count - 1.0) * (lit[i].bend.variance / power - all / count) / power +
        (1.0 - chance_) * all / power;
  }
}

void IndirectLight::solve(const Origin& origin, const dvec3& target, std::vector<GeometricPath>& paths) {
  {
    const std::lock_guard lock(mutex_);
    if (!ready_) light(origin);
    ready_ = true;
  }
  if (tree_.empty()) return;
  const uint32_t walls = walls_allowed(*model_, limits_, 2), before = strata_before(paths);
  const auto sight = [&](const LitPatch& patch, uint32_t) {
    return origin.scatterers.passes_what_rests(
        {.a = patch.position, .b = target, .facet_a = patch.facet, .walls = walls});
  };
  GeometricPath path;
  for (const ScatterDraw& draw : draw_scatterings(tree_, target, {}, two_bend_budget(limits_), sight)) {
    const LitPatch& lit = tree_.patches()[draw.index];
    const Bend& bend = bends_[lit.arrival];
    if (!assemble(origin, lit, bend, target, path)) continue;
    (bend.edge ? path.patch_area_m2 : path.second_patch_area_m2) *= draw.factor * bend.weight;
    path.draw_variance = bend.variance / draw.factor;
    if (draw.stratum > 0) path.stratum = before + draw.stratum;
    if (origin.tree.end() == Source::receiver) turn_to_transmitter(path);
    paths.push_back(path);
  }
}

void IndirectLight::light_by_patch(const Origin& origin, uint32_t number, double u, Work& work) const {
  const Scatterers& scatterers = origin.scatterers;
  const dvec3 to = scatterers.center(scatterers.patches()[number]);
  const ScatterTree& sources = scatterers.lit();
  const ScatterTree::Descent found =
      sources.descend([&](const ScatterTree::Node& node) { return sources.to(node, to); }, u);
  if (found.patch == ScatterTree::none) return;
  const LitPatch& by = scatterers.lit().patches()[found.patch];
  const uint32_t interactions = scatterers.reflections_to(by) + 2;
  if (by.patch == number || interactions > limits_.max_depth) return;
  const double between_m = glm::distance(by.position, to);
  if (between_m == 0.0) return;
  const double area_m2 = scatterers.patches()[by.patch].area_m2;
  const double power =
      scattered_power(by, (to - by.position) / between_m, between_patches_m(between_m, area_m2));
  if (!(power > 0.0)) return;
  const double passes =
      scatterers.passes_what_rests({.a = by.position,
                                    .b = to,
                                    .facet_a = by.facet,
                                    .facet_b = scatterers.patches()[number].facet,
                                    .walls = walls_allowed(*model_, limits_, interactions)});
  if (passes == 0.0) return;
  const double weight = 1.0 / found.probability;
  std::optional<LitPatch> lit = scatterers.met(number, by.position, passes * power * weight, 1.0);
  if (!lit) return;
  lit->length_m = by.length_m + between_m;
  work.tries.push_back({*lit, {.element = found.patch, .point = by.position, .weight = weight}});
}

/// Adds a way, which comes with the probability `chance`, to the offers if it may bend towards `to`.
void IndirectLight::offer(const Origin& origin, const EdgeWay& way, const dvec3& to, double chance,
                          Work& work) const {
  const scene::Wedge& wedge = wedges_[way.wedge];
  const dvec3& image = origin.edge_tree.image(way.sequence);
  const std::optional<dvec3> point = keller_point(wedge, image, to);
  if (!point) return;
  if (!model_->effects.diffraction_lit_region && !in_shadow(wedge, image, to)) return;
  const double length_m = glm::distance(image, *point) + glm::distance(*point, to);
  const double wave_number = 2.0 * pi / model_->surfaces.wavelength_m();
  const double power = edge_share(wedge, image, *point, to, wave_number) / (length_m * length_m);
  work.offers.push_back({&way, *point, length_m, chance, power / chance});
}

/// Offers about `edges_offered` of the ways to `to`.
void IndirectLight::offer_edges(const Origin& origin, const dvec3& to, double u, Work& work) const {
  work.offers.clear();
  if (edge_ways_.size() <= edges_offered) {
    for (const EdgeWay& way : edge_ways_) offer(origin, way, to, 1.0, work);
    return;
  }
  // Marks stand at equal distances on the line of all weights. A way with a mark or more is offered once.
  const double step = edge_ways_.back().sum / edges_offered;
  double mark = u * step;
  for (auto way = edge_ways_.begin(); way != edge_ways_.end(); ++way) {
    way = std::upper_bound(way, edge_ways_.end(), mark,
                           [](double at, const EdgeWay& one) { return at < one.sum; });
    if (way == edge_ways_.end()) return;
    offer(origin, *way, to, std::min(1.0, way->weight / step), work);
    mark += step * (std::floor((way->sum - mark) / step) + 1.0);
  }
}

void IndirectLight::light_by_edge(const Origin& origin, uint32_t number, double u_offers, double u_choice,
                                  Work& work) const {
  const Patch& patch = origin.scatterers.patches()[number];
  const dvec3 to = origin.scatterers.center(patch);
  offer_edges(origin, to, u_offers, work);
  double sum = 0.0;
  for (const Offer& one : work.offers) sum += one.share;
  double left = u_choice * sum;
  const auto taken =
      std::ranges::find_if(work.offers, [&](const Offer& one) { return (left -= one.share) < 0.0; });
  if (taken == work.offers.end()) return;
  const double power = over_edge(origin, *taken, patch, to, work.way);
  if (power == 0.0) return;
  const double weight = sum / (taken->share * taken->chance);
  std::optional<LitPatch> lit = origin.scatterers.met(number, taken->point, power * weight, 1.0);
  if (!lit) return;
  lit->length_m = taken->length_m;
  work.tries.push_back({*lit, {true, taken->way->wedge, taken->way->sequence, taken->point, weight}});
}

/// Returns the power per area that arrives at a patch over an edge, for what is at rest, relative to what the
/// source sends: the mean over both polarizations. 0: nothing arrives. `way` is room.
double IndirectLight::over_edge(const Origin& origin, const Offer& offer, const Patch& patch, const dvec3& to,
                                GeometricPath& way) const {
  const Scatterers& scatterers = origin.scatterers;
  const scene::Wedge& wedge = wedges_[offer.way->wedge];
  way.clear();
  way.vertices.push_back(origin.tree.source());
  if (!origin.edge_tree.reach(offer.way->sequence, offer.point, way)) return 0.0;
  if (!in_exterior(wedge, way.vertices.back())) return 0.0;
  const uint32_t walls = walls_allowed(*model_, limits_, way.interactions.size() + 2);
  double share = scatterers.passes_what_rests({.a = offer.point,
                                               .b = to,
                                               .facet_a = wedge.facet_0,
                                               .facet_b = patch.facet,
                                               .other_a = wedge.facet_n,
                                               .walls = walls});
  const size_t count = way.interactions.size();
  for (size_t i = 0; i <= count && share > 0.0; ++i) {
    Segment segment{.a = way.vertices[i], .b = i < count ? way.vertices[i + 1] : offer.point, .walls = walls};
    if (i > 0) segment.facet_a = way.interactions[i - 1].element;
    segment.facet_b = i < count ? way.interactions[i].element : wedge.facet_0;
    if (i == count) segment.other_b = wedge.facet_n;
    share *= scatterers.passes_what_rests(segment);
    if (i < count && segment.a != segment.b)
      share *= scatterers.reflected(segment.facet_b, glm::normalize(segment.b - segment.a));
  }
  if (share == 0.0 || way.vertices.back() == offer.point) return 0.0;
  const double after_m = glm::distance(offer.point, to), before_m = offer.length_m - after_m;
  const EdgeDyadic edge =
      edge_dyadic(wedge, glm::normalize(offer.point - way.vertices.back()), glm::normalize(to - offer.point),
                  before_m, after_m, model_->facets, model_->surfaces);
  double power = 0.0;
  for (const Complex& element : edge.matrix) power += 0.5 * std::norm(element);
  return share * power / (offer.length_m * offer.length_m);
}

/// Sets `path` to the one that leads over a bend and a patch to the target. Returns false if there is none.
bool IndirectLight::assemble(const Origin& origin, const LitPatch& lit, const Bend& bend, const dvec3& target,
                             GeometricPath& path) const {
  const Scatterers& scatterers = origin.scatterers;
  const Patch& patch = scatterers.patches()[lit.patch];
  const PosedFacet& facet = model_->facets.facet(patch.facet);
  const double side = facet.distance(target), from = facet.distance(bend.point);
  if (std::abs(side) <= facet.tolerance_m || side * from < 0.0) return false;
  path.clear();
  path.vertices.push_back(origin.tree.source());
  if (bend.edge) {
    if (!origin.edge_tree.reach(bend.sequence, bend.point, path)) return false;
    path.interactions.push_back({InteractionType::diffraction, bend.element});
    path.patch_area_m2 = patch.area_m2;
  } else {
    const LitPatch& by = scatterers.lit().patches()[bend.element];
    const Patch& first = scatterers.patches()[by.patch];
    scatterers.append_way(by, path);
    path.interactions.push_back({InteractionType::scattering, first.facet, first.number});
    path.patch_area_m2 = first.area_m2;
    path.second_patch_area_m2 = patch.area_m2;
  }
  path.vertices.push_back(bend.point);
  path.interactions.push_back({InteractionType::scattering, patch.facet, patch.number});
  path.vertices.push_back(lit.position);
  path.vertices.push_back(target);
  path.length_m = lit.length_m + glm::distance(lit.position, target);
  return true;
}

}  // namespace greatx::rf
