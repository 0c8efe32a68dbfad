// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/fit/run.h"

#include <chrono>
#include <iostream>

#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "apps/console/watch.h"
#include "apps/fit/fit_file.h"
#include "apps/fit/journal.h"
#include "apps/fit/materials_file.h"
#include "apps/fit/pictures.h"
#include "apps/fit/result.h"
#include "core/hash.h"
#include "io/files/file.h"
#include "io/formats/png.h"
#include "sim/fit/links.h"

namespace greatx::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Returns everything that decides the bytes of the result.
Json request_of(const FitFile& fit, const FitInput& input, const FitOptions& options,
                const sim::Experiment& experiment, uint32_t channel, const gpu::Device& device) {
  const sim::Scenario& scenario = experiment.scenario;
  Json json{{"greatx", GREATX_VERSION},
            {"fit", fs::path(fit.file).filename().string()},
            {"fit_sha256", Sha256().update(fit.text).hex()},
            {"scenario", scenario.name},
            {"scenario_sha256", Sha256().update(scenario.text).hex()},
            {"scene_sha256", experiment.scene().hash},
            {"device", device.info().name},
            {"driver", device.info().driver},
            {"channel", scenario.channels[channel].name},
            {"carrier_hz", scenario.channels[channel].carrier_hz},
            {"seed", scenario.seed},
            {"split",
             {{"block_m", input.problem.split.block_m},
              {"held_out", input.problem.split.held_out},
              {"seed", input.problem.split.seed}}},
            {"pictures", !options.no_pictures}};
  json["measurements"] = Json::array();
  for (const FitData& data : input.data)
    json["measurements"].push_back({{"file", data.name}, {"sha256", data.sha256}});
  json["effects"] = Json::object();
  for (const sim::Effect* effect : experiment.plan.all()) json["effects"][effect->name] = effect->on;
  return json;
}

std::vector<sim::FitLink> solve_paths(const FitOptions& options, gpu::Device& device,
                                      const sim::Experiment& experiment, uint32_t channel,
                                      const sim::FitProblem& problem, const sim::FitMaterials& materials) {
  size_t positions = 0;
  for (const sim::FitSet& set : problem.sets) positions += set.points.size();
  Progress progress("paths", static_cast<int64_t>(positions), options.quiet, "positions");
  std::optional<std::vector<sim::FitLink>> links;
  try {
    const TerminalWatch watch(options.quiet);
    links = sim::solve_links(device, experiment, channel, problem, materials, [&](size_t done) {
      progress.update(static_cast<int64_t>(done));
      return !interrupted();
    });
  } catch (const Interrupted&) {
    links.reset();
  }
  if (!links)
    throw Interrupted(fmt::format("{}: stopped before all paths were found; the same command begins again",
                                  options.output));
  return std::move(*links);
}

/// Throws UserError unless the lists of a state that was read have the lengths of this fit.
void check_state(const sim::FitState& state, const sim::FitModel& model, const std::string& folder) {
  const size_t variables = model.variables().size(), sets = model.problem().sets.size();
  const auto fits = [&](const std::vector<double>& of, bool may_be_empty) {
    return of.size() == variables || (may_be_empty && of.empty());
  };
  if (!fits(state.coordinates, false) || !fits(state.best, true) || state.sigmas.size() != sets ||
      !fits(state.before, state.stage == sim::FitStage::unknowns))
    throw_user_error("{}: expected the state of a fit of {} variables, found another one in fit.part", folder,
                     variables);
}

void iterate(const FitOptions& options, const sim::FitSolver& solver, FitJournal& journal,
             sim::FitState& state) {
  Progress progress("fit", static_cast<int64_t>(solver.runs()), options.quiet, "runs");
  const auto show = [&] { progress.update(static_cast<int64_t>(solver.runs_done(state))); };
  show();
  try {
    const TerminalWatch watch(options.quiet);
    while (!state.done) {
      if (interrupted()) throw Interrupted("");
      sim::FitState next = state;
      solver.step(next);
      state = std::move(next);
      journal.write(state);
      show();
    }
  } catch (const Interrupted&) {
    throw Interrupted(fmt::format("{}: {} of {} runs are kept; the same command with --resume goes on",
                                  options.output, solver.runs_done(state), solver.runs()));
  }
}

