// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/contact_sheet.h"

#include <algorithm>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "draw/sheet/panels.h"
#include "io/dataset/summary.h"
#include "io/dataset/verify.h"
#include "io/formats/png.h"
#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ContactSheet, ShowsASampleRun) {
  const test::TemporaryFolder folder;
  {
    DatasetWriter writer(folder.path() / "set", sample_info());
    ASSERT_TRUE(write_sample_run(writer, sample_info()));
  }
  const DatasetReader reader(folder.path() / "set");
  write_contact_sheet(reader, folder.path() / "set" / "contact_sheet.png", 1);
  const Array sheet = decode_png(read_file(folder.path() / "set" / "contact_sheet.png"), "sheet");
  EXPECT_EQ(sheet.bytes, contact_sheet(reader, 1).bytes);
  EXPECT_GT(sheet.shape[0], 800);
  EXPECT_GT(sheet.shape[1], 1200);
  EXPECT_TRUE(verify(folder.path() / "set").empty()) << "the sheet may lie beside the data";
  EXPECT_THROW(contact_sheet(reader, 2), UserError);
}

TEST(ContactSheet, WorksForAnySensorAlone) {
  for (size_t keep = 0; keep < 4; ++keep) {
    const test::TemporaryFolder folder;
    DatasetInfo info = sample_info();
    info.sensors = {info.sensors[keep]};
    {
      DatasetWriter writer(folder.path(), info);
      writer.begin_sequence(0);
      for (int64_t tick = 0; tick < info.ticks_per_sequence; ++tick) {
        Packet packet = sample_packet(sample_info(), 0, tick);
        std::erase_if(packet.records, [&](const Record& record) { return record.sensor != keep; });
        for (Record& record : packet.records) record.sensor = 0;
        writer.write(std::move(packet));
      }
      writer.flush();
    }
    EXPECT_GT(contact_sheet(DatasetReader(folder.path())).shape[1], 1000)
        << "an unfinished set, " << info.sensors[0].name;
  }
}

/// Writes a data set of cameras with long names and pictures from 1 x 1 to 1 x 300 pixels, each with a
/// segmentation of many ids, beside poses.
void write_cameras(const std::filesystem::path& folder, size_t count) {
  DatasetInfo info;
  info.tick_rate = "10";
  info.ticks_per_sequence = 5;
  const int64_t sizes[][2] = {{1, 1}, {1, 300}, {300, 1}, {48, 64}};
  nlohmann::json run{{"scenario", std::string(90, 'x')}, {"instances", nlohmann::json::array()}};
  for (int i = 0; i < 40; ++i)
    run["instances"].push_back(
        {{"name", "a_thing_with_quite_a_long_name_" + std::to_string(i)}, {"class", "building"}});
  run["instances"][7]["node"] = "a_node_that_moves";
  info.run_json = run.dump();
  for (size_t c = 0; c < count; ++c) {
    const auto& [height, width] = sizes[c % 4];
    info.sensors.push_back({fmt::format("an_unmanned_aerial_vehicle_{}/camera_front_left_wide", c),
                            "camera",
                            "10",
                            {{"rgb", DType::u8, {height, width, 3}, "1", ""},
                             {"depth", DType::f32, {height, width}, "m", ""},
                             {"instance", DType::u16, {height, width}, "1", ""}},
                            {{"rgb", FileFormat::png, {"rgb"}},
                             {"depth", FileFormat::exr, {"depth"}},
                             {"instance", FileFormat::png, {"instance"}}},
                            "{}"});
  }
  info.sensors.push_back(
      {"poses",
       "pose",
       "10",
       {{"position", DType::f64, {12, 3}, "m", ""}, {"velocity", DType::f64, {12, 3}, "m/s", ""}},
       {{"position", FileFormat::npy_stack, {"position"}}, {"velocity", FileFormat::npy_stack, {"velocity"}}},
       R"({"nodes": ["one", "two", "a_node_that_moves", "four", "five", "six", "seven"]})"});
  DatasetWriter writer(folder, info);
  writer.begin_sequence(0);
  for (int64_t tick = 0; tick < 5; ++tick) {
    Packet packet{tick, tick * 100'000'000, {}};
    for (uint32_t c = 0; c < count; ++c) {
      const auto& [height, width] = sizes[c % 4];
      Array depth(DType::f32, {height, width}), ids(DType::u16, {height, width});
      for (size_t i = 0; i < ids.as<uint16_t>().size(); ++i) {
        depth.as<float>()[i] = 1.0f + static_cast<float>(i);
        ids.as<uint16_t>()[i] = static_cast<uint16_t>(i % 41);
      }
      packet.records.push_back(
          {c, tick, packet.time_ns, tick, {Array(DType::u8, {height, width, 3}), depth, ids}});
    }
    Array position(DType::f64, {12, 3}), velocity(DType::f64, {12, 3});
    for (size_t i = 0; i < 36; ++i)
      position.as<double>()[i] = 5e6 + static_cast<double>(i) * 3.7 + static_cast<double>(tick);
    packet.records.push_back(
        {static_cast<uint32_t>(count), tick, packet.time_ns, tick, {position, velocity}});
    writer.write(std::move(packet));
  }
  writer.end_sequence();
  writer.finish();
}

