// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the files of fits: measured arrays and tables, the journal, and materials that are written and read
// again.
#include <cmath>
#include <complex>
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "apps/fit/journal.h"
#include "apps/fit/materials_file.h"
#include "apps/fit/measurement_file.h"
#include "io/files/file.h"
#include "io/formats/npy.h"
#include "scene/material/radio_fields.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps {
namespace {

using sim::FitQuantity;
using sim::FitSet;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Complex = std::complex<float>;

class FitFiles : public testing::Test {
 protected:
  void npy(const std::string& name, const Array& array) {
    io::write_file_atomically(folder_.path() / name, io::encode_npy(array));
  }
  template <typename T>
  void npy(const std::string& name, std::vector<int64_t> shape, const std::vector<T>& values) {
    npy(name, Array::of<T>(std::move(shape), values));
  }
  /// Reads the measurements that `yaml` names into a set of `quantity` with `width` values.
  FitSet read(const std::string& yaml, FitQuantity quantity, uint32_t width, bool is_complex = false) {
    FitSet set;
    set.quantity = quantity;
    set.width = width;
    set.complex_values = is_complex;
    const Field root = Field::parse_yaml(yaml, {"fit.yaml", folder_.path(), {}});
    read_measurements(FieldMap(root, {"file", "columns", "positions", "values"}), set, data_);
    return set;
  }
  auto reading(const std::string& yaml, FitQuantity quantity, uint32_t width, bool is_complex = false) {
    return [this, yaml, quantity, width, is_complex] { read(yaml, quantity, width, is_complex); };
  }
  std::vector<FitData> data_;
  const test::TemporaryFolder folder_;
};

TEST_F(FitFiles, ArraysHoldWhatTablesHold) {
  npy<double>("at.npy", {2, 3}, {1, 2, 3, -4, 5.5, 6});
  npy<float>("power.npy", {2}, {-60.5f, NAN});
  std::ofstream(folder_.path() / "walk.csv")
      << "\xEF\xBB\xBFPower_dB,Y,x_m,z\r\n-60.5,2,1,3\r\n,5.5,-4,6\r\n";
  const FitSet arrays = read("{positions: at.npy, values: power.npy}", FitQuantity::power_db, 1),
               table = read("{file: walk.csv}", FitQuantity::power_db, 1);
  for (const FitSet& set : {arrays, table}) {
    ASSERT_EQ(set.points.size(), 2u);
    EXPECT_EQ(set.points[0], dvec3(1, 2, 3));
    EXPECT_EQ(set.points[1], dvec3(-4, 5.5, 6));
    EXPECT_EQ(set.values[0], -60.5);
    EXPECT_TRUE(std::isnan(set.values[1]));
    EXPECT_TRUE(set.orientations.empty());
  }
  ASSERT_EQ(data_.size(), 3u);
  EXPECT_EQ(data_[2].name, "walk.csv");
  EXPECT_EQ(data_[2].sha256.size(), 64u);
}

TEST_F(FitFiles, TablesHoldOrientations) {
  std::ofstream(folder_.path() / "walk.csv") << "x,y,z,rms,yaw_deg,heading\n0,0,1,12.5,90,0\n";
  const FitSet set = read("{file: walk.csv, columns: {value: RMS}}", FitQuantity::delay_spread_ns, 1);
  ASSERT_EQ(set.orientations.size(), 1u);
  const dvec3 ahead = set.orientations[0] * dvec3(1, 0, 0);
  EXPECT_NEAR(ahead.y, 1.0, 1e-15);
  EXPECT_EQ(set.values[0], 12.5);
}

TEST_F(FitFiles, ResponsesAreLinearOrInDecibels) {
  npy<float>("at.npy", {1, 3}, {0, 0, 1});
  npy<Complex>("linear.npy", {1, 2}, {Complex(0.0f, 0.1f), Complex(0.0f, 0.0f)});
  npy<double>("levels.npy", {1, 2}, {-20.0, -INFINITY});
  for (const char* values : {"linear.npy", "levels.npy"}) {
    const FitSet set = read(fmt::format("{{positions: at.npy, values: {}}}", values), FitQuantity::cfr, 2);
    EXPECT_NEAR(set.values[0], -20.0, 1e-6);
    EXPECT_EQ(set.values[1], -1000.0);  // no power
    EXPECT_TRUE(set.responses.empty());
  }
  const FitSet response = read("{positions: at.npy, values: linear.npy}", FitQuantity::cfr, 2, true);
  EXPECT_EQ(response.responses[0], std::complex<double>(0.0, 0.1f));
  // Taps become a response: a tap at delay 0 alone is flat.
  npy<Complex>("taps.npy", {1, 4}, {Complex(0.5f, 0.0f), 0.0f, 0.0f, 0.0f});
  const FitSet taps = read("{positions: at.npy, values: taps.npy}", FitQuantity::cir, 4, true);
  for (const std::complex<double>& value : taps.responses) EXPECT_NEAR(std::abs(value - 0.5), 0.0, 1e-15);
}

TEST_F(FitFiles, ArraysOfAnotherShapeAreRefused) {
  npy<float>("at.npy", {2, 3}, {0, 0, 1, 0, 0, 2});
  npy<float>("flat.npy", {6}, {0, 0, 1, 0, 0, 2});
  npy<int32_t>("whole.npy", {2}, {1, 2});
  npy<float>("one.npy", {1}, {1});
  npy<float>("wide.npy", {2, 3}, {1, 2, 3, 4, 5, 6});
  npy<float>("far.npy", {1, 3}, {0, 0, NAN});
  const auto expect = [&](const char* yaml, FitQuantity quantity, uint32_t width, const char* message,
                          bool is_complex = false) {
    EXPECT_THAT(reading(yaml, quantity, width, is_complex), ThrowsMessage<UserError>(HasSubstr(message)));
  };
  expect("{positions: flat.npy, values: one.npy}", FitQuantity::power_db, 1,
         "expected positions, float64 or float32 [positions, 3], found <f4 [6]");
  expect("{positions: far.npy, values: one.npy}", FitQuantity::power_db, 1,
         "far.npy: position 0: expected a number from -1e8 to 1e8, found nan");
  expect("{positions: at.npy, values: one.npy}", FitQuantity::power_db, 1,
         "expected float64 or float32 [2], found <f4 [1]");
  expect("{positions: at.npy, values: whole.npy}", FitQuantity::power_db, 1,
         "expected float64 or float32 [2], found <i4 [2]");
  expect("{positions: at.npy, values: wide.npy}", FitQuantity::cfr, 4,
         "expected float64 or float32 (dB) or complex64 [2, 4], found <f4 [2, 3]");
  expect("{positions: at.npy, values: wide.npy}", FitQuantity::cfr, 3,
         "expected complex64 [2, 3], found <f4 [2, 3]", true);
  expect("{positions: at.npy}", FitQuantity::power_db, 1,
         "expected values (.npy) beside the positions, found nothing");
  expect("{}", FitQuantity::power_db, 1,
         "expected file (CSV), or positions and values (.npy), found nothing");
  std::ofstream(folder_.path() / "walk.csv") << "x,y,z,delay_spread_ns\n0,0,1,-3\n";
  expect("{file: walk.csv}", FitQuantity::delay_spread_ns, 1,
         "walk.csv:2:1: value: expected a delay spread of 0 ns");
  std::ofstream(folder_.path() / "walk.csv") << "x,y,z,x,power_db\n0,0,1,0,-3\n";
  expect("{file: walk.csv}", FitQuantity::power_db, 1, "x: expected one column, found a second");
  std::ofstream(folder_.path() / "walk.csv") << "x,y,z,power_db,roll_deg\n0,0,1,-3,0\n";
  expect("{file: walk.csv}", FitQuantity::power_db, 1,
         "yaw: expected a column 'yaw_deg' beside the other angles");
}

/// Whatever a material is, the line that is written reads as the same material, over any other source.
TEST_F(FitFiles, MaterialsReadAsTheyWereWritten) {
  scene::RadioMaterial wall;
  wall.layers = {
      {*scene::itu_medium("glass"), 0.006},
      {{"explicit permittivity", {{1.5, 0.0, 1e-7, 0.0, 0.0, INFINITY}}, false}, 0.0123456789012345},
      {*scene::itu_medium("brick"), 0.3}};
  wall.layers[2].medium.extrapolate = true;
  wall.windows = scene::RadioWindows{0.25, {{*scene::itu_medium("glass"), 0.004}}};
  wall.scattering_coefficient = 1.0 / 3.0;
  wall.pattern = scene::ScatteringPattern::backscattering;
  wall.pattern_exponent = 7.0, wall.backscatter_exponent = 2.0, wall.backscatter_share = 0.3;
  wall.cross_polarization = 0.1, wall.roughness_m = 0.0021, wall.deviation_m = 0.0033;
  wall.clutter = scene::SurfaceClutter{scene::ClutterForm::constant_gamma, -17.0, 0.0, 3.0, 0.0, -8.0};
  scene::RadioMaterial half_space;
  half_space.layers = {{{"fitted", {{5.24, 0.0, 0.0462, 0.7822, 1e9, 1e11}}, false}, 0.0}};
  half_space.clutter = scene::clutter_called("concrete");
  for (const scene::RadioMaterial& expected : {wall, half_space}) {
    scene::Material material;
    material.name = "facade";
    material.radio = expected;
    material.reflectance_905nm = 0.4f;
    scene::RadioSources below;
    below.radio = expected.windows ? half_space : wall;
    if (!expected.windows) below.radio->windows.reset();
    const Field field = Field::parse_yaml(radio_fields_line(material), {"line", folder_.path(), {}});
    const scene::RadioSources read = scene::read_radio_fields(field, below);
    ASSERT_TRUE(read.radio);
    scene::RadioMaterial got = *read.radio;
    for (auto* layers : {&got.layers})
      for (size_t i = 0; i < layers->size(); ++i)
        (*layers)[i].medium.source = expected.layers[i].medium.source;
    if (got.windows) got.windows->layers[0].medium.source = expected.windows->layers[0].medium.source;
    EXPECT_TRUE(got == expected);
    EXPECT_EQ(read.reflectance_905nm, 0.4f);
  }
}

TEST_F(FitFiles, TheJournalKeepsEveryBit) {
  const nlohmann::ordered_json request{{"a", 1}, {"b", {{"c", "x"}}}};
  sim::FitState state;
  state.stage = sim::FitStage::search;
  state.run = 3, state.round = 2, state.iteration = 17;
  state.lambda = 1.0 / 3.0, state.cost = 1e-17 / 7.0, state.best_cost = -2.0 / 3.0;
  state.converged = true;
  state.coordinates = {0.1, -1e300 / 3.0, 5e-324}, state.sigmas = {M_PI}, state.before = {1.0 / 7.0},
  state.best = {};
  const std::filesystem::path folder = folder_.path() / "fit";
  {
    FitJournal journal(folder, request, false);
    EXPECT_FALSE(journal.state());
    journal.write(state);
  }
  FitJournal journal(folder, request, true);
  ASSERT_TRUE(journal.state());
  const sim::FitState& read = *journal.state();
  EXPECT_EQ(read.stage, state.stage);
  EXPECT_EQ(read.run, state.run);
  EXPECT_EQ(read.round, state.round);
  EXPECT_EQ(read.iteration, state.iteration);
  EXPECT_EQ(read.lambda, state.lambda);
  EXPECT_EQ(read.cost, state.cost);
  EXPECT_EQ(read.best_cost, state.best_cost);
  EXPECT_EQ(read.coordinates, state.coordinates);
  EXPECT_EQ(read.sigmas, state.sigmas);
  EXPECT_EQ(read.before, state.before);
  EXPECT_EQ(read.best, state.best);
  EXPECT_TRUE(read.converged);
  EXPECT_FALSE(read.done);

  const auto opening = [&](const nlohmann::ordered_json& asked, bool resume) {
    return [&folder, asked, resume] { FitJournal(folder, asked, resume); };
  };
  EXPECT_THAT(opening(request, false), ThrowsMessage<UserError>(HasSubstr("holds an unfinished fit")));
  EXPECT_THAT(opening({{"a", 1}, {"b", {{"c", "y"}}}}, true),
              ThrowsMessage<UserError>(HasSubstr("/b/c: asked for \"y\", the folder's has \"x\"")));
  std::ofstream(folder / "fit.part") << "{\"request\": 1";
  EXPECT_THAT(opening(request, true), ThrowsMessage<UserError>(HasSubstr("fit.part")));
  const std::filesystem::path other = folder_.path() / "other";
  std::filesystem::create_directory(other);
  std::ofstream(other / "notes.txt") << "mine";
  EXPECT_THAT([&] { FitJournal(other, request, true); },
              ThrowsMessage<UserError>(
                  HasSubstr("expected a new or empty folder, or that of a fit, found 'notes.txt'")));
}

}  // namespace
}  // namespace greatx::apps
