// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/two_edge_paths.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "core/parallel.h"
#include "core/units.h"
#include "core/watch.h"
#include "rf/edges/keller_points.h"

namespace greatx::rf {
namespace {

constexpr size_t wedges_at_once = 16;

class TwoEdgeJoin {
 public:
  TwoEdgeJoin(const RadioModel& model, const PathLimits& limits, const EdgeEnd& source, const EdgeEnd& target)
      : model_(model),
        source_(source),
        target_(target),
        most_beside_(std::min(limits.max_reflections_beside_diffraction, limits.max_depth - 2)),
        most_reflections_(limits.max_depth - 2),
        floor_db_(limits.two_edge_floor_db) {}

  /// Tells whether the source reaches a wedge with few enough reflections.
  bool reaches(uint32_t first) const { return source_.arrivals.least_depth(first) <= most_beside_; }

  /// Joins all ways over `first` and then `second`.
  void join(uint32_t first, uint32_t second, std::vector<GeometricPath>& paths) {
    const uint32_t nearest = target_.arrivals.least_depth(second);
    const uint32_t least = source_.arrivals.least_depth(first);
    if (least > most_beside_ || nearest > most_beside_ || least + nearest > most_reflections_) return;
    const scene::Wedge from = posed(model_.wedges[first], model_.facets),
                       to = posed(model_.wedges[second], model_.facets);
    for (const uint32_t suffix : target_.arrivals.of(second)) {
      const uint32_t behind = target_.tree.depth(suffix);
      if (behind > most_beside_ || behind + least > most_reflections_) continue;
      const dvec3& after = target_.tree.image(suffix);
      if (!in_exterior(to, after)) continue;
      for (const uint32_t prefix : source_.arrivals.of(first)) {
        const uint32_t before = source_.tree.depth(prefix);
        if (before > most_beside_ || before + behind > most_reflections_) continue;
        const auto points = keller_points(from, to, source_.tree.image(prefix), after);
        if (!points || !strong_enough(from, to, source_.tree.image(prefix), *points, after)) continue;
        if (assemble(first, second, prefix, suffix, *points, from, to)) paths.push_back(path_);
      }
    }
  }

 private:
  bool strong_enough(const scene::Wedge& from, const scene::Wedge& to, const dvec3& before,
                     const KellerPoints& points, const dvec3& after) const {
    const double wave_number = 2.0 * pi / model_.surfaces.wavelength_m();
    return least_two_edge_loss_db(from, to, before, points, after, wave_number) <= floor_db_;
  }

  bool assemble(uint32_t first, uint32_t second, uint32_t prefix, uint32_t suffix, const KellerPoints& points,
                const scene::Wedge& from, const scene::Wedge& to) {
    path_.clear();
    path_.vertices.push_back(source_.tree.source());
    if (!source_.tree.reach(prefix, points.first, path_)) return false;
    if (!in_exterior(from, path_.vertices.back())) return false;
    path_.interactions.push_back({InteractionType::diffraction, first});
    path_.interactions.push_back({InteractionType::diffraction, second});
    path_.vertices.push_back(points.first);
    path_.vertices.push_back(points.second);
    back_.clear();
    if (!target_.tree.reach(suffix, points.second, back_)) return false;
    back_.vertices.insert(back_.vertices.begin(), target_.tree.source());
    if (!in_exterior(to, back_.vertices.back())) return false;
    const dvec3 &before = source_.tree.image(prefix), &after = target_.tree.image(suffix);
    if (!model_.effects.diffraction_lit_region &&
        !(in_shadow(from, before, points.second) && in_shadow(to, points.first, after)))
      return false;
    path_.interactions.insert(path_.interactions.end(), back_.interactions.rbegin(),
                              back_.interactions.rend());
    path_.vertices.insert(path_.vertices.end(), back_.vertices.rbegin(), back_.vertices.rend());
    path_.length_m = glm::length(points.first - before) + glm::length(points.second - points.first) +
                     glm::length(after - points.second);
    return true;
  }

  const RadioModel& model_;
  const EdgeEnd &source_, &target_;
  uint32_t most_beside_, most_reflections_;
  double floor_db_;
  GeometricPath path_, back_;
};

}  // namespace

void join_two_edges(const RadioModel& model, const PathLimits& limits, EdgePairs& pairs,
                    const EdgeEnd& source, const EdgeEnd& target, uint32_t threads,
                    std::vector<GeometricPath>& paths) {
  if (limits.max_depth < 2) return;
  const auto wedges = source.arrivals.wedges();
  std::vector<std::vector<GeometricPath>> found((wedges.size() + wedges_at_once - 1) / wedges_at_once);
  parallel_for(found.size(), threads, [&](size_t chunk) {
    TwoEdgeJoin joiner(model, limits, source, target);
    for (size_t i = chunk * wedges_at_once; i < std::min(wedges.size(), (chunk + 1) * wedges_at_once); ++i) {
      checkpoint();
      if (!joiner.reaches(wedges[i])) continue;
      for (const uint32_t second : pairs.seen_from(wedges[i])) joiner.join(wedges[i], second, found[chunk]);
    }
  });
  for (std::vector<GeometricPath>& some : found) std::ranges::move(some, std::back_inserter(paths));
}

}  // namespace greatx::rf
