// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/draw/report_run.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <zlib.h>

namespace greatx::io {

namespace {

using Json = nlohmann::json;
constexpr size_t run_points = 500;
constexpr int64_t run_ranges = 40, run_velocities = 30, run_subcarriers = 32, run_ports = 3;

dquat turn_of(int64_t tick) {
  return orientation_from_yaw_pitch_roll(0.3 + 0.02 * static_cast<double>(tick), 0.1, -0.05);
}

/// x', y' of undistorted x, y.
dvec2 through_lens(const dvec2& u) {
  const auto [k1, k2, p1, p2, k3] =
      std::tuple(run_lens[0], run_lens[1], run_lens[2], run_lens[3], run_lens[4]);
  const double s = glm::dot(u, u), radial = 1.0 + k1 * s + k2 * s * s + k3 * s * s * s;
  return {u.x * radial + 2.0 * p1 * u.x * u.y + p2 * (s + 2.0 * u.x * u.x),
          u.y * radial + p1 * (s + 2.0 * u.y * u.y) + 2.0 * p2 * u.x * u.y};
}

std::vector<std::byte> base64_bytes(std::string_view text) {
  std::vector<std::byte> bytes;
  uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const uint32_t six = c >= 'A' && c <= 'Z'   ? c - 'A'
                         : c >= 'a' && c <= 'z' ? c - 'a' + 26
                         : c >= '0' && c <= '9' ? c - '0' + 52
                         : c == '+'             ? 62
                         : c == '/'             ? 63
                                                : throw std::runtime_error("not base64");
    word = word << 6 | six;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::byte>(word >> bits & 255u));
  }
  return bytes;
}

std::string unzipped(const Bytes& packed) {
  std::string out(1 << 24, '\0');
  uLongf size = out.size();
  if (uncompress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                 packed.size()) != Z_OK)
    throw std::runtime_error("not zlib");
  out.resize(size);
  return out;
}

SensorSpec stacked(std::string name, std::string kind, std::string rate, std::vector<ArraySpec> arrays,
                   const Json& metadata) {
  SensorSpec spec{std::move(name), std::move(kind), std::move(rate), std::move(arrays), {}, metadata.dump()};
  for (const ArraySpec& array : spec.arrays)
    spec.outputs.push_back(
        {array.name,
         !array.shape.empty() && array.shape[0] < 0 ? FileFormat::npy_ragged : FileFormat::npy_stack,
         {array.name}});
  return spec;
}

template <typename T>
Array array_of(std::vector<int64_t> shape, const std::vector<T>& values) {
  return Array::of<T>(std::move(shape), values);
}

}  // namespace

Pose run_camera(int64_t tick) {
  return Pose{{4.5e5 + 0.5 * static_cast<double>(tick), 5.4e6, 30.0}, turn_of(tick)} *
         Pose{{0.5, 0.1, -0.2}, orientation_from_yaw_pitch_roll(0.0, 0.2, 0.0)};
}
dvec2 run_pixel(int64_t tick) {
  return {10.0 + static_cast<double>(tick), 40.0 - 0.7 * static_cast<double>(tick)};
}
dvec3 run_vertex(int64_t tick) {
  const dvec2 seen = (run_pixel(tick) - dvec2(run_width, run_height) / 2.0) / run_focal;
  dvec2 u = seen;
  for (int i = 0; i < 200; ++i) u += seen - through_lens(u);  // a contraction for this lens
  // Optical axes: x right, y down, z forward; the sensor's: x forward, y left, z up.
  return run_camera(tick).apply(30.0 * dvec3(1.0, -u.x, -u.y));
}
float run_depth(int64_t tick, size_t i) {
  if (i % 50 == 7) return std::numeric_limits<float>::infinity();
  return 0.3f * std::pow(1.003f, static_cast<float>(i % 2900)) + 0.01f * static_cast<float>(tick);
}
vec4 run_point(int64_t tick, size_t i) {
  const float a = 0.1f * static_cast<float>(i),
              r = 3.0f + 0.3f * static_cast<float>(i + static_cast<size_t>(tick));
  return {r * std::cos(a), r * std::sin(a), 0.01f * static_cast<float>(i) - 2.0f,
          0.001f * static_cast<float>(1 + i)};
}
float run_power(int64_t tick, size_t i) {
  return 1e-16f * (1.0f + 0.5f * std::sin(static_cast<float>(i))) +
         (i == 300 + static_cast<size_t>(tick) ? 1e-9f : 0.0f);
}
std::complex<float> run_response(int64_t tick, size_t port, size_t k) {
  return 1e-4f * std::polar(1.0f / static_cast<float>(1 + port),
                            0.3f * static_cast<float>(k * (port + 1)) + static_cast<float>(tick));
}

