// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/suite_embree.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"

#if GREATX_EMBREE == 3
#include <embree3/rtcore.h>
#elif GREATX_EMBREE == 4
#include <embree4/rtcore.h>
#endif

namespace greatx::apps {

#if GREATX_EMBREE

struct SuiteEmbree::Tree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

namespace {

/// Rays that a thread takes at once.
constexpr size_t rays_at_once = 1024;

RTCRay embree_ray(const SuiteRay& from) {
  RTCRay ray{};
  ray.org_x = from.origin.x, ray.org_y = from.origin.y, ray.org_z = from.origin.z;
  ray.dir_x = from.direction.x, ray.dir_y = from.direction.y, ray.dir_z = from.direction.z;
  ray.tnear = from.t_min, ray.tfar = from.t_max;
  ray.mask = ~0u;
  return ray;
}

SuiteAnswer closest_hit(RTCScene scene, const SuiteRay& from) {
  RTCRayHit query{};
  query.ray = embree_ray(from);
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if GREATX_EMBREE == 3
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
#else
  rtcIntersect1(scene, &query, nullptr);
#endif
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {1, query.ray.tfar};
}

SuiteAnswer any_hit(RTCScene scene, const SuiteRay& from) {
  RTCRay ray = embree_ray(from);
#if GREATX_EMBREE == 3
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#else
  rtcOccluded1(scene, &ray, nullptr);
#endif
  return {ray.tfar < 0.0f ? 1u : 0u, 0.0f};  // Embree sets it to minus infinity
}

}  // namespace

SuiteEmbree::SuiteEmbree(const scene::Scene& scene) : tree_(std::make_unique<Tree>()) {
  tree_->device = rtcNewDevice(nullptr);
  if (tree_->device == nullptr) throw_user_error("bench --suite: Embree cannot be started");
  const size_t indices = scene.bodies.size() > 1
                             ? scene.primitives[scene.bodies[1].first_primitive].first_index
                             : scene.indices.size();
  tree_->scene = rtcNewScene(tree_->device);
  rtcSetSceneFlags(tree_->scene, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(tree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Embree copies the corners, because it reads four bytes beyond the last one.
  auto* const corners = static_cast<vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), scene.positions.size()));
  std::ranges::copy(scene.positions, corners);
  auto* const triangles = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), indices / 3));
  std::copy_n(scene.indices.begin(), indices, triangles);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(tree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(tree_->scene);
}

SuiteEmbree::~SuiteEmbree() {
  if (tree_->scene != nullptr) rtcReleaseScene(tree_->scene);
  rtcReleaseDevice(tree_->device);
}

std::vector<SuiteAnswer> SuiteEmbree::trace(const std::vector<SuiteRay>& rays, bool closest) const {
  std::vector<SuiteAnswer> answers(rays.size());
  parallel_for((rays.size() + rays_at_once - 1) / rays_at_once, 0, [&](size_t part) {
    const size_t end = std::min(rays.size(), (part + 1) * rays_at_once);
    for (size_t i = part * rays_at_once; i < end; ++i)
      answers[i] = closest ? closest_hit(tree_->scene, rays[i]) : any_hit(tree_->scene, rays[i]);
  });
  return answers;
}

std::string SuiteEmbree::version() { return RTC_VERSION_STRING; }

#else

struct SuiteEmbree::Tree {};
SuiteEmbree::SuiteEmbree(const scene::Scene&) {}
SuiteEmbree::~SuiteEmbree() = default;
std::vector<SuiteAnswer> SuiteEmbree::trace(const std::vector<SuiteRay>&, bool) const {
  throw ContractError("suite: built without Embree");
}
std::string SuiteEmbree::version() { return {}; }

#endif

}  // namespace greatx::apps