Json write_pictures(const FitOptions& options, const FitResult& result, const sim::Experiment& experiment,
                    const std::string& title) {
  Json files = Json::array();
  const fs::path folder = options.output;
  const auto write = [&](const std::string& file, const Array& image) {
    io::write_file_atomically(folder / file, io::encode_png(image));
    files.push_back(file);
  };
  const std::vector<sim::FitSet>& sets = result.model->problem().sets;
  for (uint32_t s = 0; s < sets.size(); ++s) {
    std::vector<double> heights;
    for (const dvec3& point : sets[s].points) heights.push_back(point.z);
    const auto middle = heights.begin() + static_cast<ptrdiff_t>(heights.size() / 2);
    std::nth_element(heights.begin(), middle, heights.end());
    const std::vector<PlanLine> plan = plan_lines(*result.model, experiment.scene().origin, *middle);
    write(fmt::format("errors_{}.png", sets[s].name), draw_error_map(result, s, plan, title));
    write(fmt::format("distributions_{}.png", sets[s].name), draw_distributions(result, s, title));
  }
  write("correlation.png", draw_correlations(result, title));
  return files;
}

}  // namespace

void run_fit(const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  if (options.output.empty())
    throw_user_error("-o: expected a folder for the result of the fit {}, found none",
                     options.scenario.scenario);
  const FitFile fit = read_fit_file(options.scenario.scenario);
  ScenarioOptions from = options.scenario;
  from.scenario = fit.scenario;
  sim::Scenario scenario = load_scenario(from);
  const uint32_t channel = find_channel(fit.channel, scenario);
  const FitInput input = read_fit_input(fit, scenario, channel);
  auto world = std::make_shared<const sim::World>(sim::load_world(scenario));
  const double carrier_hz = scenario.channels[channel].carrier_hz;
  const sim::FitMaterials materials(world->scene, carrier_hz, input.problem.parameters);
  const sim::Experiment experiment =
      sim::make_experiment(std::move(scenario), std::move(world), sim::bounds_of(input.problem.sets));
  gpu::Device device(options.run.device_options());
  const Json request = request_of(fit, input, options, experiment, channel, device);
  FitJournal journal(options.output, request, options.resume);
  if (journal.finished()) {
    if (!options.quiet) std::cout << options.output << " is already finished\n";
    return;
  }
  install_interrupt_handler();

  std::vector<sim::FitLink> links =
      solve_paths(options, device, experiment, channel, input.problem, materials);
  check_validation(device);
  const double paths_s = seconds();
  size_t paths = 0;
  std::vector<dvec3> places;
  for (const sim::FitLink& link : links) paths += link.paths.size(), places.push_back(link.place);
  const sim::FitBlocks blocks = sim::split_by_place(places, input.problem.split);
  const sim::FitModel model(input.problem, materials, carrier_hz, std::move(links));
  FitResult result;
  result.model = &model;
  std::vector<uint32_t> fitted, fitted_blocks;
  for (uint32_t l = 0; l < model.links().size(); ++l) {
    if (!model.usable(l)) continue;
    if (blocks.held_out[blocks.of[l]]) {
      ++result.held_out;
      continue;
    }
    fitted.push_back(l);
    fitted_blocks.push_back(blocks.of[l]);
  }
  result.fitted = fitted.size();
  const sim::FitSolver solver(model, fitted);
  if (journal.state()) check_state(*journal.state(), model, options.output);
  result.state = journal.state() ? *journal.state() : solver.begin();
  if (!journal.state()) journal.write(result.state);
  iterate(options, solver, journal, result.state);

  result.assessment = sim::assess(model, solver, result.state, fitted_blocks);
  result.places = places_of(model, result.state, blocks);
  const fs::path folder = options.output;
  const std::string title =
      fmt::format("{}, {}", fs::path(fit.file).filename().string(), experiment.scenario.name);
  io::write_file_atomically(folder / "materials.yaml",
                            fitted_sidecar(experiment.scenario.scene.radio_materials, experiment.scene(),
                                           model, result.assessment, title));
  io::write_file_atomically(folder / "positions.csv", places_csv(result));
  const std::string words = fit_words(result);
  io::write_file_atomically(folder / "report.txt", words);
  Json json{{"request", request}};
  json.update(fit_json(result));
  json["pictures"] = options.no_pictures ? Json::array() : write_pictures(options, result, experiment, title);
  io::write_file_atomically(folder / fit_description, json_text(json) + "\n");
  journal.finish();
  if (options.json) {
    json["seconds"] = seconds();
    json["paths_s"] = paths_s;
    json["paths"] = paths;
    std::cout << json_text(json) << '\n';
  } else if (!options.quiet) {
    std::cout << words
              << fmt::format("{} paths to {} positions in {:.1f} s, all in {:.1f} s\nwrote {}\n", paths,
                             result.places.size(), paths_s, seconds(), options.output);
  }
}

}  // namespace greatx::apps