DatasetInfo report_info(const std::string& name, uint32_t sequences) {
  const Json mount = {{"position_m", {0.5, 0.1, -0.2}},
                      {"orientation_wxyz", {std::cos(0.1), 0.0, std::sin(0.1), 0.0}}};
  DatasetInfo info;
  info.tick_rate = "100";
  info.sequences = sequences;
  info.ticks_per_sequence = run_ticks;
  info.scenario_text = "name: " + name + "\n# </script><script>alert(1)</script>\n";
  info.run_json = Json({{"scenario", name},
                        {"greatx", "0"},
                        {"effects", {{"fog", false}, {"gas", true}}},
                        {"instances", {{{"name", name}, {"class", name}, {"box_m", {{1, 2, 3}, {4, 5, 6}}}}}},
                        {"materials", {name}},
                        {"semantic_classes", {"none"}}})
                      .dump();
  info.sensors = {
      stacked("poses", "pose", "", {{"position", DType::f64, {2, 3}}, {"orientation", DType::f64, {2, 4}}},
              {{"nodes", {"node", "mast"}}}),
      stacked("node/eye", "camera", "100",
              {{"rgb", DType::u8, {run_height, run_width, 3}},
               {"depth", DType::f32, {run_height, run_width}},
               {"instance", DType::u32, {run_height, run_width}}},
              {{"fx", run_focal},
               {"fy", run_focal},
               {"cx", run_width / 2},
               {"cy", run_height / 2},
               {"width", run_width},
               {"height", run_height},
               {"body_from_sensor", mount},
               {"distortion",
                {{"k1", run_lens[0]},
                 {"k2", run_lens[1]},
                 {"p1", run_lens[2]},
                 {"p2", run_lens[3]},
                 {"k3", run_lens[4]}}}}),
      stacked("node/lidar", "lidar", "25", {{"points", DType::f32, {-1, 4}}, {"instance", DType::u32, {-1}}},
              Json::object()),
      stacked("node/radar", "radar", "50", {{"range_doppler", DType::f32, {run_ranges, run_velocities}}},
              {{"range_bin_m", 0.5}, {"velocity_min_m_s", -7.5}, {"velocity_bin_m_s", 0.5}}),
      stacked("csi", "csi", "50",
              {{"cfr", DType::complex64, {1, 1, 1, run_ports, 1, run_subcarriers}},
               {"path_gain", DType::f64, {1, 1}},
               {"rx", DType::i32, {-1}},
               {"tx", DType::i32, {-1}},
               {"delay", DType::f64, {-1}},
               {"amplitude", DType::complex64, {-1, 1, run_ports}},
               {"interaction", DType::u8, {-1, 2}},
               {"vertex", DType::f64, {-1, 2, 3}},
               {"object", DType::u32, {-1, 2}},
               {"object_material", DType::u32, {-1, 2}}},
              {{"non_finite", {"vertex"}},
               {"subcarrier_spacing_hz", 1e6},
               {"receivers", {{{"name", "node/antenna"}, {"ports", 1}}}},
               {"transmitters", {{{"name", "mast/panel"}, {"ports", run_ports}}}}})};
  return info;
}

