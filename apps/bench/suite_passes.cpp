// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/suite_passes.h"

#include <algorithm>
#include <cmath>

#include "apps/bench/suite_picture.h"
#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "renderer/lidar/lidar_pass.h"
#include "renderer/lidar/scan/scan_pattern.h"
#include "renderer/probe/probe.h"
#include "rf/facets/facet_world.h"
#include "rf/paths/crossings.h"
#include "rf/radar/echoes/echo_pass.h"
#include "rf/search/candidate_search.h"

namespace greatx::apps {

namespace {

constexpr uint64_t ray_seed = 21;
constexpr uint32_t lidar_channels = 64;
constexpr uint32_t bounces = 3;  ///< of candidate rays and of radar rays
constexpr double lidar_range_m = 200.0, lidar_begin_m = 0.5;
constexpr float far_m = 1e6f;

uint64_t hashed(uint64_t hash, uint32_t word) { return (hash ^ word) * 0x100000001b3ull; }

/// Returns a place among the boxes: mostly below their roofs, within 300 m of the mast.
dvec3 drawn_place(const SuiteScene& scene, RandomStream& random) {
  const double reach = std::min(0.48 * scene.side_m, 300.0);
  return {random.uniform(-reach, reach), random.uniform(-reach, reach),
          random.uniform(0.1, 1.4) * scene.cell_m};
}

/// Returns rays from drawn places towards drawn places near the start, and on without end.
std::vector<SuiteRay> single_rays(const SuiteScene& scene, const SuiteWork& work) {
  RandomStream random(ray_seed, 1);
  std::vector<SuiteRay> rays(work.rays);
  for (SuiteRay& ray : rays) {
    const dvec3 from = drawn_place(scene, random);
    dvec3 towards = drawn_place(scene, random) - from;
    towards.z = random.uniform(-0.2, 0.05) * glm::length(towards);
    ray = {vec3(from), 0.0f, vec3(glm::normalize(towards)), far_m};
  }
  return rays;
}

std::vector<rf::Segment> segments(const SuiteScene& scene, const SuiteWork& work) {
  RandomStream random(ray_seed, 2);
  std::vector<rf::Segment> result(work.rays);
  for (rf::Segment& segment : result) {
    segment.a = scene.mast;
    segment.b = drawn_place(scene, random);
  }
  return result;
}

render::ScanPattern suite_pattern(const SuiteWork& work) {
  render::SpinningScan scan;
  for (uint32_t i = 0; i < lidar_channels; ++i)
    scan.elevations.push_back(radians(-45.0 + 60.0 * i / (lidar_channels - 1)));
  scan.azimuth_steps = std::max(1u, work.rays / lidar_channels);
  return render::scan_pattern(scan);
}

class SingleRays : public SuitePass {
 public:
  SingleRays(scene::GpuScene& gpu_scene, const SuiteScene& scene, const SuiteWork& work) : pass_(gpu_scene) {
    for (const SuiteRay& ray : single_rays(scene, work)) rays_.push_back({ray.origin, ray.direction});
  }
  void record(gpu::TickSlot& slot, const std::vector<Pose>&) override {
    hits_ = pass_.record(slot, rays_, std::nullopt);
  }
  std::vector<SuiteAnswer> answers(const std::vector<Pose>&) override {
    std::vector<SuiteAnswer> result;
    for (const shared::ProbeHit& hit : hits_.as<shared::ProbeHit>().first(rays_.size()))
      result.push_back(hit.primitive == 0 ? SuiteAnswer{} : SuiteAnswer{1, hit.t});
    return result;
  }

 private:
  render::ProbePass pass_;
  std::vector<shared::ProbeRay> rays_;
  gpu::Slice hits_;
};

class LidarSweep : public SuitePass {
 public:
  LidarSweep(scene::GpuScene& gpu_scene, const SuiteScene& scene, const SuiteWork& work)
      : pass_(gpu_scene, desc(work)), pose_{scene.mast, {}} {}
  void record(gpu::TickSlot& slot, const std::vector<Pose>&) override {
    pending_ = pass_.record(slot, std::span(&pose_, 1));
  }
  std::vector<SuiteAnswer> answers(const std::vector<Pose>&) override {
    std::vector<SuiteAnswer> result;
    for (const shared::LidarEcho& echo :
         pending_.echoes.as<shared::LidarEcho>().first(pending_.pattern->size()))
      result.push_back(echo.instance == 0 ? SuiteAnswer{} : SuiteAnswer{1, echo.range});
    return result;
  }