/// Writes a data set of all sensors that navigate: the GNSS receiver has a fix at every second record only.
void write_navigation(const std::filesystem::path& folder, const std::vector<int64_t>& position_shape = {3}) {
  DatasetInfo info;
  info.tick_rate = "10";
  info.ticks_per_sequence = 6;
  const auto sensor = [&](const char* kind, std::vector<ArraySpec> arrays) {
    SensorSpec spec{fmt::format("car/{}", kind), kind, "10",
                    std::move(arrays),           {},   R"({"non_finite": ["position"]})"};
    for (const ArraySpec& array : spec.arrays)
      spec.outputs.push_back(
          {array.name, array.shape[0] < 0 ? FileFormat::npy_ragged : FileFormat::npy_stack, {array.name}});
    info.sensors.push_back(std::move(spec));
  };
  sensor("imu", {{"time", DType::i64, {-1}, "ns", ""},
                 {"specific_force", DType::f64, {-1, 3}, "m/s^2", ""},
                 {"angular_rate", DType::f64, {-1, 3}, "rad/s", ""}});
  sensor("gnss", {{"position", DType::f64, position_shape, "m", ""},
                  {"position_true", DType::f64, {3}, "m", ""},
                  {"satellite_state", DType::u8, {24}, "1", ""}});
  sensor("barometer", {{"height", DType::f64, {1}, "m", ""}, {"height_true", DType::f64, {1}, "m", ""}});
  sensor("magnetometer", {{"field", DType::f64, {3}, "T", ""}});
  DatasetWriter writer(folder, info);
  writer.begin_sequence(0);
  for (int64_t tick = 0; tick < 6; ++tick) {
    const int64_t samples = tick == 0 ? 1 : 5;
    Array times(DType::i64, {samples}), force(DType::f64, {samples, 3}), rate(DType::f64, {samples, 3});
    for (int64_t i = 0; i < samples; ++i) {
      times.as<int64_t>()[static_cast<size_t>(i)] = 20'000'000 * (5 * tick - samples + 1 + i);
      force.as<double>()[static_cast<size_t>(3 * i + 2)] = 9.8 + 0.1 * static_cast<double>(i);
    }
    Array measured(DType::f64, position_shape), truth(DType::f64, {3}), states(DType::u8, {24});
    for (double& value : measured.as<double>())
      value = tick % 2 == 0 ? std::numeric_limits<double>::quiet_NaN() : 3.0 + static_cast<double>(tick);
    for (size_t i = 0; i < 24; ++i) states.as<uint8_t>()[i] = static_cast<uint8_t>(i % 4);
    Array height(DType::f64, {1}), field(DType::f64, {3});
    field.as<double>()[1] = 2e-5;
    Packet packet{tick, tick * 100'000'000, {}};
    packet.records.push_back({0, tick, packet.time_ns, tick, {times, force, rate}});
    packet.records.push_back({1, tick, packet.time_ns, tick, {measured, truth, states}});
    packet.records.push_back({2, tick, packet.time_ns, tick, {height, height}});
    packet.records.push_back({3, tick, packet.time_ns, tick, {field}});
    writer.write(std::move(packet));
  }
  writer.end_sequence();
  writer.finish();
}

