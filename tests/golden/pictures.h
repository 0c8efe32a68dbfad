// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs of small scenarios, and their arrays as pictures that a PNG keeps.
#pragma once

#include <string>
#include <vector>

#include "core/record.h"

namespace greatx::test {

struct Outcome {
  std::vector<SensorSpec> sensors;
  std::vector<Packet> packets;
  /// Of the sensor's record at the tick. Throws std::runtime_error if there is none.
  const Array& array(int64_t tick, const std::string& sensor, const std::string& name) const;
};

/// `yaml`: a scenario, whole.
Outcome run_scenario(const std::string& yaml);

/// One array of a run as u8 [h, w, 3], u8 or u16 [h, w]:
///   rgb, instance, difference_picture   as they are
///   depth    cm, at most 65535 (sky)
///   normals  127.5 (1 + n)
///   flow     u above v, [2 h, w]: 32768 + 64 px, 0: out of sight (the coding of KITTI's flow pictures)
///   events   summed by pixel in colours (io::event_picture)
///   range    of a LiDAR, [ring, azimuth]: cm, 0: no return
Array picture_of(const Outcome& run, int64_t tick, const std::string& sensor, const std::string& array);

}  // namespace greatx::test
