// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/panel/panel.h"

#include <cmath>
#include <complex>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "draw/canvas/plot.h"
#include "draw/sheet/sheet_tiles.h"
#include "io/dataset/dataset_reader.h"
#include "io/dataset/dataset_writer.h"
#include "tests/support/temporary_folder.h"
#include "view/panel/record_history.h"

namespace greatx::view {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr int64_t camera_width = 8, camera_height = 6;
constexpr int width = 400, height = 300;

template <typename T>
Array array_of(std::vector<int64_t> shape, std::vector<T> values) {
  return Array::of<T>(std::move(shape), std::span<const T>(values));
}

enum SensorNumber : uint32_t { camera, events, lidar, radar, csi, poses };

/// A node with every kind of sensor.
io::DatasetInfo info() {
  io::DatasetInfo info;
  info.tick_rate = "100";
  info.ticks_per_sequence = 20;
  info.run_json = R"({"scenario": "panels",
    "instances": [{"name": "road", "class": "road"}, {"name": "red car", "class": "vehicle"}],
    "semantic_classes": ["unlabeled", "ground", "road", "vehicle"], "materials": ["asphalt", "steel"]})";
  const auto sensor = [&](const char* name, const char* kind, std::vector<ArraySpec> arrays,
                          const char* metadata) {
    SensorSpec spec{name, kind, kind == std::string("pose") ? "" : "100", std::move(arrays), {}, metadata};
    for (const ArraySpec& array : spec.arrays)
      spec.outputs.push_back(
          {array.name,
           !array.shape.empty() && array.shape[0] < 0 ? FileFormat::npy_ragged : FileFormat::npy_stack,
           {array.name}});
    info.sensors.push_back(std::move(spec));
  };
  const int64_t h = camera_height, w = camera_width;
  sensor("uav/cam", "camera",
         {{"rgb", DType::u8, {h, w, 3}, "1", ""},
          {"depth", DType::f32, {h, w}, "m", ""},
          {"instance", DType::u16, {h, w}, "1", ""},
          {"semantic", DType::u8, {h, w}, "1", ""},
          {"material", DType::u16, {h, w}, "1", ""},
          {"normals", DType::f32, {h, w, 3}, "1", ""},
          {"flow", DType::f32, {h, w, 2}, "pixel", ""},
          {"hdr", DType::f32, {h, w, 3}, "cd/m^2", ""},
          {"box_instance", DType::u32, {-1}, "1", ""},
          {"box_amodal", DType::f32, {-1, 4}, "pixel", ""},
          {"box_visibility", DType::f32, {-1}, "1", ""}},
         R"({"width": 8, "height": 6, "fx": 4, "fy": 4, "cx": 4, "cy": 3, "non_finite": ["flow"]})");
  sensor("uav/events", "event_camera",
         {{"t", DType::i64, {-1}, "ns", ""},
          {"x", DType::u16, {-1}, "1", ""},
          {"y", DType::u16, {-1}, "1", ""},
          {"p", DType::u8, {-1}, "1", ""}},
         R"({"width": 8, "height": 6})");
  sensor("uav/lidar", "lidar",
         {{"points", DType::f32, {-1, 4}, "m", ""},
          {"ring", DType::u16, {-1}, "1", ""},
          {"range", DType::f32, {-1}, "m", ""},
          {"instance", DType::u32, {-1}, "1", ""}},
         R"({"pattern": "spinning", "azimuth_steps": 36, "azimuth_start_deg": 0, "azimuth_span_deg": 360,
             "elevations_deg": [-10, 10, 0]})");
  sensor("uav/radar", "radar",
         {{"range_doppler", DType::f32, {16, 8}, "W", ""},
          {"range_azimuth", DType::f32, {16, 9}, "W", ""},
          {"detections", DType::f32, {-1, 4}, "m, dBsm", ""},
          {"range", DType::f32, {-1}, "m", ""},
          {"velocity", DType::f32, {-1}, "m/s", ""},
          {"azimuth", DType::f32, {-1}, "rad", ""},
          {"instance", DType::u32, {-1}, "1", ""}},
         R"({"range_bin_m": 2.0, "velocity_min_m_s": -4.0, "velocity_bin_m_s": 1.0, "azimuth_min_rad": -0.8,
             "azimuth_max_rad": 0.8})");
  sensor("csi", "csi",
         {{"cfr", DType::complex64, {2, 1, 1, 2, 1, 64}, "1", ""},
          {"path_count", DType::i32, {2, 1}, "1", "[rx, tx] visible paths"},
          {"path_gain", DType::f64, {2, 1}, "1", "[rx, tx] sum"},
          {"delay_spread", DType::f64, {2, 1}, "s", "[rx, tx] rms"},
          {"rx", DType::i32, {-1}, "1", ""},
          {"tx", DType::i32, {-1}, "1", ""},
          {"amplitude", DType::complex64, {-1, 1, 2}, "1", ""},
          {"delay", DType::f64, {-1}, "s", ""},
          {"doppler", DType::f64, {-1}, "Hz", ""},
          {"arrival", DType::f64, {-1, 2}, "rad", ""},
          {"departure", DType::f64, {-1, 2}, "rad", ""},
          {"id", DType::u64, {-1}, "1", ""},
          {"interaction", DType::u8, {-1, 2}, "1", ""}},
         R"({"subcarrier_spacing_hz": 1e6, "non_finite": ["delay_spread"]})");
  sensor("poses", "pose",
         {{"position", DType::f64, {2, 3}, "m", ""},
          {"orientation", DType::f64, {2, 4}, "1", ""},
          {"velocity", DType::f64, {2, 3}, "m/s", ""}},
         R"({"nodes": ["uav", "car"]})");
  return info;
}

/// What varies between ticks: everything is there, or nothing where there can be none.
struct Content {
  bool empty = false;
};

std::complex<float> cfr_at(int64_t tick, int rx, int port, int k) {
  // One path of delay 100 ns and amplitude 1e-3 * (1 + tick), weaker at the second receiver and port.
  const double amplitude = 1e-3 * static_cast<double>(1 + tick) / (1 + rx) / (1 + port);
  return std::complex<float>(std::polar(amplitude, -2.0 * pi * (k - 32) * 1e6 * 100e-9));
}

