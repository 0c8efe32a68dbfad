// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/midpoints.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "rf/diffraction.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

namespace {

struct Triangle {
  dvec3 corners[3];
};

/// Halves the longest side until none is longer than `side_m`; the pieces in order, first half first.
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
  if (patches.size() >= most)
    throw_user_error(
        "scattering_patch_m: {} m makes more than {} patches of this scene; expected a larger one", side_m,
        most);
  patches.push_back({facet, static_cast<uint32_t>(patches.size() - first), (a + b + c) / 3.0,
                     0.5 * glm::length(glm::cross(b - a, c - a))});
}

void reverse(GeometricPath& path) {
  std::reverse(path.interactions.begin(), path.interactions.end());
  std::reverse(path.vertices.begin(), path.vertices.end());
}

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
      cut({{triangle.corners[0], triangle.corners[1], triangle.corners[2]}}, side_m, index, patches, first,
          most);
    }
    std::erase_if(patches, [](const Patch& patch) { return patch.area_m2 == 0.0; });
  }
  return patches;
}

/// One prefix and one suffix that meet.
struct Midpoints::Chain {
  const ImageTree& tree;
  const ImageTree& suffixes;
  uint32_t prefix = 0, suffix = 0;

  /// Source, prefix, `middle` at `point`, suffix, target; false if either side does not get there.
  bool assemble(const Interaction& middle, const dvec3& point, GeometricPath& path) const {
    path.vertices.push_back(tree.source());
    if (!tree.reach(prefix, point, path)) return false;
    path.interactions.push_back(middle);
    path.vertices.push_back(point);
    GeometricPath back;
    if (!suffixes.reach(suffix, point, back)) return false;
    path.interactions.insert(path.interactions.end(), back.interactions.rbegin(), back.interactions.rend());
    path.vertices.insert(path.vertices.end(), back.vertices.rbegin(), back.vertices.rend());
    path.vertices.push_back(suffixes.source());
    path.length_m = glm::length(point - tree.image(prefix)) + glm::length(point - suffixes.image(suffix));
    return true;
  }
};

Midpoints::Midpoints(const RadioModel& model, const MidpointOptions& options)
    : model_(&model), options_(options) {
  if (!model.effects.scattering) return;
  patches_ = scattering_patches(*model.scene, model.kinds, options.patch_m);
  patch_offsets_.assign(model.kinds.size() + 1, 0);
  for (const Patch& patch : patches_) ++patch_offsets_[patch.facet + 1];
  for (size_t i = 1; i < patch_offsets_.size(); ++i) patch_offsets_[i] += patch_offsets_[i - 1];
}

Midpoints::Arrivals Midpoints::arrivals_at_wedges(const CandidateList& candidates) const {
  Arrivals arrivals;
  arrivals.offsets.assign(model_->wedges.size() + 1, 0);
  for (const uint32_t wedge : candidates.wedges) ++arrivals.offsets[wedge + 1];
  for (size_t i = 1; i < arrivals.offsets.size(); ++i) arrivals.offsets[i] += arrivals.offsets[i - 1];
  arrivals.sequences.resize(candidates.wedges.size());
  std::vector<uint32_t> next(arrivals.offsets.begin(), arrivals.offsets.end() - 1);
  for (uint32_t sequence = 0; sequence < candidates.size(); ++sequence)
    for (const uint32_t wedge : candidates.wedges_of(sequence)) arrivals.sequences[next[wedge]++] = sequence;
  return arrivals;
}

/// A sequence that ends with a facet says that the one without it leads there.
Midpoints::Arrivals Midpoints::arrivals_at_facets(const CandidateList& candidates) const {
  std::map<std::vector<uint32_t>, uint32_t> index_of;
  for (uint32_t i = 0; i < candidates.size(); ++i) {
    const auto facets = candidates.sequence(i);
    if (facets.size() + 1 <= options_.max_depth) index_of[{facets.begin(), facets.end()}] = i;
  }
  std::vector<std::pair<uint32_t, uint32_t>> pairs;  // facet, prefix
  for (uint32_t i = 0; i < candidates.size(); ++i) {
    const auto facets = candidates.sequence(i);
    if (facets.empty()) continue;
    const auto prefix = index_of.find({facets.begin(), facets.end() - 1});
    if (prefix != index_of.end()) pairs.emplace_back(facets.back(), prefix->second);
  }
  std::sort(pairs.begin(), pairs.end());
  Arrivals arrivals;
  arrivals.offsets.assign(model_->kinds.size() + 1, 0);
  for (const auto& [facet, prefix] : pairs) {
    ++arrivals.offsets[facet + 1];
    arrivals.sequences.push_back(prefix);
  }
  for (size_t i = 1; i < arrivals.offsets.size(); ++i) arrivals.offsets[i] += arrivals.offsets[i - 1];
  return arrivals;
}

