// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Sends rays through shaders/tests/trace.comp.glsl, and makes the scenes that they meet.
#pragma once

#include <cmath>
#include <span>
#include <tuple>
#include <vector>

#include "core/random.h"
#include "gpu/tick_ring.h"
#include "scene/device/gpu_scene.h"
#include "shaders/tests/trace_test.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::test::tracing {

using shared::TraceTestRay;
using shared::TraceTestResult;
inline constexpr uint32_t none = shared::trace_test_none;

inline TraceTestRay ray(const dvec3& origin, const dvec3& direction, double t_max = 1e30) {
  return {vec3(origin), 0.0f, vec3(direction), static_cast<float>(t_max), none, none};
}

/// Makes a ray towards `target`, which is one unit of t away.
inline TraceTestRay ray_towards(const dvec3& origin, const dvec3& target) {
  return {vec3(origin), 0.0f, vec3(target) - vec3(origin), 1e30f, none, none};
}

/// Returns the tracers of the device, one of which may be missing.
inline std::vector<gpu::Tracer> tracers() {
  std::vector<gpu::Tracer> all{gpu::Tracer::tree};
  if (test::device().info().has_ray_query()) all.push_back(gpu::Tracer::driver);
  return all;
}

/// Defines a test that runs once with each tracer of the device, which its body calls `tracer`.
#define GREATX_TRACER_TEST(suite, name)                         \
  void suite##_##name(gpu::Tracer tracer);                      \
  TEST(suite, name) {                                           \
    for (const gpu::Tracer tracer : test::tracing::tracers()) { \
      SCOPED_TRACE(gpu::name_of(tracer));                       \
      suite##_##name(tracer);                                   \
    }                                                           \
  }                                                             \
  void suite##_##name([[maybe_unused]] gpu::Tracer tracer)

/// Returns the result of a shader of shaders/tests/trace_test.h for each ray.
template <typename Result>
std::vector<Result> answers_of(const char* shader, scene::GpuScene& gpu_scene,
                               std::span<const TraceTestRay> rays, const std::vector<Pose>& bodies) {
  gpu::Device& device = gpu_scene.device();
  gpu::ComputeDesc desc;
  gpu_scene.prepare_tracing(desc, shader);
  desc.bindings.push_back({shared::trace_test_rays_binding});
  desc.bindings.push_back({shared::trace_test_results_binding});
  desc.push_constant_bytes = sizeof(uint32_t);
  const gpu::ComputePipeline pipeline(device, desc, shader);
  const uint32_t count = static_cast<uint32_t>(rays.size());
  gpu::TickRing ring(device, 1, 1u << 20, 1u << 20);
  gpu::TickSlot& slot = ring.begin();
  gpu_scene.record_update(slot, bodies);
  const gpu::Slice upload = slot.upload.put(rays);
  const gpu::Slice results = slot.readback.allocate_for<Result>(count);
  slot.cmd->bind(pipeline);
  std::vector<gpu::Descriptor> descriptors = gpu_scene.descriptors();
  descriptors.push_back(gpu::Descriptor::buffer(shared::trace_test_rays_binding, upload));
  descriptors.push_back(gpu::Descriptor::buffer(shared::trace_test_results_binding, results));
  slot.cmd->push(descriptors);
  slot.cmd->constants(count);
  slot.cmd->dispatch((count + 63) / 64);
  ring.submit(slot);
  ring.wait(slot);
  const std::span<Result> answers = results.as<Result>().first(count);
  return {answers.begin(), answers.end()};
}

inline std::vector<TraceTestResult> trace(gpu::Tracer tracer, const scene::Scene& scene,
                                          std::span<const TraceTestRay> rays,
                                          const std::vector<Pose>& bodies = {Pose{}}) {
  scene::GpuSceneOptions options;
  options.tracer = tracer;
  scene::GpuScene gpu_scene(test::device(), scene, options);
  return answers_of<TraceTestResult>("tests/trace.comp", gpu_scene, rays, bodies);
}

inline dvec3 random_direction(RandomStream& random) {
  const double z = random.uniform(-1.0, 1.0), azimuth = random.uniform(0.0, 2.0 * M_PI),
               r = std::sqrt(1.0 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

inline dmat3 random_rotation(RandomStream& random) {
  return glm::mat3_cast(glm::angleAxis(random.uniform(0.0, 6.28), random_direction(random)));
}

/// Returns the triangles of a sphere: an octahedron subdivided `levels` times.
inline std::vector<Triangle> sphere(int levels, double radius, const dvec3& center) {
  std::vector<Triangle> triangles;
  const dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  for (const auto& [a, b, c] : {std::tuple{x, y, z},
                                {y, -x, z},
                                {-x, -y, z},
                                {-y, x, z},
                                {y, x, -z},
                                {-x, y, -z},
                                {-y, -x, -z},
                                {x, -y, -z}})
    triangles.push_back({a, b, c});
  for (int level = 0; level < levels; ++level) {
    std::vector<Triangle> finer;
    for (const Triangle& t : triangles) {
      const dvec3 ab = glm::normalize(t[0] + t[1]), bc = glm::normalize(t[1] + t[2]),
                  ca = glm::normalize(t[2] + t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    triangles = finer;
  }
  for (Triangle& t : triangles)
    for (dvec3& corner : t) corner = center + radius * corner;
  return triangles;
}

}  // namespace greatx::test::tracing
