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
#include "apps/fit/fit_file.h"
#include "apps/fit/run.h"
#include "core/error.h"
#include "io/files/file.h"
#include "sim/experiment/experiment.h"

namespace greatx::apps {

namespace {

struct CalibrateOptions : FitOptions {
  bool again = false;
};

/// Refuses the options of one meaning beside a file of the other.
void check_options(const CalibrateOptions& options, bool fit) {
  const auto refuse = [&](bool given, const char* option) {
    if (given)
      throw_user_error("{}: expected a {} beside it, found the {} {}", option,
                       fit ? "scenario" : "fit (measurements)", fit ? "fit" : "scenario",
                       options.scenario.scenario);
  };
  if (fit) return refuse(options.again, "--again");
  refuse(options.resume, "--resume");
  refuse(options.no_pictures, "--no-pictures");
}

void run_calibrate(const CalibrateOptions& options) {
  const bool fit = is_fit_file(options.scenario.scenario);
  check_options(options, fit);
  if (fit) return run_fit(options);
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
  CLI::App* command =
      app.add_subcommand("calibrate",
                         "fit materials to measurements (a file with 'greatx_fit: 1' and -o DIR; "
                         "docs/fit.md), or choose settings "
                         "for a scenario that gives errors (accuracy) or a time budget (docs/accuracy.md)");
  auto options = std::make_shared<CalibrateOptions>();
  options->scenario.add_to(*command);
  options->run.add_to(*command);
  command->add_option("-o,--output", options->output,
                      "of a fit: folder for materials.yaml, report and pictures; of a scenario: file for the "
                      "scenario with the choice");
  command->add_flag("--again", options->again, "of a scenario: calibrate even if the cache has the choice");
  command->add_flag("--resume", options->resume, "of a fit: go on with the fit in the folder");
  command->add_flag("--no-pictures", options->no_pictures, "of a fit: write no pictures");
  command->add_flag("--json", options->json, "print one JSON object with the result");
  command->add_flag("-q,--quiet", options->quiet, "print nothing but warnings and errors");
  command->callback([options] { run_calibrate(*options); });
}

}  // namespace greatx::apps
