// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/dataset/packed_outputs.h"

#include <algorithm>

#include "io/dataset/dataset_format.h"

namespace greatx::sim {

namespace {

constexpr uint64_t least_bytes = 4096;

bool is_packed_output(const SensorSpec& sensor, const OutputSpec& output) {
  const bool numpy = io::is_stack(output.format) || output.format == FileFormat::npy_frame;
  if (!numpy) return false;
  const ArraySpec& array = sensor.arrays[io::arrays_of(sensor, output)[0]];
  if (array.dtype == DType::complex64) return false;
  if (!array.shape.empty() && array.shape[0] < 0)
    return sensor.kind == "event_camera" || sensor.kind == "lidar";
  return sensor.kind != "csi" && sensor.kind != "pose" && io::stack_row_bytes(array) >= least_bytes;
}

}  // namespace

void pack_outputs(SensorSpec& sensor) {
  OutputSpec packed{packed_output, FileFormat::hdf5_records, {}};
  std::vector<OutputSpec> kept;
  size_t place = 0;  // of the first that is packed
  for (OutputSpec& output : sensor.outputs) {
    if (!is_packed_output(sensor, output)) {
      kept.push_back(std::move(output));
      continue;
    }
    if (packed.arrays.empty()) place = kept.size();
    packed.arrays.push_back(output.arrays[0]);
  }
  if (!packed.arrays.empty()) kept.insert(kept.begin() + static_cast<ptrdiff_t>(place), std::move(packed));
  sensor.outputs = std::move(kept);
}

}  // namespace greatx::sim
