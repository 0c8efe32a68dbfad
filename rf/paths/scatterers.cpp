// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/scatterers.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/watch.h"
#include "rf/paths/scatter_draw.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

namespace {

/// Separates the draws of the clocks from every other use of the seed of the run.
constexpr uint64_t way_clocks = 0x7761792d636c6b73ull;

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

}  // namespace

void turn_to_transmitter(GeometricPath& path) {
  std::reverse(path.interactions.begin(), path.interactions.end());
  std::reverse(path.vertices.begin(), path.vertices.end());
  path.from_receiver = true;
}

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

Scatterers::Scatterers(const RadioModel& model, const PathLimits& limits, bool moving_bodies)
    : model_(&model),
      limits_(limits),
      moving_bodies_(moving_bodies),
      patches_(scattering_patches(*model.scene, model.kinds, limits.patch_m)) {
  if (limits.scattering_budget == 0) return;
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
  std::vector<LitPatch> scatterers;
  for (const std::optional<LitPatch>& one : found)
    if (one) scatterers.push_back(*one);
  tree_ = ScatterTree(std::move(scatterers));
}

/// Returns the number of walls that a path with these interactions may pass.
uint32_t Scatterers::walls_beside(uint32_t interactions) const {
  if (!model_->effects.transmission || interactions >= limits_.max_depth) return 0;
  return std::min({limits_.max_depth - interactions, limits_.max_transmissions, shared::crossings_max});
}

/// Returns the share of the power that passes everything at rest on a segment; 0: it is blocked.
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
  const uint32_t interactions = way.depth + 1;
  const uint32_t walls =
      model_->effects.transmission && interactions < limits_.max_depth
          ? std::min({limits_.max_depth - interactions, limits_.max_transmissions, shared::crossings_max})
          : 0;
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

/// Describes a patch as the wave on a way from the source meets it. None: it is not lit.
std::optional<LitPatch> Scatterers::lit_patch(uint32_t number, uint32_t arrival, const dvec3& source) const {
  const Patch& patch = patches_[number];
  const PatchArrival& way = at_patches_.arrivals[arrival];
  const PosedFacet& facet = model_->facets.facet(patch.facet);
  const double side = facet.distance(way.from);
  if (std::abs(side) <= facet.tolerance_m) return std::nullopt;
  const double share = reaches(way, patch, source);
  if (share == 0.0) return std::nullopt;
  const auto reflected = [&](const PosedFacet& mirror, const dvec3& in) {
    const double towards = glm::dot(in, mirror.normal);
    const ReflectionCoefficients r =
        model_->surfaces.reflect(mirror.material, towards < 0.0, std::min(1.0, std::abs(towards)));
    // A share that is too small costs accuracy, and one of 0 would lose power.
    return std::max(1e-4, 0.5 * (std::norm(r.r_te) + std::norm(r.r_tm)));
  };
  LitPatch scatterer;
  scatterer.position = center(patch);
  scatterer.normal = side > 0.0 ? facet.normal : -facet.normal;
  const dvec3 in = glm::normalize(scatterer.position - way.from);
  const double cos_in = std::max(0.0, -glm::dot(in, scatterer.normal));
  scatterer.specular = in + 2.0 * cos_in * scatterer.normal;
  scatterer.surface = &model_->surfaces.surface(facet.material).scattering;
  const double coefficient = scatterer.surface->coefficient;
  scatterer.power = share * coefficient * coefficient * reflected(facet, in) * std::max(cos_in, 1e-9) *
                    patch.area_m2 / (way.length_m * way.length_m);
  dvec3 from = source;
  uint64_t key = model_->effects.field.seed ^ way_clocks;
  for (uint32_t i = way.first; i < way.first + way.depth; ++i) {
    const dvec3& to = at_patches_.points[i];
    if (to != from)
      scatterer.power *= reflected(model_->facets.facet(at_patches_.facets[i]), glm::normalize(to - from));
    from = to;
    key = RandomStream(key, at_patches_.facets[i], i - way.first).bits();
  }
  if (!(scatterer.power > 0.0)) return std::nullopt;
  scatterer.length_m = way.length_m;
  scatterer.facet = patch.facet;
  scatterer.patch = number;
  scatterer.arrival = arrival;
  scatterer.clock = -std::log(1.0 - RandomStream(key, patch.facet, patch.number).uniform());
  return scatterer;
}

/// Appends the path of a prefix and a suffix that meet at a patch, if both reach its centre from the same
/// side.
void Scatterers::join(const ImageTree& tree, const dvec3& target, size_t number, const PatchArrival& before,
                      const PatchArrival& after, const PatchArrivals& suffixes,
                      std::vector<GeometricPath>& paths) const {
  const Patch& patch = patches_[number];
  const PosedFacet& facet = model_->facets.facet(patch.facet);
  const double to = facet.distance(after.from);
  if (std::abs(to) <= facet.tolerance_m) return;
  const size_t count = before.depth + 1 + after.depth;
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
  for (uint32_t i = after.first + after.depth; i-- > after.first;) {
    path.interactions.push_back({InteractionType::reflection, suffixes.facets[i]});
    path.vertices.push_back(suffixes.points[i]);
  }
  path.vertices.push_back(target);
  path.length_m = before.length_m + after.length_m;
  path.patch_area_m2 = patch.area_m2;
  if (tree.end() == Source::receiver) turn_to_transmitter(path);
}

/// Appends the paths of the draws for a target, to which patches send straight.
void Scatterers::draw(const ImageTree& tree, const dvec3& target, std::vector<GeometricPath>& paths) const {
  if (tree_.empty()) return;
  const PatchArrivals none;
  for (const ScatterDraw& draw : draw_scatterers(tree_, target, limits_.scattering_budget)) {
    const LitPatch& scatterer = tree_.scatterers()[draw.scatterer];
    const size_t known = paths.size();
    join(tree, target, scatterer.patch, at_patches_.arrivals[scatterer.arrival],
         {0, 0, target, glm::length(target - scatterer.position)}, none, paths);
    if (paths.size() == known) continue;
    paths.back().patch_area_m2 *= draw.factor;
    paths.back().stratum = draw.stratum;
  }
}

LeftOut Scatterers::solve(const ImageTree& tree, const dvec3& target, uint32_t target_body, uint32_t threads,
                          std::vector<GeometricPath>& paths) const {
  LeftOut left_out;
  if (at_patches_.arrivals.empty()) return left_out;
  if (limits_.scattering_budget > 0 && limits_.max_reflections_after == 0) {
    draw(tree, target, paths);
    return left_out;
  }
  PatchArrivals at_patches;
  if (limits_.max_reflections_after > 0) {
    BeamSearchOptions search;
    search.max_depth = limits_.max_reflections_after + 1;
    search.max_transmissions = model_->effects.transmission ? limits_.max_transmissions : 0;
    search.moving_bodies = moving_bodies_;
    search.source_body = target_body;
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
  for (size_t patch = 0; patch < patches_.size(); ++patch) {
    checkpoint();
    for (const PatchArrival& after : at_patches.of(patch))
      for (const PatchArrival& before : at_patches_.of(patch))
        join(tree, target, patch, before, after, at_patches, paths);
  }
  return left_out;
}

}  // namespace greatx::rf
