// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs one LiDAR sweep over a scene of a few triangles.
#pragma once

#include <cmath>
#include <vector>

#include "core/units.h"
#include "renderer/lidar/lidar_pass.h"
#include "renderer/lidar/scan/footprint.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::test {

struct Sweep {
  render::LidarScan scan;
  std::vector<float> ranges;
};

/// Returns the ranges of the beams' axes as an image, f32 [rows, columns] in metres; +inf where nothing was
/// met.
inline std::vector<float> ranges_of(const render::LidarPass& pass,
                                    const render::LidarPass::Pending& pending) {
  const render::ScanPattern& pattern = *pending.pattern;
  const size_t rays = render::sub_rays(pass.desc().divergence, pass.desc().rings).size();
  const render::EchoView echoes{pending.echoes.as<shared::LidarEcho>(), static_cast<uint32_t>(pattern.size()),
                                static_cast<uint32_t>(rays)};
  std::vector<float> image(pattern.size());
  for (uint32_t row = 0; row < pattern.rows; ++row)
    for (uint32_t column = 0; column < pattern.columns; ++column)
      image[size_t{row} * pattern.columns + column] = echoes.at(column * pattern.rows + row, 0, 0).range;
  return image;
}

inline Sweep sweep(const scene::Scene& scene, const render::LidarDesc& desc, std::span<const Pose> sensor,
                   const std::vector<Pose>& bodies = {Pose{}}, const render::LidarTargets& targets = {},
                   const render::ShotNoise& noise = {}) {
  scene::GpuScene gpu_scene(device(), scene, {});
  render::LidarPass pass(gpu_scene, desc);
  gpu::TickRing ring(device(), 1, 1u << 16, 1u << 16);
  gpu::TickSlot& slot = ring.begin();
  gpu_scene.record_update(slot, bodies);
  const render::LidarPass::Pending pending = pass.record(slot, sensor, targets);
  ring.submit(slot);
  ring.wait(slot);
  return {pass.collect(pending, noise), ranges_of(pass, pending)};
}

/// Returns a scan of five channels from -20 to 20 degrees of elevation.
inline render::SpinningScan small_scan() {
  render::SpinningScan scan;
  for (int i = 0; i < 5; ++i) scan.elevations.push_back(radians(-20.0 + 10.0 * i));
  scan.azimuth_steps = 41;
  scan.azimuth_start = radians(-40.0);
  scan.azimuth_span = radians(82.0);
  return scan;
}

/// Returns a LiDAR with one shot along each of the directions.
inline render::LidarDesc lidar_along(const std::vector<dvec3>& directions) {
  render::LidarDesc desc;
  desc.pattern.columns = static_cast<uint32_t>(directions.size());
  desc.pattern.directions = directions;
  desc.pattern.rings.assign(directions.size(), 0);
  desc.pattern.instants.assign(directions.size(), 0);
  desc.pattern.times_s = {0.0};
  return desc;
}

/// Returns a wall across the x axis at x = `distance`, 200 m wide. The caller may add further objects.
inline TinyScene wall(double distance, float reflectance = 0.8f) {
  TinyScene tiny;
  tiny.object("wall", 0, tiny.material("paint", reflectance))
      .quad({distance, 100, -100}, {distance, -100, -100}, {distance, -100, 100}, {distance, 100, 100});
  return tiny;
}

}  // namespace greatx::test