TEST(ContactSheet, ShowsSensorsThatNavigate) {
  const test::TemporaryFolder folder;
  write_navigation(folder.path() / "set");
  const Canvas sheet = drawn_contact_sheet(DatasetReader(folder.path() / "set"));
  std::set<std::string> texts;
  for (const DrawnText& text : sheet.texts()) {
    EXPECT_TRUE(text.whole) << text.text;
    texts.insert(text.text);
  }
  for (const char* title :
       {"car/imu: specific force", "car/imu: angular rate", "car/gnss: satellites",
        "car/gnss: error of position", "car/barometer: height", "car/magnetometer: magnetic field"})
    EXPECT_TRUE(texts.contains(title)) << title;
  // A data set may give any array this name.
  write_navigation(folder.path() / "wrong", {4});
  EXPECT_THROW(contact_sheet(DatasetReader(folder.path() / "wrong"), 0), UserError);
}

/// Whatever the number of sensors, the length of names and the shape of pictures: no text covers another one
/// or is cut off.
TEST(ContactSheet, TextsNeitherOverlapNorAreCut) {
  for (const size_t cameras : {1, 3, 6, 12}) {
    const test::TemporaryFolder folder;
    write_cameras(folder.path() / "set", cameras);
    const Canvas sheet = drawn_contact_sheet(DatasetReader(folder.path() / "set"));
    const std::vector<DrawnText>& texts = sheet.texts();
    EXPECT_GT(texts.size(), 20 * cameras);
    for (size_t i = 0; i < texts.size(); ++i) {
      EXPECT_TRUE(texts[i].whole) << texts[i].text;
      for (size_t j = i + 1; j < texts.size(); ++j)
        ASSERT_FALSE(texts[i].rect.overlaps(texts[j].rect))
            << cameras << " cameras: '" << texts[i].text << "' and '" << texts[j].text << "'";
    }
  }
}

/// The key names what is seen, in the colours of the picture; what moves comes first.
TEST(ContactSheet, TheKeyOfIdsNamesWhatIsSeen) {
  const test::TemporaryFolder folder;
  write_cameras(folder.path() / "set", 4);
  const DatasetReader reader(folder.path() / "set");
  const auto scene = std::make_shared<const SceneFacts>(scene_facts(reader));
  for (const auto& [camera, seen] : {std::pair(size_t{0}, 0), std::pair(size_t{3}, 40)}) {
    Panels panels;
    add_panels({reader, 0, camera, reader.records_of(0, camera), {}, scene}, panels);
    ASSERT_EQ(panels.frames.size(), 3u);
    const std::vector<KeyEntry> key = panels.frames[2]->key(light_theme());
    if (seen == 0) {
      EXPECT_TRUE(key.empty()) << "the only pixel has id 0";
      continue;
    }
    ASSERT_EQ(key.size(), most_key_entries);
    EXPECT_EQ(key[0].text, "8 a_thing_with_quite_a_long_name_7 (building)");
    EXPECT_EQ(key.back().text, "and 32 more");
    const Color color = color_of_id(light_theme(), 8);
    EXPECT_EQ(std::tuple(key[0].color.r, key[0].color.g, key[0].color.b),
              std::tuple(color.r, color.g, color.b));
    // A pixel of the picture with this id has the colour.
    Canvas canvas(64, 80, light_theme());
    panels.frames[2]->draw(canvas, {0, 0, 64, 48}, {0, 50, 64, 20}, 0);
    const Array image = canvas.image();
    EXPECT_EQ(image.as<uint8_t>()[3 * 8 + 2], color.b);
  }
}

TEST(ContactSheet, IdsAreThoseWished) {
  const test::TemporaryFolder folder;
  DatasetInfo info;
  info.ticks_per_sequence = 1;
  info.sensors = {{"uav/cam", "camera", "1000", {}, {}, "{}"}};
  for (const char* name : {"instance", "semantic", "material"}) {
    info.sensors[0].arrays.push_back({name, DType::u8, {2, 2}, "1", ""});
    info.sensors[0].outputs.push_back({name, FileFormat::png, {name}});
  }
  DatasetWriter writer(folder.path(), info);
  writer.begin_sequence(0);
  Packet packet{0, 0, {}};
  packet.records.push_back(
      {0, 0, 0, 0, {Array(DType::u8, {2, 2}), Array(DType::u8, {2, 2}), Array(DType::u8, {2, 2})}});
  writer.write(std::move(packet));
  writer.end_sequence();
  writer.finish();
  const DatasetReader reader(folder.path());
  for (const auto& [wish, title] : {std::pair("", "uav/cam instances"),
                                    {"semantic", "uav/cam semantic"},
                                    {"material", "uav/cam material"}}) {
    Panels panels;
    add_panels({reader, 0, 0, reader.records_of(0, 0)}, panels, {.ids = wish, .links = {}});
    ASSERT_EQ(panels.frames.size(), 1u);
    EXPECT_EQ(panels.frames[0]->title(), title);
  }
}

