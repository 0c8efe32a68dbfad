// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "apps/calibration/resolve.h"
#include "apps/commands.h"
#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "apps/console/session.h"
#include "core/error.h"
#include "io/files/file.h"
#include "sim/experiment/experiment.h"

namespace greatx::apps {

namespace {

struct CalibrateOptions {
  ScenarioOptions scenario;
  RunOptions run;
  std::string output;
  bool again = false, json = false, quiet = false;
};

void run_calibrate(const CalibrateOptions& options) {
  const sim::Experiment experiment = sim::make_experiment(load_scenario(options.scenario, true));
  if (experiment.scenario.accuracy.empty())
    throw_user_error("{}: expected 'accuracy' or 'time_budget_ms_per_tick', found neither",
                     options.scenario.scenario);
  gpu::Device device(options.run.device_options());
  install_interrupt_handler();
  const Resolved resolved =
      resolve(experiment, device, options.scenario.assets, {}, options.again, options.quiet);
  check_validation(device);
  if (!options.output.empty()) io::write_file_atomically(options.output, resolved.scenario.text);
  if (options.json)
    std::cout << json_text(resolved.json) << '\n';
  else if (!options.quiet)
    std::cout << calibration_words(resolved.json) << (resolved.source == "cache" ? "from the cache\n" : "")
              << (options.output.empty() ? "" : fmt::format("wrote {}\n", options.output));
}

}  // namespace

void add_calibrate(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "calibrate", "choose settings for a scenario that gives errors (accuracy) or a time budget");
  auto options = std::make_shared<CalibrateOptions>();
  options->scenario.add_to(*command);
  options->run.add_to(*command);
  command->add_option("-o,--output", options->output, "file for the scenario with the choice");
  command->add_flag("--again", options->again, "calibrate even if the cache has the choice");
  command->add_flag("--json", options->json, "print one JSON object with the choice");
  command->add_flag("-q,--quiet", options->quiet, "print nothing but warnings and errors");
  command->callback([options] { run_calibrate(*options); });
}

}  // namespace greatx::apps
