// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks all stages together on scenes of a few facets: candidates, geometry, crossings on the device,
// fields.
#include "rf/paths/path_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "rf/search/beam_search.h"
#include "tests/rf/exhaustive.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using ::testing::ElementsAre;
using testing::exhaustive_candidates;
using ::testing::IsEmpty;

constexpr double carrier_hz = 3.5e9;

scene::Material concrete(const std::string& name, double thickness_m, double scattering = 0.0) {
  scene::Material material;
  material.name = name;
  scene::RadioMaterial radio;
  radio.layers.push_back({*scene::itu_medium("concrete"), thickness_m});
  radio.scattering_coefficient = scattering;
  material.radio = radio;
  return material;
}

/// Adds the materials of a thin wall (index 1), a half-space (2) and a wall that scatters (3).
TinyScene materials() {
  TinyScene tiny;
  tiny.material_as(concrete("wall", 0.2));
  tiny.material_as(concrete("ground", 0.0));
  tiny.material_as(concrete("rough", 0.2, 0.4));
  return tiny;
}

struct Solved {
  std::vector<Path> paths;
  size_t geometric = 0;  ///< number of paths before occlusion
  std::vector<std::string> chains() const {
    std::vector<std::string> all;
    for (const Path& path : paths) {
      std::string chain;
      for (const Interaction& i : path.interactions) chain += "0RTDS"[static_cast<size_t>(i.type)];
      all.push_back(chain);
    }
    return all;
  }
};

/// Solves a link. `end` is the source of the candidates. If `windows` is false, the windows of the candidates
/// are dropped.
Solved solve(const scene::Scene& scene, const dvec3& tx, const dvec3& rx, const RadioEffects& effects,
             const PathLimits& options, Source end = Source::transmitter, bool windows = true) {
  gpu::Device& device = test::device();
  scene::GpuScene gpu_scene(device, scene, {});
  const RadioModel model(scene, carrier_hz, effects);
  CrossingPass pass(gpu_scene, model.kinds);
  BeamSearchOptions search;
  search.max_depth = options.max_depth;
  search.max_transmissions = effects.transmission ? options.max_transmissions : 0;
  const dvec3 source = end == Source::transmitter ? tx : rx;
  BeamSearchResult found = BeamSearch(model.facets, model.kinds, model.wedges, search).search(source);
  if (!windows) found.list.windows.clear();
  PathSolver solver(model, options);
  solver.set_candidates(found.list, source, end);

  EndState transmitter, receiver;
  transmitter.position = tx, receiver.position = rx;
  const LinkGeometry link = solver.geometry(end == Source::transmitter ? receiver : transmitter);
  EXPECT_EQ(link.overflow, 0u);
  std::vector<Segment> segments;
  solver.add_segments(link.paths, transmitter, receiver, segments);
  gpu::TickRing ring(device, 1, 1u << 16, 1u << 16);
  gpu::TickSlot& slot = ring.begin();
  gpu_scene.record_update(slot, std::vector<Pose>(scene.bodies.size()));
  const CrossingPass::Pending pending = pass.record(slot, segments);
  ring.submit(slot);
  ring.wait(slot);
  return {solver.finish(link.paths, pass.collect(pending, segments, model.facets), transmitter, receiver,
                        model.facets),
          link.paths.size()};
}

RadioEffects with_walls() {
  RadioEffects effects;
  effects.transmission = true;
  return effects;
}

/// Returns a wall in the plane x = 0, 20 m by 10 m.
TinyScene one_wall(uint32_t material) {
  TinyScene tiny = materials();
  tiny.object("wall", 0, material).quad({0, -10, 0}, {0, 10, 0}, {0, 10, 10}, {0, -10, 10});
  return tiny;
}