 private:
  static render::LidarDesc desc(const SuiteWork& work) {
    render::LidarDesc result;
    result.pattern = suite_pattern(work);
    result.min_range_m = lidar_begin_m;
    result.max_range_m = lidar_range_m;
    return result;
  }
  render::LidarPass pass_;
  Pose pose_;
  render::LidarPass::Pending pending_;
};

class Crossings : public SuitePass {
 public:
  Crossings(scene::GpuScene& gpu_scene, const SuiteScene& scene, const SuiteWork& work)
      : world_(scene.scene),
        pass_(gpu_scene, rf::FacetKinds(scene.scene.facets.size(), rf::FacetKind::opaque)),
        segments_(segments(scene, work)) {}
  void record(gpu::TickSlot& slot, const std::vector<Pose>&) override {
    pending_ = pass_.record(slot, segments_);
  }
  std::vector<SuiteAnswer> answers(const std::vector<Pose>& bodies) override {
    for (uint32_t body = 1; body < bodies.size(); ++body) world_.move(body, {bodies[body]});
    std::vector<SuiteAnswer> result;
    for (const rf::Crossing& crossing : pass_.collect(pending_, segments_, world_))
      result.push_back({crossing.blocked ? 1u : 0u, 0.0f});
    return result;
  }

 private:
  rf::FacetWorld world_;
  rf::CrossingPass pass_;
  std::vector<rf::Segment> segments_;
  rf::CrossingPass::Pending pending_;
};

class CandidateRays : public SuitePass {
 public:
  CandidateRays(scene::GpuScene& gpu_scene, const SuiteScene& scene, const SuiteWork& work)
      : search_(gpu_scene, options(work)), source_(scene.mast) {}
  void record(gpu::TickSlot& slot, const std::vector<Pose>&) override {
    pending_ = search_.record(slot, source_);
  }
  std::vector<SuiteAnswer> answers(const std::vector<Pose>&) override {
    // Walls are opaque here, so every ray has one way and `bounces` words.
    std::vector<SuiteAnswer> result;
    for (const gpu::Slice& part : pending_.keys) {
      const std::span<const uint32_t> words = part.as<const uint32_t>();
      for (size_t ray = 0; ray < words.size() / bounces && result.size() < search_.options().rays; ++ray) {
        SuiteAnswer answer;
        for (uint32_t i = 0; i < bounces; ++i) answer.word = hashed(answer.word, words[ray * bounces + i]);
        result.push_back(answer);
      }
    }
    return result;
  }

 private:
  static rf::CandidateSearchOptions options(const SuiteWork& work) {
    rf::CandidateSearchOptions result;
    result.rays = work.rays;
    result.max_depth = bounces;
    return result;
  }
  rf::CandidateSearch search_;
  dvec3 source_;
  rf::CandidateSearch::Pending pending_;
};

class RadarRays : public SuitePass {
 public:
  RadarRays(scene::GpuScene& gpu_scene, const SuiteScene& scene, const SuiteWork& work)
      : pass_(gpu_scene, bounces, true, false) {
    rays_.source = rays_.receiver = scene.mast;
    // The field of view is 120 degrees wide and from 40 degrees below the horizon to 10 degrees above it.
    const auto columns = static_cast<uint32_t>(std::sqrt(2.0 * work.rays)), rows = work.rays / columns;
    for (uint32_t i = 0; i < work.rays; ++i) {
      const double azimuth = radians(-60.0 + 120.0 * (i % columns + 0.5) / columns),
                   elevation = radians(-40.0 + 50.0 * (std::min(i / columns, rows) + 0.5) / (rows + 1));
      directions_.push_back(vec3(render::beam_direction(azimuth, elevation)));
    }
  }
  void record(gpu::TickSlot& slot, const std::vector<Pose>&) override {
    pending_ = pass_.record(slot, rays_, directions_);
  }
  std::vector<SuiteAnswer> answers(const std::vector<Pose>&) override {
    const std::span<const uint32_t> words = pass_.collect(pending_);
    std::vector<SuiteAnswer> result(directions_.size());
    for (uint32_t bounce = 0; bounce < bounces; ++bounce)
      for (size_t ray = 0; ray < result.size(); ++ray)
        result[ray].word = hashed(result[ray].word, words[bounce * result.size() + ray]);
    return result;
  }

