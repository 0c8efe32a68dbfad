// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests radio maps: where cells are, what lies below them, and that a cell equals a receiver at its place.
#include <cmath>
#include <cstring>
#include <limits>
#include <sched.h>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/units.h"
#include "sim/channel/radio_map_run.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/sim/radio_run.h"

namespace greatx::sim {
namespace {

using sim::testing::experiment_in;
using sim::testing::radio_material;
using sim::testing::RadioRun;
using sim::testing::run;
using test::TinyScene;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double carrier_hz = 3.5e9, inf = std::numeric_limits<double>::infinity();

/// Returns a street of slabs, away from the origin of the world.
scene::Scene street() {
  TinyScene tiny;
  const uint32_t ground = tiny.material_as(radio_material("medium_dry_ground")),
                 wall = tiny.material_as(radio_material("brick", 0.2));
  tiny.object("ground", 0, ground).quad({60, -40, 0}, {140, -40, 0}, {140, 40, 0}, {60, 40, 0});
  tiny.object("north", 0, wall).box({88, 8, 0}, {99, 14, 9});
  tiny.object("east", 0, wall).box({104, 8, 0}, {114, 14, 6});
  tiny.object("south", 0, wall).box({91, -14, 0}, {106, -7, 7});
  scene::Scene scene = tiny.build({100, 0, 0});
  scene.instances[0].semantic_class = scene::SemanticClass::ground;
  for (int i = 1; i < 4; ++i) scene.instances[i].semantic_class = scene::SemanticClass::building;
  return scene;
}

/// Returns a scenario with two base stations, and terminals at `terminals`.
std::string two_stations(const std::vector<dvec3>& terminals) {
  std::string nodes, names;
  for (size_t i = 0; i < terminals.size(); ++i) {
    const dvec3& p = terminals[i];
    nodes += fmt::format(
        "  - name: ue{}\n    trajectory: {{type: static, position_m: [{:.17g}, {:.17g}, {:.17g}]}}\n"
        "    sensors: [{{name: antenna, type: antenna}}]\n",
        i, p.x, p.y, p.z);
    names += fmt::format("{}ue{}/antenna", i ? ", " : "", i);
  }
  return fmt::format(
      "greatx: 1\nname: test\nseed: 5\nticks: 1\ntick_rate_hz: 100\nnodes:\n"
      "  - name: west\n    trajectory: {{type: static, position_m: [80, 1.1, 5.2], rotation_deg: [20, 5, "
      "0]}}\n"
      "    sensors: [{{name: panel, type: antenna, polarization: slant, rows: 2, columns: 2}}]\n"
      "  - name: east\n    trajectory: {{type: static, position_m: [120.3, -2.4, 6.1]}}\n"
      "    sensors: [{{name: panel, type: antenna, polarization: slant, rows: 2, columns: 2}}]\n{}"
      "channels:\n  - {{name: csi, tx: [west/panel, east/panel], rx: [{}], rate_hz: 100, subcarriers: 4, "
      "bandwidth_hz: 20e6, carrier_hz: {}, max_depth: 2}}\n",
      nodes, names, carrier_hz);
}

/// Holds a channel of a scenario, ready for maps.
class Site {
 public:
  Site(const std::string& yaml, const scene::Scene& scene)
      : experiment_(experiment_in(yaml, scene)), snapshot_(test::device(), experiment_, 0, {}) {}

  MapCells cells(const MapGrid& grid, const MapHeight& height, bool beyond = false) const {
    const std::vector<dvec3> ends{{80, 1.1, 5.2}, {120.3, -2.4, 6.1}};
    return place_cells(grid, height, experiment_.scene(), snapshot_.model().kinds, snapshot_.moment().bodies,
                       ends, beyond);
  }
  const Experiment& experiment() const { return experiment_; }
  ChannelSnapshot& snapshot() { return snapshot_; }
  std::vector<MapLink> solve(const MapCells& cells, size_t first = 0, size_t most = ~size_t{0},
                             const MapPrecoder& precoder = {}) {
    RadioMapSolver solver(snapshot_, {}, precoder);
    std::vector<MapLink> links;
    solver.solve(cells, first, [&](std::span<const MapLink> more) {
      links.insert(links.end(), more.begin(), more.end());
      return links.size() < most;
    });
    return links;
  }

