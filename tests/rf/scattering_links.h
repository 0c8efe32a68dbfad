// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Small scenes that scatter, and the links in them, for tests of drawn scatterings.
#pragma once

#include <algorithm>
#include <vector>

#include "rf/paths/path_solver.h"
#include "rf/search/beam_search.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::rf::testing {

using scene::ScatteringPattern;
using test::TinyScene;

inline constexpr double budget_hz = 3.5e9;

/// Adds a half-space of concrete that scatters (index 1) and one that does not (2).
inline TinyScene rough_materials(ScatteringPattern pattern) {
  TinyScene tiny;
  for (const double coefficient : {0.4, 0.0}) {
    scene::Material material;
    material.name = coefficient > 0.0 ? "rough" : "smooth";
    scene::RadioMaterial radio;
    radio.layers.push_back({*scene::itu_medium("concrete"), 0.0});
    radio.scattering_coefficient = coefficient;
    radio.pattern = pattern;
    material.radio = radio;
    tiny.material_as(material);
  }
  return tiny;
}

/// Ground, a wall and a house that hides parts of both.
inline TinyScene yard(ScatteringPattern pattern = ScatteringPattern::directive) {
  TinyScene tiny = rough_materials(pattern);
  tiny.object("ground", 0, 1).quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0});
  tiny.object("wall", 0, 1).quad({-20, 25, 0}, {20, 25, 0}, {20, 25, 12}, {-20, 25, 12});
  tiny.object("house", 0, 1).box({-4, 0, 0}, {5, 6, 7});
  return tiny;
}

inline RadioEffects with_scattering(uint64_t seed = 1) {
  RadioEffects effects;
  effects.scattering = true;
  effects.field.seed = seed;
  return effects;
}

/// Traces segments in a scene at rest.
class Obstacles {
 public:
  explicit Obstacles(const scene::Scene& scene, const RadioEffects& effects = with_scattering())
      : gpu_scene_(test::device(), scene, {}),
        pass_(gpu_scene_, facet_kinds(scene, effects)),
        bodies_(scene.bodies.size()) {}
  std::vector<Crossing> on(const std::vector<Segment>& segments, const FacetWorld& world) {
    gpu::TickRing ring(test::device(), 1, 1u << 16, 1u << 16);
    gpu::TickSlot& slot = ring.begin();
    gpu_scene_.record_update(slot, bodies_);
    const CrossingPass::Pending pending = pass_.record(slot, segments);
    ring.submit(slot);
    ring.wait(slot);
    return pass_.collect(pending, segments, world);
  }

 private:
  scene::GpuScene gpu_scene_;
  CrossingPass pass_;
  std::vector<Pose> bodies_;
};

/// Solves links from one source.
class Links {
 public:
  Links(const scene::Scene& scene, const dvec3& source, const PathLimits& limits, uint64_t seed = 1,
        Source end = Source::transmitter)
      : Links(scene, source, limits, with_scattering(seed), end) {}
  Links(const scene::Scene& scene, const dvec3& source, const PathLimits& limits, const RadioEffects& effects,
        Source end = Source::transmitter, bool moving_bodies = false)
      : model_(scene, budget_hz, effects),
        source_(source),
        end_(end),
        moving_bodies_(moving_bodies),
        solver_(model_, limits, moving_bodies) {
    search();
  }
  std::vector<GeometricPath> geometry(const dvec3& target, uint32_t threads = 1) const {
    return solver_.geometry({.position = target}, threads).paths;
  }
  /// Returns the paths as if nothing were in the way.
  std::vector<Path> unhidden(const dvec3& target) const { return unhidden(geometry(target), target); }
  std::vector<Path> unhidden(const std::vector<GeometricPath>& paths, const dvec3& target) const {
    return unhidden_between(paths, transmitter(target).position, receiver(target).position);
  }
  std::vector<Path> unhidden_between(const std::vector<GeometricPath>& paths, const dvec3& from,
                                     const dvec3& to) const {
    size_t segments = 0;
    for (const GeometricPath& path : paths) segments += path.interactions.size() + 1;
    return solver_.finish(paths, std::vector<Crossing>(segments), {.position = from}, {.position = to},
                          model_.facets);
  }
  std::vector<Path> lit(const dvec3& target, Obstacles& obstacles) const {
    return lit(geometry(target), target, obstacles);
  }
  /// Returns those of any paths of a link that nothing hides.
  std::vector<Path> lit(const std::vector<GeometricPath>& paths, const dvec3& target,
                        Obstacles& obstacles) const {
    std::vector<Segment> segments;
    solver_.add_segments(paths, transmitter(target), receiver(target), segments);
    return solver_.finish(paths, obstacles.on(segments, model_.facets), transmitter(target), receiver(target),
                          model_.facets);
  }
  void move_body(uint32_t body, const Motion& motion) {
    model_.facets.move(body, motion);
    search();
  }
  const RadioModel& model() const { return model_; }

 private:
  void search() {
    const PathLimits& limits = solver_.limits();
    const BeamSearch search(
        model_.facets, model_.kinds, {},
        {.max_depth = limits.max_depth,
         .max_transmissions =
             model_.effects.transmission ? std::min(limits.max_transmissions, limits.max_depth) : 0,
         .moving_bodies = moving_bodies_});
    solver_.set_candidates(search.search(source_).list, source_, end_);
    if (model_.effects.diffraction && limits.max_depth > 1) solver_.find_edge_ways(0, 1);
  }
  EndState transmitter(const dvec3& target) const {
    return {.position = end_ == Source::transmitter ? source_ : target};
  }
  EndState receiver(const dvec3& target) const {
    return {.position = end_ == Source::transmitter ? target : source_};
  }
  RadioModel model_;
  dvec3 source_;
  Source end_;
  bool moving_bodies_;
  PathSolver solver_;
};

inline bool scatters(const std::vector<Interaction>& interactions) {
  return std::ranges::find(interactions, InteractionType::scattering, &Interaction::type) !=
         interactions.end();
}

inline double power_of(const Path& path) {
  double power = 0.0;
  for (const Complex& t : path.transfer) power += 0.5 * std::norm(t);
  return power;
}

inline double scattered(const std::vector<Path>& paths) {
  double power = 0.0;
  for (const Path& path : paths)
    if (scatters(path.interactions)) power += power_of(path);
  return power;
}

}  // namespace greatx::rf::testing