TEST(PathSolver, AWallIsPassedWithTheFieldOfItsSlab) {
  const dvec3 tx(-4, 0, 5), rx(6, 0, 5);
  const Solved through = solve(one_wall(1).build(), tx, rx, with_walls(), {});
  ASSERT_THAT(through.chains(), ElementsAre("T"));
  const Path& path = through.paths[0];
  EXPECT_NEAR(path.length_m, 10.0, 1e-12);
  EXPECT_NEAR(glm::length(path.vertices[1] - dvec3(0, 0, 5)), 0.0, 1e-12);
  const scene::Material wall = concrete("wall", 0.2);
  const RadioSurface surface = radio_surface(*wall.radio, carrier_hz, "wall");
  const Complex t = slab(surface.front[0], speed_of_light / carrier_hz, 1.0).t_te *
                    sheet_phase(0.2, speed_of_light / carrier_hz, 1.0);
  EXPECT_LT(std::abs(path.transfer[0] - t / 10.0), 1e-12);
  EXPECT_LT(std::abs(path.transfer[3] + t / 10.0), 1e-12);
}

/// A half-space with windows is passed by them alone, and reflects as the mean of both.
TEST(PathSolver, WindowsLetWavesThroughAHalfSpace) {
  scene::Material facade = concrete("facade", 0.0);
  facade.radio->windows = scene::RadioWindows{0.25, {{*scene::itu_medium("glass"), 0.006}}};
  TinyScene tiny;
  tiny.object("wall", 0, tiny.material_as(facade)).quad({0, -10, 0}, {0, 10, 0}, {0, 10, 10}, {0, -10, 10});
  const scene::Scene scene = tiny.build();
  const dvec3 tx(-4, 0, 5), rx(6, 0, 5), beside(-4, 3, 5);
  const double wavelength_m = speed_of_light / carrier_hz;
  const DielectricLayer pane{scene::relative_permittivity(*scene::itu_medium("glass"), carrier_hz, "glass"),
                             0.006};
  const Solved through = solve(scene, tx, rx, with_walls(), {});
  ASSERT_THAT(through.chains(), ElementsAre("T"));
  const Complex t = 0.25 * slab(pane, wavelength_m, 1.0).t_te * sheet_phase(0.006, wavelength_m, 1.0);
  EXPECT_LT(std::abs(through.paths[0].transfer[0] - t / 10.0), 1e-12);
  const Solved reflected = solve(scene, tx, beside, with_walls(), {});
  ASSERT_THAT(reflected.chains(), ElementsAre("", "R"));
  const double cosine = 4.0 / std::hypot(4.0, 1.5), length_m = 2.0 * std::hypot(4.0, 1.5);
  const Complex eta = scene::relative_permittivity(*scene::itu_medium("concrete"), carrier_hz, "concrete");
  const Complex r = 0.75 * half_space(eta, cosine).r_te + 0.25 * slab(pane, wavelength_m, cosine).r_te;
  // The wave lies in the horizontal plane, so that the vertical field is TE.
  EXPECT_LT(std::abs(std::abs(reflected.paths[1].transfer[0]) - std::abs(r) / length_m), 1e-12);
  EXPECT_THAT(solve(scene, tx, rx, {}, {}).paths, IsEmpty()) << "transmission is off";
}

TEST(PathSolver, WallsBlockWhereTransmissionIsOffOrNoneIsAllowed) {
  const dvec3 tx(-4, 0, 5), rx(6, 0, 5);
  EXPECT_THAT(solve(one_wall(1).build(), tx, rx, {}, {}).paths, IsEmpty());
  EXPECT_THAT(solve(one_wall(2).build(), tx, rx, with_walls(), {}).paths, IsEmpty());  // a half-space
  EXPECT_THAT(solve(one_wall(1).build(), tx, rx, with_walls(), {.max_transmissions = 0}).paths, IsEmpty());
  EXPECT_THAT(solve(one_wall(1).build(), tx, rx, with_walls(), {.max_depth = 0}).paths, IsEmpty());
}