std::vector<Array> camera_arrays(const Content& content) {
  const int64_t h = camera_height, w = camera_width;
  Array rgb(DType::u8, {h, w, 3}), depth(DType::f32, {h, w}), instance(DType::u16, {h, w}),
      semantic(DType::u8, {h, w}), material(DType::u16, {h, w}), normals(DType::f32, {h, w, 3}),
      flow(DType::f32, {h, w, 2}), hdr(DType::f32, {h, w, 3});
  for (size_t i = 0; i < size_t(h * w); ++i) {
    rgb.as<uint8_t>()[3 * i] = static_cast<uint8_t>(i);
    depth.as<float>()[i] = i == 0 ? std::numeric_limits<float>::infinity() : static_cast<float>(i);
    instance.as<uint16_t>()[i] = static_cast<uint16_t>(i % 3);
    semantic.as<uint8_t>()[i] = static_cast<uint8_t>(i % 4);
    material.as<uint16_t>()[i] = static_cast<uint16_t>(i % 3);
    normals.as<float>()[3 * i + 2] = 1.0f;
    flow.as<float>()[2 * i] = static_cast<float>(i);
    hdr.as<float>()[3 * i + 1] = static_cast<float>(i + 1);
  }
  const int64_t boxes = content.empty ? 0 : 1;
  const auto some = [&](auto values) {
    if (content.empty) values.clear();
    return values;
  };
  return {rgb,
          depth,
          instance,
          semantic,
          material,
          normals,
          flow,
          hdr,
          array_of<uint32_t>({boxes}, some(std::vector<uint32_t>{2})),
          array_of<float>({boxes, 4}, some(std::vector<float>{2, 1, 6, 4})),
          array_of<float>({boxes}, some(std::vector<float>{0.5f}))};
}

/// The packet of a tick, 10 ms apart: one event at its start, one path, points to the front and to the left.
Packet packet_of(int64_t tick, const Content& content = {}) {
  Packet packet{tick, tick * 10'000'000, {}};
  const int64_t n = content.empty ? 0 : 1, two = 2 * n;
  const auto some = [&](auto values) {
    if (content.empty) values.clear();
    return values;
  };
  const auto add = [&](uint32_t sensor, std::vector<Array> arrays) {
    packet.records.push_back({sensor, tick, packet.time_ns, tick, std::move(arrays)});
  };
  add(camera, camera_arrays(content));
  const int64_t t = packet.time_ns - 5'000'000;
  add(events, {array_of<int64_t>({two}, some(std::vector<int64_t>{t, packet.time_ns})),
               array_of<uint16_t>({two}, some(std::vector<uint16_t>{uint16_t(tick % 8), 7})),
               array_of<uint16_t>({two}, some(std::vector<uint16_t>{2, 5})),
               array_of<uint8_t>({two}, some(std::vector<uint8_t>{1, 0}))});
  add(lidar, {array_of<float>({two, 4}, some(std::vector<float>{10, 0, 0, 0.5f, 0, 8, 1.4106f, 0.25f})),
              array_of<uint16_t>({two}, some(std::vector<uint16_t>{2, 1})),
              array_of<float>({two}, some(std::vector<float>{10.0f, 8.1234f})),
              array_of<uint32_t>({two}, some(std::vector<uint32_t>{2, 0}))});
  Array range_doppler(DType::f32, {16, 8}), range_azimuth(DType::f32, {16, 9});
  for (float& watt : range_doppler.as<float>()) watt = 1e-13f;
  for (float& watt : range_azimuth.as<float>()) watt = 1e-13f;
  range_doppler.as<float>()[5 * 8 + 6] = 1e-9f;  // 10 m, 2 m/s
  range_azimuth.as<float>()[5 * 9 + 6] = 1e-9f;  // 10 m, 0.4 rad to the left
  add(radar,
      {range_doppler, range_azimuth, array_of<float>({n, 4}, some(std::vector<float>{9.2f, 3.9f, 0, 10})),
       array_of<float>({n}, some(std::vector<float>{10})), array_of<float>({n}, some(std::vector<float>{2})),
       array_of<float>({n}, some(std::vector<float>{0.4f})),
       array_of<uint32_t>({n}, some(std::vector<uint32_t>{2}))});
  Array cfr(DType::complex64, {2, 1, 1, 2, 1, 64});
  for (int i = 0; i < 4 * 64; ++i)
    cfr.as<std::complex<float>>()[i] = cfr_at(tick, i / 128, i / 64 % 2, i % 64);
  const std::vector<double> spread =
      content.empty ? std::vector<double>{std::nan(""), std::nan("")} : std::vector<double>{12.5e-9, 2e-9};
  add(csi,
      {cfr, array_of<int32_t>({2, 1}, {content.empty ? 0 : 1, 0}), array_of<double>({2, 1}, {1e-6, 1e-9}),
       array_of<double>({2, 1}, spread), array_of<int32_t>({n}, some(std::vector<int32_t>{0})),
       array_of<int32_t>({n}, some(std::vector<int32_t>{0})),
       array_of<std::complex<float>>({n, 1, 2},
                                     some(std::vector<std::complex<float>>{{0, 1e-3f}, {0, 1e-3f}})),
       array_of<double>({n}, some(std::vector<double>{100e-9})),
       array_of<double>({n}, some(std::vector<double>{-40.0})),
       array_of<double>({n, 2}, some(std::vector<double>{1.5, radians(30.0)})),
       array_of<double>({n, 2}, some(std::vector<double>{1.5, radians(-150.0)})),
       array_of<uint64_t>({n}, some(std::vector<uint64_t>{0xabcdef})),
       array_of<uint8_t>({n, 2}, some(std::vector<uint8_t>{1, 3}))});
  const auto x = static_cast<double>(tick);
  add(poses,
      {array_of<double>({2, 3}, {x, 0, 30 + x, 5, 5, 0}), array_of<double>({2, 4}, {1, 0, 0, 0, 1, 0, 0, 0}),
       array_of<double>({2, 3}, {3, 4, 0, 0, 1 + x, 0})});
  return packet;
}

ShownTick shown(Packet packet) {
  ShownTick tick;
  for (const Record& record : packet.records) tick.newest.push_back(std::make_shared<const Record>(record));
  tick.packet = std::move(packet);
  return tick;
}

struct Memory {
  explicit Memory(io::DatasetInfo of = info())
      : history(std::make_shared<RecordHistory>(std::make_shared<const io::DatasetInfo>(std::move(of)),
                                                "live")) {}
  void add(int64_t tick, const Content& content = {}) {
    last = shown(packet_of(tick, content));
    history->add(last);
  }
  std::unique_ptr<Panel> panel(uint32_t sensor, const char* kind) {
    std::unique_ptr<Panel> made = make_panel({sensor, kind, ""}, history);
    made->show(last);
    return made;
  }
  std::shared_ptr<RecordHistory> history;
  ShownTick last;
};