 private:
  Experiment experiment_;
  ChannelSnapshot snapshot_;
};

/// Expects the same bits, where any NaN equals any other.
void expect_same(const std::vector<MapLink>& a, const std::vector<MapLink>& b) {
  ASSERT_EQ(a.size(), b.size());
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  for (size_t i = 0; i < a.size(); ++i)
    EXPECT_TRUE(a[i].paths == b[i].paths && a[i].line_of_sight == b[i].line_of_sight &&
                same(a[i].path_gain, b[i].path_gain) && same(a[i].mean_delay_s, b[i].mean_delay_s) &&
                same(a[i].delay_spread_s, b[i].delay_spread_s) && same(a[i].k_factor, b[i].k_factor) &&
                same(a[i].departure_azimuth_spread, b[i].departure_azimuth_spread) &&
                same(a[i].departure_zenith_spread, b[i].departure_zenith_spread) &&
                same(a[i].beam_gain, b[i].beam_gain) && a[i].beam == b[i].beam &&
                same(a[i].arrival_azimuth_spread, b[i].arrival_azimuth_spread) &&
                same(a[i].arrival_zenith_spread, b[i].arrival_zenith_spread))
        << "link " << i;
}

TEST(RadioMapGrid, CellsCoverTheRectangleFromTheSouthWest) {
  const MapGrid grid = make_map_grid({-3.0, 10.0}, {4.5, 12.0}, 1.0, 2);
  EXPECT_EQ(grid.columns, 8u);  // the last column extends beyond the rectangle
  EXPECT_EQ(grid.rows, 2u);
  EXPECT_EQ(grid.max_m(), dvec2(5.0, 12.0));
  EXPECT_EQ(grid.center(0), dvec2(-2.5, 10.5));
  EXPECT_EQ(grid.center(8), dvec2(-2.5, 11.5));
  EXPECT_EQ(grid.center(15), dvec2(4.5, 11.5));
  EXPECT_EQ(make_map_grid({0, 0}, {300, 0.3}, 0.1, 1).columns, 3000u);
  EXPECT_EQ(make_map_grid({0, 0}, {300, 0.3}, 0.1, 1).rows, 3u);
}

TEST(RadioMapGrid, RefusesWhatIsNoGrid) {
  const double nan = std::nan("");
  for (const double cell : {0.0, -1.0, nan, inf})
    EXPECT_THAT(
        [&] {
          make_map_grid({0, 0}, {1, 1}, cell, 1);
        },
        ThrowsMessage<UserError>(HasSubstr("--cell")));
  EXPECT_THAT([&] { make_map_grid({nan, 0}, {1, 1}, 1.0, 1); }, ThrowsMessage<UserError>(HasSubstr("--min")));
  for (const dvec2 max : {dvec2(0, 1), dvec2(1, -1), dvec2(inf, 1)})
    EXPECT_THAT([&] { make_map_grid({0, 0}, max, 1.0, 1); }, ThrowsMessage<UserError>(HasSubstr("--max")));
  EXPECT_THAT(
      [&] {
        make_map_grid({0, 0}, {2000, 2000}, 1.0, 2);
      },
      ThrowsMessage<UserError>(HasSubstr("2000 x 2000")));
  EXPECT_EQ(make_map_grid({0, 0}, {2000, 2000}, 1.0, 1).cells(), most_map_links);
}

TEST(RadioMapGround, IsTheHighestOfItsClassOrTheLowestThatFacesUp) {
  TinyScene tiny;
  tiny.object("slope").quad({0, 0, 0}, {20, 0, 2}, {20, 10, 2}, {0, 10, 0});
  tiny.object("road").quad({0, 4, 5}, {20, 4, 5}, {20, 6, 5}, {0, 6, 5});  // a bridge
  tiny.object("house").box({8, 7, -1}, {12, 9, 6});
  tiny.object("tree").quad({1, 1, 9}, {3, 1, 9}, {3, 3, 9}, {1, 3, 9});
  scene::Scene scene = tiny.build({100, 200, 50});
  for (scene::FacetTriangle& t : scene.facet_triangles)
    for (dvec3& corner : t.corners) corner += dvec3(100, 200, 50);  // build() takes world coordinates
  scene.bounds.min += dvec3(100, 200, 50);
  scene.bounds.max += dvec3(100, 200, 50);
  using scene::SemanticClass;
  const auto classes = [&](std::array<SemanticClass, 4> all) {
    for (size_t i = 0; i < 4; ++i) scene.instances[i].semantic_class = all[i];
  };
  const dvec2 at(100, 200);
  classes({SemanticClass::ground, SemanticClass::road, SemanticClass::building, SemanticClass::vegetation});
  const GroundHeights ground(scene, MapOver::ground), roofs(scene, MapOver::roofs);
  EXPECT_NEAR(*ground.at(at + dvec2(5, 2)), 50.5, 1e-12);
  EXPECT_NEAR(*ground.at(at + dvec2(10, 5)), 55.0, 1e-12);  // on the bridge
  EXPECT_NEAR(*ground.at(at + dvec2(10, 8)), 51.0, 1e-12);  // under the house
  EXPECT_NEAR(*roofs.at(at + dvec2(10, 8)), 56.0, 1e-12);
  EXPECT_NEAR(*roofs.at(at + dvec2(2, 2)), 50.2, 1e-12);  // under the tree
  EXPECT_FALSE(ground.at(at + dvec2(-0.5, 2)));
  // The height is also right on corners, on edges and on the diagonal of a quad.
  for (const dvec2& p : {dvec2(0, 0), dvec2(20, 0), dvec2(10, 0), dvec2(4, 2), dvec2(20, 10)})
    EXPECT_NEAR(ground.at(at + p).value_or(-1.0), 50.0 + 0.1 * p.x, 1e-9);
  classes({});
  const GroundHeights lowest(scene, MapOver::ground);
  EXPECT_NEAR(*lowest.at(at + dvec2(10, 5)), 51.0, 1e-12);
  EXPECT_NEAR(*lowest.at(at + dvec2(10, 8)), 51.0, 1e-12);  // the house's floor faces down
}

TEST(RadioMap, CellsKnowWhereTheyStand) {
  Site site(two_stations({{100, 0, 1.5}}), street());
  const MapGrid grid = make_map_grid({50, -15}, {140, 15}, 1.0, 2);
  const MapCells cells = site.cells(grid, {{}, 1.5, MapOver::ground});
  for (size_t cell = 0; cell < grid.cells(); ++cell) {
    const dvec2 p = grid.center(cell);
    const auto in = [&](double x0, double y0, double x1, double y1) {
      return p.x > x0 && p.x < x1 && p.y > y0 && p.y < y1;
    };
    const bool inside = in(88, 8, 99, 14) || in(104, 8, 114, 14) || in(91, -14, 106, -7);
    EXPECT_EQ(cells.placement[cell], p.x < 60 ? CellPlacement::nothing_beneath
                                     : inside ? CellPlacement::solid
                                              : CellPlacement::free)
        << p.x << ", " << p.y;
    EXPECT_EQ(std::isnan(cells.z_m[cell]) ? 1.5 : cells.z_m[cell], 1.5);
    EXPECT_EQ(std::isnan(cells.z_m[cell]), p.x < 60);
  }
  // One plane lies above two of the houses, the other in the plane of the ground.
  const MapCells high = site.cells(grid, {8.0, 1.5, MapOver::ground});
  EXPECT_EQ(high.placement[25 * 90 + 60], CellPlacement::free);   // (110.5, 10.5)
  EXPECT_EQ(high.placement[25 * 90 + 40], CellPlacement::solid);  // (90.5, 10.5)
  EXPECT_EQ(high.placement[0], CellPlacement::free);
  EXPECT_EQ(site.cells(grid, {0.0, 1.5, MapOver::ground}).placement[20], CellPlacement::on_surface);
}

TEST(RadioMap, RefusesAPlaneThatMissesTheScene) {
  Site site(two_stations({{100, 0, 1.5}}), street());
  const MapGrid here = make_map_grid({90, -5}, {110, 5}, 5.0, 2),
                away = make_map_grid({0, 0}, {50, 50}, 5.0, 2);
  const auto place = [&](const MapGrid& grid, std::optional<double> plane, double height,
                         bool beyond = false) {
    return [&site, grid, plane, height, beyond] {
      site.cells(grid, {plane, height, MapOver::ground}, beyond);
    };
  };
  EXPECT_THAT(place(here, -3.0, 1.5), ThrowsMessage<UserError>(HasSubstr("z 0 to 9 m, found -3")));
  EXPECT_THAT(place(here, 400.0, 1.5), ThrowsMessage<UserError>(HasSubstr("--plane")));
  EXPECT_THAT(place(here, std::nan(""), 1.5, true), ThrowsMessage<UserError>(HasSubstr("--plane")));
  EXPECT_THAT(place(away, 2.0, 1.5), ThrowsMessage<UserError>(HasSubstr("x 60 to 140 m")));
  EXPECT_THAT(place(away, {}, 1.5, true), ThrowsMessage<UserError>(HasSubstr("beneath none")));
  for (const double height : {0.0, -1.0, inf})
    EXPECT_THAT(place(here, {}, height), ThrowsMessage<UserError>(HasSubstr("--height")));
  EXPECT_EQ(site.cells(away, {400.0, 1.5, MapOver::ground}, true).z_m[0], 400.0);
}

TEST(RadioMap, ACellIsAReceiverPutThereToTheBit) {
  const MapGrid grid = make_map_grid({83.1, -20.7}, {119.0, 19.0}, 3.7, 2);
  std::vector<dvec3> terminals;
  std::vector<size_t> chosen;
  Site site(two_stations({{100, 0, 1.5}}), street());
  const MapCells cells = site.cells(grid, {{}, 1.7, MapOver::ground});
  for (size_t cell = 0; cell < grid.cells(); cell += 3)
    if (cells.solved(cell)) chosen.push_back(cell), terminals.push_back(cells.point(cell));
  ASSERT_GT(chosen.size(), 20u);
  const std::vector<MapLink> links = site.solve(cells);
  ASSERT_EQ(links.size(), 2 * grid.cells());

  const RadioRun csi = run(two_stations(terminals), street());
  const MapPower power{{20.0, 30.0}, 20e6, 5.0};
  const RadioMap map{&cells, links, power};
  const std::vector<std::string> names = {"path_gain",
                                          "mean_delay",
                                          "delay_spread",
                                          "departure_azimuth_spread",
                                          "departure_zenith_spread",
                                          "arrival_zenith_spread",
                                          "k_factor",
                                          "arrival_azimuth_spread"};
  size_t with_several = 0, in_shadow = 0;
  for (const std::string& name : names) {
    const std::vector<double> put = csi.values<double>(0, name);
    ASSERT_EQ(put.size(), 2 * chosen.size());
    const Array array = map_array(map, map_quantity(name));
    EXPECT_EQ(array.shape, (std::vector<int64_t>{2, grid.rows, grid.columns}));
    for (size_t i = 0; i < chosen.size(); ++i)
      for (size_t t = 0; t < 2; ++t) {
        const double cell = array.as<double>()[t * grid.cells() + chosen[i]], there = put[2 * i + t];
        EXPECT_EQ(std::memcmp(&cell, &there, sizeof cell), 0) << name << ": " << cell << ", " << there;
      }
  }
  for (const size_t cell : chosen) {
    with_several += links[2 * cell].paths > 2;
    in_shadow += links[2 * cell].paths > 0 && !links[2 * cell].line_of_sight;
  }
  EXPECT_GT(with_several, 5u);  // otherwise the test proves nothing
  EXPECT_GT(in_shadow, 2u);
}

TEST(RadioMapRun, IsItsStepsOneAfterTheOther) {
  Site site(two_stations({{100, 0, 1.5}}), street());
  const ChannelConfig& config = site.experiment().scenario.channels[0];
  MapRequest request;
  request.min_m = dvec2(85, -20);
  request.max_m = dvec2(120, 15);
  request.cell_m = 2.5;
  request.power_dbm = {20.0, 30.0};
  request.bandwidth_hz = 1e6;
  request.inside_solids = true;
  const MapGrid grid = make_map_grid({85, -20}, {120, 15}, 2.5, 2);
  const scene::Bounds box = map_bounds(request, config, site.experiment().scene()),
                      by_hand = bounds_of_cells(grid, request.height, site.experiment().scene());
  EXPECT_EQ(box.min, by_hand.min);
  EXPECT_EQ(box.max, by_hand.max);

  RadioMapRun run(site.snapshot(), request, {});
  EXPECT_EQ(run.transmitters(), (std::vector<dvec3>{{80, 1.1, 5.2}, {120.3, -2.4, 6.1}}));
  EXPECT_EQ(run.power().transmit_dbm, request.power_dbm);
  MapCells cells = site.cells(grid, request.height);
  cells.solve_inside = true;
  EXPECT_EQ(run.cells().z_m, cells.z_m);
  EXPECT_EQ(run.cells().placement, cells.placement);
  std::vector<MapLink> links;
  run.solve(0, [&](std::span<const MapLink> more) {
    links.insert(links.end(), more.begin(), more.end());
    return true;
  });
  expect_same(links, site.solve(cells));
  const RadioMap map = run.map(links);
  EXPECT_EQ(map.transmitters(), 2u);
  EXPECT_EQ(map_array(map, map_quantity("rss")).shape, (std::vector<int64_t>{2, 14, 14}));
  EXPECT_EQ(map_placement(cells).shape, (std::vector<int64_t>{14, 14}));
}

TEST(RadioMapRun, SaysBeforeTheSceneWhatItCannotDo) {
  const Site site(two_stations({{100, 0, 1.5}}), street());
  const ChannelConfig& config = site.experiment().scenario.channels[0];
  MapRequest request;
  request.power_dbm = {1.0, 2.0, 3.0};
  EXPECT_THAT([&] { check_map_request(request, config); },
              ThrowsMessage<UserError>(HasSubstr("--power: expected 1 number, or 2")));
  request = {};
  request.bandwidth_hz = 0.0;
  EXPECT_THAT([&] { check_map_request(request, config); },
              ThrowsMessage<UserError>(HasSubstr("--bandwidth")));
  request = {};
  request.cell_m = -1.0;
  EXPECT_THAT([&] { map_bounds(request, config, site.experiment().scene()); },
              ThrowsMessage<UserError>(HasSubstr("--cell")));
}

TEST(RadioMap, AnyPartAndAnyNumberOfThreadsGivesTheSameBits) {
  Site site(two_stations({{100, 0, 1.5}}), street());
  const MapGrid grid = make_map_grid({70, -20}, {130, 20}, 1.9, 2);
  const MapCells cells = site.cells(grid, {{}, 1.5, MapOver::ground});
  const std::vector<MapLink> whole = site.solve(cells);
  ASSERT_EQ(whole.size(), 2 * grid.cells());
  // The solution is stopped, and continued from where it was.
  std::vector<MapLink> parts = site.solve(cells, 0, 100);
  EXPECT_LT(parts.size(), whole.size());
  const auto rest = site.solve(cells, parts.size() / 2);
  parts.insert(parts.end(), rest.begin(), rest.end());
  expect_same(parts, whole);
  for (const size_t first : {size_t{1}, size_t{137}, grid.cells() - 1, grid.cells()})
    expect_same(site.solve(cells, first), {whole.begin() + static_cast<ptrdiff_t>(2 * first), whole.end()});

  cpu_set_t all, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  CPU_ZERO(&one);
  for (int cpu = 0; CPU_COUNT(&one) == 0; ++cpu)
    if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const std::vector<MapLink> alone = site.solve(cells);
  ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
  expect_same(alone, whole);
}

TEST(RadioMap, CellsInsideSolidsHaveValuesOnRequest) {
  Site site(two_stations({{100, 0, 1.5}}), street());
  const MapGrid grid = make_map_grid({90, 9}, {98, 13}, 2.0, 2);
  MapCells cells = site.cells(grid, {{}, 1.5, MapOver::ground});
  for (const MapLink& link : site.solve(cells)) EXPECT_EQ(link.paths, 0u);
  cells.solve_inside = true;
  size_t paths = 0;
  for (const MapLink& link : site.solve(cells)) paths += link.paths;
  EXPECT_GT(paths, 0u);
}

TEST(RadioMap, FreeSpaceIsFriis) {
  // The cells lie above the roofs, and reflections are switched off.
  std::string yaml = two_stations({{100, 0, 1.5}});
  yaml.replace(yaml.find("max_depth: 2"), 12, "max_depth: 0");
  Site site(yaml, street());
  const MapGrid grid = make_map_grid({85, -10}, {115, 10}, 5.0, 2);
  const MapCells cells = site.cells(grid, {9.0, 1.5, MapOver::ground});
  const std::vector<MapLink> links = site.solve(cells);
  const dvec3 stations[] = {{80, 1.1, 5.2}, {120.3, -2.4, 6.1}};
  size_t seen = 0;
  for (size_t cell = 0; cell < grid.cells(); ++cell)
    for (size_t t = 0; t < 2; ++t) {
      const MapLink& link = links[2 * cell + t];
      if (link.paths == 0) continue;
      const double d = glm::distance(stations[t], cells.point(cell));
      const double gain = std::pow(speed_of_light / carrier_hz / (4.0 * pi * d), 2);
      // The panels have elements at +-45 degrees. A vertical element receives half of the power of each,
      // averaged over the ports.
      EXPECT_NEAR(link.path_gain / gain, 0.5, t == 1 ? 1e-9 : 0.02);  // the first panel leans
      EXPECT_NEAR(link.mean_delay_s, d / speed_of_light, 1e-18);
      EXPECT_EQ(link.delay_spread_s, 0.0);
      EXPECT_EQ(link.k_factor, inf);
      ++seen;
    }
  EXPECT_GT(seen, 30u);
}

TEST(RadioMapPrecoder, GainsOfBeamsAndMaximumRatio) {
  Site site(two_stations({{100, 0, 1.5}}), street());
  const MapGrid grid = make_map_grid({84, -18}, {118, 16}, 3.1, 2);
  const MapCells cells = site.cells(grid, {{}, 1.7, MapOver::ground});
  const std::vector<MapLink> mean = site.solve(cells),
                             best = site.solve(cells, 0, ~size_t{0}, {MapPrecoding::best_beam, {}, {{2, 1}}}),
                             most = site.solve(cells, 0, ~size_t{0}, {MapPrecoding::maximum_ratio, {}, {}});
  constexpr uint64_t beams = 4 * 2 * 4;  // of 2 x 2 elements, twice as many along the rows, with four phases
  std::vector<double> largest(mean.size(), 0.0);
  std::vector<int32_t> which(mean.size(), -1);
  for (uint64_t beam = 0; beam < beams; ++beam) {
    const std::vector<MapLink> links = site.solve(cells, 0, ~size_t{0}, {MapPrecoding::beam, beam, {{2, 1}}});
    for (size_t i = 0; i < links.size(); ++i) {
      EXPECT_EQ(links[i].beam, links[i].beam_gain > 0.0 ? static_cast<int32_t>(beam) : -1);
      if (links[i].beam_gain > largest[i]) largest[i] = links[i].beam_gain, which[i] = links[i].beam;
    }
  }
  size_t several = 0, gained = 0;
  for (size_t i = 0; i < mean.size(); ++i) {
    EXPECT_EQ(best[i].beam_gain, largest[i]);
    EXPECT_EQ(best[i].beam, which[i]);
    EXPECT_EQ(mean[i].beam_gain, mean[i].path_gain);
    EXPECT_EQ(mean[i].beam, -1);
    EXPECT_EQ(most[i].beam_gain, 8.0 * mean[i].path_gain);  // eight ports
    EXPECT_EQ(most[i].path_gain, mean[i].path_gain);
    EXPECT_LE(best[i].beam_gain, most[i].beam_gain * (1.0 + 1e-12));
    several += mean[i].paths > 2;
    gained += best[i].beam_gain > 4.0 * mean[i].path_gain;
  }
  EXPECT_GT(several, 20u);
  EXPECT_GT(gained, 100u);
}

TEST(RadioMapPrecoder, RefusesWhatDoesNotFit) {
  const auto refused = [](const MapPrecoder& precoder, const char* text) {
    EXPECT_THAT([&] { check_map_precoder(precoder); }, ThrowsMessage<UserError>(HasSubstr(text)));
  };
  refused({MapPrecoding::beam, {}, {}},
          "--beam: expected the index of a beam for --precoder beam, found none");
  refused({MapPrecoding::mean, 3, {}}, "--beam: expected --precoder beam beside it, found mean");
  refused({MapPrecoding::maximum_ratio, {}, {{1, 1}}},
          "--oversampling: expected --precoder beam or best_beam beside it, found maximum_ratio");
  refused({MapPrecoding::best_beam, {}, {{1, 0}}},
          "--oversampling: expected 1 to 32 beams per element, found 0");
  refused({MapPrecoding::best_beam, {}, {{33, 1}}}, "found 33");
  EXPECT_THAT([] { map_precoding("zero_forcing"); },
              ThrowsMessage<UserError>(HasSubstr("--precoder: expected one of mean, beam, best_beam, "
                                                 "maximum_ratio, found 'zero_forcing'")));
  rf::AntennaArray array;
  array.rows = 2;
  array.columns = 4;
  array.polarization = rf::Polarization::slant;
  EXPECT_THAT(
      [&] {
        MapBeams({MapPrecoding::beam, 32, {}}, array, "bs/panel");
      },
      ThrowsMessage<UserError>(
          HasSubstr("--beam: expected 0 to 31, one of the beams of 'bs/panel', found 32")));
  array.rows = array.columns = 1024;
  EXPECT_THAT(
      [&] {
        MapBeams({MapPrecoding::best_beam, {}, {{32, 32}}}, array, "bs/panel");
      },
      ThrowsMessage<UserError>(HasSubstr("--precoder: expected at most 8388608 beams times ports")));
  array.positions_m = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_THAT(
      [&] {
        MapBeams({MapPrecoding::best_beam, {}, {}}, array, "bs/free");
      },
      ThrowsMessage<UserError>(HasSubstr("found elements_wl of 'bs/free'")));
  MapBeams({MapPrecoding::maximum_ratio, {}, {}}, array, "bs/free");
}

/// Holds a row of cells of 1 m with the given gains of each transmitter. The last cell is inside a solid.
struct Table {
  MapCells cells;
  std::vector<MapLink> links;
  Table(std::vector<std::vector<double>> gains) {
    cells.grid = make_map_grid({0, 0}, {static_cast<double>(gains.size()), 1}, 1.0, 1);
    cells.placement.assign(gains.size(), CellPlacement::free);
    cells.placement.back() = CellPlacement::solid;
    cells.z_m.assign(gains.size(), 1.5);
    for (const std::vector<double>& cell : gains)
      for (const double gain : cell) {
        links.push_back(no_link());
        links.back().path_gain = gain;
        links.back().beam_gain = 8.0 * gain;
        links.back().beam = gain > 0.0 ? static_cast<int32_t>(links.size()) : -1;
        links.back().paths = gain > 0.0 ? 1 : 0;
      }
  }
  std::vector<double> values(const std::string& name, const MapPower& power,
                             MapPrecoding precoding = MapPrecoding::mean) const {
    const Array array = map_array({&cells, links, power, precoding}, map_quantity(name));
    if (array.dtype == DType::f64) return {array.as<double>().begin(), array.as<double>().end()};
    return {array.as<int32_t>().begin(), array.as<int32_t>().end()};
  }
};

TEST(RadioMapValues, PowerInterferenceAndServers) {
  const Table table({{1e-8, 1e-9}, {1e-9, 1e-9}, {0.0, 1e-10}, {0.0, 0.0}, {1e-3, 1e-3}});
  const MapPower power{{20.0, 30.0}, 10e6, 3.0};
  // k T B F = 1.380649e-23 * 290 * 1e7 * 10^0.3 W
  const double noise = 1.380649e-23 * 290.0 * 1e7 * std::pow(10.0, 0.3);
  EXPECT_NEAR(power.noise_w(), noise, 1e-27);
  const auto rss = table.values("rss", power);
  EXPECT_NEAR(rss[0], -60.0, 1e-12);
  EXPECT_NEAR(rss[5], -60.0, 1e-12);
  EXPECT_EQ(rss[3], -inf);
  EXPECT_TRUE(std::isnan(rss[4]) && std::isnan(rss[9]));  // inside the solid
  EXPECT_EQ(table.values("best_server", power), (std::vector<double>{0, 1, 1, -1, -1}));
  const auto sinr = table.values("sinr", power);
  EXPECT_NEAR(sinr[0], 10.0 * std::log10(1e-9 / (1e-9 + noise)), 1e-12);
  EXPECT_NEAR(sinr[1], 10.0 * std::log10(1e-10 / (1e-9 + noise)), 1e-12);
  EXPECT_NEAR(sinr[7], 10.0 * std::log10(1e-10 / noise), 1e-12);  // no other transmitter is heard
  EXPECT_EQ(sinr[3], -inf);
  const auto gain = table.values("path_gain", power);
  EXPECT_EQ(gain[1], 1e-9);
  EXPECT_EQ(gain[3], 0.0);
  EXPECT_TRUE(std::isnan(gain[4]));
  const auto best = map_at_best_server({&table.cells, table.links, power}, map_quantity("path_gain"));
  EXPECT_EQ(best[0], 1e-8);
  EXPECT_EQ(best[1], 1e-9);
  EXPECT_EQ(best[2], 1e-10);
  EXPECT_TRUE(std::isnan(best[3]) && std::isnan(best[4]));
  EXPECT_EQ(best_server(std::vector<double>{1e-9, 2e-9, 2e-9}), 1);  // the first of equals
}

TEST(RadioMapValues, PrecodersServeAndInterfere) {
  const Table table({{1e-8, 1e-9}, {0.0, 1e-10}, {1e-3, 1e-3}});
  const MapPower power{{20.0, 30.0}, 10e6, 3.0};
  const double noise = power.noise_w();
  for (const MapPrecoding precoding :
       {MapPrecoding::best_beam, MapPrecoding::maximum_ratio, MapPrecoding::beam}) {
    // The other station's beam looks elsewhere, unless it is the same beam for everybody.
    const double others = precoding == MapPrecoding::beam ? 8.0 : 1.0;
    const auto rss = table.values("rss", power, precoding), sinr = table.values("sinr", power, precoding);
    EXPECT_NEAR(rss[0], 10.0 * std::log10(8e-9) + 30.0, 1e-12);
    EXPECT_NEAR(sinr[0], 10.0 * std::log10(8e-9 / (others * 1e-9 + noise)), 1e-12);
    EXPECT_NEAR(sinr[4], 10.0 * std::log10(8e-10 / noise), 1e-12);
    EXPECT_EQ(table.values("best_server", power, precoding), (std::vector<double>{0, 1, -1}));
    EXPECT_EQ(table.values("path_gain", power, precoding)[0], 1e-8);
    EXPECT_EQ(table.values("beam_gain", power, precoding)[0], 8e-8);
    EXPECT_EQ(table.values("best_beam", power, precoding), (std::vector<double>{1, -1, -1, 2, 4, -1}));
  }
  EXPECT_EQ(map_quantities_of(MapPrecoding::mean).size() + 2, map_quantities().size());
  EXPECT_EQ(map_quantities_of(MapPrecoding::best_beam).size(), map_quantities().size());
}

TEST(RadioMapValues, RefusesPowersThatAreNone) {
  const double nan = std::nan("");
  for (const double dbm : {nan, inf, -inf})
    EXPECT_THAT(
        [&] {
          check_power({{30.0, dbm}, 1e6, 0.0});
        },
        ThrowsMessage<UserError>(HasSubstr("--power")));
  for (const double hz : {0.0, -1.0, nan, inf})
    EXPECT_THAT([&] { check_power({{30.0}, hz, 0.0}); }, ThrowsMessage<UserError>(HasSubstr("--bandwidth")));
  for (const double db : {-1.0, nan, inf})
    EXPECT_THAT(
        [&] {
          check_power({{30.0}, 1e6, db});
        },
        ThrowsMessage<UserError>(HasSubstr("--noise-figure")));
  EXPECT_THAT([] { map_quantity("gain"); },
              ThrowsMessage<UserError>(::testing::AllOf(HasSubstr("'gain'"), HasSubstr("path_gain"))));
}

}  // namespace
}  // namespace greatx::sim