TEST(PathSolver, DepthBoundsReflectionsAndWallsTogether) {
  TinyScene tiny = one_wall(1);
  tiny.object("ground", 0, 2).quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
  const dvec3 tx(-4, 0, 5), rx(6, 0, 5);
  EXPECT_THAT(solve(tiny.build(), tx, rx, with_walls(), {.max_depth = 1}).chains(), ElementsAre("T"));
  EXPECT_THAT(solve(tiny.build(), tx, rx, with_walls(), {.max_depth = 2}).chains(), ElementsAre("T", "TR"));
  // The link in the opposite direction has the same paths in reverse order.
  EXPECT_THAT(solve(tiny.build(), rx, tx, with_walls(), {.max_depth = 2}).chains(), ElementsAre("T", "RT"));
}

TEST(PathSolver, AClosedBoxIsTwoWallsAndASeamIsOne) {
  TinyScene box = materials();
  box.object("box", 0, 1).box({-2, -2, 0}, {2, 2, 4});
  const dvec3 tx(-9, 0.3, 2.1), rx(9, 0.4, 2.2);
  EXPECT_THAT(solve(box.build(), tx, rx, with_walls(), {.max_depth = 2}).chains(), ElementsAre("TT"));
  EXPECT_THAT(solve(box.build(), tx, rx, with_walls(), {.max_depth = 1}).chains(), IsEmpty());
  // The path meets the common edge of two facets in one plane.
  TinyScene seam = materials();
  seam.object("low", 0, 1).quad({0, -10, 0}, {0, 10, 0}, {0, 10, 5}, {0, -10, 5});
  seam.object("high", 0, 1).quad({0, -10, 5}, {0, 10, 5}, {0, 10, 10}, {0, -10, 10});
  EXPECT_THAT(solve(seam.build(), {-4, 0, 5}, {6, 0, 5}, with_walls(), {}).chains(), ElementsAre("T"));
}

TEST(PathSolver, ATwiceDrawnWallIsPassedOnce) {
  TinyScene tiny = one_wall(1);
  tiny.object("again", 0, 1).quad({0, -10, 0}, {0, 10, 0}, {0, 10, 10}, {0, -10, 10});
  EXPECT_THAT(solve(tiny.build(), {-4, 0, 5}, {6, 0, 5}, with_walls(), {}).chains(), ElementsAre("T"));
}

RadioEffects with_edges() {
  RadioEffects effects;
  effects.diffraction = true;
  return effects;
}

/// The vertical edge of a house stands at the origin, and each end is in the shadow of the other.
TEST(PathSolver, InTheShadowOfAHouseItsEdgesAreAllThatIsLeft) {
  TinyScene house = materials();
  house.object("house", 0, 2).box({0, 0, 0}, {10, 10, 8});
  const dvec3 tx(-3, 8, 3), rx(8, -3, 3);
  EXPECT_THAT(solve(house.build(), tx, rx, {}, {}).paths, IsEmpty());
  const Solved shadow = solve(house.build(), tx, rx, with_edges(), {.max_depth = 1});
  ASSERT_THAT(shadow.chains(), ElementsAre("D"));
  const Path& path = shadow.paths[0];
  EXPECT_NEAR(glm::length(path.vertices[1] - dvec3(0, 0, 3)), 0.0, 1e-9);
  EXPECT_NEAR(path.length_m, 2.0 * std::hypot(3, 8), 1e-12);
  EXPECT_GT(std::abs(path.transfer[0]), 0.0);
  // A search from the receiver finds the same path. By reciprocity the strength is equal on this symmetric
  // link.
  const Solved back = solve(house.build(), tx, rx, with_edges(), {.max_depth = 1}, Source::receiver);
  ASSERT_EQ(back.paths.size(), 1u);
  EXPECT_EQ(back.paths[0].id(), path.id());
  EXPECT_LT(std::abs(back.paths[0].transfer[0] - path.transfer[0]), 1e-12 * std::abs(path.transfer[0]));
}

