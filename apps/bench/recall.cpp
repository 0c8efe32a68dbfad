// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/recall.h"

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "apps/bench/measure.h"
#include "apps/bench/recall_scene.h"
#include "apps/bench/scatter_recall.h"
#include "apps/bench/two_bend_recall.h"
#include "apps/console/exit_code.h"
#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "rf/edges/corners.h"
#include "rf/reference/comparison.h"
#include "rf/reference/exhaustive_diffraction.h"
#include "rf/reference/exhaustive_paths.h"
#include "sim/channel/channel_paths.h"
#include "sim/experiment/experiment.h"
#include "sim/plan/plan_options.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/receiver_list.h"
#include "sim/world/moment.h"

namespace greatx::apps {

namespace {

using rf::reference::Comparison;
/// Holds a scene with its transmitter and receivers, and the paths of the reference.
struct Case {
  sim::Experiment experiment;
  std::vector<dvec3> receivers;  ///< world coordinates
  rf::reference::ExhaustiveResult reference;
  double reference_s = 0.0;
};

/// Holds the paths that greatx finds.
struct Answer {
  std::vector<sim::ChannelPaths::Link> links;  ///< [receivers]
  uint64_t candidates = 0;
  double search_s = 0.0;  ///< time of the candidates and their images
  double solve_s = 0.0;   ///< time of geometry, obstruction and fields for all receivers
};

sim::Moment beginning_of(const sim::Experiment& experiment) {
  const sim::Courses courses = sim::make_courses(experiment.scenario, *experiment.world, 0);
  return sim::moment_at(*experiment.world, courses, sim::Clock(experiment.scenario.tick_rate_hz), 0);
}

/// Solves the channel as in a tick of a run, with the receivers as points. `rays`: number of rays; 0: the
/// guaranteed search.
Answer solve(gpu::Device& device, const Case& c, uint32_t rays) {
  sim::Scenario scenario = c.experiment.scenario;
  scenario.channels[0].candidates =
      rays == 0 ? sim::ChannelConfig::Candidates::beams : sim::ChannelConfig::Candidates::rays;
  if (rays > 0) scenario.channels[0].rays = rays;
  const sim::Experiment experiment = sim::make_experiment(std::move(scenario), c.experiment.world);
  scene::GpuScene gpu_scene(device, experiment.scene(), sim::gpu_scene_options(experiment.plan));
  rf::CrossingPass crossings(gpu_scene, rf::facet_kinds(experiment.scene(), sim::radio_effects(experiment)));
  sim::ChannelPaths paths(gpu_scene, crossings, experiment, 0);
  paths.set_points(c.receivers);
  const sim::Moment moment = beginning_of(experiment);

  Answer answer;
  Clock::time_point begin = Clock::now();
  paths.start(moment.context);
  answer.search_s = seconds_since(begin);
  begin = Clock::now();
  gpu::TickRing ring(device, 1, 1u << 20, 1u << 20);
  gpu::TickSlot& slot = ring.begin();
  gpu_scene.record_update(slot, moment.bodies);
  paths.record(slot, moment.context);
  ring.submit(slot);
  ring.wait(slot);
  answer.links = paths.collect(slot).links;
  answer.solve_s = seconds_since(begin);
  std::map<std::string, uint64_t> counters;
  paths.count(counters);
  answer.candidates = counters["candidates"];
  return answer;
}

Comparison compare(const Case& c, const Answer& answer) {
  Comparison comparison(c.experiment.scenario.channels[0].limits.max_depth);
  for (uint32_t r = 0; r < answer.links.size(); ++r)
    comparison.add(r, rf::reference::polylines(c.reference.paths[r]),
                   rf::reference::polylines(answer.links[r].paths));
  return comparison;
}

/// Adds the paths over edges to those of the reference.
void add_edges(Case& c, const RecallPaths& sought, const rf::FacetKinds& kinds, const rf::FacetWorld& world,
               const sim::Moment& moment, std::span<const dvec3> receivers) {
  const scene::Scene& scene = c.experiment.scene();
  std::vector<scene::Wedge> wedges = scene::find_wedges(scene);
  const auto hard = [&](uint32_t facet) {
    return kinds[facet] == rf::FacetKind::opaque || kinds[facet] == rf::FacetKind::wall;
  };
  std::erase_if(wedges, [&](const scene::Wedge& wedge) {
    return wedge.body != 0 || !hard(wedge.facet_0) || !hard(wedge.facet_n);
  });
  const rf::OpenCorners corners(scene, kinds, wedges);
  std::vector<std::array<bool, 2>> open_ends;
  for (uint32_t i = 0; i < wedges.size(); ++i)
    open_ends.push_back({corners.open(i, rf::Corner::a), corners.open(i, rf::Corner::b)});
  const sim::ChannelConfig& channel = c.experiment.scenario.channels[0];
  const auto found = rf::reference::exhaustive_diffraction(
      scene, world, moment.bodies, kinds, wedges,
      transmitter_position(c.experiment.scenario, *c.experiment.world, moment), receivers,
      {.max_depth = sought.max_depth,
       .max_transmissions = sought.max_transmissions,
       .max_edges = sought.edges,
       .open_ends = std::move(open_ends),
       .most_excess_m = rf::largest_excess_m(channel.limits.corner_step_db,
                                             2.0 * pi * channel.carrier_hz / speed_of_light)});
  for (size_t r = 0; r < found.size(); ++r)
    c.reference.paths[r].insert(c.reference.paths[r].end(), found[r].begin(), found[r].end());
}

Case make_case(const RecallOptions& options, const std::string& name) {
  ScenarioOptions chosen = options.scenario;
  chosen.scenario = name;
  Case c{sim::make_experiment(frozen_for_recall(load_scenario(chosen), options.paths)), {}, {}};
  const scene::Scene& scene = c.experiment.scene();
  c.receivers =
      options.receiver_file.empty()
          ? draw_receivers(scene, c.experiment.scenario.seed, options.receivers)
          : sim::load_receiver_list(options.receiver_file, sim::EarthPositions(c.experiment.scenario.scene));
  const rf::FacetKinds kinds = rf::facet_kinds(scene, sim::radio_effects(c.experiment));
  const rf::FacetWorld world(scene);
  const sim::Moment moment = beginning_of(c.experiment);
  std::vector<dvec3> local;
  for (const dvec3& receiver : c.receivers) local.push_back(scene.to_local(receiver));

  Progress progress(fmt::format("{}: reference", name), 1000, options.json, "");
  rf::reference::ExhaustiveOptions exhaustive;
  exhaustive.max_depth = options.paths.max_depth;
  exhaustive.max_transmissions = options.paths.max_transmissions;
  exhaustive.progress = [&](double done) { progress.update(static_cast<int64_t>(1000.0 * done)); };
  const Clock::time_point begin = Clock::now();
  c.reference = rf::reference::exhaustive_paths(
      scene, world, moment.bodies, kinds,
      transmitter_position(c.experiment.scenario, *c.experiment.world, moment), local, exhaustive);
  if (options.paths.edges > 0) add_edges(c, options.paths, kinds, world, moment, local);
  c.reference_s = seconds_since(begin);
  return c;
}

nlohmann::json json_of(const Comparison::Counts& counts) {
  return {{"reference", counts.reference},
          {"found", counts.found},
          {"missing", counts.missing},
          {"doubled", counts.doubled},
          {"extra", counts.extra}};
}

/// Prints the vertices and interactions of the first mismatched paths, to help find the fault.
void print_mismatches(const Case& c, const Answer& answer, const Comparison& comparison) {
  constexpr size_t shown = 20;
  static constexpr const char* names[] = {"missing", "doubled", "extra"};
  const auto print = [](const char* fault, uint32_t receiver, double length, const auto& interactions,
                        const std::vector<dvec3>& vertices) {
    std::string line = fmt::format("    {}: receiver {}, {:.6f} m:", fault, receiver, length);
    for (size_t i = 0; i < vertices.size(); ++i) {
      if (i > 0 && i + 1 < vertices.size())
        line += fmt::format(" {} at {}", rf::name_of(interactions[i - 1].type), interactions[i - 1].element);
      line += fmt::format(" ({:.4f}, {:.4f}, {:.4f})", vertices[i].x, vertices[i].y, vertices[i].z);
    }
    std::cout << line << '\n';
  };
  for (size_t i = 0; i < std::min(shown, comparison.mismatches().size()); ++i) {
    const Comparison::Mismatch& m = comparison.mismatches()[i];
    const char* fault = names[static_cast<size_t>(m.fault)];
    if (m.fault == Comparison::Fault::missing) {
      const rf::GeometricPath& path = c.reference.paths[m.receiver][m.path];
      print(fault, m.receiver, path.length_m, path.interactions, path.vertices);
    } else {
      const rf::Path& path = answer.links[m.receiver].paths[m.path];
      print(fault, m.receiver, path.length_m, path.interactions, path.vertices);
    }
  }
  if (comparison.mismatches().size() > shown)
    std::cout << fmt::format("    and {} more\n", comparison.mismatches().size() - shown);
}

/// Measures the guaranteed search. Returns false if it does not find exactly the paths of the reference.
bool measure_beams(gpu::Device& device, const Case& c, bool quiet, nlohmann::json& result) {
  const Answer answer = solve(device, c, 0);
  const Comparison comparison = compare(c, answer);
  nlohmann::json& beams = result["beams"];
  beams = {{"candidates", answer.candidates},
           {"search_s", answer.search_s},
           {"solve_s", answer.solve_s},
           {"all", json_of(comparison.all())}};
  for (const Comparison::Counts& counts : comparison.by_depth()) beams["depths"].push_back(json_of(counts));
  if (!quiet) {
    std::cout << fmt::format(
        "  beams: {} candidates, search {:.3f} s, all receivers {:.3f} s\n"
        "  {:>8} {:>10} {:>10} {:>10} {:>10} {:>10}\n",
        answer.candidates, answer.search_s, answer.solve_s, "depth", "reference", "found", "missing",
        "doubled", "extra");
    for (size_t depth = 0; depth < comparison.by_depth().size(); ++depth) {
      const Comparison::Counts& n = comparison.by_depth()[depth];
      std::cout << fmt::format("  {:>8} {:>10} {:>10} {:>10} {:>10} {:>10}\n", depth, n.reference, n.found,
                               n.missing, n.doubled, n.extra);
    }
    print_mismatches(c, answer, comparison);
    std::cout << std::flush;
  }
  return comparison.all().perfect();
}

/// Measures plain shooting and bouncing of rays for increasing numbers of rays.
void measure_rays(gpu::Device& device, const Case& c, const RecallOptions& options, nlohmann::json& result) {
  result["rays"] = nlohmann::json::array();
  if (options.max_rays_log2 < 14 || options.paths.edges > 0) return;
  if (!options.json)
    std::cout << fmt::format("  {:>8} {:>10} {:>10} {:>10} {:>10} {:>10} {:>9} {:>9}\n", "rays", "candidates",
                             "found", "missing", "doubled", "recall", "search s", "solve s");
  const spdlog::level::level_enum level = spdlog::get_level();
  spdlog::set_level(spdlog::level::err);  // measure_beams() has already warned about the receivers
  for (uint32_t log2 = 14; log2 <= options.max_rays_log2; ++log2) {
    const Answer answer = solve(device, c, 1u << log2);
    const Comparison::Counts all = compare(c, answer).all();
    result["rays"].push_back({{"rays", 1u << log2},
                              {"candidates", answer.candidates},
                              {"search_s", answer.search_s},
                              {"solve_s", answer.solve_s},
                              {"all", json_of(all)}});
    if (!options.json)
      std::cout << fmt::format("  {:>8} {:>10} {:>10} {:>10} {:>10} {:>9.3f}% {:>9.3f} {:>9.3f}\n",
                               fmt::format("2^{}", log2), answer.candidates, all.found, all.missing,
                               all.doubled, 100.0 * all.recall(), answer.search_s, answer.solve_s)
                << std::flush;
  }
  spdlog::set_level(level);
}

}  // namespace

void run_recall(const RecallOptions& options) {
  // The cache is off, so that the search itself is timed.
  setenv("GREATX_CACHE", "off", 1);
  std::vector<std::string> names{options.scenario.scenario};
  if (options.every_scene) names = {"room", "canyon", "city"};
  gpu::Device device(options.run.device_options());
  nlohmann::json results = nlohmann::json::array();
  if (options.paths.scattering > 0) {
    (options.paths.scattering > 1 ? measure_two_bends : measure_scattering)(device, options, names, results);
    if (options.json) std::cout << json_text(results) << '\n';
    return;
  }
  bool perfect = true;
  for (const std::string& name : names) {
    const Case c = make_case(options, name);
    nlohmann::json& result = results.emplace_back();
    result = {{"scene", c.experiment.scenario.name},
              {"facets", c.experiment.scene().facets.size()},
              {"receivers", c.receivers.size()},
              {"max_depth", options.paths.max_depth},
              {"max_transmissions", options.paths.max_transmissions},
              {"edges", options.paths.edges},
              {"reference_s", c.reference_s},
              {"reference_sequences", c.reference.sequences}};
    if (!options.json)
      std::cout
          << fmt::format(
                 "{}: {} facets, {} receivers, {} interactions, of them {} walls{}; reference {:.1f} s\n",
                 c.experiment.scenario.name, c.experiment.scene().facets.size(), c.receivers.size(),
                 options.paths.max_depth, options.paths.max_transmissions,
                 options.paths.edges == 0   ? ""
                 : options.paths.edges == 1 ? " and one edge"
                                            : " and two edges",
                 c.reference_s)
          << std::flush;
    perfect = measure_beams(device, c, options.json, result) && perfect;
    measure_rays(device, c, options, result);
    check_validation(device);
  }
  if (options.json) std::cout << json_text(results) << '\n';
  if (!perfect) throw Failed{};
}

}  // namespace greatx::apps