using Rgb = std::array<int, 3>;
Rgb pixel(const Array& picture, int x, int y) {
  const uint8_t* const p = picture.as<uint8_t>().data() + 3 * (y * picture.shape[1] + x);
  return {p[0], p[1], p[2]};
}
Rgb rgb(io::Color c) { return {c.r, c.g, c.b}; }

/// Where a FramePanel's picture lies in a panel.
io::Rect frame_rect(int w, int h, double aspect) {
  return io::fit({0, 0, w, h - io::sheet::legend_height}, aspect);
}
io::Rect camera_rect(int w, int h) { return frame_rect(w, h, 0.75); }
/// The middle of a cell of a raster that fills `rect`.
std::array<int, 2> middle(const io::Rect& rect, int columns, int rows, int column, int row) {
  return {rect.x + (2 * column + 1) * rect.width / (2 * columns),
          rect.y + (2 * row + 1) * rect.height / (2 * rows)};
}

/// The first pixel whose text contains `part`; -1: none.
std::array<int, 2> find_text(Panel& panel, const std::string& part, int w = width, int h = height) {
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (panel.value_at(x, y).find(part) != std::string::npos) return {x, y};
  return {-1, -1};
}

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const UserError& error) {
    return error.what();
  }
  return {};
}

TEST(PanelChoices, ListWhatTheSensorsDeliver) {
  const io::DatasetInfo of = info();
  std::vector<std::string> titles;
  for (const PanelChoice& choice : panels_of(of.sensors)) titles.push_back(choice.title);
  EXPECT_THAT(titles,
              ElementsAre("uav/cam: rgb", "uav/cam: depth", "uav/cam: instance", "uav/cam: semantic",
                          "uav/cam: material", "uav/cam: normals", "uav/cam: flow", "uav/cam: boxes",
                          "uav/cam: luminance", "uav/events: events", "uav/events: time surface",
                          "uav/lidar: from above", "uav/lidar: range image", "uav/radar: range-Doppler",
                          "uav/radar: range-azimuth", "uav/radar: over the picture", "csi: delay over time",
                          "csi: |H| over frequency", "csi: |H| over frequency and time", "csi: arrivals",
                          "csi: departures", "csi: delay and gain of paths", "csi: amplitudes of paths",
                          "csi: link", "poses: speeds", "poses: heights"));
  EXPECT_TRUE(panels_of({}).empty());
}

TEST(PanelChoices, AMissingArrayIsNamed) {
  const io::DatasetInfo all = info();
  for (const PanelChoice& choice : panels_of(all.sensors)) {
    io::DatasetInfo none = all;
    SensorSpec& sensor = none.sensors[choice.sensor];
    const std::string first = sensor.arrays[0].name;
    sensor.arrays.clear();
    sensor.outputs.clear();
    Memory memory(none);
    EXPECT_THAT(error_of([&] { make_panel(choice, memory.history); }),
                testing::AllOf(HasSubstr(sensor.name), HasSubstr("needs the array")))
        << choice.title;
    EXPECT_TRUE(panels_of(none.sensors).size() < panels_of(all.sensors).size());
  }
  io::DatasetInfo without = all;
  std::erase_if(without.sensors[camera].arrays, [](const ArraySpec& array) { return array.name == "depth"; });
  Memory memory(without);
  EXPECT_EQ(error_of([&] {
              make_panel({camera, "depth", ""}, memory.history);
            }),
            "uav/cam: the panel 'depth' needs the array depth, which the sensor does not deliver");
  EXPECT_THAT(error_of([&] { make_panel({camera, "smell", ""}, memory.history); }), HasSubstr("'smell'"));
  EXPECT_THAT(error_of([&] { make_panel({77, "depth", ""}, memory.history); }), HasSubstr("found 77"));
}

TEST(Panels, ArraysOfAnotherTypeOrShapeAreNamed) {
  io::DatasetInfo wrong = info();
  wrong.sensors[camera].arrays[1].dtype = DType::f64;
  Memory memory(wrong);
  memory.last = shown(packet_of(1));
  memory.history->add(memory.last);
  const auto panel = memory.panel(camera, "depth");
  panel->draw(width, height);
  EXPECT_THAT(panel->error(), testing::AllOf(HasSubstr("uav/cam"), HasSubstr("array depth of <f4")));
  EXPECT_EQ(panel->value_at(100, 100), "");

  // A record that differs from its declaration.
  Memory other;
  Packet packet = packet_of(1);
  packet.records[camera].arrays[1] = Array(DType::f32, {3, 3});
  other.last = shown(std::move(packet));
  other.history->add(other.last);
  const auto broken = other.panel(camera, "depth");
  broken->draw(width, height);
  EXPECT_THAT(broken->error(), HasSubstr("tick 1: depth: expected <f4 [6, 8], found <f4 [3, 3]"));
  // The next record is whole again.
  other.add(2);
  broken->show(other.last);
  broken->draw(width, height);
  EXPECT_EQ(broken->error(), "");
}

TEST(CameraPanels, AnElementHasItsColorAndItsValue) {
  Memory memory;
  memory.add(3);
  for (const auto& [w, h] : {std::pair{400, 324}, std::pair{173, 500}, std::pair{1000, 300}}) {
    const io::Rect rect = camera_rect(w, h);
    const auto at = [&](int column, int row) { return middle(rect, 8, 6, column, row); };
    const auto color = memory.panel(camera, "rgb"), depth = memory.panel(camera, "depth"),
               instance = memory.panel(camera, "instance"), flow = memory.panel(camera, "flow");
    const Array picture = color->draw(w, h);
    ASSERT_THAT(picture.shape, ElementsAre(h, w, 3));
    depth->draw(w, h);
    const Array ids = instance->draw(w, h);
    flow->draw(w, h);
    for (const auto& [column, row] : {std::pair{0, 0}, {7, 0}, {0, 5}, {7, 5}, {4, 3}, {1, 1}}) {
      const auto [x, y] = at(column, row);
      const int i = row * 8 + column;
      EXPECT_EQ(pixel(picture, x, y), (Rgb{i, 0, 0}));
      EXPECT_EQ(color->value_at(x, y), fmt::format("({}, {})  rgb {} 0 0", column, row, i));
      EXPECT_EQ(depth->value_at(x, y),
                fmt::format("({}, {})  {}", column, row, i == 0 ? "sky" : fmt::format("{} m", i)));
      EXPECT_EQ(pixel(ids, x, y), rgb(io::color_of_id(static_cast<uint32_t>(i % 3))));
      const char* const names[] = {"nothing", "1 road (road)", "2 red car (vehicle)"};
      EXPECT_EQ(instance->value_at(x, y), fmt::format("({}, {})  {}", column, row, names[i % 3]));
      EXPECT_EQ(flow->value_at(x, y),
                fmt::format("({}, {})  right {}.00 down 0.00 px a picture", column, row, i));
    }
    // The corners of the picture, and what is just outside.
    EXPECT_THAT(color->value_at(rect.x, rect.y), HasSubstr("(0, 0)"));
    EXPECT_THAT(color->value_at(rect.right() - 1, rect.bottom() - 1), HasSubstr("(7, 5)"));
    for (const auto& [x, y] : {std::pair{rect.x - 1, rect.y},
                               {rect.right(), rect.y},
                               {rect.x, rect.y - 1},
                               {rect.x, rect.bottom()},
                               {-1, -1},
                               {w, h},
                               {1 << 30, 0},
                               {0, -(1 << 30)}})
      EXPECT_EQ(color->value_at(x, y), "") << x << " " << y;
  }
}