TEST(PathSolver, ReflectionsBeforeAndAfterADiffraction) {
  TinyScene house = materials();
  house.object("house", 0, 2).box({0, 0, 0}, {10, 10, 8});
  house.object("west", 0, 2).quad({-20, -30, -5}, {-20, 30, -5}, {-20, 30, 15}, {-20, -30, 15});
  house.object("south", 0, 2).quad({-30, -20, -5}, {30, -20, -5}, {30, -20, 15}, {-30, -20, 15});
  const dvec3 tx(-3, 8, 3), rx(8, -3, 3);
  // Counts paths over the vertical edge at the origin; the edges of the roof have paths of their own.
  const auto count = [&](const PathLimits& options, const std::string& chain,
                         Source end = Source::transmitter) {
    const Solved solved = solve(house.build(), tx, rx, with_edges(), options, end);
    const std::vector<std::string> chains = solved.chains();
    int found = 0;
    for (size_t i = 0; i < chains.size(); ++i) {
      const dvec3 edge = solved.paths[i].vertices[1 + chains[i].find('D') % (chains[i].size() + 1)];
      found += chains[i] == chain && std::hypot(edge.x, edge.y) < 1e-9;
    }
    return found;
  };
  // There is one path by each of the two walls, on either side of the edge and from either end.
  for (const Source end : {Source::transmitter, Source::receiver})
    for (const char* chain : {"RD", "DR"}) {
      EXPECT_EQ(count({.max_depth = 2}, chain, end), 2);
      EXPECT_EQ(count({.max_depth = 2, .max_reflections_beside_diffraction = 0}, chain, end), 0);
    }
}

/// Returns the vertical component of the sum of all paths at the carrier.
Complex total(const std::vector<Path>& paths) {
  Complex sum = 0.0;
  for (const Path& path : paths)
    sum += path.transfer[0] * std::polar(1.0, -2.0 * pi * std::remainder(path.delay_s * carrier_hz, 1.0));
  return sum;
}

TEST(PathSolver, TheFieldIsRightExactlyOnABoundaryAndWithinRoundingsOfIt) {
  // The corner of a house at the origin. A receiver walks through the shadow boundary of the transmitter, and
  // through the ends of the reflections in both faces, in steps from none to a tenth of a millimetre. The
  // house stands where its corners are representable, or turned, so that all planes have roundings.
  const struct {
    dvec3 tx, rx, step;
  } walks[] = {{{-6, 8, 3}, {6, -8, 3}, {0.8, 0.6, 0}},        // shadow
               {{-6, 8, 3}, {-9, -12, 3}, {0.8, -0.6, 0}},     // reflection in the face x = 0
               {{5, -12, 3}, {-10, -24, 3}, {0.9, -0.4, 0}}};  // reflection in the face y = 0
  for (const double turn : {0.0, 0.3})
    for (const auto& walk : walks) {
      const dquat turned = orientation_from_yaw_pitch_roll(turn, 0.0, 0.0);
      TinyScene house = materials();
      const auto at = [&](double x, double y, double z) { return turned * dvec3(x, y, z); };
      house.object("house", 0, 2)
          .quad(at(0, 0, -30), at(0, 0, 40), at(0, 40, 40), at(0, 40, -30))
          .quad(at(0, 0, -30), at(40, 0, -30), at(40, 0, 40), at(0, 0, 40));
      const scene::Scene scene = house.build();
      const auto field = [&](double off) {
        return total(solve(scene, turned * walk.tx, turned * (walk.rx + off * walk.step), with_edges(),
                           {.max_depth = 1})
                         .paths);
      };
      // A little beyond, where nothing is in doubt, the field is that of the boundary to 3 %.
      const Complex before = field(-4e-4), behind = field(4e-4), middle = 0.5 * (before + behind);
      EXPECT_LT(std::abs(before - behind), 0.06 * std::abs(middle));
      for (const double off : {0.0, 1e-15, 1e-9, 3e-8, 1e-6, 1e-4})
        for (const double sign : {1.0, -1.0})
          EXPECT_LT(std::abs(field(sign * off) - middle), 0.01 * std::abs(middle))
              << "turned by " << turn << ", " << sign * off << " m off";
    }
}

