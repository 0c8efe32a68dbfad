// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/golden/pictures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "core/units.h"
#include "core/vec.h"
#include "draw/canvas/canvas.h"
#include "draw/sheet/panels.h"

namespace greatx::test {

namespace {

constexpr int64_t lidar_rings = 32, lidar_steps = 256;           // those of day.yaml
constexpr double focal_px = 80.0, center_u = 80, center_v = 60;  // intrinsics of its cameras

uint16_t centimetres(float metres) {
  return static_cast<uint16_t>(std::lround(std::min(100.0f * metres, 65535.0f)));
}

template <typename T>
Array coded(std::vector<int64_t> shape, std::span<const float> values, T (*code)(float)) {
  Array picture(DTypeOf<T>::value, std::move(shape));
  std::transform(values.begin(), values.end(), picture.as<T>().begin(), code);
  return picture;
}

Array flow_picture(const Array& flow) {
  const int64_t height = flow.shape[0], width = flow.shape[1];
  Array picture(DType::u16, {2 * height, width});
  const size_t pixels = static_cast<size_t>(height * width);
  for (size_t i = 0; i < 2 * pixels; ++i) {
    const float value = flow.as<float>()[i];
    const float code = std::clamp(32768.0f + 64.0f * value, 1.0f, 65535.0f);
    picture.as<uint16_t>()[i % 2 * pixels + i / 2] =
        std::isfinite(value) ? static_cast<uint16_t>(std::lround(code)) : uint16_t{0};
  }
  return picture;
}

/// Codes a luminance with 128 codes per factor of two, starting at 2^-30 cd/m^2.
uint16_t stops(float radiance) {
  if (!(radiance > 0.0f)) return 0;
  return static_cast<uint16_t>(std::lround(std::clamp(128.0 * (30.0 + std::log2(radiance)), 1.0, 65535.0)));
}

/// Takes every second pixel of every second row, so that the file is as small as the others.
Array radiance_picture(const Array& hdr) {
  const int64_t height = hdr.shape[0] / 2, width = hdr.shape[1] / 2;
  Array picture(DType::u16, {3 * height, width});
  uint16_t* to = picture.as<uint16_t>().data();
  for (int64_t channel = 0; channel < 3; ++channel)
    for (int64_t row = 0; row < height; ++row)
      for (int64_t column = 0; column < width; ++column)
        *to++ = stops(hdr.as<float>()[static_cast<size_t>((4 * row * width + 2 * column) * 3 + channel)]);
  return picture;
}

/// Draws the twelve edges of a box, except edges that reach behind the camera.
void draw_edges(io::Canvas& canvas, const Pose& sensor_from_box, const float* size, io::Color color) {
  const auto corner = [&](int bits) {
    const dvec3 side((bits & 1) - 0.5, (bits >> 1 & 1) - 0.5, (bits >> 2) - 0.5);
    return sensor_from_box.apply(side * dvec3(size[0], size[1], size[2]));
  };
  const auto pixel = [](const dvec3& p) {
    return 2.0 * dvec2(center_u - focal_px * p.y / p.x, center_v - focal_px * p.z / p.x);
  };
  for (int from = 0; from < 8; ++from)
    for (const int axis : {1, 2, 4}) {
      const dvec3 a = corner(from), b = corner(from | axis);
      if ((from & axis) != 0 || std::min(a.x, b.x) < 0.1) continue;
      canvas.line(pixel(a).x, pixel(a).y, pixel(b).x, pixel(b).y, 1.0, color);
    }
}

/// Draws the boxes at twice the resolution of the camera.
template <typename Get>
Array boxes_picture(const Get& get) {
  const Array& rgb = get("rgb");  // for the size
  io::Canvas canvas(static_cast<int>(2 * rgb.shape[1]), static_cast<int>(2 * rgb.shape[0]),
                    io::Color{0, 0, 0});
  const auto id = get("box_instance").template as<uint32_t>();
  const auto size = get("box_size").template as<float>(),
             visibility = get("box_visibility").template as<float>(),
             amodal = get("box_amodal").template as<float>();
  const auto modal = get("box_modal").template as<int32_t>();
  const auto center = get("box_sensor_center").template as<double>(),
             orientation = get("box_sensor_orientation").template as<double>();
  const auto rectangle = [](const auto* r) {
    const auto at = [&](int i) { return static_cast<int>(std::lround(2.0 * r[i])); };
    return io::Rect{at(0), at(1), at(2) - at(0), at(3) - at(1)};
  };
  for (size_t i = 0; i < id.size(); ++i) {
    const io::Color color = io::color_of_id(id[i]);
    canvas.fill(rectangle(&modal[4 * i]), color, 0.6 * double{visibility[i]});
    canvas.frame(rectangle(&amodal[4 * i]), color);
    const double *const c = &center[3 * i], *const q = &orientation[4 * i];
    draw_edges(canvas, {{c[0], c[1], c[2]}, {q[0], q[1], q[2], q[3]}}, &size[3 * i], color);
  }
  return canvas.image();
}

Array range_picture(const Array& points, const Array& rings, const Array& ranges) {
  Array picture(DType::u16, {lidar_rings, lidar_steps});
  for (size_t i = 0; i < ranges.as<float>().size(); ++i) {
    const float* const p = points.as<float>().data() + 4 * i;
    const double turns = std::atan2(p[1], p[0]) / (2.0 * pi);
    const auto step = (std::lround(turns * lidar_steps) + lidar_steps) % lidar_steps;
    picture.as<uint16_t>()[static_cast<size_t>(rings.as<uint16_t>()[i] * lidar_steps + step)] =
        centimetres(ranges.as<float>()[i]);
  }
  return picture;
}

}  // namespace

Array picture_of(const KeptRun& run, int64_t tick, const std::string& sensor, const std::string& array) {
  const auto at = std::ranges::find(run.packets, tick, &Packet::tick);
  if (at == run.packets.end()) throw std::runtime_error("no packet at tick " + std::to_string(tick));
  const auto packet = static_cast<size_t>(at - run.packets.begin());
  const auto get = [&](const char* name) -> const Array& { return run.array(packet, sensor, name); };
  if (array == "events") {
    const Array& differences = get("difference_picture");  // for the size
    return io::event_picture(get("x").as<uint16_t>(), get("y").as<uint16_t>(), get("p").as<uint8_t>(),
                             differences.shape[1], differences.shape[0]);
  }
  if (array == "range") return range_picture(get("points"), get("ring"), get("range"));
  if (array == "boxes") return boxes_picture(get);
  const Array& found = get(array.c_str());
  if (array == "hdr") return radiance_picture(found);
  if (array == "depth" || array == "depth_ray")
    return coded<uint16_t>(found.shape, found.as<float>(), centimetres);
  if (array == "flow") return flow_picture(found);
  if (array == "normals")
    return coded<uint8_t>(found.shape, found.as<float>(),
                          [](float n) { return static_cast<uint8_t>(std::lround(127.5f * (1.0f + n))); });
  return found;
}

}  // namespace greatx::test
