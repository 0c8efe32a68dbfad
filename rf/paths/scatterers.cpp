// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/scatterers.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/watch.h"

namespace greatx::rf {

namespace {

/// Separates the draws of the clocks from every other use of the seed of the run.
constexpr uint64_t way_clocks = 0x7761792d636c6b73ull;

/// Returns an exponential variable of mean 1.
double exponential(RandomStream random) { return -std::log(1.0 - random.uniform()); }

/// Checks that a number fits into 32 bits and returns it. Throws UserError if it does not fit.
uint32_t number_of(size_t count, const char* what) {
  if (count > ~0u)
    throw_user_error("paths: {} {}, expected at most {}; a smaller max_depth, a larger scattering_patch_m",
                     count, what, ~0u);
  return static_cast<uint32_t>(count);
}

}  // namespace

void turn_to_transmitter(GeometricPath& path) {
  std::reverse(path.interactions.begin(), path.interactions.end());
  std::reverse(path.vertices.begin(), path.vertices.end());
  path.from_receiver = true;
}

Scatterers::Scatterers(const RadioModel& model, const PathLimits& limits, bool moving_bodies)
    : model_(&model),
      limits_(limits),
      moving_bodies_(moving_bodies),
      patches_(scattering_patches(*model.scene, model.kinds, limits.patch_m)) {
  if (most_after() > 0 && !moving_bodies)
    beams_ =
        std::make_shared<const BeamScene>(model.facets, model.kinds, std::span<const scene::Wedge>{}, false);
  if (limits.scattering_budget == 0) return;
  if (most_after() > 0) shares_.emplace(model);
  FacetKinds kinds = model.kinds;
  for (uint32_t i = 0; i < kinds.size(); ++i)
    if (model.facets.facet(i).body != 0) kinds[i] = FacetKind::absent;
  at_rest_.emplace(*model.scene, kinds);
}

/// Finds the sequences that lead to facets. A candidate sequence that ends with a facet shows that the
/// sequence without this facet leads to the facet. `windows`: [sequences of the result], the part of the
/// facet that the sequence reaches; or empty.
Scatterers::Arrivals Scatterers::arrivals_at_facets(const CandidateList& candidates,
                                                    uint32_t most_reflections,
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

dvec3 Scatterers::center(const Patch& patch) const {
  const uint32_t body = model_->facets.facet(patch.facet).body;
  return body == 0 ? patch.center : model_->facets.motion(body).pose.apply(patch.center);
}

Scatterers::PatchArrivals Scatterers::arrivals_at_patches(const Arrivals& at_facets,
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
Scatterers::PatchArrivals Scatterers::straight_to_patches(const dvec3& from) const {
  PatchArrivals at_patches;
  at_patches.offsets.push_back(0);
  for (const Patch& patch : patches_) {
    at_patches.arrivals.push_back({0, 0, from, glm::length(center(patch) - from)});
    at_patches.offsets.push_back(static_cast<uint32_t>(at_patches.arrivals.size()));
  }
  return at_patches;
}

void Scatterers::set_candidates(const CandidateList& candidates, const ImageTree& tree) {
  std::vector<PlaneWindow> windows;
  at_facets_ = arrivals_at_facets(candidates, limits_.max_reflections_before_scattering, windows);
  place_ways(tree, windows);
}

void Scatterers::move(const ImageTree& tree) { place_ways(tree, {}); }

void Scatterers::place_ways(const ImageTree& tree, const std::vector<PlaneWindow>& windows) {
  at_patches_ = arrivals_at_patches(at_facets_, windows, tree);
  if (!at_rest_) return;
  std::vector<std::pair<uint32_t, uint32_t>> ways;  // patch, arrival
  for (uint32_t patch = 0; patch < patches_.size(); ++patch)
    for (uint32_t i = at_patches_.offsets[patch]; i < at_patches_.offsets[patch + 1]; ++i)
      ways.emplace_back(patch, i);
  std::vector<std::optional<LitPatch>> found(ways.size());
  constexpr size_t ways_at_once = 256;
  parallel_for((ways.size() + ways_at_once - 1) / ways_at_once, 0, [&](size_t chunk) {
    checkpoint();
    for (size_t i = chunk * ways_at_once; i < std::min(ways.size(), (chunk + 1) * ways_at_once); ++i)
      found[i] = lit_patch(ways[i].first, ways[i].second, tree.source());
  });
  std::vector<LitPatch> lit;
  for (const std::optional<LitPatch>& one : found)
    if (one) lit.push_back(*one);
  tree_ = ScatterTree(std::move(lit));
}

double Scatterers::passes_what_rests(const Segment& segment) const {
  Crossing crossing;
  at_rest_->settle(model_->facets, segment, crossing);
  if (crossing.blocked) return 0.0;
  double share = 1.0;
  for (const uint32_t wall : crossing.walls) {
    const PosedFacet& facet = model_->facets.facet(wall);
    const double towards = glm::dot(glm::normalize(segment.b - segment.a), facet.normal);
    const SheetTransmission sheet =
        model_->surfaces.transmit(facet.material, towards < 0.0, std::min(1.0, std::abs(towards)));
    share *= 0.5 * (std::norm(sheet.te) + std::norm(sheet.tm));
  }
  return std::max(share, 1e-30);
}

/// Returns the share of the source's power that passes what is at rest on the way to a patch; 0: none does.
double Scatterers::reaches(const PatchArrival& way, const Patch& patch, const dvec3& source) const {
  const uint32_t walls = walls_allowed(*model_, limits_, way.depth + 1);
  double share = 1.0;
  for (uint32_t i = 0; i <= way.depth && share > 0.0; ++i) {
    Segment segment{.a = i == 0 ? source : at_patches_.points[way.first + i - 1],
                    .b = i == way.depth ? center(patch) : at_patches_.points[way.first + i]};
    if (i > 0) segment.facet_a = at_patches_.facets[way.first + i - 1];
    segment.facet_b = i == way.depth ? patch.facet : at_patches_.facets[way.first + i];
    segment.walls = walls;
    share *= passes_what_rests(segment);
  }
  return share;
}

double Scatterers::reflected(uint32_t index, const dvec3& in) const {
  const PosedFacet& facet = model_->facets.facet(index);
  const double towards = glm::dot(in, facet.normal);
  const ReflectionCoefficients r =
      model_->surfaces.reflect(facet.material, towards < 0.0, std::min(1.0, std::abs(towards)));
  return std::max(1e-4, 0.5 * (std::norm(r.r_te) + std::norm(r.r_tm)));
}

/// Describes a patch as the wave on a way from the source meets it. None: it is not lit.
std::optional<LitPatch> Scatterers::lit_patch(uint32_t number, uint32_t arrival, const dvec3& source) const {
  const Patch& patch = patches_[number];
  const PatchArrival& way = at_patches_.arrivals[arrival];
  const PosedFacet& facet = model_->facets.facet(patch.facet);
  const double side = facet.distance(way.from);
  if (std::abs(side) <= facet.tolerance_m) return std::nullopt;
  double share = reaches(way, patch, source);
  if (share == 0.0) return std::nullopt;
  uint64_t key = model_->effects.field.seed ^ way_clocks;
  dvec3 from = source;
  for (uint32_t i = way.first; i < way.first + way.depth; ++i) {
    const dvec3& to = at_patches_.points[i];
    if (to != from) share *= reflected(at_patches_.facets[i], glm::normalize(to - from));
    from = to;
    key = RandomStream(key, at_patches_.facets[i], i - way.first).bits();
  }
  std::optional<LitPatch> lit = met(number, way.from, share, way.length_m * way.length_m);
  if (!lit) return std::nullopt;
  lit->length_m = way.length_m;
  lit->arrival = arrival;
  lit->depth = way.depth;
  lit->clock = exponential(RandomStream(key, patch.facet, patch.number));
  return lit;
}

std::optional<LitPatch> Scatterers::met(uint32_t number, const dvec3& from, double share,
                                        double spread_m2) const {
  const Patch& patch = patches_[number];
  const PosedFacet& facet = model_->facets.facet(patch.facet);
  const double side = facet.distance(from);
  if (std::abs(side) <= facet.tolerance_m) return std::nullopt;
  LitPatch lit;
  lit.position = center(patch);
  lit.normal = side > 0.0 ? facet.normal : -facet.normal;
  const dvec3 in = glm::normalize(lit.position - from);
  const double cosine = std::max(1e-9, -glm::dot(in, lit.normal));
  lit.specular = in + 2.0 * cosine * lit.normal;
  lit.surface = &model_->surfaces.surface(facet.material).scattering;
  lit.power = share * reflected(patch.facet, in) * lit.surface->coefficient * lit.surface->coefficient *
              cosine * patch.area_m2 / spread_m2;
  if (!(lit.power > 0.0)) return std::nullopt;
  lit.facet = patch.facet;
  lit.patch = number;
  return lit;
}

void Scatterers::append_way(const LitPatch& lit, GeometricPath& path) const {
  const PatchArrival& way = at_patches_.arrivals[lit.arrival];
  for (uint32_t i = way.first; i < way.first + way.depth; ++i) {
    path.interactions.push_back({InteractionType::reflection, at_patches_.facets[i]});
    path.vertices.push_back(at_patches_.points[i]);
  }
}

}  // namespace greatx::rf
