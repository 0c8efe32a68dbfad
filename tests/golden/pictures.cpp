// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/golden/pictures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "core/units.h"
#include "io/panels.h"

namespace greatx::test {

namespace {

constexpr int64_t lidar_rings = 32, lidar_steps = 256;  // day.yaml's

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
  const Array& found = get(array.c_str());
  if (array == "depth") return coded<uint16_t>(found.shape, found.as<float>(), centimetres);
  if (array == "flow") return flow_picture(found);
  if (array == "normals")
    return coded<uint8_t>(found.shape, found.as<float>(),
                          [](float n) { return static_cast<uint8_t>(std::lround(127.5f * (1.0f + n))); });
  return found;
}

}  // namespace greatx::test
