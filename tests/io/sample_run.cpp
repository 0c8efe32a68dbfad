// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/io/sample_run.h"

#include <limits>

#include "core/random.h"
#include "io/files/file.h"

namespace greatx::io {

namespace {

constexpr int64_t width = 24, height = 16, nodes = 2;
constexpr double sample_step_m = 0.005;
const std::vector<int64_t> cfr_shape{1, 2, 1, 4, 1, 8};

SensorSpec camera() {
  return {"uav/cam",
          "camera",
          "30",
          {{"rgb", DType::u8, {height, width, 3}, "1", "8-bit sRGB"},
           {"depth", DType::f32, {height, width}, "m", "planar, sky = +inf"},
           {"instance", DType::u32, {height, width}, "1", "instance ids"},
           {"radiance", DType::f32, {height, width, 3}, "1", "linear"}},
          {{"rgb", FileFormat::png, {"rgb"}},
           {"depth24", FileFormat::png_depth24, {"depth"}},
           {"depth", FileFormat::exr, {"depth"}},
           {"instance", FileFormat::png, {"instance"}},
           {"radiance", FileFormat::exr, {"radiance"}}},
          R"({"fx": 20.0, "fy": 20.0})"};
}

SensorSpec lidar() {
  return {"uav/lidar",
          "lidar",
          "20",
          {{"points", DType::f32, {-1, 4}, "m", "x, y, z, intensity"},
           {"ring", DType::u16, {-1}, "1", "channel"},
           {"time", DType::f32, {-1}, "s", "offset"}},
          {{"cloud", FileFormat::ply, {"points", "ring", "time"}},
           {"pcd", FileFormat::pcd, {"points", "ring", "time"}},
           {"velodyne", FileFormat::kitti, {"points"}},
           {"ring", FileFormat::npy_ragged, {"ring"}}},
          "{}"};
}

SensorSpec csi() {
  return {"bs/csi",
          "csi",
          "100",
          {{"cfr", DType::complex64, cfr_shape, "1", "[rx, rx_ant, tx, tx_ant, time, subcarrier]"},
           {"delay", DType::f64, {-1}, "s", "[path]"},
           {"vertices", DType::f32, {-1, 3, 3}, "m", "[path, vertex, 3]"},
           {"loss", DType::f64, {}, "dB", "a scalar"}},
          {{"cfr", FileFormat::npy_stack, {"cfr"}},
           {"delay", FileFormat::npy_ragged, {"delay"}},
           {"vertices", FileFormat::npy_ragged, {"vertices"}},
           {"loss", FileFormat::npy_frame, {"loss"}}},
          R"({"carrier_hz": 3.5e9, "subcarrier_spacing_hz": 30e3})"};
}

SensorSpec poses() {
  return {"poses",
          "pose",
          "1000",
          {{"position", DType::f64, {nodes, 3}, "m", "[node, 3]"},
           {"orientation", DType::f64, {nodes, 4}, "1", ""}},
          {{"position", FileFormat::npy_stack, {"position"}},
           {"orientation", FileFormat::npy_stack, {"orientation"}}},
          R"({"nodes": ["bs", "uav"]})"};
}

SensorSpec packed() {
  return {"uav/packed",
          "packed",
          "50",
          {{"t", DType::i64, {-1}, "ns", "[event]"},
           {"x", DType::u16, {-1}, "1", "[event]"},
           {"y", DType::u16, {-1}, "1", "[event]"},
           {"p", DType::u8, {-1}, "1", "[event]"},
           {"points", DType::f32, {-1, 4}, "m", "[return, x y z intensity]", sample_step_m},
           {"map", DType::f32, {6, 5}, "W", "[range, velocity]"}},
          {{"records", FileFormat::hdf5_records, {"t", "x", "y", "p", "points", "map"}},
           {"events", FileFormat::hdf5_events, {"t", "x", "y", "p"}},
           {"events_text", FileFormat::text_events, {"t", "x", "y", "p"}}},
          "{}"};
}

std::vector<Array> camera_arrays(RandomStream random) {
  Array rgb(DType::u8, {height, width, 3}), depth(DType::f32, {height, width}),
      ids(DType::u32, {height, width}), radiance(DType::f32, {height, width, 3});
  for (uint8_t& value : rgb.as<uint8_t>()) value = static_cast<uint8_t>(random.below(256));
  for (float& value : depth.as<float>()) value = static_cast<float>(random.uniform(1.0, 900.0));
  for (size_t i = 0; i < 2 * width; ++i) depth.as<float>()[i] = std::numeric_limits<float>::infinity();
  for (uint32_t& value : ids.as<uint32_t>()) value = random.below(300);
  for (float& value : radiance.as<float>()) value = static_cast<float>(random.uniform());
  return {rgb, depth, ids, radiance};
}

std::vector<Array> lidar_arrays(RandomStream random) {
  const int64_t count = random.below(40);  // may be 0
  Array points(DType::f32, {count, 4}), ring(DType::u16, {count}), time(DType::f32, {count});
  for (float& value : points.as<float>()) value = static_cast<float>(random.uniform(-50.0, 50.0));
  for (uint16_t& value : ring.as<uint16_t>()) value = static_cast<uint16_t>(random.below(64));
  for (float& value : time.as<float>()) value = static_cast<float>(random.uniform(0.0, 0.05));
  return {points, ring, time};
}

std::vector<Array> csi_arrays(RandomStream random, uint32_t sequence, int64_t sample) {
  Array cfr(DType::complex64, cfr_shape);
  const auto values = cfr.as<std::complex<float>>();
  for (size_t i = 0; i < values.size(); ++i) values[i] = sample_cfr(sequence, sample, i);
  const int64_t paths = random.below(4);
  Array delay(DType::f64, {paths}), vertices(DType::f32, {paths, 3, 3}), loss(DType::f64, {});
  for (double& value : delay.as<double>()) value = random.uniform(1e-8, 1e-6);
  for (float& value : vertices.as<float>()) value = static_cast<float>(random.uniform(0.0, 100.0));
  loss.as<double>()[0] = random.uniform(60.0, 120.0);
  return {cfr, delay, vertices, loss};
}

std::vector<Array> pose_arrays(RandomStream random) {
  Array position(DType::f64, {nodes, 3}), orientation(DType::f64, {nodes, 4});
  for (double& value : position.as<double>()) value = random.uniform(-10.0, 10.0);
  for (double& value : orientation.as<double>()) value = random.uniform();
  return {position, orientation};
}

std::vector<Array> packed_arrays(RandomStream random) {
  const int64_t events = random.below(3) == 0 ? 0 : random.below(900), returns = random.below(30);
  Array t(DType::i64, {events}), x(DType::u16, {events}), y(DType::u16, {events}), p(DType::u8, {events}),
      points(DType::f32, {returns, 4}), map(DType::f32, {6, 5});
  int64_t time_ns = random.below(1000);
  for (int64_t& value : t.as<int64_t>()) value = time_ns += random.below(5000);
  for (uint16_t& value : x.as<uint16_t>()) value = static_cast<uint16_t>(random.below(640));
  for (uint16_t& value : y.as<uint16_t>()) value = static_cast<uint16_t>(random.below(480));
  for (uint8_t& value : p.as<uint8_t>()) value = static_cast<uint8_t>(random.below(2));
  for (float& value : points.as<float>()) {
    const auto steps = static_cast<int32_t>(random.below(60000)) - 30000;
    value = static_cast<float>(sample_step_m * steps);
  }
  for (float& value : map.as<float>()) value = static_cast<float>(random.uniform());
  return {t, x, y, p, points, map};
}

}  // namespace

DatasetInfo sample_info() {
  DatasetInfo info;
  info.run_json = R"({"scenario": "sample", "seed": 7, "scene_sha256": "00ff"})";
  info.scenario_text = "name: sample\n";
  info.run_key = "key";
  info.tick_rate = "1000";
  info.sensors = {camera(), lidar(), csi(), poses(), packed()};
  info.sequences = 2;
  info.ticks_per_sequence = 70;
  return info;
}

std::complex<float> sample_cfr(uint32_t sequence, int64_t sample, size_t element) {
  return {static_cast<float>(sequence + sample), -static_cast<float>(element)};
}

Packet sample_packet(const DatasetInfo& info, uint32_t sequence, int64_t tick) {
  Packet packet{tick, tick * 1'000'000, {}};
  for (uint32_t s = 0; s < info.sensors.size(); ++s) {
    const SampleClock clock(info.tick_rate, info.sensors[s].rate);
    const int64_t sample = clock.samples_before(tick);
    if (clock.tick_of(sample) != tick) continue;
    const RandomStream random(7, s, sequence * 100000 + static_cast<uint32_t>(tick));
    std::vector<Array> arrays = s == 0   ? camera_arrays(random)
                                : s == 1 ? lidar_arrays(random)
                                : s == 2 ? csi_arrays(random, sequence, sample)
                                : s == 3 ? pose_arrays(random)
                                         : packed_arrays(random);
    packet.records.push_back({s, tick, packet.time_ns, sample, std::move(arrays)});
  }
  return packet;
}

bool write_sample_run(DatasetWriter& writer, const DatasetInfo& info, int64_t packets) {
  auto [sequence, tick, finished] = writer.resume_position();
  for (; sequence < info.sequences; ++sequence, tick = 0) {
    writer.begin_sequence(sequence);
    for (; tick < info.ticks_per_sequence; ++tick) {
      writer.write(sample_packet(info, sequence, tick));
      if (packets > 0 && --packets == 0) return false;
    }
    writer.end_sequence();
  }
  writer.finish();
  return true;
}

std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), folder).string()] = read_text_file(entry.path());
  }
  return files;
}

}  // namespace greatx::io