/// Outlines of a run, and boxes of buildings where a run has none.
TEST(SceneOutlines, AreThoseOfTheRunOrItsBoxes) {
  const test::TemporaryFolder folder;
  const auto outlines_with = [&](const std::string& instances) {
    std::filesystem::remove_all(folder.path() / "set");
    DatasetInfo info = sample_info();
    info.run_json = fmt::format(R"({{"instances": {}}})", instances);
    DatasetWriter writer(folder.path() / "set", info);
    EXPECT_TRUE(write_sample_run(writer, info));
    return scene_outlines(DatasetReader(folder.path() / "set"));
  };
  const char* const boxes = R"({"name": "b", "class": "building", "box_m": [[10, 10, 0], [20, 30, 8]]},
    {"name": "c", "class": "vegetation", "box_m": [[10, 10, 0], [20, 30, 8]]},
    {"name": "d", "class": "building", "node": "uav", "box_m": [[0, 0, 0], [1, 1, 1]]})";
  const std::vector<OutlineLine> lines =
      outlines_with(fmt::format(R"([{{"name": "a", "class": "building", "outline_height_m": 4.5,
                        "outline_m": [[0, 1, 2, 1], [2, 1, 2, 3]]}}, {}])",
                                boxes));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1].to, dvec3(2, 3, 4.5));
  const std::vector<OutlineLine> sides = outlines_with(fmt::format("[{}]", boxes));
  ASSERT_EQ(sides.size(), 4u);
  EXPECT_EQ(sides[0].from, dvec3(10, 10, 4));
  EXPECT_EQ(sides[3].to, dvec3(10, 10, 4)) << "the box is closed";
  for (const auto& [instances, place] :
       {std::pair(R"([{"name": "a", "outline_m": [[0, 1, 2, 1]]}])", "outline_height_m"),
        {R"([{"name": "a", "outline_height_m": 1, "outline_m": [[0, 1, 2]]}])", "instances[0].outline_m[0]"}})
    try {
      outlines_with(instances);
      ADD_FAILURE() << instances;
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), HasSubstr(place));
    }
}

/// A path of known delay and amplitude is a line at this delay in the picture of |h|. Its value is |a| in dB.
TEST(ContactSheet, ImpulseResponsePeaksAtTheDelay) {
  const test::TemporaryFolder folder;
  constexpr double spacing = 240e3, delay = 700e-9, amplitude = 1e-4;
  DatasetInfo info;
  info.ticks_per_sequence = 2;
  info.sensors = {{"link",
                   "csi",
                   "1000",
                   {{"cfr", DType::complex64, {1, 1, 1, 1, 1, 256}, "1", ""}},
                   {{"cfr", FileFormat::npy_stack, {"cfr"}}},
                   R"({"subcarrier_spacing_hz": 240000.0})"}};
  DatasetWriter writer(folder.path(), info);
  writer.begin_sequence(0);
  for (int64_t tick = 0; tick < 2; ++tick) {
    Array cfr(DType::complex64, {1, 1, 1, 1, 1, 256});
    for (int k = 0; k < 256; ++k)
      cfr.as<std::complex<float>>()[k] =
          std::complex<float>(std::polar(amplitude, -2.0 * pi * (k - 128) * spacing * delay));
    Packet packet{tick, tick * 1'000'000, {}};
    packet.records.push_back({0, tick, packet.time_ns, tick, {cfr}});
    writer.write(std::move(packet));
  }
  writer.end_sequence();
  writer.finish();
  const DatasetReader reader(folder.path());
  Panels panels;
  add_panels({reader, 0, 0, {}}, panels);
  ASSERT_EQ(panels.series.size(), 2u);
  Canvas canvas(600, 400, theme::page);
  panels.series[0]->draw(canvas, {0, 0, 600, 400});
  // The axis ends one eighth behind the last cell within 45 dB of the peak. The brightest row is that of the
  // path.
  const Array image = canvas.image();
  int brightest = -1, row = -1;
  const int top = 8 + theme::line_height, height = 400 - 16 - 4 * theme::line_height;
  for (int y = top; y < top + height; ++y) {
    const uint8_t* const pixel = image.as<uint8_t>().data() + (static_cast<size_t>(y) * 600 + 200) * 3;
    if (pixel[0] + pixel[1] > brightest) brightest = pixel[0] + pixel[1], row = y;
  }
  const double fraction = 1.0 - static_cast<double>(row - top) / height;
  // Hann's main lobe is +-2 / (256 spacing) = 32.6 ns wide, and the point at -45 dB lies inside it. 4 * 256
  // cells of 4.07 ns cover 1/spacing.
  const double end = 1.125 * (delay + 30e-9);
  EXPECT_NEAR(fraction * end, delay, 25e-9);
}

