// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs one LiDAR sweep over a scene of a few triangles.
#pragma once

#include <cmath>
#include <vector>

#include "core/units.h"
#include "renderer/lidar/lidar_pass.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::test {

struct Sweep {
  render::LidarScan scan;
  std::vector<float> ranges;
};

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
  return {pass.collect(pending, noise), pass.collect_ranges(pending)};
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
