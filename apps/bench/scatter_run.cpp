// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/scatter_run.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "apps/bench/measure.h"
#include "core/error.h"
#include "sim/plan/plan_options.h"
#include "sim/world/moment.h"

namespace greatx::apps {

ScatterRun run_receivers(gpu::Device& device, const sim::Experiment& base, sim::Scenario scenario,
                         std::span<const dvec3> receivers, size_t at_once,
                         const std::function<void(const std::vector<rf::Path>&)>& of_link) {
  const sim::Experiment experiment = sim::make_experiment(std::move(scenario), base.world);
  scene::GpuScene gpu_scene(device, experiment.scene(), sim::gpu_scene_options(experiment.plan));
  rf::CrossingPass crossings(gpu_scene, rf::facet_kinds(experiment.scene(), sim::radio_effects(experiment)));
  sim::ChannelPaths paths(gpu_scene, crossings, experiment, 0);
  const sim::Courses courses = sim::make_courses(experiment.scenario, *experiment.world, 0);
  const sim::Moment moment =
      sim::moment_at(*experiment.world, courses, sim::Clock(experiment.scenario.tick_rate_hz), 0);
  paths.set_points(receivers.first(1));
  double cpu = cpu_milliseconds();
  paths.start(moment.context);
  ScatterRun run;
  run.search_ms = cpu_milliseconds() - cpu;
  gpu::TickRing ring(device, 1, 1u << 20, 1u << 20);
  for (size_t first = 0; first < receivers.size(); first += at_once) {
    paths.set_points(receivers.subspan(first, std::min(at_once, receivers.size() - first)), first);
    cpu = cpu_milliseconds();
    const Clock::time_point begin = Clock::now();
    gpu::TickSlot& slot = ring.begin();
    gpu_scene.record_update(slot, moment.bodies);
    paths.record(slot, moment.context);
    ring.submit(slot);
    ring.wait(slot);
    const sim::ChannelPaths::Result result = paths.collect(slot);
    run.cpu_ms += cpu_milliseconds() - cpu;
    run.wall_ms += milliseconds_since(begin);
    for (const sim::ChannelPaths::Link& link : result.links) of_link(link.paths);
  }
  std::map<std::string, uint64_t> counters;
  paths.count(counters);
  if (counters["path_overflow"] > 0)
    throw_user_error("{}: {} paths lie beyond max_paths; expected none, for a comparison with all patches",
                     experiment.scenario.name, counters["path_overflow"]);
  run.chains = counters["geometric_paths"];
  return run;
}

}  // namespace greatx::apps
