// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a channel senses, from above.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "draw/canvas/plot.h"
#include "draw/sheet/panels.h"
#include "io/dataset/dataset_reader.h"
#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A channel that senses, with one cell of its map above the rest, a detection there and a target beside it.
DatasetInfo sensed_info() {
  DatasetInfo info;
  info.ticks_per_sequence = 1;
  SensorSpec spec{"link", "csi", "1000",
                  {},     {},    R"({"sensing": {"range_bin_m": 2.0, "velocity_min_m_s": -4.0,
      "velocity_bin_m_s": 1.0, "symbols": 8, "azimuth_min_rad": -0.8, "azimuth_max_rad": 0.8},
      "targets": [{"node": "drone"}]})"};
  const auto add = [&](const char* name, DType type, std::vector<int64_t> shape) {
    spec.outputs.push_back({std::string("sensing/") + name,
                            shape[0] < 0 ? FileFormat::npy_ragged : FileFormat::npy_stack,
                            {name}});
    spec.arrays.push_back({name, type, std::move(shape), "1", ""});
  };
  add("range_azimuth", DType::f32, {1, 1, 16, 9});
  add("detection_rx", DType::i32, {-1}), add("detection_tx", DType::i32, {-1});
  for (const char* name : {"detection_range", "detection_velocity", "detection_azimuth"})
    add(name, DType::f32, {-1});
  add("detection_instance", DType::u32, {-1});
  for (const char* name : {"target_range", "target_velocity", "target_azimuth", "target_power"})
    add(name, DType::f64, {1, 1, 1});
  info.sensors = {spec};
  return info;
}

TEST(ContactSheet, SensingFromAboveShowsTheMapAndItsMarks) {
  const test::TemporaryFolder folder;
  DatasetWriter writer(folder.path(), sensed_info());
  writer.begin_sequence(0);
  Array map(DType::f32, {1, 1, 16, 9});
  for (float& watt : map.as<float>()) watt = 1e-13f;
  map.as<float>()[5 * 9 + 6] = 1e-9f;  // 10 m, 0.4 rad to the left
  const auto one = [](auto value) { return Array::of<decltype(value)>({1}, std::span(&value, 1)); };
  const auto target = [](double value) { return Array::of<double>({1, 1, 1}, std::span(&value, 1)); };
  Packet packet{0, 0, {}};
  packet.records.push_back({0,
                            0,
                            0,
                            0,
                            {map, one(int32_t{0}), one(int32_t{0}), one(10.0f), one(2.0f), one(0.4f),
                             one(uint32_t{3}), target(20.0), target(5.0), target(-0.3), target(-80.0)}});
  writer.write(std::move(packet));
  writer.end_sequence();
  writer.finish();
  const DatasetReader reader(folder.path());
  Panels panels;
  add_panels({reader, 0, 0, {reader.records_of(0, 0)[0]}}, panels);
  ASSERT_EQ(panels.frames.size(), 1u);
  EXPECT_EQ(panels.frames[0]->title(), "link from above");
  // All 16 cells of 2 m are shown, in a picture of 400 x 300 from its foot up.
  const Rect picture{0, 0, 400, 300};
  const double pixels = 200.0 / 32.0;
  const auto text_at = [&](double range, double azimuth) {
    return panels.frames[0]->value_at(
        picture, 0, static_cast<int>(std::lround(200 - range * pixels * std::sin(azimuth))),
        static_cast<int>(std::lround(290 - range * pixels * std::cos(azimuth))), {});
  };
  EXPECT_THAT(text_at(10.0, 0.4), testing::AllOf(HasSubstr(": -60.0 dBm"),
                                                 HasSubstr("detection: 10.00 m, 2.00 m/s, 22.9 deg, 3")));
  // The velocity of 5 m/s is beyond the span of 8 m/s.
  EXPECT_THAT(text_at(20.0, -0.3),
              testing::AllOf(HasSubstr(": -100.0 dBm"), HasSubstr("drone: 20.00 m, -3.00 m/s, -17.2 deg")));
  EXPECT_THAT(text_at(10.0, 1.2), HasSubstr("outside of the map"));
  Canvas canvas(400, 340, theme::page);
  panels.frames[0]->draw(canvas, picture, {0, 310, 400, 20}, 0);
  const Array image = canvas.image();
  const auto color_at = [&](double range, double azimuth) {
    const auto x = std::lround(200 - range * pixels * std::sin(azimuth)),
               y = std::lround(290 - range * pixels * std::cos(azimuth));
    const uint8_t* const rgb = image.as<uint8_t>().data() + (y * 400 + x) * 3;
    return std::vector<int>{rgb[0], rgb[1], rgb[2]};
  };
  const Color top = viridis(1.0), floor = viridis(1.0 / 41.0);
  // Between the ring of 10 m and the mark.
  EXPECT_THAT(color_at(9.7, 0.4), ElementsAre(top.r, top.g, top.b));
  EXPECT_THAT(color_at(15.5, 0.6), ElementsAre(floor.r, floor.g, floor.b));
}

/// Metadata from elsewhere are not believed.
TEST(ContactSheet, SensingWithoutAnAngleIsAnError) {
  const test::TemporaryFolder folder;
  DatasetInfo info = sensed_info();
  std::string& metadata = info.sensors[0].metadata_json;
  metadata.replace(metadata.find("_rad\": 0.8"), 10, "_rad\": -1.8");
  DatasetWriter writer(folder.path(), info);
  writer.begin_sequence(0);
  writer.end_sequence();
  writer.finish();
  const DatasetReader reader(folder.path());
  Panels panels;
  try {
    add_panels({reader, 0, 0, {}}, panels);
    FAIL() << "accepted";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("azimuth_max_rad: expected more than azimuth_min_rad, -0.8"));
  }
}

}  // namespace
}  // namespace greatx::io
