// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/edge_search.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/same_pose.h"
#include "rf/search/beam_search.h"
#include "rf/search/target_images.h"

namespace greatx::rf {
namespace {

constexpr size_t beams_at_once = 64;

/// Sets `wedges` to those of the list of the model that lie in a region, ascending.
void wedges_in(const BeamScene& scene, std::span<const HalfSpace> region, std::vector<uint32_t>& wedges) {
  wedges.clear();
  scene.gather_wedges(region, wedges);
  size_t kept = 0;
  for (const uint32_t slot : wedges) {
    const BeamWedge& wedge = scene.wedge(slot);
    const auto outside = [&](const HalfSpace& side) {
      return glm::dot(side.normal, wedge.a) < side.offset && glm::dot(side.normal, wedge.b) < side.offset;
    };
    if (std::none_of(region.begin(), region.end(), outside)) wedges[kept++] = wedge.index;
  }
  wedges.resize(kept);
  std::sort(wedges.begin(), wedges.end());
}

/// Does the same for the beam of a sequence. The beam of the empty sequence is everything.
void wedges_behind(const BeamScene& scene, std::span<const uint32_t> sequence, const SequenceBeam& beam,
                   double extent_m, std::vector<uint32_t>& wedges) {
  if (sequence.empty()) return wedges_in(scene, {}, wedges);
  if (beam.walls == SequenceBeam::none) return;
  const auto pyramid = make_pyramid(beam, scene.facet(scene.index_of(sequence.back())), extent_m);
  if (pyramid) wedges_in(scene, pyramid->region(), wedges);
}

/// Adds the wedges behind the sequences with `depth` reflections and more, which have none yet.
void add_wedges(const BeamScene& scene, const BeamSearchResult& result, uint32_t depth, double extent_m,
                uint32_t threads, CandidateList& list) {
  const size_t count = list.size();
  size_t first = 0;
  while (first < count && list.sequence(first).size() < depth) ++first;
  const size_t last = count - first;
  std::vector<std::vector<uint32_t>> found(last);
  parallel_for((last + beams_at_once - 1) / beams_at_once, threads, [&](size_t chunk) {
    for (size_t i = chunk * beams_at_once; i < std::min(last, (chunk + 1) * beams_at_once); ++i)
      wedges_behind(scene, list.sequence(first + i), result.beams[first + i], extent_m, found[i]);
  });
  list.wedges.resize(list.wedge_offsets[first]);
  for (size_t i = 0; i < last; ++i) {
    list.wedges.insert(list.wedges.end(), found[i].begin(), found[i].end());
    list.wedge_offsets[first + i + 1] = static_cast<uint32_t>(list.wedges.size());
  }
}

}  // namespace

EdgeSearch::EdgeSearch(const RadioModel& model, const PathLimits& limits, bool moving_bodies)
    : model_(&model), limits_(limits), moving_bodies_(moving_bodies) {
  move();
}

void EdgeSearch::move() {
  if (scene_ && (!moving_bodies_ || same_poses())) return;
  scene_ = std::make_shared<const BeamScene>(model_->facets, model_->kinds, model_->wedges, moving_bodies_);
  answers_.clear();
}

/// Tells whether all bodies are where they were at the last call. If not, it takes their places.
bool EdgeSearch::same_poses() {
  std::vector<Pose> now;
  for (uint32_t body = 1; body < model_->scene->bodies.size(); ++body)
    now.push_back(model_->facets.motion(body).pose);
  const bool same =
      std::ranges::equal(now, poses_, [](const Pose& a, const Pose& b) { return same_pose(a, b); });
  poses_ = std::move(now);
  return same;
}

EdgePairs& EdgeSearch::pairs() {
  const std::lock_guard lock(pairs_mutex_);
  if (!pairs_) {
    const uint32_t walls = model_->effects.transmission ? limits_.max_transmissions : 0;
    const uint32_t left = limits_.max_depth > 2 ? limits_.max_depth - 2 : 0;
    const auto still = moving_bodies_ ? std::make_shared<const BeamScene>(model_->facets, model_->kinds,
                                                                          model_->wedges, false)
                                      : scene_;
    pairs_ = std::make_unique<EdgePairs>(*still, model_->wedges, std::min(walls, left));
  }
  return *pairs_;
}

std::shared_ptr<const EdgeWays> EdgeSearch::from(const dvec3& end, uint32_t body, uint32_t threads,
                                                 bool keep) {
  return answers_.get({end, body}, keep, [&] { return search(end, body, threads); });
}

EdgeWays EdgeSearch::search(const dvec3& end, uint32_t body, uint32_t threads) const {
  BeamSearchOptions options;
  // What follows a way is the wedge, which counts as a reflection would.
  options.max_depth = limits_.max_depth;
  options.stop_depth = std::min(limits_.max_reflections_beside_diffraction, limits_.max_depth - 1);
  options.max_transmissions = model_->effects.transmission ? limits_.max_transmissions : 0;
  options.wedge_depth = 1;
  options.source_body = body;
  options.threads = threads;
  BeamSearchResult result = BeamSearch(scene_, options, true).search(end);
  EdgeWays ways;
  ways.left_out = {result.overflow(), result.complete_depth()};
  ways.list = std::move(result.list);
  GREATX_CHECK(result.beams.size() == ways.list.size(), "{} beams of {} sequences", result.beams.size(),
               ways.list.size());
  const double extent_m =
      std::max({scene_->largest_coordinate(), std::abs(end.x), std::abs(end.y), std::abs(end.z)});
  add_wedges(*scene_, result, std::min(options.stop_depth, options.wedge_depth), extent_m, threads,
             ways.list);
  return ways;
}

}  // namespace greatx::rf