TEST(CameraPanels, OtherValues) {
  Memory memory;
  memory.add(3);
  const auto text = [&](const char* kind, int column, int row) {
    const auto panel = memory.panel(camera, kind);
    panel->draw(width, height);
    EXPECT_EQ(panel->error(), "") << kind;
    const auto [x, y] = middle(camera_rect(width, height), 8, 6, column, row);
    return panel->value_at(x, y);
  };
  EXPECT_EQ(text("semantic", 3, 0), "(3, 0)  3 vehicle");
  EXPECT_EQ(text("material", 2, 0), "(2, 0)  2 steel");
  EXPECT_EQ(text("normals", 2, 0), "(2, 0)  east 0.000 north 0.000 up 1.000");
  EXPECT_EQ(text("luminance", 1, 0), "(1, 0)  1.43 cd/m2, red 0 green 2 blue 0");
  EXPECT_EQ(text("boxes", 3, 2), "(3, 2)  2 red car (vehicle)\n4 x 3 px, 50 % seen");
  EXPECT_EQ(text("boxes", 7, 2), "(7, 2)  no box");
}

TEST(EventPanels, CountAndDecay) {
  Memory memory;
  memory.add(2);
  const auto counts = memory.panel(events, "events");
  counts->draw(width, height);
  const auto at = [&](int column, int row) { return middle(camera_rect(width, height), 8, 6, column, row); };
  EXPECT_EQ(counts->value_at(at(2, 2)[0], at(2, 2)[1]), "(2, 2)  ON 1 OFF 0");
  EXPECT_EQ(counts->value_at(at(7, 5)[0], at(7, 5)[1]), "(7, 5)  ON 0 OFF 1");
  EXPECT_EQ(counts->value_at(at(0, 0)[0], at(0, 0)[1]), "(0, 0)  ON 0 OFF 0");

  const auto surface = memory.panel(events, "time surface");
  const Array fresh = surface->draw(width, height);
  EXPECT_EQ(pixel(fresh, at(7, 5)[0], at(7, 5)[1]), (Rgb{35, 75, 240})) << "darker, right now";
  EXPECT_EQ(pixel(fresh, at(0, 0)[0], at(0, 0)[1]), (Rgb{128, 128, 128}));
  EXPECT_EQ(surface->value_at(at(0, 0)[0], at(0, 0)[1]), "(0, 0)  no event");
  // The brighter event is 5 ms old.
  surface->set_knob("tau", 5.0);
  const Array decayed = surface->draw(width, height);
  const double share = std::exp(-1.0);
  EXPECT_EQ(surface->value_at(at(2, 2)[0], at(2, 2)[1]), fmt::format("(2, 2)  ON 5 ms ago: {:.4f}", share));
  EXPECT_NEAR(pixel(decayed, at(2, 2)[0], at(2, 2)[1])[0], 128 + share * (235 - 128), 0.51);
  EXPECT_NEAR(pixel(decayed, at(2, 2)[0], at(2, 2)[1])[1], 128 + share * (45 - 128), 0.51);
  surface->set_knob("tau", 10.0);
  surface->draw(width, height);
  EXPECT_THAT(surface->value_at(at(2, 2)[0], at(2, 2)[1]), HasSubstr(fmt::format("{:.4f}", std::exp(-0.5))));
}

/// The surface after one tick at a time is that of a panel that sees all of them at once, forwards and back.
TEST(EventPanels, TheSurfaceGrowsAsItIsMadeAnew) {
  Memory memory;
  memory.add(0);
  const auto grown = memory.panel(events, "time surface");
  std::vector<ShownTick> ticks;
  for (int64_t tick = 0; tick < 12; ++tick) {
    memory.add(tick);
    ticks.push_back(memory.last);
    grown->show(memory.last);
    grown->draw(160, 120);
  }
  const auto made = memory.panel(events, "time surface");
  EXPECT_EQ(grown->draw(160, 120).bytes, made->draw(160, 120).bytes);
  for (const Array& last = grown->draw(160, 120); const double tau : {2.0, 300.0}) {
    grown->set_knob("tau", tau);
    const auto fresh = memory.panel(events, "time surface");
    fresh->set_knob("tau", tau);
    EXPECT_EQ(grown->draw(160, 120).bytes, fresh->draw(160, 120).bytes) << tau;
    EXPECT_FALSE(last.bytes.empty());
  }
  Memory past;
  for (int64_t tick = 0; tick < 6; ++tick) past.add(tick);
  const auto earlier = past.panel(events, "time surface");
  earlier->set_knob("tau", 300.0);
  grown->show(ticks[5]);
  EXPECT_EQ(grown->draw(160, 120).bytes, earlier->draw(160, 120).bytes) << "a jump back";
}

