// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/reference/exhaustive_paths.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "core/error.h"
#include "core/random.h"
#include "rf/reference/chains.h"

namespace greatx::rf::reference {

namespace {

struct Found {
  uint32_t receiver;
  GeometricPath path;
};

/// Holds the memory and the results of one thread.
struct Worker {
  std::vector<std::vector<HalfSpace>> half_spaces;  ///< by depth
  std::vector<Found> found;
  std::vector<uint64_t> sequences;
  uint64_t geometric_paths = 0;
};

class Enumeration {
 public:
  Enumeration(const scene::Scene& scene, const FacetWorld& world, std::span<const Pose> body_poses,
              const FacetKinds& kinds, const dvec3& transmitter, std::span<const dvec3> receivers,
              const ExhaustiveOptions& options)
      : chains_(scene, world, body_poses, kinds),
        transmitter_(transmitter),
        receivers_(receivers),
        options_(options),
        receiver_tree_(boxes_of(receivers)) {}

  ExhaustiveResult run();

 private:
  static std::vector<scene::Bounds> boxes_of(std::span<const dvec3> points);
  /// Must be called for each length of the chain in turn.
  const std::vector<HalfSpace>& view(const Chain& chain, Worker& worker) const {
    const size_t depth = chain.facets.size();
    chains_.view(chain, worker.half_spaces[depth - 1], worker.half_spaces[depth]);
    return worker.half_spaces[depth];
  }
  void descend(Chain& chain, uint32_t levels, Worker& worker) const;
  std::vector<std::pair<uint32_t, uint32_t>> first_pairs(Worker& worker) const;
  void work(const std::vector<std::pair<uint32_t, uint32_t>>& pairs, std::atomic<size_t>& next, bool reports,
            Worker& worker) const;
  void try_receiver(const Chain& chain, uint32_t receiver, Worker& worker) const;

  Chains chains_;
  const dvec3 transmitter_;
  std::span<const dvec3> receivers_;
  const ExhaustiveOptions& options_;
  BoxTree receiver_tree_;
};

std::vector<scene::Bounds> Enumeration::boxes_of(std::span<const dvec3> points) {
  std::vector<scene::Bounds> boxes(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y) || !std::isfinite(points[i].z))
      throw_user_error("receiver {}: expected a finite position, found ({}, {}, {})", i, points[i].x,
                       points[i].y, points[i].z);
    boxes[i].add(points[i]);
  }
  return boxes;
}

/// Tries the receivers behind the chain's last facet, and then every facet that may be next, `levels` deep.
void Enumeration::descend(Chain& chain, uint32_t levels, Worker& worker) const {
  ++worker.sequences[chain.facets.size()];
  const std::vector<HalfSpace>& half_spaces = view(chain, worker);
  receiver_tree_.within(half_spaces, [&](uint32_t receiver) { try_receiver(chain, receiver, worker); });
  if (levels == 0) return;
  chains_.next(half_spaces, [&](uint32_t facet) {
    if (!chains_.push(chain, facet)) return;
    descend(chain, levels - 1, worker);
    Chains::pop(chain);
  });
}

void Enumeration::try_receiver(const Chain& chain, uint32_t receiver, Worker& worker) const {
  GeometricPath path;
  const dvec3& at = receivers_[receiver];
  if (!chains_.reflect(chain, at, path.vertices)) return;
  path.length_m = glm::distance(chain.images.back(), at);
  for (const uint32_t facet : chain.facets)
    path.interactions.push_back({InteractionType::reflection, facet, 0});
  ++worker.geometric_paths;
  const Chains::Limits limits{options_.max_depth, options_.max_transmissions, options_.transmitter_body,
                              options_.receiver_body};
  if (chains_.pass_walls(path, limits)) worker.found.push_back({receiver, std::move(path)});
}

/// Returns all sequences of two facets in random order, so that the share that is done predicts the remaining
/// time. On the way it tries the receivers for one reflection.
std::vector<std::pair<uint32_t, uint32_t>> Enumeration::first_pairs(Worker& worker) const {
  std::vector<std::pair<uint32_t, uint32_t>> pairs;
  Chain chain{{}, {}, {transmitter_}};
  for (const uint32_t first : chains_.facets()) {
    if (!chains_.push(chain, first)) continue;
    descend(chain, 0, worker);
    const std::vector<HalfSpace>& half_spaces = worker.half_spaces[1];
    if (options_.max_depth > 1)
      chains_.next(half_spaces, [&](uint32_t second) {
        if (!chains_.push(chain, second)) return;
        pairs.emplace_back(first, second);
        Chains::pop(chain);
      });
    Chains::pop(chain);
  }
  RandomStream random(1, 1);
  for (size_t i = pairs.size(); i > 1; --i) std::swap(pairs[i - 1], pairs[random.bits() % i]);
  return pairs;
}

