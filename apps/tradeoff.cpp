// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/exit_code.h"
#include "apps/console/progress.h"
#include "apps/tradeoff/report.h"
#include "apps/tradeoff/study.h"
#include "core/error.h"
#include "core/expected.h"

namespace greatx::apps {

namespace {

struct TradeoffOptions {
  ScenarioOptions scenario;
  RunOptions run;
  StudyOptions study;
  std::string output;
};

void check_parts(const std::vector<std::string>& only) {
  std::vector<std::string_view> names;
  for (const sim::Modality known : sim::all_modalities) names.push_back(sim::name_of(known));
  names.push_back(map_part);
  for (const std::string& name : only)
    if (std::ranges::find(names, name) == names.end())
      throw_user_error("--only: {}", expected_one_of(names, name));
}

void run_tradeoff(TradeoffOptions options) {
  check_parts(options.study.only);
  if (options.study.quick) {
    options.study.blocks = 1;
    options.study.ticks = 2;
    options.study.joint = 3;
    options.study.joint_s = 3.0;
  }
  install_interrupt_handler();
  Study study(options.scenario, options.run, options.study, options.output);
  const bool complete = study.run();
  write_report(study.report(), options.output);
  std::cout << fmt::format("{} {}/index.html\n", complete ? "wrote" : "interrupted:", options.output);
  if (!complete) throw Failed{exit_interrupted};
}

}  // namespace

void add_tradeoff(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "tradeoff", "measure what each knob of a scenario costs in time and in accuracy, and report it");
  auto options = std::make_shared<TradeoffOptions>();
  options->scenario.add_to(*command);
  options->run.add_to(*command);
  command->add_option("-o,--output", options->output, "folder for the report; an interrupted study goes on")
      ->required();
  command->add_flag("--quick", options->study.quick,
                    "fewer ticks, and without settings that cost many times the default");
  command->add_option("--only", options->study.only, "parts: csi, map, camera, events, lidar, radar")
      ->delimiter(',');
  command->add_option("--knob", options->study.knobs, "knobs by name, without joint settings")
      ->delimiter(',');
  command->add_flag("--quiet", options->study.quiet, "print no progress");
  command->callback([options] { run_tradeoff(*options); });
}

}  // namespace greatx::apps