void Midpoints::set_candidates(const CandidateList& candidates) {
  if (model_->effects.diffraction) at_wedges_ = arrivals_at_wedges(candidates);
  if (model_->effects.scattering) at_facets_ = arrivals_at_facets(candidates);
}

void Midpoints::diffract(const Chain& chain, uint32_t index, std::vector<GeometricPath>& paths) const {
  const scene::Wedge wedge = posed(model_->wedges[index], model_->facets);
  const std::optional<dvec3> point =
      keller_point(wedge, chain.tree.image(chain.prefix), chain.suffixes.image(chain.suffix));
  if (!point) return;
  GeometricPath path;
  if (!chain.assemble({InteractionType::diffraction, index}, *point, path)) return;
  const size_t middle = chain.tree.depth(chain.prefix) + 1;
  if (!in_exterior(wedge, path.vertices[middle - 1]) || !in_exterior(wedge, path.vertices[middle + 1]))
    return;
  if (!model_->effects.lit_region &&
      !in_shadow(wedge, chain.tree.image(chain.prefix), chain.suffixes.image(chain.suffix)))
    return;
  if (chain.tree.end() == Source::receiver) reverse(path);
  paths.push_back(std::move(path));
}

void Midpoints::scatter(const Chain& chain, const Patch& patch, std::vector<GeometricPath>& paths) const {
  const PosedFacet& facet = model_->facets.facet(patch.facet);
  const dvec3 point = model_->facets.motion(facet.body).pose.apply(patch.center);
  GeometricPath path;
  if (!chain.assemble({InteractionType::scattering, patch.facet, patch.number}, point, path)) return;
  // What comes from one side is scattered back to it.
  const size_t middle = chain.tree.depth(chain.prefix) + 1;
  const double from = facet.distance(path.vertices[middle - 1]),
               to = facet.distance(path.vertices[middle + 1]);
  if (std::min(std::abs(from), std::abs(to)) <= facet.tolerance_m || from * to < 0.0) return;
  path.patch_area_m2 = patch.area_m2;
  if (chain.tree.end() == Source::receiver) reverse(path);
  paths.push_back(std::move(path));
}

/// Every prefix with every suffix at every wedge and patch that both reach.
void Midpoints::join(const ImageTree& tree, const ImageTree& suffixes, const Arrivals& wedges,
                     const Arrivals& facets, std::vector<GeometricPath>& paths) const {
  const auto each = [&](std::span<const uint32_t> from, std::span<const uint32_t> to, const auto& meet) {
    for (const uint32_t suffix : to)
      for (const uint32_t prefix : from)
        if (tree.depth(prefix) + 1 + suffixes.depth(suffix) <= options_.max_depth)
          meet(Chain{tree, suffixes, prefix, suffix});
  };
  for (uint32_t wedge = 0; wedge + 1 < at_wedges_.offsets.size(); ++wedge)
    each(at_wedges_.of(wedge), wedges.of(wedge), [&](const Chain& chain) { diffract(chain, wedge, paths); });
  for (const Patch& patch : patches_)
    each(at_facets_.of(patch.facet), facets.of(patch.facet),
         [&](const Chain& chain) { scatter(chain, patch, paths); });
}

void Midpoints::solve(const ImageTree& tree, const dvec3& target, uint32_t target_body,
                      std::vector<GeometricPath>& paths) const {
  CandidateList list;
  Arrivals wedges, facets;
  if (options_.max_reflections_after > 0) {
    BeamSearchOptions search;
    search.max_depth = options_.max_reflections_after + 1;
    search.max_transmissions = options_.max_transmissions;
    search.moving_bodies = options_.moving_bodies;
    search.source_body = target_body;
    search.threads = 1;  // targets are solved side by side
    list = BeamSearch(model_->facets, model_->kinds, model_->wedges, search).search(target).list;
    wedges = arrivals_at_wedges(list);
    facets = arrivals_at_facets(list);
  } else {
    // Nothing is known of what the target sees: every wedge and facet may be reached straight.
    list.add({});
    wedges.offsets.resize(model_->wedges.size() + 1);
    facets.offsets.resize(model_->kinds.size() + 1);
    for (Arrivals* all : {&wedges, &facets}) {
      for (size_t i = 0; i < all->offsets.size(); ++i) all->offsets[i] = static_cast<uint32_t>(i);
      all->sequences.assign(all->offsets.size() - 1, 0);
    }
  }
  const Source other = tree.end() == Source::transmitter ? Source::receiver : Source::transmitter;
  join(tree, ImageTree(model_->facets, target, list, other), wedges, facets, paths);
}

}  // namespace greatx::rf