TEST(LidarPanels, FromAboveAndAsARangeImage) {
  Memory memory;
  memory.add(2);
  const auto above = memory.panel(lidar, "from above");
  above->draw(width, height);
  const auto car = find_text(*above, "2 red car (vehicle)"), fog = find_text(*above, "fog or rain");
  ASSERT_GE(car[0], 0);
  ASSERT_GE(fog[0], 0);
  EXPECT_GT(car[0], fog[0]) << "the car is east, ahead of a sensor that looks east; the fog is north of it";
  EXPECT_GT(car[1], fog[1]);
  EXPECT_THAT(above->value_at(car[0], car[1]), HasSubstr("range 10.00 m, height 32.00 m, intensity 0.5"));
  EXPECT_THAT(above->value_at(200, 20), HasSubstr("m of the sensor"));
  EXPECT_EQ(above->value_at(1, 1), "") << "beside the square";

  const auto image = memory.panel(lidar, "range image");
  const Array picture = image->draw(640, 200);
  const auto ahead = find_text(*image, "range 10.00 m", 640, 200),
             left = find_text(*image, "range 8.12 m", 640, 200);
  ASSERT_GE(ahead[0], 0);
  ASSERT_GE(left[0], 0);
  EXPECT_THAT(image->value_at(ahead[0], ahead[1]), HasSubstr("ring 2, elevation 0.0 deg"));
  EXPECT_THAT(image->value_at(ahead[0], ahead[1]), HasSubstr("2 red car (vehicle)"));
  EXPECT_THAT(image->value_at(left[0], left[1]), HasSubstr("ring 1, elevation 10.0 deg"));
  EXPECT_LT(left[0], ahead[0]) << "the left is on the left";
  EXPECT_LT(left[1], ahead[1]) << "and up is up";
  // Straight ahead is the middle of the picture, 90 degrees to the left a quarter of its width to the left.
  const int x0 = 68, w = 640 - 68 - 20;
  EXPECT_NEAR(ahead[0], x0 + w / 2, w / 36);
  EXPECT_NEAR(left[0], x0 + w / 4, w / 36);
  EXPECT_NE(pixel(picture, ahead[0] + 2, ahead[1] + 2), pixel(picture, left[0] + 2, left[1] + 2));
  EXPECT_THAT(image->value_at(x0 + w - 1, ahead[1]), HasSubstr("no return"));
}

TEST(RadarPanels, ThePeakLiesAtItsRangeVelocityAndAzimuth) {
  Memory memory;
  memory.add(2);
  const auto doppler = memory.panel(radar, "range-Doppler");
  for (const auto& [w, h] : {std::pair{400, 300}, std::pair{300, 424}}) {
    const Array picture = doppler->draw(w, h);
    const io::Rect rect = frame_rect(w, h, 0.75);
    // As far as 12 m, a fifth beyond the farthest detection: 6 cells of 2 m, and 8 of 1 m/s from -4.
    const auto [x, y] = middle(rect, 8, 6, 6, 0);
    EXPECT_THAT(doppler->value_at(x, y), HasSubstr("10.00 m, 2.00 m/s: -60.0 dBm"));
    EXPECT_EQ(pixel(picture, x + 12, y + 12), rgb(io::viridis(1.0)));
    const auto [u, v] = middle(rect, 8, 6, 1, 3);
    EXPECT_THAT(doppler->value_at(u, v), HasSubstr("4.00 m, -3.00 m/s: -100.0 dBm"));
    EXPECT_NE(pixel(picture, u, v), pixel(picture, x + 12, y + 12));
    const auto mark = find_text(*doppler, "detection: 10.00 m, 2.00 m/s", w, h);
    ASSERT_GE(mark[0], 0);
    EXPECT_THAT(doppler->value_at(mark[0], mark[1]), HasSubstr("2 red car"));
    EXPECT_NEAR(mark[0], x, 8);
  }
  const auto azimuth = memory.panel(radar, "range-azimuth");
  const Array picture = azimuth->draw(width, height);
  const io::Rect rect = frame_rect(width, height, 0.75);
  const double pixels = std::min(rect.height - 24.0, 0.5 * rect.width) / 12.0;
  const auto at = [&](double metres) {
    return std::array<int, 2>{
        static_cast<int>(std::lround(rect.x + 0.5 * rect.width - metres * pixels * std::sin(0.4))),
        static_cast<int>(std::lround(rect.bottom() - 10.0 - metres * pixels * std::cos(0.4)))};
  };
  EXPECT_THAT(azimuth->value_at(at(10.0)[0], at(10.0)[1]),
              testing::AllOf(HasSubstr("10.0"), HasSubstr(": -60.0 dBm"), HasSubstr("detection: 10.00 m")));
  // The cell, 9 to 11 m, reaches farther than the mark.
  EXPECT_EQ(pixel(picture, at(9.3)[0], at(9.3)[1]), rgb(io::viridis(1.0)));
  EXPECT_THAT(azimuth->value_at(at(9.3)[0], at(9.3)[1]), testing::ContainsRegex("^9.[23].*: -60.0 dBm$"));
  EXPECT_THAT(azimuth->value_at(at(8.7)[0], at(8.7)[1]), HasSubstr(": -100.0 dBm"));
  EXPECT_THAT(azimuth->value_at(rect.right() - 1, rect.bottom() - 1), HasSubstr("outside of the map"));
}

/// Where a waterfall's plot lies.
io::Rect plot_rect(int w, int h) {
  const int line = io::theme::line_height;
  return {92, 8 + line, w - 184, h - 8 - line - 12 - 2 * line};
}

TEST(ChannelPanels, ThePowerDelayProfilePeaksAtTheDelay) {
  Memory memory;
  memory.add(0);
  const auto panel = memory.panel(csi, "delay over time");
  const Array picture = panel->draw(480, 320);
  const io::Rect plot = plot_rect(480, 320);
  int best = -1, brightest = -1;
  for (int x = plot.x; x < plot.right(); ++x) {
    const Rgb color = pixel(picture, x, plot.y);
    if (color[0] + color[1] > brightest) brightest = color[0] + color[1], best = x;
  }
  const std::string text = panel->value_at(best, plot.y);
  double delay_ns = 0.0, metres = 0.0, db = 0.0;
  ASSERT_EQ(std::sscanf(text.c_str(), "0.0000 s, %lf ns (%lf m): %lf dB", &delay_ns, &metres, &db), 3)
      << text;
  EXPECT_NEAR(delay_ns, 100.0, 4.0);  // cells of 3.9 ns
  EXPECT_NEAR(metres, 30.0, 1.2);
  EXPECT_NEAR(db, -60.0, 0.1);
  // Where several cells share a pixel, the strongest is shown.
  panel->draw(16, 20);
  double strongest_db = -400.0;
  for (int x = 0; x < 16; ++x) {
    ASSERT_EQ(std::sscanf(panel->value_at(x, 0).c_str(), "0.0000 s, %*s %*[^(](%*[^)]): %lf dB", &db), 1);
    strongest_db = std::max(strongest_db, db);
  }
  EXPECT_NEAR(strongest_db, -60.0, 0.1);
  // The weaker receiver and the weaker port.
  panel->set_knob("receiver", 1);
  panel->set_knob("transmitter port", 1);
  panel->draw(480, 320);
  EXPECT_THAT(panel->value_at(best, plot.y), HasSubstr("receiver 1"));
  ASSERT_EQ(std::sscanf(panel->value_at(best, plot.y).c_str(), "0.0000 s, %lf ns (%lf m): %lf dB", &delay_ns,
                        &metres, &db),
            3);
  EXPECT_NEAR(db, -72.0, 0.2);
  EXPECT_THROW(panel->set_knob("colour", 1), ContractError);
  panel->set_knob("receiver", 99);
  EXPECT_EQ(panel->knobs()[0].value, 1.0) << "the last one";
}