TEST(PathSolver, PatchesCoverTheirFacetsAndScatterFromOneSide) {
  TinyScene tiny = one_wall(3);
  const scene::Scene scene = tiny.build();
  RadioEffects effects;
  effects.scattering = true;
  const FacetKinds kinds = facet_kinds(scene, effects);
  double area = 0.0;
  for (const Patch& patch : scattering_patches(scene, kinds, 3.0)) area += patch.area_m2;
  EXPECT_NEAR(area, 200.0, 1e-9);
  for (const double side : {1e-3, 1e-12, 1e-300})
    EXPECT_THROW(scattering_patches(scene, kinds, side, 1000), UserError) << side;

  const PathLimits options{.max_depth = 1, .patch_m = 3.0};
  const Solved front = solve(scene, {5, 0, 5}, {6, 3, 4}, effects, options);
  const size_t scattered =
      static_cast<size_t>(std::count_if(front.paths.begin(), front.paths.end(), [](const Path& path) {
        return path.interactions.size() == 1 && path.interactions[0].type == InteractionType::scattering;
      }));
  EXPECT_EQ(scattered, scattering_patches(scene, kinds, 3.0).size());
  // Nothing arrives on the other side of the wall: patches scatter back.
  EXPECT_THAT(solve(scene, {5, 0, 5}, {-6, 3, 4}, effects, options).paths, IsEmpty());
}

TEST(PathSolver, ScatteredPowerConvergesWithThePatches) {
  // The incoherent power that all patches scatter to a point changes less and less as the patches are halved.
  const scene::Scene scene = one_wall(3).build();
  RadioEffects effects;
  effects.scattering = true;
  double before = 0.0, change = 1.0;
  for (const double side : {4.0, 2.0, 1.0}) {
    double power = 0.0;
    for (const Path& path :
         solve(scene, {8, 0, 5}, {9, 3, 4}, effects, {.max_depth = 1, .patch_m = side}).paths)
      if (!path.interactions.empty() && path.interactions[0].type == InteractionType::scattering)
        for (const Complex& t : path.transfer) power += std::norm(t);
    if (before > 0.0) {
      EXPECT_LT(std::abs(power / before - 1.0), change);
      change = std::abs(power / before - 1.0);
    }
    before = power;
  }
  EXPECT_LT(change, 0.03);
}

/// Returns a house that hides parts of a wall and of the ground, which both scatter.
TinyScene hidden_patches() {
  TinyScene tiny = materials();
  tiny.object("ground", 0, 3).quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0});
  tiny.object("wall", 0, 3).quad({-20, 25, 0}, {20, 25, 0}, {20, 25, 12}, {-20, 25, 12});
  tiny.object("house", 0, 3).box({-4, 0, 0}, {5, 6, 7});
  return tiny;
}

bool same_bits(const std::vector<Path>& a, const std::vector<Path>& b) {
  return std::ranges::equal(a, b, [](const Path& p, const Path& q) {
    return p.interactions == q.interactions && p.vertices == q.vertices && p.length_m == q.length_m &&
           std::ranges::equal(p.transfer, q.transfer);
  });
}

TEST(PathSolver, PatchesThatABeamDoesNotReachAreLeftOutBeforeTheyAreTraced) {
  const scene::Scene scene = hidden_patches().build();
  RadioEffects effects;
  effects.scattering = true;
  for (const uint32_t after : {0u, 1u})
    for (const Source end : {Source::transmitter, Source::receiver}) {
      const PathLimits options{.max_depth = 2, .max_reflections_after = after, .patch_m = 4.0};
      const dvec3 tx(1, -9, 3), rx(7, 14, 2);
      const Solved with = solve(scene, tx, rx, effects, options, end);
      const Solved without = solve(scene, tx, rx, effects, options, end, false);
      EXPECT_TRUE(same_bits(with.paths, without.paths));
      EXPECT_GT(with.paths.size(), 100u);
      EXPECT_LE(with.geometric, without.geometric - (after == 0));
    }
}

