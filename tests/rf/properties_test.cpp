// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What must hold in any scene: all stages, on scenes drawn from a seed.
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "rf/path_solver.h"
#include "rf/reference/comparison.h"
#include "rf/reference/exhaustive_paths.h"
#include "rf/search/beam_search.h"
#include "tests/rf/random_scene.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::rf {
namespace {

using reference::Comparison;
using reference::polylines;
using rf::testing::build;
using rf::testing::Change;
using rf::testing::random_scene;
using rf::testing::random_scene_kinds;
using rf::testing::RandomScene;

constexpr double carrier_hz = 3.5e9;
constexpr uint32_t max_depth = 3;

using Links = std::vector<std::vector<Path>>;  ///< [receivers]
using CandidateSource =
    std::function<CandidateList(const RadioModel& model, const dvec3& transmitter, uint32_t walls)>;

CandidateList by_beams(const RadioModel& model, const dvec3& transmitter, uint32_t walls) {
  BeamSearchOptions options;
  options.max_depth = max_depth;
  options.max_transmissions = walls;
  BeamSearchResult result = BeamSearch(model.facets, model.kinds, model.wedges, options).search(transmitter);
  EXPECT_EQ(result.overflow(), 0u);
  return std::move(result.list);
}

/// No search at all: every sequence there is.
CandidateList every_sequence(const RadioModel& model, const dvec3&, uint32_t) {
  return exhaustive_candidates(model.facets.facet_count(), max_depth);
}

/// All stages for one transmitter and a list of receivers; `walls`: how many a path may pass.
Links solve(const scene::Scene& scene, const dvec3& transmitter, std::span<const dvec3> receivers,
            uint32_t walls, const CandidateSource& candidates = by_beams) {
  RadioEffects effects;
  effects.transmission = walls > 0;
  const RadioModel model(scene, carrier_hz, effects);
  PathOptions options;
  options.max_depth = max_depth;
  options.max_transmissions = walls;
  PathSolver solver(model, options);
  solver.set_candidates(candidates(model, transmitter, walls), transmitter, Source::transmitter);

  EndState from, to;
  from.position = transmitter;
  std::vector<LinkGeometry> geometry;
  std::vector<Segment> segments;
  std::vector<size_t> first{0};
  for (const dvec3& receiver : receivers) {
    to.position = receiver;
    geometry.push_back(solver.geometry(to));
    solver.add_segments(geometry.back().paths, from, to, segments);
    first.push_back(segments.size());
  }

  gpu::Device& device = test::device();
  scene::GpuScene gpu_scene(device, scene, {});
  CrossingPass pass(gpu_scene, model.kinds);
  gpu::TickRing ring(device, 1, 1u << 16, 1u << 16);
  gpu::TickSlot& slot = ring.begin();
  gpu_scene.record_update(slot, std::vector{Pose{}});
  const CrossingPass::Pending pending = pass.record(slot, segments);
  ring.submit(slot);
  ring.wait(slot);
  const std::vector<Crossing> crossings = pass.collect(pending, segments);

  Links links;
  for (size_t r = 0; r < receivers.size(); ++r) {
    to.position = receivers[r];
    links.push_back(solver.finish(geometry[r].paths,
                                  std::span(crossings).subspan(first[r], first[r + 1] - first[r]), from, to));
  }
  return links;
}
Links solve(const scene::Scene& scene, const RandomScene& random, uint32_t walls) {
  return solve(scene, random.transmitter, random.receivers, walls);
}

std::vector<std::vector<GeometricPath>> reference_of(const scene::Scene& scene, const RandomScene& random,
                                                     uint32_t walls) {
  RadioEffects effects;
  effects.transmission = walls > 0;
  const std::vector<Pose> bodies{Pose{}};
  return reference::exhaustive_paths(scene, FacetWorld(scene), bodies, facet_kinds(scene, effects),
                                     random.transmitter, random.receivers,
                                     {.max_depth = max_depth, .max_transmissions = walls})
      .paths;
}

std::string text_of(std::span<const Interaction> interactions, double length) {
  std::string text = fmt::format("{:.9f} m:", length);
  for (const Interaction& i : interactions) text += fmt::format(" {} {}", name_of(i.type), i.element);
  return text;
}

template <typename AnyPath>
void expect_same(const std::vector<std::vector<AnyPath>>& expected, const Links& actual,
                 const std::string& what, const reference::ComparisonTolerance& tolerance = {}) {
  static constexpr const char* names[] = {"missing", "doubled", "extra"};
  ASSERT_EQ(expected.size(), actual.size());
  Comparison comparison(max_depth, tolerance);
  for (uint32_t r = 0; r < actual.size(); ++r)
    comparison.add(r, polylines(expected[r]), polylines(actual[r]));
  for (const Comparison::Mismatch& m : comparison.mismatches())
    ADD_FAILURE()
        << what << ", receiver " << m.receiver << ", " << names[static_cast<int>(m.fault)] << ": "
        << (m.fault == Comparison::Fault::missing
                ? text_of(expected[m.receiver][m.path].interactions, expected[m.receiver][m.path].length_m)
                : text_of(actual[m.receiver][m.path].interactions, actual[m.receiver][m.path].length_m));
}

bool same_bits(const Path& a, const Path& b) {
  return a.interactions == b.interactions && a.vertices == b.vertices && a.length_m == b.length_m &&
         a.delay_s == b.delay_s && a.doppler_hz == b.doppler_hz && a.departure == b.departure &&
         a.arrival == b.arrival && std::equal(a.transfer, a.transfer + 4, b.transfer);
}

/// Largest singular value of a 2 x 2 matrix.
double spectral_norm(const Complex (&m)[4]) {
  double squares = 0.0;
  for (const Complex& value : m) squares += std::norm(value);
  const double determinant = std::abs(m[0] * m[3] - m[1] * m[2]);
  return std::sqrt(0.5 *
                   (squares + std::sqrt(std::max(0.0, squares * squares - 4.0 * determinant * determinant))));
}

/// Runs `test(random, scene, walls, name)` on scenes of every kind, with walls passed and without.
template <typename Test>
void on_random_scenes(uint64_t seeds, const Test& test) {
  for (uint64_t seed = 100; seed < 100 + seeds; ++seed)
    for (uint32_t kind = 0; kind < random_scene_kinds; ++kind) {
      const RandomScene random = random_scene(seed, kind, 5);
      const scene::Scene scene = build(random);
      for (const uint32_t walls : {0u, 2u})
        test(random, scene, walls, fmt::format("{}, seed {}, {} walls", random.name, seed, walls));
    }
}

TEST(Properties, EveryPathOfTheReferenceAndNoOther) {
  size_t paths = 0, through_walls = 0;
  on_random_scenes(
      8, [&](const RandomScene& random, const scene::Scene& scene, uint32_t walls, const std::string& name) {
        const auto reference = reference_of(scene, random, walls);
        expect_same(reference, solve(scene, random, walls), name);
        for (const auto& link : reference) {
          paths += link.size();
          for (const GeometricPath& path : link)
            through_walls += std::ranges::any_of(path.interactions, [](const Interaction& i) {
              return i.type == InteractionType::transmission;
            });
        }
      });
  EXPECT_GT(paths, 5000u);  // that there is something to find
  EXPECT_GT(through_walls, 1000u);
}

TEST(Properties, TheSearchLeavesOutNothingThatEverySequenceFinds) {
  on_random_scenes(
      2, [](const RandomScene& random, const scene::Scene& scene, uint32_t walls, const std::string& name) {
        const Links all = solve(scene, random.transmitter, random.receivers, walls, every_sequence);
        const Links beams = solve(scene, random, walls);
        for (size_t r = 0; r < all.size(); ++r) {
          ASSERT_EQ(all[r].size(), beams[r].size()) << name << ", receiver " << r;
          for (size_t i = 0; i < all[r].size(); ++i) EXPECT_TRUE(same_bits(all[r][i], beams[r][i])) << name;
        }
      });
}

TEST(Properties, AReceiversPathsDependOnNoOther) {
  on_random_scenes(
      2, [](const RandomScene& random, const scene::Scene& scene, uint32_t walls, const std::string& name) {
        const Links all = solve(scene, random, walls);
        for (size_t r = 0; r < all.size(); ++r) {
          const Links alone = solve(scene, random.transmitter, std::span(&random.receivers[r], 1), walls);
          ASSERT_EQ(alone[0].size(), all[r].size()) << name << ", receiver " << r;
          for (size_t i = 0; i < all[r].size(); ++i) EXPECT_TRUE(same_bits(alone[0][i], all[r][i])) << name;
        }
      });
}

TEST(Properties, AShiftByUtmCoordinatesChangesNothing) {
  const dvec3 utm(500000.0, 5400000.0, 0.0);
  on_random_scenes(
      2, [&](const RandomScene& random, const scene::Scene& scene, uint32_t walls, const std::string& name) {
        const Links near = solve(scene, random, walls);
        // The origin moves along: every bit is the same.
        const Links along = solve(build(random, {.shift = utm, .origin = utm}), random, walls);
        for (size_t r = 0; r < near.size(); ++r) {
          ASSERT_EQ(near[r].size(), along[r].size()) << name;
          for (size_t i = 0; i < near[r].size(); ++i) EXPECT_TRUE(same_bits(near[r][i], along[r][i])) << name;
        }
        // It stays some way off, as when other objects set the bounds: 1e-9 m.
        const dvec3 off(-37.0, 54.0, 8.0);
        RandomScene moved = random;
        moved.transmitter -= off;
        for (dvec3& receiver : moved.receivers) receiver -= off;
        Links shifted = solve(build(random, {.shift = utm, .origin = utm + off}), moved, walls);
        for (auto& link : shifted)
          for (Path& path : link)
            for (dvec3& vertex : path.vertices) vertex += off;
        expect_same(near, shifted, name, {.vertex_m = 1e-8, .length_m = 1e-9});
      });
}

TEST(Properties, ATurnedSceneHasTurnedPaths) {
  on_random_scenes(
      2, [](const RandomScene& random, const scene::Scene& scene, uint32_t walls, const std::string& name) {
        const Links straight = solve(scene, random, walls);
        for (const dquat& turn : {orientation_from_yaw_pitch_roll(0.7, 0.0, 0.0),
                                  orientation_from_yaw_pitch_roll(-2.1, 0.4, 1.3)}) {
          RandomScene turned = random;
          turned.transmitter = turn * turned.transmitter;
          for (dvec3& receiver : turned.receivers) receiver = turn * receiver;
          Links links = solve(build(random, {.turn = turn}), turned, walls);
          for (auto& link : links)
            for (Path& path : link)
              for (dvec3& vertex : path.vertices) vertex = glm::conjugate(turn) * vertex;
          expect_same(straight, links, name, {.vertex_m = 1e-8, .length_m = 1e-9});
        }
      });
}

TEST(Properties, FinerTrianglesChangeNothing) {
  on_random_scenes(
      2, [](const RandomScene& random, const scene::Scene& scene, uint32_t walls, const std::string& name) {
        expect_same(solve(scene, random, walls), solve(build(random, {.split = true}), random, walls), name,
                    {.vertex_m = 1e-9, .length_m = 1e-9});
      });
}

TEST(Properties, RenumberedFacetsChangeOnlyTheNumbers) {
  on_random_scenes(
      2, [](const RandomScene& random, const scene::Scene& scene, uint32_t walls, const std::string& name) {
        std::vector<uint32_t> order(random.faces.size());
        std::iota(order.rbegin(), order.rend(), 0u);
        RandomStream draw(walls, 77);
        for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[draw.bits() % i]);
        const Links plain = solve(scene, random, walls),
                    other = solve(build(random, {.order = order}), random, walls);
        expect_same(plain, other, name, {.vertex_m = 1e-9, .length_m = 1e-9});
        // And the same field by the same facets; of walls that stand in one place another one may have been named.
        if (random.name == "terrace") return;
        for (size_t r = 0; r < plain.size(); ++r)
          for (const Path& path : plain[r]) {
            const auto same = std::ranges::find_if(other[r], [&](const Path& p) {
              return std::ranges::equal(p.interactions, path.interactions,
                                        [&](const Interaction& a, const Interaction& b) {
                                          return a.type == b.type && order[a.element] == b.element;
                                        });
            });
            ASSERT_NE(same, other[r].end()) << name << ": " << text_of(path.interactions, path.length_m);
            EXPECT_TRUE(std::equal(path.transfer, path.transfer + 4, same->transfer)) << name;
          }
      });
}