TEST(ContactSheet, SeveralSideBySide) {
  const test::TemporaryFolder folder;
  std::vector<DatasetReader> readers;
  for (const char* name : {"a", "b", "c"}) {
    DatasetInfo info = sample_info();
    DatasetWriter writer(folder.path() / name, info);
    ASSERT_TRUE(write_sample_run(writer, info));
    readers.emplace_back(folder.path() / name);
  }
  const Array sheet = comparison_sheet(readers);
  EXPECT_EQ(sheet.shape[1], 2 * 28 + 3 * 400 + 2 * 14);
  // Equal data give equal columns.
  const size_t column = 3 * 414, width = 3 * static_cast<size_t>(sheet.shape[1]);
  for (int64_t y = 0; y < sheet.shape[0]; ++y) {
    const std::byte* const line = sheet.bytes.data() + static_cast<size_t>(y) * width + 3 * 28;
    ASSERT_TRUE(std::equal(line, line + 3 * 400, line + column)) << y;
  }
  EXPECT_THROW(comparison_sheet(readers, 7), UserError);
}

TEST(EventPanels, GreyRedBlueAndBoth) {
  const std::vector<uint16_t> x{0, 1, 2, 2}, y{0, 0, 1, 1};
  const std::vector<uint8_t> p{1, 0, 1, 0};
  const Array picture = event_picture(x, y, p, 3, 2);
  const auto pixel = [&](size_t i) {
    return std::vector<int>(picture.as<uint8_t>().begin() + 3 * i, picture.as<uint8_t>().begin() + 3 * i + 3);
  };
  EXPECT_GT(pixel(0)[0], pixel(0)[2] + 50) << "brighter: red";
  EXPECT_GT(pixel(1)[2], pixel(1)[0] + 50) << "darker: blue";
  EXPECT_THAT(pixel(2), ElementsAre(128, 128, 128)) << "nothing: grey";
  EXPECT_NEAR(pixel(5)[0], pixel(5)[2], 10) << "both: between the two";
  EXPECT_LT(pixel(5)[1], 90);
  EXPECT_THROW(event_picture(x, y, p, 2, 2), UserError);
}