TEST(PathSolver, ASourceThatMovesScattersFromWhereItIs) {
  const scene::Scene scene = hidden_patches().build();
  RadioEffects effects;
  effects.scattering = true;
  const RadioModel model(scene, carrier_hz, effects);
  const PathLimits options{.max_depth = 2, .patch_m = 4.0};
  const dvec3 first(1, -9, 3), second(-3, -11, 4);
  CandidateList list = exhaustive_candidates(model.facets.facet_count(), 2);
  PathSolver moved(model, options), there(model, options);
  moved.set_candidates(list, first, Source::transmitter);
  there.set_candidates(list, second, Source::transmitter);
  const auto geometry = [](const PathSolver& solver) {
    return solver.geometry({.position = {7, 14, 2}}).paths;
  };
  const auto same = [](const GeometricPath& a, const GeometricPath& b) {
    return a.interactions == b.interactions && a.vertices == b.vertices && a.length_m == b.length_m;
  };
  EXPECT_FALSE(std::ranges::equal(geometry(moved), geometry(there), same));
  moved.move_source(second);
  EXPECT_TRUE(std::ranges::equal(geometry(moved), geometry(there), same));
  EXPECT_GT(geometry(there).size(), 100u);
}

TEST(PathSolver, AWedgesOwnFaceDoesNotReflectRightBesideIt) {
  // A corner of the wall stands 0.05 mm off its plane, as merging allows. So does the edge, and a reflection
  // just before the edge would have a point of its own.
  TinyScene tiny = materials();
  tiny.object("wall", 0, 2)
      .face({{dvec3(0, 0, 0), dvec3(10, 0, 0), dvec3(10, 0, 8)},
             {dvec3(0, 0, 0), dvec3(10, 0, 8), dvec3(0, -5e-5, 8)}});
  tiny.object("screen", 0, 2).quad({-20, -20, -5}, {30, -20, -5}, {30, -20, 30}, {-20, -20, 30});
  const scene::Scene scene = tiny.build();
  RadioEffects effects;
  effects.diffraction = effects.free_edges = true;
  const RadioModel model(scene, carrier_hz, effects);
  const auto top = std::ranges::find_if(model.wedges, [](const scene::Wedge& wedge) {
    return std::min(wedge.a.z, wedge.b.z) > 7.0 && wedge.facet_0 == 0;
  });
  ASSERT_NE(top, model.wedges.end());
  const scene::Wedge& wedge = *top;
  CandidateList list = exhaustive_candidates(model.facets.facet_count(), 2);
  for (size_t i = 0; i < list.size(); ++i) {
    list.wedge_offsets.push_back(static_cast<uint32_t>(i));
    list.wedges.push_back(static_cast<uint32_t>(top - model.wedges.begin()));
  }
  list.wedge_offsets.push_back(static_cast<uint32_t>(list.size()));
  PathSolver solver(model, {.max_depth = 3});
  solver.set_candidates(list, {4, -6, 5}, Source::transmitter);
  int beside = 0, elsewhere = 0;
  for (const GeometricPath& path : solver.geometry({.position = {6, 5, 10}}).paths)
    for (size_t i = 1; i < path.interactions.size(); ++i) {
      if (path.interactions[i].type != InteractionType::diffraction) continue;
      const uint32_t before = path.interactions[i - 1].element;
      ++(before == wedge.facet_0 || before == wedge.facet_n ? beside : elsewhere);
    }
  EXPECT_EQ(beside, 0);
  EXPECT_GT(elsewhere, 0) << "the screen reflects towards the edge";
}