TEST(Properties, NoPathGainsEnergy) {
  double largest = 0.0;
  on_random_scenes(
      4, [&](const RandomScene& random, const scene::Scene& scene, uint32_t walls, const std::string& name) {
        for (const auto& link : solve(scene, random, walls))
          for (const Path& path : link) {
            // What free space of that length would leave of the field bounds it.
            const double gain = spectral_norm(path.transfer) * path.length_m;
            EXPECT_LE(gain, 1.0 + 1e-12) << name << ": " << text_of(path.interactions, path.length_m);
            if (!path.interactions.empty()) largest = std::max(largest, gain);
          }
      });
  EXPECT_GT(largest, 0.9);  // metal comes near
}

TEST(Properties, ThePathsOfTheReverseLinkAreTheSame) {
  on_random_scenes(
      2, [](const RandomScene& random, const scene::Scene& scene, uint32_t walls, const std::string& name) {
        const Links forward = solve(scene, random, walls);
        for (size_t r = 0; r < forward.size(); ++r) {
          Links back = solve(scene, random.receivers[r], std::span(&random.transmitter, 1), walls);
          for (Path& path : back[0]) std::ranges::reverse(path.vertices);
          expect_same(Links{forward[r]}, back, name, {.vertex_m = 1e-8, .length_m = 1e-9});
        }
      });
}

TEST(PropertiesHardCase, N63_SearchesOfOneAndTwoThreadsAreTheSame) {
  for (uint32_t kind = 0; kind < random_scene_kinds; ++kind) {
    const RandomScene random = random_scene(200, kind, 0);
    const scene::Scene scene = build(random);
    const RadioModel model(scene, carrier_hz, {});
    BeamSearchOptions options;
    options.max_depth = max_depth;
    CandidateList lists[2];
    for (uint32_t threads : {1u, 2u}) {
      options.threads = threads;
      lists[threads - 1] =
          BeamSearch(model.facets, model.kinds, model.wedges, options).search(random.transmitter).list;
    }
    EXPECT_GT(lists[0].size(), 10u) << random.name;
    EXPECT_TRUE(lists[0] == lists[1]) << random.name;
  }
}

}  // namespace
}  // namespace greatx::rf