/// The sheet shows normals, flow, boxes, events and differences from the files of a data set alone.
TEST(ContactSheet, ShowsTruthAndEvents) {
  const test::TemporaryFolder folder;
  DatasetInfo info;
  info.tick_rate = "10";
  info.ticks_per_sequence = 3;
  info.sensors = {{"uav/cam",
                   "camera",
                   "10",
                   {{"rgb", DType::u8, {4, 6, 3}, "1", ""},
                    {"normals", DType::f32, {4, 6, 3}, "1", ""},
                    {"flow", DType::f32, {4, 6, 2}, "pixel", ""},
                    {"box_instance", DType::u32, {-1}, "1", ""},
                    {"box_amodal", DType::f32, {-1, 4}, "pixel", ""},
                    {"box_visibility", DType::f32, {-1}, "1", ""}},
                   {{"rgb", FileFormat::png, {"rgb"}},
                    {"normals", FileFormat::exr, {"normals"}},
                    {"flow", FileFormat::npy_frame, {"flow"}},
                    {"box_instance", FileFormat::npy_ragged, {"box_instance"}},
                    {"box_amodal", FileFormat::npy_ragged, {"box_amodal"}},
                    {"box_visibility", FileFormat::npy_ragged, {"box_visibility"}}},
                   R"({"width": 6, "height": 4, "non_finite": ["flow"]})"},
                  {"uav/events",
                   "event_camera",
                   "10",
                   {{"x", DType::u16, {-1}, "1", ""},
                    {"y", DType::u16, {-1}, "1", ""},
                    {"p", DType::u8, {-1}, "1", ""},
                    {"difference_picture", DType::u8, {4, 6}, "1", ""}},
                   {{"x", FileFormat::npy_ragged, {"x"}},
                    {"y", FileFormat::npy_ragged, {"y"}},
                    {"p", FileFormat::npy_ragged, {"p"}},
                    {"differences", FileFormat::png, {"difference_picture"}}},
                   R"({"width": 6, "height": 4})"}};
  DatasetWriter writer(folder.path() / "set", info);
  writer.begin_sequence(0);
  for (int64_t tick = 0; tick < 3; ++tick) {
    Array normals(DType::f32, {4, 6, 3}), flow(DType::f32, {4, 6, 2}), box(DType::f32, {1, 4});
    for (size_t i = 0; i < 24; ++i) normals.as<float>()[3 * i + 2] = 1.0f, flow.as<float>()[2 * i] = 2.0f;
    for (size_t i = 0; i < 4; ++i) box.as<float>()[i] = static_cast<float>(i + 1);
    const uint32_t id = 3;
    const float visibility = 0.5f;
    const uint16_t x = 5, y = 3;
    const uint8_t p = 1;
    const int64_t events = tick > 0;
    const auto one = [&](auto value, int64_t count) {
      return Array::of<decltype(value)>({count}, std::span(&value, static_cast<size_t>(count)));
    };
    Packet packet{tick, tick * 100'000'000, {}};
    packet.records.push_back(
        {0,
         tick,
         packet.time_ns,
         tick,
         {Array(DType::u8, {4, 6, 3}), normals, flow, one(id, 1), box, one(visibility, 1)}});
    packet.records.push_back({1,
                              tick,
                              packet.time_ns,
                              tick,
                              {one(x, events), one(y, events), one(p, events), Array(DType::u8, {4, 6})}});
    writer.write(std::move(packet));
  }
  writer.end_sequence();
  writer.finish();
  const DatasetReader reader(folder.path() / "set");
  Panels panels;
  for (size_t s = 0; s < 2; ++s) add_panels({reader, 0, s, {reader.records_of(0, s)[1]}}, panels);
  std::vector<std::string> titles;
  for (const auto& panel : panels.frames) titles.push_back(panel->title());
  EXPECT_THAT(titles, ElementsAre("uav/cam rgb", "uav/cam normals", "uav/cam flow", "uav/cam boxes",
                                  "uav/events: ON red, OFF blue", "uav/events differences"));
  const auto corner = [&](size_t panel) {  // colour of the first column and row
    Canvas canvas(60, 80, theme::page);
    panels.frames[panel]->draw(canvas, {0, 0, 60, 40}, {0, 50, 60, 20}, 0);
    const Array image = canvas.image();
    const uint8_t* const rgb = image.as<uint8_t>().data() + (5 * 60 + 5) * 3;
    return std::vector<int>{rgb[0], rgb[1], rgb[2]};
  };
  EXPECT_THAT(corner(1), ElementsAre(128, 128, 255)) << "up";
  EXPECT_THAT(corner(2), ElementsAre(255, 0, 0)) << "to the right, the longest there is";
  EXPECT_THAT(corner(4), ElementsAre(128, 128, 128)) << "no event there";
  EXPECT_GT(contact_sheet(reader).shape[0], 800);
}

TEST(Summary, CountsWhatIsThere) {
  const test::TemporaryFolder folder;
  {
    DatasetWriter writer(folder.path(), sample_info());
    ASSERT_TRUE(write_sample_run(writer, sample_info()));
  }
  const Summary summary = summarize(DatasetReader(folder.path()));
  EXPECT_EQ(summary.title, "sample");
  EXPECT_TRUE(summary.finished);
  EXPECT_EQ(summary.records, 2 * 86);
  EXPECT_DOUBLE_EQ(summary.duration_s, 0.07);
  EXPECT_EQ(summary.sensors[0].records, 6);
  uint64_t bytes = 0;
  for (const auto& [path, text] : contents(folder.path())) bytes += path == "manifest.json" ? 0 : text.size();
  EXPECT_EQ(summary.bytes, bytes);
  EXPECT_THAT(to_text(summary), HasSubstr("uav/cam (camera, 30 Hz): 6 records"));
  EXPECT_THAT(to_text(summary), HasSubstr("cfr: npy_stack <c8 [1, 2, 1, 4, 1, 8]"));
  const nlohmann::json json = nlohmann::json::parse(to_json(summary));
  EXPECT_EQ(json["sensors"][3]["records"], 140);
  EXPECT_EQ(json["files"], summary.files);
}

}  // namespace
}  // namespace greatx::io