TEST(PathSolver, AWedgeDiffractsWhereItsBodyIsNow) {
  TinyScene tiny = materials();
  const uint32_t body = tiny.body("van");
  tiny.object("van", body, 2).box({0, 0, 0}, {4, 2, 2});
  const scene::Scene scene = tiny.build();
  RadioEffects effects;
  effects.diffraction = true;
  RadioModel model(scene, carrier_hz, effects);
  CandidateList list;
  list.add({});
  list.wedge_offsets = {0, static_cast<uint32_t>(model.wedges.size())};
  for (uint32_t i = 0; i < model.wedges.size(); ++i) list.wedges.push_back(i);
  PathSolver solver(model, {.max_depth = 1}, true);
  solver.set_candidates(list, {-3, 1, 3}, Source::transmitter);
  // The paths over the near and the far edge of the roof are at y = 1 by symmetry. They move with the van.
  const auto edges = [&] {
    std::vector<dvec3> points;
    for (const GeometricPath& path : solver.geometry({.position = {40, 1, 3}}).paths)
      if (path.interactions.size() == 1 && std::abs(path.vertices[1].y - 1.0) < 1e-9)
        points.push_back(path.vertices[1]);
    return points;
  };
  const std::vector<dvec3> before = edges();
  ASSERT_FALSE(before.empty());
  Motion motion;
  motion.pose.position = {10, 0, 0.25};
  model.facets.move(body, motion);
  const std::vector<dvec3> after = edges();
  ASSERT_EQ(after.size(), before.size());
  for (size_t i = 0; i < after.size(); ++i) {
    EXPECT_NEAR(after[i].x - before[i].x, 10.0, 1e-9);
    EXPECT_NEAR(after[i].z - before[i].z, 0.25, 1e-9);
  }
}

TEST(RadioModel, CountsEdgesThatAreTooShortToDiffract) {
  TinyScene tiny = materials();
  tiny.object("house", 0, 2).box({0, 0, 0}, {10, 10, 8});
  tiny.object("grain", 0, 2).box({20, 0, 0}, {20.0005, 5, 5});
  RadioEffects effects;
  effects.diffraction = true;
  const scene::Scene scene = tiny.build();
  const RadioModel model(scene, carrier_hz, effects);
  EXPECT_EQ(model.wedges.size(), 12u + 8u);
  EXPECT_EQ(model.short_wedges, 4u);
  effects.diffraction = false;
  EXPECT_EQ(RadioModel(scene, carrier_hz, effects).short_wedges, 0u);
}

TEST(PathSolver, APathBeyondTheBoundIsCounted) {
  const scene::Scene scene = one_wall(3).build();
  RadioEffects effects;
  effects.scattering = true;
  const RadioModel model(scene, carrier_hz, effects);
  PathSolver solver(model, {.max_depth = 1, .patch_m = 1.0, .max_paths = 10});
  const dvec3 source(5, 0, 5);
  solver.set_candidates(BeamSearch(model.facets, model.kinds, {}, {.max_depth = 1}).search(source).list,
                        source, Source::transmitter);
  const LinkGeometry link = solver.geometry({.position = {6, 3, 4}});
  EXPECT_EQ(link.paths.size(), 10u);
  EXPECT_GT(link.overflow, 100u);
}

TEST(PathSolver, EffectsThatAreOffGiveNoPaths) {
  TinyScene tiny = materials();
  tiny.object("ground", 0, 2).quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
  RadioEffects effects;
  effects.line_of_sight = false;
  EXPECT_THAT(solve(tiny.build(), {0, 0, 5}, {6, 0, 5}, effects, {}).chains(), ElementsAre("R"));
  effects = {};
  effects.reflection = false;
  EXPECT_THAT(solve(tiny.build(), {0, 0, 5}, {6, 0, 5}, effects, {}).chains(), ElementsAre(""));
}

TEST(PathId, IsAFunctionOfTheWholeSequence) {
  const std::vector<Interaction> a{{InteractionType::reflection, 1}, {InteractionType::transmission, 2}};
  const std::vector<Interaction> b{{InteractionType::transmission, 1}, {InteractionType::reflection, 2}};
  const std::vector<Interaction> c{{InteractionType::reflection, 1}};
  const std::vector<Interaction> d{{InteractionType::scattering, 1, 1}},
      e{{InteractionType::scattering, 1, 2}};
  std::vector<uint64_t> ids{path_id(a), path_id(b), path_id(c), path_id(d), path_id(e), path_id({})};
  EXPECT_EQ(path_id(a), ids[0]);
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::unique(ids.begin(), ids.end()), ids.end());
}

}  // namespace
}  // namespace greatx::rf