Packet report_packet(const DatasetInfo& info, uint32_t, int64_t tick) {
  Packet packet{tick, tick * 10'000'000, {}};
  const auto add = [&](uint32_t sensor, int64_t every, std::vector<Array> arrays) {
    if (tick % every == 0)
      packet.records.push_back({sensor, tick, packet.time_ns, tick / every, std::move(arrays)});
  };
  const Pose body =
      run_camera(tick) * Pose{{0.5, 0.1, -0.2}, orientation_from_yaw_pitch_roll(0, 0.2, 0)}.inverse();
  const dquat q = body.orientation;
  add(0, 1,
      {array_of<double>({2, 3}, {body.position.x, body.position.y, body.position.z, 4.5e5, 5.4e6 + 9, 40.0}),
       array_of<double>({2, 4}, {q.w, q.x, q.y, q.z, 1.0, 0.0, 0.0, 0.0})});
  Array rgb(DType::u8, {run_height, run_width, 3}), depth(DType::f32, {run_height, run_width}),
      ids(DType::u32, {run_height, run_width});
  for (size_t i = 0; i < depth.as<float>().size(); ++i) {
    depth.as<float>()[i] = run_depth(tick, i);
    ids.as<uint32_t>()[i] = i % 3 == 0 ? 1 : 0;
    for (size_t c = 0; c < 3; ++c) rgb.as<uint8_t>()[3 * i + c] = static_cast<uint8_t>(i * (c + 1) + tick);
  }
  add(1, 1, {rgb, depth, ids});
  Array points(DType::f32, {run_points, 4}), hit(DType::u32, {run_points});
  for (size_t i = 0; i < run_points; ++i) {
    const vec4 p = run_point(tick, i);
    for (int c = 0; c < 4; ++c) points.as<float>()[4 * i + static_cast<size_t>(c)] = p[c];
    hit.as<uint32_t>()[i] = i % 2;
  }
  add(2, 4, {points, hit});
  Array map(DType::f32, {run_ranges, run_velocities});
  for (size_t i = 0; i < map.as<float>().size(); ++i) map.as<float>()[i] = run_power(tick, i);
  add(3, 2, {map});
  Array cfr(DType::complex64, {1, 1, 1, run_ports, 1, run_subcarriers});
  for (size_t i = 0; i < cfr.as<std::complex<float>>().size(); ++i)
    cfr.as<std::complex<float>>()[i] = run_response(tick, i / run_subcarriers, i % run_subcarriers);
  const dvec3 v = run_vertex(tick);
  const double none = std::numeric_limits<double>::quiet_NaN();
  add(4, 2,
      {cfr, array_of<double>({1, 1}, {1e-8}), array_of<int32_t>({1}, {0}), array_of<int32_t>({1}, {0}),
       array_of<double>({1}, {2e-7}),
       array_of<std::complex<float>>({1, 1, run_ports}, {{1e-4f, 0}, {0, 1e-4f}, {1e-4f, 0}}),
       array_of<uint8_t>({1, 2}, {1, 0}), array_of<double>({1, 2, 3}, {v.x, v.y, v.z, none, none, none}),
       array_of<uint32_t>({1, 2}, {1, 0}), array_of<uint32_t>({1, 2}, {1, 0})});
  (void)info;
  return packet;
}

void write_report_run(const std::filesystem::path& folder, const DatasetInfo& info, int64_t packets) {
  DatasetWriter writer(folder, info);
  for (uint32_t sequence = 0; sequence < info.sequences; ++sequence) {
    writer.begin_sequence(sequence);
    for (int64_t tick = 0; tick < info.ticks_per_sequence; ++tick) {
      writer.write(report_packet(info, sequence, tick));
      if (packets > 0 && --packets == 0) return;
    }
    writer.end_sequence();
  }
  writer.finish();
}

ReadReport::ReadReport(std::string text_of_page) : html(std::move(text_of_page)) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const size_t from = html.find(begin) + begin.size();
  data = Json::parse(html.substr(from, html.find("</script>", from) - from));
}

Bytes ReadReport::raw(size_t blob) const {
  const std::string begin = "<script type=\"text/plain\" id=\"b" + std::to_string(blob) + "\">";
  const size_t found = html.find(begin);
  if (found == std::string::npos) throw std::runtime_error("no blob " + std::to_string(blob));
  const size_t from = found + begin.size();
  return base64_bytes(std::string_view(html).substr(from, html.find("</script>", from) - from));
}

std::vector<uint32_t> ReadReport::numbers(size_t blob, int bytes, size_t row, size_t count) const {
  const std::string planes = unzipped(raw(blob));
  if (planes.size() != count * static_cast<size_t>(bytes)) throw std::runtime_error("a blob of another size");
  std::vector<uint32_t> values(count);
  const uint32_t mask = bytes == 4 ? 0xffffffffu : (1u << (8 * bytes)) - 1;
  for (size_t i = 0; i < count; ++i) {
    for (size_t b = 0; b < static_cast<size_t>(bytes); ++b)
      values[i] |= static_cast<uint32_t>(static_cast<unsigned char>(planes[b * count + i])) << (8 * b);
    if (row > 0 && i % row != 0) values[i] = (values[i] + values[i - 1]) & mask;
  }
  return values;
}

Json ReadReport::text(size_t blob) const { return Json::parse(unzipped(raw(blob))); }

const Json& ReadReport::sensor(const std::string& name, size_t sequence) const {
  for (const Json& entry : data.at("sequences").at(sequence).at("sensors"))
    if (entry.at("name") == name) return entry;
  throw std::runtime_error("no sensor " + name);
}

}  // namespace greatx::io