TEST(ChannelPanels, LinesOfTheWaterfallMoveWithTheTicks) {
  for (const char* kind : {"delay over time", "|H| over frequency and time"}) {
    Memory memory;
    memory.add(0);
    const auto panel = memory.panel(csi, kind);
    panel->set_knob("ticks", 10);
    const io::Rect plot = plot_rect(480, 320);
    const auto text = [&](int line) {
      const std::string all = panel->value_at(plot.x + 60, plot.y + (2 * line + 1) * plot.height / 20);
      return all.substr(0, all.find(','));
    };
    for (int64_t tick = 0; tick < 14; ++tick) {
      memory.add(tick);
      panel->show(memory.last);
      panel->draw(480, 320);
      for (int line = 0; line < 10; ++line)
        EXPECT_EQ(text(line),
                  line <= tick ? fmt::format("{:.4f} s", 0.01 * static_cast<double>(tick - line)) : "")
            << kind << " " << tick;
    }
    // Back to a tick that is stored: the lines after it go.
    panel->show(shown(packet_of(4)));
    const Array back = panel->draw(480, 320);
    EXPECT_EQ(text(0), "0.0400 s");
    EXPECT_EQ(text(4), "0.0000 s");
    EXPECT_EQ(text(5), "");
    EXPECT_EQ(pixel(back, plot.x + 60, plot.bottom() - 2), rgb(io::theme::panel)) << "no line there";
    EXPECT_NE(pixel(back, plot.x + 60, plot.y + 1), rgb(io::theme::panel));
  }
}

TEST(ChannelPanels, TheResponseHasItsValues) {
  Memory memory;
  memory.add(1);
  const auto panel = memory.panel(csi, "|H| over frequency");
  panel->draw(480, 320);
  const int left = 92, plot_width = 480 - 112, y = 100;
  EXPECT_THAT(panel->value_at(left, y), HasSubstr("fc + -32 MHz, subcarrier 0: -53.98 dB"));
  EXPECT_THAT(panel->value_at(left + plot_width - 1, y), HasSubstr("fc + 31 MHz, subcarrier 63: -53.98 dB"));
  EXPECT_THAT(panel->value_at(left + (2 * 32 + 1) * plot_width / 128, y),
              HasSubstr("subcarrier 32: -53.98 dB, phase"));
  EXPECT_EQ(panel->value_at(left - 1, y), "");
}

TEST(PathPanels, TheCompassPointsToThePath) {
  Memory memory;
  memory.add(1);
  const auto arrivals = memory.panel(csi, "arrivals"), departures = memory.panel(csi, "departures");
  // 1e-3 is -60 dB, on the rim.
  for (const int size : {320, 200, 500}) {
    const Array picture = arrivals->draw(size, size);
    const double radius = 0.5 * size - io::theme::line_height;
    const int x = static_cast<int>(0.5 * size + radius * std::cos(radians(30.0))),
              y = static_cast<int>(0.5 * size - radius * std::sin(radians(30.0)));
    const std::string text = arrivals->value_at(x, y);
    EXPECT_THAT(text,
                testing::AllOf(HasSubstr("path 0: -60.00 dB"), HasSubstr("azimuth 30.00 deg"),
                               HasSubstr("reflection, diffraction"), HasSubstr("delay 100 ns (29.98 m)"),
                               HasSubstr("Doppler -40 Hz"), HasSubstr("id 0000000000abcdef")));
    EXPECT_EQ(pixel(picture, x, y), rgb(io::color_of_series(2)));
    EXPECT_THAT(arrivals->value_at(size - x, y),
                testing::ContainsRegex("azimuth (149|150)\\.[0-9] deg, -6[01]\\."))
        << "no path there";
    EXPECT_EQ(arrivals->value_at(0, 0), "") << "beyond the rim";
    departures->draw(size, size);
    EXPECT_THAT(departures->value_at(size - x, size - y), HasSubstr("azimuth -150.00 deg"));
  }
  arrivals->set_knob("receiver", 1);
  arrivals->draw(320, 320);
  EXPECT_EQ(find_text(*arrivals, "path", 320, 320)[0], -1) << "the other receiver has none";
}

TEST(PathPanels, DelayGainAndAmplitude) {
  Memory memory;
  memory.add(1);
  const auto gain = memory.panel(csi, "delay and gain of paths");
  gain->draw(width, height);
  const auto mark = find_text(*gain, "path 0: -60.00 dB");
  ASSERT_GE(mark[0], 0);
  // Elsewhere the axes tell where one is; next to the mark that must be the path.
  const std::string beside = gain->value_at(mark[0] + 8, mark[1] - 6);
  double delay_ns = 0.0, db = 0.0;
  ASSERT_EQ(std::sscanf(beside.c_str(), "delay %lf ns, %lf dB", &delay_ns, &db), 2) << beside;
  EXPECT_NEAR(delay_ns, 100.0, 0.3);
  EXPECT_NEAR(db, -60.0, 1.0);
  const auto plane = memory.panel(csi, "amplitudes of paths");
  plane->draw(320, 320);
  const int up = static_cast<int>(160 - 0.46 * 320);
  EXPECT_THAT(plane->value_at(160, up), HasSubstr("amplitude 0 +0.001 j, phase 90.0 deg"));
  EXPECT_EQ(plane->value_at(160, 320 - up), "");
}

TEST(LinkTable, ShowsEveryStatistic) {
  Memory memory;
  memory.add(1);
  const auto panel = memory.panel(csi, "link");
  for (const auto& [w, h, line] : {std::tuple{480, 300, 22}, std::tuple{200, 300, 11}}) {
    panel->draw(w, h);
    EXPECT_EQ(panel->value_at(5, line / 2), "path count: 1\n[rx, tx] visible paths");
    EXPECT_EQ(panel->value_at(w - 1, line + line / 2), "path gain: -60.00 dB\n[rx, tx] sum");
    EXPECT_EQ(panel->value_at(5, 2 * line), "delay spread: 12.5 ns\n[rx, tx] rms");
    EXPECT_EQ(panel->value_at(5, 3 * line), "");
  }
  panel->set_knob("receiver", 1);
  panel->draw(480, 300);
  EXPECT_EQ(panel->value_at(5, 44), "delay spread: 2 ns\n[rx, tx] rms");
  panel->draw(200, 23);  // room for two lines, of which the second says that there are more
  EXPECT_THAT(panel->value_at(5, 5), HasSubstr("path count"));
  EXPECT_EQ(panel->value_at(5, 16), "");
}

