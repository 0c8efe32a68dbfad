// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/suffix_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"

namespace greatx::rf {
namespace {

/// Returns the half-spaces of all rays from the image of a beam through its rectangle, behind the rectangle.
/// Each is wider than the pyramid by the roundings of fp64.
std::array<HalfSpace, 5> pyramid(const SequenceBeam& beam, double largest_m) {
  const dvec3 &a = beam.half_a, &b = beam.half_b, to_center = beam.center - beam.image;
  std::array<HalfSpace, 5> sides;
  const auto bound = [&](size_t i, dvec3 normal, const dvec3& inside) {
    const double length = glm::length(normal);
    if (length > 0.0) normal /= length;
    if (glm::dot(normal, inside - beam.image) < 0.0) normal = -normal;
    const double room = 1e-9 + 1e-12 * (largest_m + glm::length(beam.image));
    sides[i] = {normal, glm::dot(normal, beam.image) - room};
  };
  bound(0, glm::cross(to_center + a, b), beam.center);
  bound(1, glm::cross(to_center - a, b), beam.center);
  bound(2, glm::cross(to_center + b, a), beam.center);
  bound(3, glm::cross(to_center - b, a), beam.center);
  // Behind the mirror; a wedge may lie in its plane.
  dvec3 normal = glm::cross(a, b);
  if (const double length = glm::length(normal); length > 0.0) normal /= length;
  if (glm::dot(normal, to_center) < 0.0) normal = -normal;
  sides[4] = {normal, glm::dot(normal, beam.center) - 1e-3};
  return sides;
}

}  // namespace

SuffixSearch::SuffixSearch(const RadioModel& model, const PathLimits& limits, bool moving_bodies)
    : model_(&model), limits_(limits), moving_bodies_(moving_bodies) {
  move();
}

void SuffixSearch::move() {
  if (scene_ && !moving_bodies_) return;
  scene_ = std::make_shared<const BeamScene>(model_->facets, model_->kinds, model_->wedges, moving_bodies_);
}

const Suffixes& SuffixSearch::from(const dvec3& target, uint32_t body, uint32_t threads,
                                   SuffixMemory& memory) const {
  if (memory.scene != scene_ || memory.target != target || memory.body != body)
    memory = {scene_, target, body, search(target, body, threads)};
  return memory.suffixes;
}

Suffixes SuffixSearch::search(const dvec3& target, uint32_t body, uint32_t threads) const {
  BeamSearchOptions options;
  // What follows a suffix is the wedge, which counts as a reflection would.
  options.max_depth = limits_.max_depth;
  options.stop_depth = std::min(limits_.max_reflections_beside_diffraction, limits_.max_depth - 1);
  options.max_transmissions = model_->effects.transmission ? limits_.max_transmissions : 0;
  options.source_body = body;
  options.threads = threads;
  BeamSearchResult result = BeamSearch(scene_, options).search(target);
  Suffixes suffixes;
  suffixes.left_out = {result.overflow(), result.complete_depth()};
  suffixes.list = std::move(result.list);
  suffixes.beams = std::move(result.beams);
  GREATX_CHECK(suffixes.beams.size() == suffixes.list.size(), "{} beams of {} sequences",
               suffixes.beams.size(), suffixes.list.size());
  return suffixes;
}

void SuffixSearch::wedges_of(const Suffixes& suffixes, size_t sequence, std::vector<uint32_t>& wedges) const {
  wedges.clear();
  const SequenceBeam& beam = suffixes.beams[sequence];
  if (beam.walls == SequenceBeam::none) return;
  const std::array<HalfSpace, 5> region = pyramid(beam, scene_->largest_coordinate());
  scene_->gather_wedges(region, wedges);
  const uint32_t last = suffixes.list.sequence(sequence).back();
  size_t kept = 0;
  for (const uint32_t slot : wedges) {
    const BeamWedge& wedge = scene_->wedge(slot);
    const scene::Wedge& own = model_->wedges[wedge.index];
    if (own.facet_0 == last || own.facet_n == last) continue;
    const auto outside = [&](const HalfSpace& side) {
      return glm::dot(side.normal, wedge.a) < side.offset && glm::dot(side.normal, wedge.b) < side.offset;
    };
    if (!std::any_of(region.begin(), region.end(), outside)) wedges[kept++] = wedge.index;
  }
  wedges.resize(kept);
  std::sort(wedges.begin(), wedges.end());
}

}  // namespace greatx::rf
