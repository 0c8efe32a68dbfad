// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Turns the echoes of a beam's rays into the returns that a LiDAR delivers. The code is plain arithmetic.
//
//   echoes of a shot ─► pulses (echoes that the receiver cannot tell apart) ─► detection, noise of the range
//     ─► chosen returns
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/lidar/scan/receiver.h"
#include "renderer/lidar/scan/scan_pattern.h"
#include "shaders/shared/lidar.h"

namespace greatx::render {

/// Selects the delivered returns of a shot. `dual` delivers the strongest and the last. Where they are the
/// same return, it delivers the second strongest as well (Velodyne VLP-16 User Manual, "Dual return mode").
enum class ReturnMode : uint32_t { strongest, last, dual, all };

struct ReturnChoice {
  ReturnMode mode = ReturnMode::strongest;
  uint32_t most = 15;         ///< for `all`: the nearest ones
  double resolution_m = 0.3;  ///< echoes whose ranges differ by less follow each other in one pulse
};

/// Holds the echoes that the GPU delivers, where they lie: [slots][shots][sub-rays].
struct EchoView {
  std::span<const shared::LidarEcho> echoes;
  uint32_t shots = 0, sub_rays = 1, slots = 1;
  const shared::LidarEcho& at(uint32_t shot, uint32_t ray, uint32_t slot) const {
    return echoes[(size_t{slot} * shots + shot) * sub_rays + ray];
  }
};

/// Holds one sweep. Returns are in the order in which the shots were fired, and within a shot by range. All
/// arrays have `size()` elements.
struct LidarScan {
  std::vector<vec4> points;    ///< x, y, z: metres in the sensor frame AT THE SHOT'S OWN TIME; w: intensity
  std::vector<uint32_t> shot;  ///< index into the pattern
  std::vector<uint16_t> ring;  ///< channel
  std::vector<float> time_offset_s;     ///< time of the shot after the tick
  std::vector<float> range_m;           ///< along the beam's axis
  std::vector<float> power;             ///< received over transmitted power
  std::vector<float> share;             ///< share of the beam's energy that goes no further
  std::vector<uint16_t> return_number;  ///< 1 for the shot's nearest detected return
  std::vector<uint16_t> return_count;   ///< detected returns of the shot, delivered or not
  std::vector<uint32_t> instance;       ///< index into Scene::instances + 1; 0: fog or rain
  std::vector<uint32_t> material;       ///< index into Scene::materials + 1; 0: fog or rain
  size_t size() const { return points.size(); }
};

/// A pulse is a series of echoes in order of range, each less than resolution_m behind the one before. Its
/// range is the mean of theirs by received power. Its intensity is the sum of weight times intensity times
/// the transmittance of the air. Its share is the sum of weight times share. Its ids are those of the
/// strongest object in it.
struct Pulse {
  double range_m = 0.0, intensity = 0.0, power = 0.0, share = 0.0;
  uint32_t instance = 0, material = 0;
};

/// Holds one weighted echo of one ray.
struct WeightedEcho {
  double range_m, weight, intensity, share;
  uint32_t instance, material;
};
/// Returns the pulses of a shot. `echoes` may be in any order; they are sorted.
std::vector<Pulse> pulses_of(std::vector<WeightedEcho>& echoes, const Receiver& receiver,
                             double resolution_m);

/// Holds the data with which the echoes of a sweep are read.
struct ReturnModel {
  std::vector<float> weights;  ///< [sub-rays] sum 1
  Receiver receiver;
  ReturnChoice choice;
  double min_range_m = 0.5, max_range_m = 120.0;  ///< limits of the beam, for backscatter of the air
};

/// Makes the sweep. The bytes depend on nothing but the arguments.
LidarScan make_scan(const ScanPattern& pattern, const EchoView& echoes, const ReturnModel& model,
                    const ShotNoise& noise);

}  // namespace greatx::render