void Enumeration::work(const std::vector<std::pair<uint32_t, uint32_t>>& pairs, std::atomic<size_t>& next,
                       bool reports, Worker& worker) const {
  constexpr size_t batch = 256;
  for (;;) {
    const size_t begin = next.fetch_add(batch);
    if (begin >= pairs.size()) return;
    if (reports && options_.progress)
      options_.progress(static_cast<double>(begin) / static_cast<double>(pairs.size()));
    for (size_t i = begin; i < std::min(begin + batch, pairs.size()); ++i) {
      Chain chain{{}, {}, {transmitter_}};
      chains_.push(chain, pairs[i].first);
      view(chain, worker);
      chains_.push(chain, pairs[i].second);
      descend(chain, options_.max_depth - 2, worker);
    }
  }
}

bool one_polyline(const GeometricPath& a, const GeometricPath& b) {
  const double tolerance = std::max(1e-6, 1e-9 * a.length_m);
  if (std::abs(a.length_m - b.length_m) > tolerance) return false;
  return std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                    [&](const dvec3& p, const dvec3& q) { return glm::distance(p, q) <= tolerance; });
}

/// Sorts one receiver's paths and keeps the first of each polyline.
std::vector<GeometricPath> without_duplicates(std::vector<GeometricPath> paths) {
  std::sort(paths.begin(), paths.end(), [](const GeometricPath& a, const GeometricPath& b) {
    return interactions_less(a.interactions, b.interactions);
  });
  std::vector<GeometricPath> kept;
  for (GeometricPath& path : paths)
    if (std::none_of(kept.begin(), kept.end(), [&](const GeometricPath& k) { return one_polyline(k, path); }))
      kept.push_back(std::move(path));
  return kept;
}

ExhaustiveResult Enumeration::run() {
  uint32_t threads = options_.threads > 0 ? options_.threads : std::thread::hardware_concurrency();
  threads = std::max(1u, threads);
  std::vector<Worker> workers(threads);
  for (Worker& worker : workers) {
    worker.half_spaces.resize(options_.max_depth + 1);
    worker.sequences.resize(options_.max_depth + 1);
  }
  const Chain direct{{}, {}, {transmitter_}};
  workers[0].sequences[0] = 1;
  for (uint32_t r = 0; r < receivers_.size(); ++r)
    if (glm::distance(transmitter_, receivers_[r]) > 1e-9) try_receiver(direct, r, workers[0]);

  if (options_.max_depth > 0) {
    const std::vector<std::pair<uint32_t, uint32_t>> pairs = first_pairs(workers[0]);
    std::atomic<size_t> next{0};
    std::vector<std::thread> pool;
    for (uint32_t i = 1; i < threads; ++i)
      pool.emplace_back([&, i] { work(pairs, next, false, workers[i]); });
    work(pairs, next, true, workers[0]);
    for (std::thread& thread : pool) thread.join();
  }

  ExhaustiveResult result;
  result.paths.resize(receivers_.size());
  result.sequences.resize(options_.max_depth + 1);
  for (Worker& worker : workers) {
    for (Found& found : worker.found) result.paths[found.receiver].push_back(std::move(found.path));
    for (size_t depth = 0; depth < result.sequences.size(); ++depth)
      result.sequences[depth] += worker.sequences[depth];
    result.geometric_paths += worker.geometric_paths;
  }
  for (std::vector<GeometricPath>& paths : result.paths) paths = without_duplicates(std::move(paths));
  return result;
}

}  // namespace

ExhaustiveResult exhaustive_paths(const scene::Scene& scene, const FacetWorld& world,
                                  std::span<const Pose> body_poses, const FacetKinds& kinds,
                                  const dvec3& transmitter, std::span<const dvec3> receivers,
                                  const ExhaustiveOptions& options) {
  return Enumeration(scene, world, body_poses, kinds, transmitter, receivers, options).run();
}

}  // namespace greatx::rf::reference