TEST(MotionPanels, NodesOverTime) {
  Memory memory;
  for (int64_t tick = 0; tick < 11; ++tick) memory.add(tick);
  const auto speeds = memory.panel(poses, "speeds"), heights = memory.panel(poses, "heights");
  speeds->draw(480, 300);
  heights->draw(480, 300);
  const int right = 480 - 20 - 1, left = 92, bottom = 300 - 12 - 44 - 1;
  EXPECT_EQ(speeds->value_at(right, 8), "0.1000 s, car: speed 11.000 m/s");
  EXPECT_EQ(speeds->value_at(left, bottom), "0.0000 s, car: speed 1.000 m/s");
  EXPECT_EQ(speeds->value_at(left, 8), "0.0000 s, uav: speed 5.000 m/s");
  EXPECT_EQ(heights->value_at(right, 8), "0.1000 s, uav: height 40.000 m");
  EXPECT_EQ(heights->value_at(right, bottom), "0.1000 s, car: height 0.000 m");
  EXPECT_EQ(heights->value_at(left - 1, 8), "");
}

TEST(Panels, EmptyRecordsSaySo) {
  Memory memory;
  memory.add(1, {.empty = true});
  Memory full;
  full.add(1);
  for (const auto& [sensor, kind] : {std::pair{camera, "boxes"},
                                     {events, "events"},
                                     {events, "time surface"},
                                     {lidar, "from above"},
                                     {lidar, "range image"},
                                     {csi, "arrivals"},
                                     {csi, "delay and gain of paths"},
                                     {csi, "amplitudes of paths"}}) {
    const auto panel = memory.panel(sensor, kind), other = full.panel(sensor, kind);
    const Array picture = panel->draw(width, height);
    EXPECT_EQ(panel->error(), "") << kind;
    // The note is in the middle, in the colour of text.
    const auto text_pixels = [](const Array& of) {
      int count = 0;
      for (int y = height / 2 - 16; y < height / 2 + 8; ++y)
        for (int x = width / 2 - 90; x < width / 2 + 90; ++x)
          count += pixel(of, x, y) == rgb(io::theme::text);
      return count;
    };
    EXPECT_GT(text_pixels(picture), 100 + text_pixels(other->draw(width, height))) << kind;
    for (int y = 0; y < height; y += 7)
      for (int x = 0; x < width; x += 7) panel->value_at(x, y);
  }
  // Tables and maps have values all the same.
  const auto link = memory.panel(csi, "link");
  link->draw(480, 300);
  EXPECT_EQ(link->value_at(5, 44), "delay spread: none\n[rx, tx] rms");
  const auto map = memory.panel(radar, "range-Doppler");
  map->draw(width, height);
  EXPECT_EQ(find_text(*map, "detection")[0], -1);
}

TEST(Panels, MetadataAreNotBelieved) {
  const auto message = [](uint32_t sensor, const char* kind, const char* metadata) {
    io::DatasetInfo wrong = info();
    wrong.sensors[sensor].metadata_json = metadata;
    Memory memory(wrong);
    memory.add(1);
    return error_of([&] {
      const auto panel = memory.panel(sensor, kind);
      panel->draw(width, height);
      if (!panel->error().empty()) throw_user_error("{}", panel->error());
    });
  };
  EXPECT_THAT(message(events, "time surface", R"({"height": 6})"), HasSubstr("uav/events: metadata"));
  EXPECT_THAT(message(events, "time surface", R"({"width": 16000, "height": 16000})"),
              HasSubstr("16000 x 16000"));
  EXPECT_THAT(message(events, "time surface", R"({"width": 4, "height": 6})"), HasSubstr("outside of 4 x 6"));
  EXPECT_THAT(message(events, "events", R"({"width": 4, "height": 6})"), HasSubstr("outside of 4 x 6"));
  EXPECT_THAT(message(events, "events", "{}"), HasSubstr("do not say how to draw events"));
  EXPECT_THAT(message(lidar, "range image", R"({"pattern": "spinning"})"), HasSubstr("azimuth_steps"));
  EXPECT_THAT(message(lidar, "range image",
                      R"({"pattern": "spinning", "azimuth_steps": 9, "azimuth_start_deg": 0,
                          "azimuth_span_deg": 0, "elevations_deg": [1]})"),
              HasSubstr("ring: expected 0 to 0, found 2"));
  EXPECT_EQ(message(lidar, "range image", "{}"), "") << "over elevation";
  EXPECT_EQ(message(lidar, "range image",
                    R"({"pattern": "raster", "columns": 100000000, "rows": 65536, "azimuth_deg": [40, 40],
                        "elevation_deg": [10, -10]})"),
            "");
  EXPECT_THAT(message(radar, "range-Doppler", R"({"range_bin_m": -1})"), HasSubstr("range_bin_m"));
  EXPECT_THAT(message(csi, "arrivals", "{}"), "");
  EXPECT_THAT(message(csi, "|H| over frequency", R"({"subcarrier_spacing_hz": 0})"),
              HasSubstr("subcarrier_spacing_hz"));
}

TEST(Panels, NothingYet) {
  Memory memory;
  for (const PanelChoice& choice : panels_of(memory.history->sensors())) {
    const auto panel = make_panel(choice, memory.history);
    const Array before = panel->draw(width, height);
    panel->show(shown({0, 0, {}}));
    EXPECT_EQ(panel->draw(width, height).bytes, before.bytes) << choice.title;
    EXPECT_EQ(panel->value_at(200, 150), "");
    EXPECT_EQ(panel->error(), "");
  }
}

TEST(Panels, AnySizeCanBeDrawn) {
  Memory memory;
  for (int64_t tick = 0; tick < 3; ++tick) memory.add(tick);
  for (const PanelChoice& choice : panels_of(memory.history->sensors())) {
    const auto panel = make_panel(choice, memory.history);
    panel->show(memory.last);
    for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {1, 300}, {400, 1}, {17, 23}, {97, 61}, {210, 130}}) {
      ASSERT_THAT(panel->draw(w, h).shape, ElementsAre(h, w, 3)) << choice.title;
      EXPECT_EQ(panel->error(), "") << choice.title;
      for (int y = 0; y < h; y += 3)
        for (int x = 0; x < w; x += 3) panel->value_at(x, y);
    }
    EXPECT_THROW(panel->draw(0, 5), ContractError);
    EXPECT_THROW(panel->draw(5, 1 << 20), ContractError);
  }
}

