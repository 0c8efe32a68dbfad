// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A small data set whose every value has a closed form, and a reader of reports that shares no code with the
// one that writes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/vec.h"
#include "io/dataset/dataset_writer.h"

namespace greatx::io {

inline constexpr int64_t run_width = 64, run_height = 48, run_ticks = 40;
inline constexpr double run_focal = 40.0;

/// Describes the run: "node/eye" is a camera with a lens, "node/lidar" a LiDAR at a quarter of its rate,
/// "node/radar" a radar, "csi" a channel with one path of one reflection, "poses" two nodes. `name` is used
/// for the node, the scenario, the instance and the material.
DatasetInfo report_info(const std::string& name, uint32_t sequences = 1);
Packet report_packet(const DatasetInfo& info, uint32_t sequence, int64_t tick);
void write_report_run(const std::filesystem::path& folder, const DatasetInfo& info, int64_t packets = 0);

/// The pose of the camera at a tick, and the pixel at which it must see the path's vertex there.
Pose run_camera(int64_t tick);
dvec2 run_pixel(int64_t tick);
/// The vertex: the point at 30 m of depth behind run_pixel(), found by inverting the lens.
dvec3 run_vertex(int64_t tick);
/// Brown-Conrady's k1, k2, p1, p2, k3 of the camera.
inline constexpr double run_lens[5] = {-0.2, 0.03, 0.002, -0.001, 0.004};
/// Values of pixel, point or cell i at a tick.
float run_depth(int64_t tick, size_t i);
vec4 run_point(int64_t tick, size_t i);
float run_power(int64_t tick, size_t i);
std::complex<float> run_response(int64_t tick, size_t port, size_t subcarrier);

/// A report as a browser sees it.
struct ReadReport {
  explicit ReadReport(std::string html);
  /// The integers of a packed blob.
  std::vector<uint32_t> numbers(size_t blob, int bytes, size_t row, size_t count) const;
  /// The JSON of a packed text.
  nlohmann::json text(size_t blob) const;
  Bytes raw(size_t blob) const;
  const nlohmann::json& sensor(const std::string& name, size_t sequence = 0) const;

  std::string html;
  nlohmann::json data;
};

}  // namespace greatx::io
