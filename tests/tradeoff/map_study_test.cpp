// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The size of the cells of a radio map as a knob: its plan, its errors on crafted maps and in free space.
#include "sim/tradeoff/map_study.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/sim/radio_run.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::sim {
namespace {

constexpr dvec3 station{13.0, -7.0, 30.0};

/// A base station above a small plate of ground, and a terminal. Both antennas are isotropic and vertical.
Experiment free_space() {
  test::TinyScene tiny;
  const uint32_t ground = tiny.material_as(testing::radio_material("medium_dry_ground"));
  tiny.object("ground", 0, ground).quad({-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
  return testing::experiment_in(
      "greatx: 1\nname: free\nticks: 1\ntick_rate_hz: 10\nnodes:\n"
      "  - name: bs\n    trajectory: {type: static, position_m: [13, -7, 30]}\n"
      "    sensors: [{name: antenna, type: antenna}]\n"
      "  - name: ue\n    trajectory: {type: static, position_m: [50, 0, 10]}\n"
      "    sensors: [{name: antenna, type: antenna}]\n"
      "channels:\n  - {name: csi, tx: bs/antenna, rx: [ue/antenna], rate_hz: 10, subcarriers: 4, "
      "bandwidth_hz: 20e6, carrier_hz: 3.5e9, max_depth: 0}\n",
      tiny.build());
}

double map_figure(const SettingResult& result, const std::string& figure) {
  for (const SensorError& error : result.errors)
    if (error.figure.name == figure) return error.figure.value;
  ADD_FAILURE() << "no " << figure;
  return std::numeric_limits<double>::quiet_NaN();
}

/// The middle of the cell of `cell_m` that contains a coordinate, of a grid that begins at `begin_m`.
double middle_of(double at_m, double begin_m, double cell_m) {
  return begin_m + (std::floor((at_m - begin_m) / cell_m) + 0.5) * cell_m;
}

/// |20 log10(d_coarse / d_fine)| at the middles of the fine cells, ascending. By Friis' formula the path gain
/// is (lambda / (4 pi d))^2, and isotropic vertical antennas are aligned everywhere.
std::vector<double> friis_errors_db(const dvec2& min, const dvec2& max, double z_m, double fine_m,
                                    double coarse_m) {
  std::vector<double> errors;
  for (double y = min.y + 0.5 * fine_m; y < max.y; y += fine_m)
    for (double x = min.x + 0.5 * fine_m; x < max.x; x += fine_m) {
      const dvec3 fine(x, y, z_m), coarse(middle_of(x, min.x, coarse_m), middle_of(y, min.y, coarse_m), z_m);
      errors.push_back(
          std::abs(20.0 * std::log10(glm::distance(station, coarse) / glm::distance(station, fine))));
    }
  std::ranges::sort(errors);
  return errors;
}

TEST(MapStudy, FreeSpaceHasTheErrorsOfFriis) {
  MapStudy study;
  study.request.min_m = dvec2(-40, -40);
  study.request.max_m = dvec2(56, 24);
  study.request.height.plane_z_m = 5.0;
  study.request.beyond_scene = true;
  study.cells_m = {16, 8, 4, 2};
  study.turns = 2;
  const std::vector<SettingResult> results =
      measure_maps(test::device(), free_space(), study, [] { return true; });
  ASSERT_EQ(results.size(), 4u);
  double before_db = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < results.size(); ++i) {
    const std::vector<double> expected =
        friis_errors_db(*study.request.min_m, *study.request.max_m, 5.0, 2.0, study.cells_m[i]);
    ASSERT_EQ(expected.size(), 48u * 32u);
    const auto at = [&](double share) {
      return expected[static_cast<size_t>(share * double(expected.size() - 1) + 0.5)];
    };
    EXPECT_NEAR(map_figure(results[i], "path_gain"), at(0.5), 1e-5) << study.cells_m[i];
    EXPECT_NEAR(map_figure(results[i], "path_gain_p95"), at(0.95), 1e-5) << study.cells_m[i];
    EXPECT_EQ(map_figure(results[i], "coverage"), 0.0);
    EXPECT_EQ(results[i].exact, i == 3);
    EXPECT_EQ(results[i].wall_ms.size(), 2u);
    EXPECT_LT(at(0.95), before_db);
    before_db = at(0.95);
  }
  EXPECT_GT(map_figure(results[0], "path_gain_p95"), 0.5);  // 16 m are coarse at 25 m beneath a station
  EXPECT_EQ(map_figure(results[3], "path_gain_p95"), 0.0);
}

TEST(MapStudy, StopsWhenItIsTold) {
  MapStudy study;
  study.request.min_m = dvec2(0, 0);
  study.request.max_m = dvec2(16, 16);
  study.request.height.plane_z_m = 5.0;
  study.request.beyond_scene = true;
  study.cells_m = {8, 4};
  int calls = 0;
  EXPECT_TRUE(measure_maps(test::device(), free_space(), study, [&] { return ++calls < 3; }).empty());
  EXPECT_EQ(calls, 3);
}

TEST(MapStudy, AllGridsOfAPlanCoverTheSameArea) {
  // The plate is 10 m wide: `greatx map` has cells of 0.1 m there.
  const Experiment experiment = free_space();
  for (const bool quick : {false, true}) {
    const MapStudy study = plan_map_study(experiment, quick);
    ASSERT_EQ(study.skipped, "");
    EXPECT_EQ(study.cells_m.size(), quick ? 4u : 5u);
    ASSERT_TRUE(study.standard.has_value());
    EXPECT_EQ(study.cells_m[*study.standard], 0.1);
    const dvec2 side = *study.request.max_m - *study.request.min_m;
    EXPECT_LE(side.x, 10.0);
    for (const double cell_m : study.cells_m)
      EXPECT_NEAR(std::remainder(side.x, cell_m), 0.0, 1e-9) << cell_m;
    const Knob knob = map_knob(study);
    EXPECT_EQ(knob.timed, "map");
    EXPECT_EQ(knob.settings.size(), study.cells_m.size());
    EXPECT_EQ(knob.settings[*knob.standard].label, "0.1 m");
    EXPECT_EQ(knob.reference, knob.settings.size() - 1);
  }
}

TEST(MapStudy, AnEmptySceneHasNoArea) {
  Experiment experiment = free_space();
  World world{scene::Scene(), experiment.world->body_of_node};
  experiment.world = std::make_shared<const World>(std::move(world));
  EXPECT_THAT(map_knob(plan_map_study(experiment, false)).skipped,
              ::testing::HasSubstr("the scene is empty"));
}

/// A map of one transmitter with its south-western corner at (0, 0).
struct Map {
  SensorSpec spec;
  Record record;
  Map(double cell_m, int64_t rows, int64_t columns, const std::vector<double>& gains) {
    spec.name = "csi";
    spec.arrays.push_back({"path_gain", DType::f64, {1, rows, columns}, "1", ""});
    spec.metadata_json = nlohmann::json{{"min_m", {0.0, 0.0}}, {"cell_m", cell_m}}.dump();
    record.arrays.push_back(Array::of<double>({1, rows, columns}, gains));
  }
};

TEST(MapError, ComparesAtTheMiddlesOfTheFineCells) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  // Rows go from south to north. The coarse cells are south-west, south-east, north-west, north-east.
  const Map fine(1.0, 4, 4,
                 {1e-8, 1e-8, 1e-6, 1e-6,  //
                  1e-8, 1e-8, 1e-6, 1e-7,  //
                  0.0, 1e-9, none, none,   //
                  1e-9, 1e-9, none, 1e-9});
  const Map coarse(2.0, 2, 2, {1e-8, 1e-6, 1e-9, none});
  const auto sum = make_error_sum("map");
  sum->add(fine.spec, fine.record, coarse.spec, coarse.record);
  const std::vector<ErrorFigure> figures = sum->figures();
  ASSERT_EQ(figures.size(), 3u);
  EXPECT_EQ(figures[0].name, "path_gain");
  EXPECT_NEAR(figures[0].value, 0.0, 1e-9);  // of 11 places with a path in both, one is 10 dB off
  EXPECT_NEAR(figures[1].value, 10.0, 1e-5);
  // One coarse path where there is none, one fine path in a coarse cell without a value, of 16.
  EXPECT_NEAR(figures[2].value, 100.0 * 2.0 / 16.0, 1e-12);
}

}  // namespace
}  // namespace greatx::sim
