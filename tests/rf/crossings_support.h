// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs one batch of segments through the crossing pass.
#pragma once

#include <span>
#include <vector>

#include "rf/paths/crossings.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::test {

inline std::vector<rf::Crossing> cross(const scene::Scene& scene, const rf::FacetKinds& kinds,
                                       std::span<const rf::Segment> segments,
                                       const std::vector<Pose>& bodies = {Pose{}},
                                       uint64_t part_bytes = uint64_t{128} << 20,
                                       uint64_t most_table_bytes = ~uint64_t{0}) {
  gpu::Device& gpu = device();
  scene::GpuScene gpu_scene(gpu, scene, {.most_table_bytes = most_table_bytes});
  rf::CrossingPass pass(gpu_scene, kinds, part_bytes);
  gpu::TickRing ring(gpu, 1, 1u << 16, 1u << 16);
  gpu::TickSlot& slot = ring.begin();
  gpu_scene.record_update(slot, bodies);
  const rf::CrossingPass::Pending pending = pass.record(slot, segments);
  ring.submit(slot);
  ring.wait(slot);
  rf::FacetWorld world(scene);
  for (uint32_t body = 1; body < bodies.size(); ++body) world.move(body, {bodies[body]});
  return pass.collect(pending, segments, world);
}

/// Returns a segment that may pass through `walls` walls.
inline rf::Segment segment(const dvec3& a, const dvec3& b, uint32_t walls = 0) {
  rf::Segment s;
  s.a = a;
  s.b = b;
  s.walls = walls;
  return s;
}

/// Returns the given kind for every facet of the scene.
inline rf::FacetKinds all_of(rf::FacetKind kind, const scene::Scene& scene) {
  return rf::FacetKinds(scene.facets.size(), kind);
}

}  // namespace greatx::test
