// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses the arrays of a sensor that a compressed data set keeps in an HDF5 file.
#pragma once

#include "core/record.h"

namespace greatx::sim {

/// The output that holds the packed arrays of a sensor: NODE/SENSOR/records.h5.
inline constexpr const char* packed_output = "records";

/// Moves the large arrays that the sensor keeps as NumPy files to one output hdf5_records. Large are arrays
/// of events, of LiDAR returns, and those whose records have a fixed size of 4 KiB or more. Poses, channels,
/// boxes, detections and cubes of samples stay in files that can be memory-mapped; pictures and clouds stay
/// what they are.
void pack_outputs(SensorSpec& sensor);

}  // namespace greatx::sim