TEST(Panels, ArePaintedOnlyWhenSomethingHasChanged) {
  Memory memory;
  memory.add(1);
  const auto panel = memory.panel(events, "time surface");
  panel->draw(width, height);
  EXPECT_EQ(panel->version(), 1u);
  panel->show(memory.last);
  panel->draw(width, height);
  EXPECT_EQ(panel->version(), 1u);
  panel->draw(width + 1, height);
  EXPECT_EQ(panel->version(), 2u);
  panel->set_knob("tau", 30.0);  // as it is
  panel->draw(width + 1, height);
  EXPECT_EQ(panel->version(), 2u);
  panel->set_knob("tau", 31.0);
  panel->draw(width + 1, height);
  EXPECT_EQ(panel->version(), 3u);
  // A tick at which the sensor was not due shows the same record.
  Packet packet = packet_of(2);
  std::erase_if(packet.records, [](const Record& record) { return record.sensor == events; });
  ShownTick later = shown(std::move(packet));
  later.newest.clear();
  memory.history->add(later);
  panel->show(later);
  panel->draw(width + 1, height);
  EXPECT_EQ(panel->version(), 3u);
  memory.add(3);
  panel->show(memory.last);
  panel->draw(width + 1, height);
  EXPECT_EQ(panel->version(), 4u);
}

TEST(Panels, MemoryAndDatasetGiveTheSamePictures) {
  const test::TemporaryFolder folder;
  const io::DatasetInfo of = info();
  Memory memory;
  {
    io::DatasetWriter writer(folder.path() / "set", of);
    writer.begin_sequence(0);
    for (int64_t tick = 0; tick < of.ticks_per_sequence; ++tick) {
      writer.write(packet_of(tick));
      memory.add(tick);
    }
    writer.end_sequence();
    writer.finish();
  }
  const auto reader = std::make_shared<io::DatasetReader>(folder.path() / "set");
  const ShownTick middle_tick = shown(packet_of(7));
  for (const PanelChoice& choice : panels_of(of.sensors)) {
    const auto live = make_panel(choice, memory.history), stored = make_panel(choice, reader);
    for (const ShownTick* tick : std::initializer_list<const ShownTick*>{&middle_tick, &memory.last}) {
      live->show(*tick);
      stored->show(*tick);
      EXPECT_EQ(live->draw(width, height).bytes, stored->draw(width, height).bytes) << choice.title;
      EXPECT_EQ(live->error() + stored->error(), "") << choice.title;
      for (int y = 0; y < height; y += 13)
        for (int x = 0; x < width; x += 13)
          ASSERT_EQ(live->value_at(x, y), stored->value_at(x, y)) << choice.title;
    }
  }
}

TEST(RecordHistory, HoldsAtMostSoManyBytes) {
  const auto of = std::make_shared<const io::DatasetInfo>(info());
  RecordHistory unbounded(of, "live");
  unbounded.add(shown(packet_of(0)));
  const uint64_t packet_bytes = unbounded.bytes();
  RecordHistory history(of, "live", 5 * packet_bytes);
  for (int64_t tick = 0; tick < 200; ++tick) {
    history.add(shown(packet_of(tick)));
    ASSERT_LE(history.bytes(), 5 * packet_bytes);
    ASSERT_GE(history.bytes(), std::min<uint64_t>(static_cast<uint64_t>(tick) + 1, 4) * packet_bytes);
    for (uint32_t s = 0; s < of->sensors.size(); ++s) {
      const std::vector<io::IndexRow> rows = history.records_of(0, s);
      ASSERT_EQ(rows.back().tick, tick) << "the newest one stays";
      for (size_t i = 1; i < rows.size(); ++i)
        ASSERT_EQ(rows[i].tick, rows[i - 1].tick + 1) << "the oldest ones go first";
    }
  }
  EXPECT_GT(history.records_of(0, poses).size(), history.records_of(0, camera).size())
      << "pictures do not push out what is small";
  const io::IndexRow gone{0, 0, camera, 0, 0};
  EXPECT_THAT(error_of([&] { history.load(0, gone, "rgb"); }),
              HasSubstr("live/sequence_0000/uav/cam, tick 0"));
}

TEST(RecordHistory, KeepsTheNewestHoweverLargeAndSharesIt) {
  const auto of = std::make_shared<const io::DatasetInfo>(info());
  RecordHistory history(of, "live", 10);
  for (int64_t tick = 0; tick < 5; ++tick) {
    const ShownTick now = shown(packet_of(tick));
    history.add(now);
    for (const auto& record : now.newest) EXPECT_EQ(record.use_count(), 2) << "no copy";
    for (uint32_t s = 0; s < of->sensors.size(); ++s) ASSERT_EQ(history.records_of(0, s).size(), 1u);
  }
  // The same tick again takes no more room; another sequence is another record.
  const uint64_t bytes = history.bytes();
  history.add(shown(packet_of(4)));
  EXPECT_EQ(history.bytes(), bytes);
  ShownTick other = shown(packet_of(4));
  other.sequence = 1;
  history.add(other);
  EXPECT_TRUE(history.records_of(0, camera).empty());
  EXPECT_EQ(history.records_of(1, camera).size(), 1u);
  // A packet alone will do.
  ShownTick alone;
  alone.packet = packet_of(6);
  RecordHistory fresh(of, "live");
  fresh.add(alone);
  EXPECT_EQ(fresh.load(0, fresh.records_of(0, poses)[0], "velocity").shape, (std::vector<int64_t>{2, 3}));
  ShownTick wrong;
  wrong.packet.records.push_back({99, 0, 0, 0, {}});
  EXPECT_THROW(fresh.add(wrong), ContractError);
}

TEST(RecordHistory, KeepsSoManyRecords) {
  io::DatasetInfo small = info();
  small.sensors = {small.sensors[poses]};
  RecordHistory history(std::make_shared<const io::DatasetInfo>(small), "live");
  for (int64_t tick = 0; tick < 5000; ++tick) {
    ShownTick now;
    now.packet = {tick, tick, {}};
    now.packet.records.push_back(
        {0,
         tick,
         tick,
         tick,
         {Array(DType::f64, {2, 3}), Array(DType::f64, {2, 4}), Array(DType::f64, {2, 3})}});
    history.add(now);
  }
  EXPECT_EQ(history.records_of(0, 0).size(), RecordHistory::most_records);
  EXPECT_EQ(history.records_of(0, 0).front().tick, 5000 - static_cast<int64_t>(RecordHistory::most_records));
}

}  // namespace
}  // namespace greatx::view
