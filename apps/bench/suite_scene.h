// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the scenes of `greatx bench --suite` in memory: ground, boxes, bodies that move, lamps.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"

namespace greatx::apps {

struct SuiteSceneSize {
  uint64_t triangles = 10'000;  ///< of the static world, 100 or more
  uint32_t bodies = 0;          ///< moving boxes of 12 triangles each
  uint32_t lamps = 0;
};

/// Holds a scene and what the passes need to know of it. With n times as many triangles, the side of the
/// square grows with the fourth root of n, and so does the number of triangles along a metre: both the extent
/// and the detail grow.
struct SuiteScene {
  scene::Scene scene;
  double side_m = 0.0;  ///< edge of the square of ground, whose centre is the local origin
  double cell_m = 0.0;  ///< edge of the cell of a box
  dvec3 mast{0.0};      ///< a place above most boxes, from which sensors look and transmitters send
};

/// Makes a scene of exactly `size.triangles` static triangles. Equal sizes give equal scenes, on every
/// machine.
SuiteScene make_suite_scene(const SuiteSceneSize& size);

/// Returns the poses of all bodies in round `round`: each one goes around its place on a circle.
std::vector<Pose> suite_poses(const SuiteScene& scene, uint32_t round);

/// Returns an estimate of the memory that a suite of `triangles` needs at its peak: for the scene, the
/// passes, and for each of `tracers` the copy on the device with its tree.
uint64_t suite_bytes(uint64_t triangles, size_t tracers);
/// Returns an estimate of the memory that whole ticks need beside the scene: another copy of it, its surfaces
/// prepared for radar and channel, and the copy on the device.
uint64_t suite_tick_bytes(uint64_t triangles);

}  // namespace greatx::apps