 private:
  rf::EchoPass pass_;
  rf::EchoRays rays_;
  std::vector<vec3> directions_;
  rf::EchoPass::Pending pending_;
};

}  // namespace

bool differs(const SuiteAnswer& a, const SuiteAnswer& b) {
  return a.word != b.word || std::abs(a.distance - b.distance) > 1e-3f + 1e-4f * std::abs(a.distance);
}

uint64_t count_differing(const std::vector<SuiteAnswer>& a, const std::vector<SuiteAnswer>& b) {
  GREATX_CHECK(a.size() == b.size(), "{} answers and {} answers", a.size(), b.size());
  uint64_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += differs(a[i], b[i]) ? 1 : 0;
  return count;
}

const std::vector<SuiteKindInfo>& suite_kinds() {
  static const std::vector<SuiteKindInfo> kinds{
      {SuiteKind::single_rays, "single rays", "probe", "rays", true},
      {SuiteKind::lidar, "LiDAR sweep", "lidar", "rays", true},
      {SuiteKind::crossings, "path segments", "channel", "segments", true},
      {SuiteKind::candidates, "candidate rays", "channel", "rays", true},
      {SuiteKind::radar, "radar rays", "radar", "rays", true},
      {SuiteKind::camera, "camera picture", "camera", "pixels", false},
      {SuiteKind::events, "event interval", "events", "pixels", false},
      {SuiteKind::lamps, "camera at night", "camera", "pixels", false}};
  return kinds;
}

const SuiteKindInfo& info_of(SuiteKind kind) {
  return *std::ranges::find(suite_kinds(), kind, &SuiteKindInfo::kind);
}

uint64_t suite_count(SuiteKind kind, const SuiteWork& work) {
  const uint64_t pixels = uint64_t{work.width} * work.height;
  if (kind == SuiteKind::events) return suite_event_pictures * pixels;
  if (!info_of(kind).traces) return pixels;
  if (kind == SuiteKind::lidar) return uint64_t{std::max(1u, work.rays / lidar_channels)} * lidar_channels;
  return work.rays;
}

std::unique_ptr<SuitePass> make_suite_pass(SuiteKind kind, scene::GpuScene& gpu_scene,
                                           const SuiteScene& scene, const SuiteWork& work) {
  switch (kind) {
    case SuiteKind::single_rays:
      return std::make_unique<SingleRays>(gpu_scene, scene, work);
    case SuiteKind::lidar:
      return std::make_unique<LidarSweep>(gpu_scene, scene, work);
    case SuiteKind::crossings:
      return std::make_unique<Crossings>(gpu_scene, scene, work);
    case SuiteKind::candidates:
      return std::make_unique<CandidateRays>(gpu_scene, scene, work);
    case SuiteKind::radar:
      return std::make_unique<RadarRays>(gpu_scene, scene, work);
    case SuiteKind::events:
      return make_suite_events(gpu_scene, scene, work);
    case SuiteKind::camera:
    case SuiteKind::lamps:
      return make_suite_picture(gpu_scene, scene, work, kind == SuiteKind::lamps);
  }
  throw ContractError("suite: no such pass");
}

std::vector<SuiteRay> suite_rays(SuiteKind kind, const SuiteScene& scene, const SuiteWork& work,
                                 bool& closest) {
  closest = kind != SuiteKind::crossings;
  if (kind == SuiteKind::single_rays) return single_rays(scene, work);
  std::vector<SuiteRay> rays;
  if (kind == SuiteKind::lidar)
    for (const dvec3& direction : suite_pattern(work).directions)
      rays.push_back({vec3(scene.mast), float(lidar_begin_m), vec3(direction), float(lidar_range_m)});
  if (kind == SuiteKind::crossings)
    for (const rf::Segment& segment : segments(scene, work))
      rays.push_back({vec3(segment.a), 0.0f, vec3(segment.b - segment.a), 1.0f});
  return rays;
}

}  // namespace greatx::apps
