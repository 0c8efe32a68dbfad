// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/reference/exhaustive_paths.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "core/error.h"
#include "core/random.h"
#include "rf/reference/occluders.h"
#include "rf/reference/pyramid.h"

namespace greatx::rf::reference {

namespace {

/// Holds a sequence of facets under test, with the image of the transmitter in each.
struct Chain {
  std::vector<uint32_t> facets;
  std::vector<double> sides;  ///< [facets] +1 if the paths are on the side of the facet's normal, else -1
  std::vector<dvec3> images;  ///< [facets + 1]: the transmitter, then its images
};

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
      : world_(world),
        kinds_(kinds),
        transmitter_(transmitter),
        receivers_(receivers),
        options_(options),
        occluders_(scene, world, body_poses, kinds),
        facet_tree_(make_hulls(scene, body_poses)),
        receiver_tree_(boxes_of(receivers)) {}

  ExhaustiveResult run();

 private:
  std::vector<scene::Bounds> make_hulls(const scene::Scene& scene, std::span<const Pose> body_poses);
  static std::vector<scene::Bounds> boxes_of(std::span<const dvec3> points);
  bool push(Chain& chain, uint32_t facet) const;
  static void pop(Chain& chain);
  const std::vector<HalfSpace>& view(const Chain& chain, Worker& worker) const;
  void descend(Chain& chain, uint32_t levels, Worker& worker) const;
  std::vector<std::pair<uint32_t, uint32_t>> first_pairs(Worker& worker) const;
  void work(const std::vector<std::pair<uint32_t, uint32_t>>& pairs, std::atomic<size_t>& next, bool reports,
            Worker& worker) const;
  bool reflect(const Chain& chain, const dvec3& receiver, GeometricPath& path) const;
  bool pass_walls(GeometricPath& path) const;
  void try_receiver(const Chain& chain, uint32_t receiver, Worker& worker) const;

