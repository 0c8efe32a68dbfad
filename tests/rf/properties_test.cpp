// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks properties that hold in any scene, with all stages, on scenes drawn from a seed.
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "rf/paths/path_solver.h"
#include "rf/reference/comparison.h"
#include "rf/reference/exhaustive_diffraction.h"
#include "rf/reference/exhaustive_paths.h"
#include "rf/search/beam_search.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/random_scene.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::rf {
namespace {

using reference::Comparison;
using reference::polylines;
using rf::testing::build;
using rf::testing::Change;
using rf::testing::exhaustive_candidates;
using rf::testing::random_scene;
using rf::testing::random_scene_kinds;
using rf::testing::RandomScene;

constexpr double carrier_hz = 3.5e9;

using Links = std::vector<std::vector<Path>>;  ///< [receivers]
/// Bounds the interactions of a path.
struct Bounds {
  uint32_t depth = 2, walls = 0;
  bool edges = false;      ///< paths may have a diffraction
  bool two_edges = false;  ///< or two
  bool corners = false;    ///< or one at the end of an edge
};
using CandidateSource = std::function<CandidateList(const RadioModel&, const dvec3& transmitter, Bounds)>;

CandidateList by_beams(const RadioModel& model, const dvec3& transmitter, Bounds bounds) {
  BeamSearchOptions options;
  options.max_depth = bounds.depth;
  options.max_transmissions = bounds.walls;
  BeamSearchResult result = BeamSearch(model.facets, model.kinds, model.wedges, options).search(transmitter);
  EXPECT_EQ(result.overflow(), 0u);
  return std::move(result.list);
}

/// Returns every possible sequence, without a search.
CandidateList every_sequence(const RadioModel& model, const dvec3&, Bounds bounds) {
  return exhaustive_candidates(model.facets.facet_count(), bounds.depth);
}

/// Runs all stages for a scene.
class Rig {
 public:
  Rig(const scene::Scene& scene, Bounds bounds)
      : bounds_(bounds),
        model_(scene, carrier_hz, effects_of(bounds)),
        gpu_scene_(test::device(), scene, {}),
        pass_(gpu_scene_, model_.kinds),
        ring_(test::device(), 1, 1u << 16, 1u << 16) {}

  /// Finds the candidates from `transmitter`, which paths() then uses for its receivers.
  void search(const dvec3& transmitter, const CandidateSource& candidates = by_beams) {
    PathLimits options;
    options.max_depth = bounds_.depth;
    options.max_transmissions = bounds_.walls;
    options.max_diffractions = bounds_.two_edges ? 2 : 1;
    options.two_edge_floor_db = 1000.0;
    solver_.emplace(model_, options);
    solver_->set_candidates(candidates(model_, transmitter, bounds_), transmitter, Source::transmitter);
    transmitter_ = transmitter;
  }

  Links paths(std::span<const dvec3> receivers) {
    EndState from, to;
    from.position = transmitter_;
    std::vector<LinkGeometry> geometry;
    std::vector<Segment> segments;
    std::vector<size_t> first{0};
    for (const dvec3& receiver : receivers) {
      to.position = receiver;
      geometry.push_back(solver_->geometry(to));
      solver_->add_segments(geometry.back().paths, from, to, segments);
      first.push_back(segments.size());
    }
    const std::vector<Crossing> crossings = trace(segments);
    Links links;
    for (size_t r = 0; r < receivers.size(); ++r) {
      to.position = receivers[r];
      links.push_back(solver_->finish(geometry[r].paths,
                                      std::span(crossings).subspan(first[r], first[r + 1] - first[r]), from,
                                      to, model_.facets));
    }
    return links;
  }

  static RadioEffects effects_of(Bounds bounds) {
    RadioEffects effects;
    effects.transmission = bounds.walls > 0;
    effects.diffraction = effects.free_edges = bounds.edges;
    effects.corner_diffraction = bounds.corners;
    return effects;
  }
  std::span<const scene::Wedge> wedges() const { return model_.wedges; }
  static double most_excess_m() {
    return largest_excess_m(PathLimits{}.corner_step_db, 2.0 * pi * carrier_hz / speed_of_light);
  }
  std::vector<std::array<bool, 2>> open_ends() const {
    std::vector<std::array<bool, 2>> open;
    for (uint32_t i = 0; i < model_.wedges.size(); ++i)
      open.push_back({model_.corners.open(i, Corner::a), model_.corners.open(i, Corner::b)});
    return open;
  }

