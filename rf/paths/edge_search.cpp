// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/edge_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {
namespace {

constexpr size_t most_answers = 64;  ///< one takes a megabyte, more or less
constexpr size_t beams_at_once = 64;

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

/// Sets `wedges` to those of the list of the model that lie in the pyramid of a beam, ascending, or to all of
/// the scene if there is no beam.
void wedges_in(const BeamScene& scene, const SequenceBeam* beam, std::vector<uint32_t>& wedges) {
  wedges.clear();
  std::array<HalfSpace, 5> sides;
  std::span<const HalfSpace> region;
  if (beam != nullptr) {
    if (beam->walls == SequenceBeam::none) return;
    sides = pyramid(*beam, scene.largest_coordinate());
    region = sides;
  }
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

/// Adds the wedges in the pyramids of the sequences with `depth` reflections and more, which have none yet.
void add_wedges(const BeamScene& scene, const BeamSearchResult& result, uint32_t depth, uint32_t threads,
                CandidateList& list) {
  const size_t count = list.size();
  size_t first = 0;
  while (first < count && list.sequence(first).size() < depth) ++first;
  const size_t last = count - first;
  std::vector<std::vector<uint32_t>> found(last);
  parallel_for((last + beams_at_once - 1) / beams_at_once, threads, [&](size_t chunk) {
    for (size_t i = chunk * beams_at_once; i < std::min(last, (chunk + 1) * beams_at_once); ++i)
      wedges_in(scene, list.sequence(first + i).empty() ? nullptr : &result.beams[first + i], found[i]);
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
  if (scene_ && !moving_bodies_) return;
  scene_ = std::make_shared<const BeamScene>(model_->facets, model_->kinds, model_->wedges, moving_bodies_);
  answers_.clear();
  next_ = 0;
}

std::shared_ptr<const EdgeWays> EdgeSearch::known(const dvec3& end, uint32_t body) const {
  for (const Answer& answer : answers_)
    if (answer.end == end && answer.body == body) return answer.ways;
  return nullptr;
}

std::shared_ptr<const EdgeWays> EdgeSearch::from(const dvec3& end, uint32_t body, uint32_t threads,
                                                 bool keep) {
  {
    const std::lock_guard lock(mutex_);
    if (auto ways = known(end, body)) return ways;
  }
  const auto ways = std::make_shared<const EdgeWays>(search(end, body, threads));
  const std::lock_guard lock(mutex_);
  if (!keep || known(end, body)) return ways;
  if (answers_.size() < most_answers)
    answers_.push_back({end, body, ways});
  else
    answers_[std::exchange(next_, (next_ + 1) % most_answers)] = {end, body, ways};
  return ways;
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
  add_wedges(*scene_, result, std::min(options.stop_depth, options.wedge_depth), threads, ways.list);
  return ways;
}

}  // namespace greatx::rf