  const FacetWorld& world_;
  const FacetKinds& kinds_;
  const dvec3 transmitter_;
  std::span<const dvec3> receivers_;
  const ExhaustiveOptions& options_;
  Occluders occluders_;
  std::vector<Hull> hulls_;       ///< [facets]; without corners if the facet cannot reflect
  std::vector<uint32_t> facets_;  ///< facets that can reflect
  BoxTree facet_tree_;            ///< over facets_
  BoxTree receiver_tree_;
};

std::vector<scene::Bounds> Enumeration::make_hulls(const scene::Scene& scene,
                                                   std::span<const Pose> body_poses) {
  hulls_.resize(scene.facets.size());
  std::vector<scene::Bounds> boxes;
  for (uint32_t f = 0; f < scene.facets.size(); ++f) {
    const scene::Facet& facet = scene.facets[f];
    if (kinds_[f] != FacetKind::opaque && kinds_[f] != FacetKind::wall) continue;
    std::vector<dvec3> corners;
    for (uint32_t t = 0; t < facet.triangle_count; ++t)
      for (const dvec3& corner : scene.facet_triangles[facet.first_triangle + t].corners)
        corners.push_back(facet.body == 0 ? corner : body_poses[facet.body].apply(corner));
    hulls_[f] = convex_hull(world_.facet(f), corners);
    facets_.push_back(f);
    boxes.push_back(hulls_[f].box);
  }
  return boxes;
}

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

/// Extends the chain by a facet. Returns false if the sides alone show that no path has this facet next.
bool Enumeration::push(Chain& chain, uint32_t index) const {
  const PosedFacet& facet = world_.facet(index);
  const double distance = facet.distance(chain.images.back());
  if (std::abs(distance) <= facet.tolerance_m) return false;
  const double side = distance > 0.0 ? 1.0 : -1.0;
  if (!chain.facets.empty()) {
    if (chain.facets.back() == index) return false;
    const auto has_corner = [&](uint32_t of, const PosedFacet& plane, double on, double beyond) {
      return std::any_of(hulls_[of].corners.begin(), hulls_[of].corners.end(),
                         [&](const dvec3& corner) { return on * plane.distance(corner) > beyond; });
    };
    const PosedFacet& last = world_.facet(chain.facets.back());
    if (!has_corner(chain.facets.back(), facet, side, -facet.tolerance_m)) return false;
    if (!has_corner(index, last, chain.sides.back(), last.tolerance_m)) return false;
  }
  chain.facets.push_back(index);
  chain.sides.push_back(side);
  chain.images.push_back(chain.images.back() - 2.0 * distance * facet.normal);
  return true;
}

void Enumeration::pop(Chain& chain) {
  chain.facets.pop_back();
  chain.sides.pop_back();
  chain.images.pop_back();
}

/// Returns half-spaces that hold everything the chain's last image sees through its facet, after the facets
/// before. It must be called for each length of the chain in turn.
const std::vector<HalfSpace>& Enumeration::view(const Chain& chain, Worker& worker) const {
  const size_t depth = chain.facets.size();
  const uint32_t last = chain.facets.back();
  std::vector<HalfSpace>& half_spaces = worker.half_spaces[depth];
  pyramid(chain.images.back(), world_.facet(last), hulls_[last], chain.sides.back(), half_spaces);
  const std::vector<HalfSpace>& before = worker.half_spaces[depth - 1];
  for (size_t i = 1; i < before.size(); ++i)  // before[0] is the plane of the mirror before
    half_spaces.push_back(mirrored(before[i], world_.facet(last)));
  return half_spaces;
}

/// Tries the receivers behind the chain's last facet, and then every facet that may be next, `levels` deep.
void Enumeration::descend(Chain& chain, uint32_t levels, Worker& worker) const {
  ++worker.sequences[chain.facets.size()];
  const std::vector<HalfSpace>& half_spaces = view(chain, worker);
  receiver_tree_.within(half_spaces, [&](uint32_t receiver) { try_receiver(chain, receiver, worker); });
  if (levels == 0) return;
  facet_tree_.within(half_spaces, [&](uint32_t item) {
    const uint32_t facet = facets_[item];
    if (!may_meet(hulls_[facet], half_spaces) || !push(chain, facet)) return;
    descend(chain, levels - 1, worker);
    pop(chain);
  });
}

/// Finds the reflection points of this chain. The receiver is mirrored from the last facet to the first, and
/// the lines to its images are intersected from the transmitter on, in the opposite direction to the
/// enumeration.
bool Enumeration::reflect(const Chain& chain, const dvec3& receiver, GeometricPath& path) const {
  const size_t count = chain.facets.size();
  std::vector<dvec3> targets(count + 1, receiver);
  for (size_t i = count; i-- > 0;) {
    const PosedFacet& facet = world_.facet(chain.facets[i]);
    targets[i] = targets[i + 1] - 2.0 * facet.distance(targets[i + 1]) * facet.normal;
  }
  path.vertices.assign(1, transmitter_);
  for (size_t i = 0; i < count; ++i) {
    const PosedFacet& facet = world_.facet(chain.facets[i]);
    const double tolerance = facet.tolerance_m, side = chain.sides[i];
    const double before = side * facet.distance(path.vertices.back());
    const double behind = -side * facet.distance(targets[i]);
    if (before < (i == 0 ? tolerance : -tolerance) || behind <= tolerance) return false;
    if (i + 1 == count && side * facet.distance(receiver) < tolerance) return false;
    const double t = std::max(before, 0.0) / (std::max(before, 0.0) + behind);
    const dvec3 hit = path.vertices.back() + t * (targets[i] - path.vertices.back());
    if (!world_.contains(chain.facets[i], facet.plane_coordinates(hit))) return false;
    if (i > 0) {
      const PosedFacet& previous = world_.facet(chain.facets[i - 1]);
      // The hit must be on the reflecting side of the facet before.
      if (chain.sides[i - 1] * previous.distance(hit) < -previous.tolerance_m) return false;
      const bool one_point =
          glm::distance(hit, path.vertices.back()) <= 4.0 * (tolerance + previous.tolerance_m);
      const bool inner_corner = side * facet.distance(previous.centroid) > tolerance &&
                                chain.sides[i - 1] * previous.distance(facet.centroid) > previous.tolerance_m;
      if (one_point && !inner_corner) return false;
    }
    path.vertices.push_back(hit);
  }
  path.vertices.push_back(receiver);
  path.length_m = glm::distance(transmitter_, targets[0]);
  path.interactions.clear();
  for (const uint32_t facet : chain.facets)
    path.interactions.push_back({InteractionType::reflection, facet, 0});
  return true;
}

/// Turns passed walls into interactions of the path. Returns false if the path is blocked.
bool Enumeration::pass_walls(GeometricPath& path) const {
  const auto body = [](uint32_t index) { return index == 0 ? Stretch::none : index; };
  const size_t reflections = path.interactions.size();
  uint32_t budget =
      std::min(options_.max_transmissions, options_.max_depth - static_cast<uint32_t>(reflections));
  GeometricPath whole;
  whole.length_m = path.length_m;
  std::vector<WallPassed> walls;
  for (size_t i = 0; i <= reflections; ++i) {
    Stretch stretch{path.vertices[i], path.vertices[i + 1]};
    if (i > 0) stretch.facet_a = path.interactions[i - 1].element;
    if (i < reflections) stretch.facet_b = path.interactions[i].element;
    if (i == 0) stretch.body_a = body(options_.transmitter_body);
    if (i == reflections) stretch.body_b = body(options_.receiver_body);
    walls.clear();
    if (!occluders_.free_but_for(stretch, budget, walls)) return false;
    budget -= static_cast<uint32_t>(walls.size());
    whole.vertices.push_back(stretch.a);
    for (const WallPassed& wall : walls) {
      whole.vertices.push_back(stretch.a + wall.t * (stretch.b - stretch.a));
      whole.interactions.push_back({InteractionType::transmission, wall.facet, 0});
    }
    if (i < reflections) whole.interactions.push_back(path.interactions[i]);
  }
  whole.vertices.push_back(path.vertices.back());
  path = std::move(whole);
  return true;
}

void Enumeration::try_receiver(const Chain& chain, uint32_t receiver, Worker& worker) const {
  GeometricPath path;
  if (!reflect(chain, receivers_[receiver], path)) return;
  ++worker.geometric_paths;
  if (pass_walls(path)) worker.found.push_back({receiver, std::move(path)});
}

/// Returns all sequences of two facets in random order, so that the share that is done predicts the remaining
/// time. On the way it tries the receivers for one reflection.
std::vector<std::pair<uint32_t, uint32_t>> Enumeration::first_pairs(Worker& worker) const {
  std::vector<std::pair<uint32_t, uint32_t>> pairs;
  Chain chain{{}, {}, {transmitter_}};
  for (const uint32_t first : facets_) {
    if (!push(chain, first)) continue;
    descend(chain, 0, worker);
    const std::vector<HalfSpace>& half_spaces = worker.half_spaces[1];
    if (options_.max_depth > 1)
      facet_tree_.within(half_spaces, [&](uint32_t item) {
        const uint32_t second = facets_[item];
        if (!may_meet(hulls_[second], half_spaces) || !push(chain, second)) return;
        pairs.emplace_back(first, second);
        pop(chain);
      });
    pop(chain);
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
      push(chain, pairs[i].first);
      view(chain, worker);
      push(chain, pairs[i].second);
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