 private:
  std::vector<Crossing> trace(const std::vector<Segment>& segments) {
    gpu::TickSlot& slot = ring_.begin();
    gpu_scene_.record_update(slot, std::vector{Pose{}});
    const CrossingPass::Pending pending = pass_.record(slot, segments);
    ring_.submit(slot);
    ring_.wait(slot);
    return pass_.collect(pending, segments, model_.facets);
  }

  Bounds bounds_;
  RadioModel model_;
  scene::GpuScene gpu_scene_;
  CrossingPass pass_;
  gpu::TickRing ring_;
  std::optional<PathSolver> solver_;
  dvec3 transmitter_{0.0};
};

Links solve(const scene::Scene& scene, const RandomScene& random, Bounds bounds) {
  Rig rig(scene, bounds);
  rig.search(random.transmitter);
  return rig.paths(random.receivers);
}

std::vector<std::vector<GeometricPath>> reference_of(const scene::Scene& scene, const RandomScene& random,
                                                     Bounds bounds) {
  const RadioEffects effects = Rig::effects_of(bounds);
  const std::vector<Pose> bodies{Pose{}};
  return reference::exhaustive_paths(scene, FacetWorld(scene), bodies, facet_kinds(scene, effects),
                                     random.transmitter, random.receivers,
                                     {.max_depth = bounds.depth, .max_transmissions = bounds.walls})
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
  Comparison comparison(3, tolerance);
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

void expect_same_bits(const Links& expected, const Links& actual, const std::string& name) {
  ASSERT_EQ(expected.size(), actual.size()) << name;
  for (size_t r = 0; r < expected.size(); ++r) {
    ASSERT_EQ(expected[r].size(), actual[r].size()) << name << ", receiver " << r;
    for (size_t i = 0; i < expected[r].size(); ++i)
      EXPECT_TRUE(same_bits(expected[r][i], actual[r][i]))
          << name << ", receiver " << r << ": "
          << text_of(expected[r][i].interactions, expected[r][i].length_m);
  }
}

template <typename Move>
void move_vertices(Links& links, const Move& move) {
  for (auto& link : links)
    for (Path& path : link)
      for (dvec3& vertex : path.vertices) vertex = move(vertex);
}

/// Returns the largest singular value of a 2 x 2 matrix.
double spectral_norm(const Complex (&m)[4]) {
  double squares = 0.0;
  for (const Complex& value : m) squares += std::norm(value);
  const double determinant = std::abs(m[0] * m[3] - m[1] * m[2]);
  return std::sqrt(0.5 *
                   (squares + std::sqrt(std::max(0.0, squares * squares - 4.0 * determinant * determinant))));
}

/// Holds a random scene with bounds. draws() returns a scene of every kind for each seed with each of the
/// bounds.
struct Draw {
  RandomScene random;
  scene::Scene scene;
  Bounds bounds;
  std::string name;
};
std::vector<Draw> draws(uint64_t seeds, std::initializer_list<Bounds> bounds, uint32_t receivers = 6) {
  std::vector<Draw> list;
  for (uint64_t seed = 100; seed < 100 + seeds; ++seed)
    for (uint32_t kind = 0; kind < random_scene_kinds; ++kind)
      for (const Bounds& b : bounds) {
        const RandomScene random = random_scene(seed, kind, receivers);
        list.push_back({random, build(random), b,
                        fmt::format("{}, seed {}, depth {}, {} walls", random.name, seed, b.depth, b.walls)});
      }
  return list;
}

TEST(Properties, EveryPathOfTheReferenceAndNoOther) {
  size_t paths = 0, through_walls = 0;
  for (const Draw& draw : draws(4, {{2, 2}, {3, 0}, {3, 2}}, 10)) {
    const auto reference = reference_of(draw.scene, draw.random, draw.bounds);
    expect_same(reference, solve(draw.scene, draw.random, draw.bounds), draw.name);
    for (const auto& link : reference) {
      paths += link.size();
      for (const GeometricPath& path : link)
        through_walls += std::ranges::any_of(
            path.interactions, [](const Interaction& i) { return i.type == InteractionType::transmission; });
    }
  }
  EXPECT_GT(paths, 2000u);  // the scenes have paths to find
  EXPECT_GT(through_walls, 200u);
}

/// Keeps the paths with a diffraction.
Links over_edges(Links links) {
  for (auto& link : links)
    std::erase_if(link, [](const Path& path) {
      return std::ranges::none_of(
          path.interactions, [](const Interaction& i) { return i.type == InteractionType::diffraction; });
    });
  return links;
}

TEST(Properties, EveryPathOverAnEdgeOfTheReferenceAndNoOther) {
  size_t paths = 0, on_both_sides = 0, two_after = 0, through_walls = 0, over_two = 0, two_and_more = 0,
         over_ends = 0;
  for (const Draw& draw : draws(4,
                                {{2, 1, true},
                                 {3, 0, true},
                                 {4, 1, true},
                                 {2, 0, true, true},
                                 {4, 1, true, true},
                                 {3, 1, true, false, true}},
                                4)) {
    Rig rig(draw.scene, draw.bounds);
    rig.search(draw.random.transmitter);
    const auto reference =
        reference::exhaustive_diffraction(draw.scene, FacetWorld(draw.scene), std::vector<Pose>(1),
                                          facet_kinds(draw.scene, Rig::effects_of(draw.bounds)), rig.wedges(),
                                          draw.random.transmitter, draw.random.receivers,
                                          {.max_depth = draw.bounds.depth,
                                           .max_transmissions = draw.bounds.walls,
                                           .max_edges = draw.bounds.two_edges ? 2u : 1u,
                                           .open_ends = rig.open_ends(),
                                           .most_excess_m = Rig::most_excess_m()});
    expect_same(reference, over_edges(rig.paths(draw.random.receivers)), draw.name);
    for (const auto& link : reference)
      for (const GeometricPath& path : link) {
        const auto edge =
            std::ranges::find(path.interactions, InteractionType::diffraction, &Interaction::type);
        const auto reflects = [](const Interaction& i) { return i.type == InteractionType::reflection; };
        const auto before = std::count_if(path.interactions.begin(), edge, reflects),
                   after = std::count_if(edge, path.interactions.end(), reflects);
        const auto edges =
            std::ranges::count(path.interactions, InteractionType::diffraction, &Interaction::type);
        ++paths;
        over_two += edges == 2, two_and_more += edges == 2 && path.interactions.size() > 2;
        over_ends += edge->patch != 0;
        on_both_sides += before > 0 && after > 0, two_after += after > 1;
        through_walls += std::ranges::find(path.interactions, InteractionType::transmission,
                                           &Interaction::type) != path.interactions.end();
      }
  }
  EXPECT_GT(paths, 3000u);
  EXPECT_GT(on_both_sides, 200u);
  EXPECT_GT(two_after, 200u);
  EXPECT_GT(through_walls, 200u);
  EXPECT_GT(over_two, 500u);
  EXPECT_GT(over_ends, 500u);
  EXPECT_GT(two_and_more, 200u);
}

/// Compares the paths to the first receiver with those of the reverse link.
void expect_same_backwards(const Draw& draw) {
  Rig rig(draw.scene, draw.bounds);
  rig.search(draw.random.transmitter);
  const Links forward = rig.paths(std::span(draw.random.receivers).first(1));
  for (size_t r = 0; r < forward.size(); ++r) {
    rig.search(draw.random.receivers[r]);
    Links back = rig.paths(std::span(&draw.random.transmitter, 1));
    for (Path& path : back[0]) std::ranges::reverse(path.vertices);
    expect_same(Links{forward[r]}, back, draw.name, {.vertex_m = 1e-8, .length_m = 1e-9});
  }
}

TEST(Properties, PathsOverEdgesAreTheSameFromBothEnds) {
  for (const Draw& draw :
       draws(2, {{3, 0, true}, {4, 1, true}, {3, 1, true, true}, {3, 1, true, false, true}}))
    expect_same_backwards(draw);
}

TEST(Properties, TheSearchLeavesOutNothingThatEverySequenceFinds) {
  for (const Draw& draw : draws(1, {{2, 1}, {3, 0}})) {
    Rig rig(draw.scene, draw.bounds);
    rig.search(draw.random.transmitter, every_sequence);
    const Links all = rig.paths(draw.random.receivers);
    rig.search(draw.random.transmitter);
    expect_same_bits(all, rig.paths(draw.random.receivers), draw.name);
  }
}

TEST(Properties, AReceiversPathsDependOnNoOther) {
  for (const Draw& draw : draws(1, {{2, 1}, {3, 0}})) {
    Rig rig(draw.scene, draw.bounds);
    rig.search(draw.random.transmitter);
    const Links all = rig.paths(draw.random.receivers);
    for (size_t r = 0; r < all.size(); ++r)
      expect_same_bits({all[r]}, rig.paths(std::span(&draw.random.receivers[r], 1)), draw.name);
    const Links some = rig.paths(std::vector{draw.random.receivers[4], draw.random.receivers[1]});
    expect_same_bits({all[4], all[1]}, some, draw.name);
  }
}

TEST(Properties, ThePathsOfTheReverseLinkAreTheSame) {
  for (const Draw& draw : draws(1, {{2, 1}, {3, 0}})) expect_same_backwards(draw);
}

TEST(Properties, AShiftByUtmCoordinatesChangesNothing) {
  const dvec3 utm(500000.0, 5400000.0, 0.0);
  for (const Draw& draw : draws(1, {{3, 2}})) {
    const Links near = solve(draw.scene, draw.random, draw.bounds);
    // The origin moves with the scene: all bits are the same.
    expect_same_bits(near, solve(build(draw.random, {.shift = utm, .origin = utm}), draw.random, draw.bounds),
                     draw.name);
    // The origin stays some way off, as if other objects set the bounds: the tolerance is 1e-9 m.
    const dvec3 off(-37.0, 54.0, 8.0);
    RandomScene moved = draw.random;
    moved.transmitter -= off;
    for (dvec3& receiver : moved.receivers) receiver -= off;
    Links shifted = solve(build(draw.random, {.shift = utm, .origin = utm + off}), moved, draw.bounds);
    move_vertices(shifted, [&](const dvec3& vertex) { return vertex + off; });
    expect_same(near, shifted, draw.name, {.vertex_m = 1e-8, .length_m = 1e-9});
  }
}

TEST(Properties, ATurnedSceneHasTurnedPaths) {
  for (const Draw& draw : draws(2, {{3, 1}})) {
    const dquat turn = orientation_from_yaw_pitch_roll(-2.1, 0.4, 1.3);
    RandomScene turned = draw.random;
    turned.transmitter = turn * turned.transmitter;
    for (dvec3& receiver : turned.receivers) receiver = turn * receiver;
    Links links = solve(build(draw.random, {.turn = turn}), turned, draw.bounds);
    move_vertices(links, [&](const dvec3& vertex) { return glm::conjugate(turn) * vertex; });
    expect_same(solve(draw.scene, draw.random, draw.bounds), links, draw.name,
                {.vertex_m = 1e-8, .length_m = 1e-9});
  }
}

TEST(Properties, FinerTrianglesChangeNothing) {
  for (const Draw& draw : draws(2, {{3, 1}}))
    expect_same(solve(draw.scene, draw.random, draw.bounds),
                solve(build(draw.random, {.split = true}), draw.random, draw.bounds), draw.name,
                {.vertex_m = 1e-9, .length_m = 1e-9});
}

TEST(Properties, RenumberedFacetsChangeOnlyTheNumbers) {
  for (const Draw& draw : draws(2, {{3, 1}})) {
    std::vector<uint32_t> order(draw.random.faces.size());
    std::iota(order.begin(), order.end(), 0u);
    RandomStream random(5, 77);
    for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.bits() % i]);
    const Links plain = solve(draw.scene, draw.random, draw.bounds);
    const Links other = solve(build(draw.random, {.order = order}), draw.random, draw.bounds);
    expect_same(plain, other, draw.name, {.vertex_m = 1e-9, .length_m = 1e-9});
    // The same facets give the same field. Of coincident walls, the path may name another one.
    if (draw.random.name == "terrace") continue;
    for (size_t r = 0; r < plain.size(); ++r)
      for (const Path& path : plain[r]) {
        const auto same = std::ranges::find_if(other[r], [&](const Path& p) {
          return std::ranges::equal(p.interactions, path.interactions,
                                    [&](const Interaction& a, const Interaction& b) {
                                      return a.type == b.type && order[a.element] == b.element;
                                    });
        });
        ASSERT_NE(same, other[r].end()) << draw.name << ": " << text_of(path.interactions, path.length_m);
        EXPECT_TRUE(std::equal(path.transfer, path.transfer + 4, same->transfer)) << draw.name;
      }
  }
}

TEST(Properties, NoPathGainsEnergy) {
  double largest = 0.0;
  for (const Draw& draw : draws(2, {{3, 1}}))
    for (const auto& link : solve(draw.scene, draw.random, draw.bounds))
      for (const Path& path : link) {
        // The field does not exceed that of free space over the same length. The norm is accurate to
        // sqrt(1e-16).
        const double gain = spectral_norm(path.transfer) * path.length_m;
        EXPECT_LE(gain, 1.0 + 1e-7) << draw.name << ": " << text_of(path.interactions, path.length_m);
        if (!path.interactions.empty()) largest = std::max(largest, gain);
      }
  EXPECT_GT(largest, 0.9);  // metal comes close to 1
}

TEST(PropertiesHardCase, N63_SearchesOfOneAndTwoThreadsAreTheSame) {
  for (uint32_t kind = 0; kind < random_scene_kinds; ++kind) {
    const RandomScene random = random_scene(200, kind, 0);
    const scene::Scene scene = build(random);
    const RadioModel model(scene, carrier_hz, {});
    BeamSearchOptions options;
    options.max_depth = 3;
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
