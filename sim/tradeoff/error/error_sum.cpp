// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/error/error_sum.h"

#include "sim/tradeoff/error/samples.h"

namespace greatx::sim {

bool relative_db(std::string_view figure) { return figure == "nmse" || figure == "map"; }

const Array* array_of(const SensorSpec& spec, const Record& record, std::string_view name) {
  for (size_t i = 0; i < spec.arrays.size() && i < record.arrays.size(); ++i)
    if (spec.arrays[i].name == name) return &record.arrays[i];
  return nullptr;
}

std::unique_ptr<ErrorSum> make_error_sum(const std::string& kind) {
  static constexpr struct {
    const char* kind;
    std::unique_ptr<ErrorSum> (*make)();
  } rows[] = {{"csi", make_csi_error},     {"camera", make_camera_error}, {"event_camera", make_event_error},
              {"lidar", make_lidar_error}, {"radar", make_radar_error},   {"map", make_map_error}};
  for (const auto& row : rows)
    if (kind == row.kind) return row.make();
  return nullptr;
}

}  // namespace greatx::sim
