// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/selftest/lab.h"

#include <cmath>

#include "core/units.h"
#include "renderer/probe/probe.h"
#include "rf/search/beam_search.h"

namespace greatx::apps::selftest {

namespace {

rf::RadioEffects effects_of(bool walls, bool edges = false) {
  rf::RadioEffects effects;
  effects.transmission = walls;
  effects.diffraction = edges;
  return effects;
}

std::vector<rf::Crossing> trace(gpu::TickRing& ring, scene::GpuScene& gpu, rf::CrossingPass& pass,
                                const rf::FacetWorld& world, std::span<const rf::Segment> segments) {
  gpu::TickSlot& slot = ring.begin();
  gpu.record_update(slot, std::vector<Pose>(gpu.scene().bodies.size()));
  const rf::CrossingPass::Pending pending = pass.record(slot, segments);
  ring.submit(slot);
  ring.wait(slot);
  return pass.collect(pending, segments, world);
}

}  // namespace

const char* precision_of(gpu::Tracer tracer) {
  return tracer == gpu::Tracer::tree ? "tree, fp32" : "driver, fp32";
}

std::vector<gpu::Tracer> Lab::tracers() const {
  if (!device_->info().has_ray_query()) return {gpu::Tracer::tree};
  return {gpu::Tracer::driver, gpu::Tracer::tree};
}

std::string Lab::host_and_tracer() const {
  return std::string("host, fp64 + ") + precision_of(device_->tracer());
}

std::vector<shared::ProbeHit> Lab::probe(const scene::Scene& scene, std::span<const shared::ProbeRay> rays,
                                         gpu::Tracer tracer) const {
  scene::GpuSceneOptions options;
  options.tracer = tracer;
  scene::GpuScene gpu(*device_, scene, options);
  const render::ProbePass pass(gpu);
  gpu::TickRing ring(*device_, 1, 1u << 16, 1u << 16);
  gpu::TickSlot& slot = ring.begin();
  gpu.record_update(slot, std::vector<Pose>(scene.bodies.size()));
  const gpu::Slice hits = pass.record(slot, rays, {});
  ring.submit(slot);
  ring.wait(slot);
  const std::span<shared::ProbeHit> answers = hits.as<shared::ProbeHit>().first(rays.size());
  return {answers.begin(), answers.end()};
}

std::vector<rf::Crossing> Lab::crossings(const scene::Scene& scene, std::span<const rf::Segment> segments,
                                         gpu::Tracer tracer, bool walls) const {
  scene::GpuSceneOptions options;
  options.tracer = tracer;
  scene::GpuScene gpu(*device_, scene, options);
  rf::CrossingPass pass(gpu, rf::facet_kinds(scene, effects_of(walls)));
  gpu::TickRing ring(*device_, 1, 1u << 16, 1u << 16);
  return trace(ring, gpu, pass, rf::FacetWorld(scene), segments);
}

render::LidarScan Lab::sweep(const scene::Scene& scene, const render::LidarDesc& desc,
                             gpu::Tracer tracer) const {
  scene::GpuSceneOptions options;
  options.tracer = tracer;
  scene::GpuScene gpu(*device_, scene, options);
  render::LidarPass pass(gpu, desc);
  gpu::TickRing ring(*device_, 1, 1u << 16, 1u << 16);
  gpu::TickSlot& slot = ring.begin();
  gpu.record_update(slot, std::vector<Pose>(scene.bodies.size()));
  const Pose at_origin;
  const render::LidarPass::Pending pending = pass.record(slot, std::span(&at_origin, 1));
  ring.submit(slot);
  ring.wait(slot);
  return pass.collect(pending);
}

Links::Links(const Lab& lab, const scene::Scene& scene, const Options& options)
    : options_(options),
      model_(scene, options.carrier_hz, effects_of(options.walls, options.edges)),
      gpu_(lab.device(), scene, {}),
      pass_(gpu_, model_.kinds),
      ring_(lab.device(), 1, 1u << 16, 1u << 16) {}

std::vector<std::vector<rf::Path>> Links::solve(const dvec3& transmitter, std::span<const dvec3> receivers) {
  rf::BeamSearchOptions search;
  search.max_depth = options_.max_depth;
  search.max_transmissions = options_.walls ? options_.max_depth : 0;
  search.threads = options_.threads;
  rf::PathLimits limits;
  limits.max_depth = search.max_depth;
  limits.max_transmissions = search.max_transmissions;
  rf::PathSolver solver(model_, limits);
  const rf::BeamSearch beams(model_.facets, model_.kinds, model_.wedges, search);
  solver.set_candidates(beams.search(transmitter).list, transmitter, rf::Source::transmitter);

  rf::EndState from, to;
  from.position = transmitter;
  std::vector<rf::LinkGeometry> geometry;
  std::vector<rf::Segment> segments;
  std::vector<size_t> first{0};
  for (const dvec3& receiver : receivers) {
    to.position = receiver;
    geometry.push_back(solver.geometry(to));
    solver.add_segments(geometry.back().paths, from, to, segments);
    first.push_back(segments.size());
  }
  const std::vector<rf::Crossing> crossings = trace(ring_, gpu_, pass_, model_.facets, segments);
  std::vector<std::vector<rf::Path>> links;
  for (size_t r = 0; r < receivers.size(); ++r) {
    to.position = receivers[r];
    const std::span answers = std::span(crossings).subspan(first[r], first[r + 1] - first[r]);
    links.push_back(solver.finish(geometry[r].paths, answers, from, to, model_.facets));
  }
  return links;
}

rf::ArrayPose antenna(rf::Pattern pattern, rf::Polarization polarization) {
  rf::ArrayPose end;
  end.array.pattern = pattern;
  end.array.polarization = polarization;
  return end;
}

dvec3 random_direction(RandomStream& random) {
  const double z = random.uniform(-1.0, 1.0), azimuth = random.uniform(0.0, 2.0 * pi),
               r = std::sqrt(1.0 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

shared::ProbeRay ray_towards(const dvec3& origin, const dvec3& target) {
  return {vec3(origin), vec3(target) - vec3(origin)};
}

}  // namespace greatx::apps::selftest
