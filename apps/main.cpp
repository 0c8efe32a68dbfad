// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <greatx_commit.h>
#include <iostream>

#include "apps/bench/bench.h"
#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/exit.h"
#include "apps/console/help.h"
#include "apps/console/parse_error.h"
#include "apps/console/run_record.h"
#include "apps/console/terminal.h"
#include "core/activity.h"
#include "core/version.h"
#include "io/files/file.h"

namespace {

/// Adds all commands, in the groups and in the order in which --help shows them.
void add_commands(CLI::App& app) {
  using namespace greatx::apps;
  const auto group = [&](const char* name, std::initializer_list<void (*)(CLI::App&)> adders) {
    const size_t before = app.get_subcommands({}).size();
    for (const auto& add : adders) add(app);
    const std::vector<CLI::App*> commands = app.get_subcommands({});
    for (size_t i = before; i < commands.size(); ++i) commands[i]->group(name);
  };
  group("Make", {add_generate, add_campaign, add_scene});
  group("Look", {add_inspect, add_view});
  group("Check and measure", {add_check, add_verify, add_explain, add_calibrate, add_tradeoff, add_bench});
  group("Radio", {add_paths, add_map, add_rcs});
  group("Machine", {add_info, add_selftest, add_cache, add_manual});
}

}  // namespace

int main(int argc, char** argv) {
  using namespace greatx;
  io::ignore_file_size_signal();  // so that a write beyond the shell's file size limit returns an error
  apps::set_up_logging("greatx");
  set_commit(GREATX_COMMIT);
  apps::set_command_line(argc, argv);
  watch_memory();
  const apps::SafeStream safe_out(std::cout), safe_err(std::cerr);
  CLI::App app{
      "greatx simulates sensing and communication in one scene on one clock. It computes seven modalities: "
      "channel state information (CSI), RGB, depth, LiDAR, radar, events, and poses, aligned to the tick and "
      "the pixel.",
      "greatx"};
  app.formatter(apps::help_formatter());
  app.set_version_flag("--version", "greatx " GREATX_VERSION " (" GREATX_COMMIT ")");
  app.require_subcommand(1);
  app.footer(
      "greatx COMMAND --help tells more. Exit codes: 0 success, 1 faulty input or data, 2 device or "
      "program, 130 interrupted.");
  add_commands(app);
  apps::read_numbers_strictly(app);
  apps::name_values(app);
  try {
    app.parse(argc, argv);
    apps::check_printed();
    return apps::exit_success;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::cerr << "greatx: error: " << apps::parse_error_words(app, error) << '\n';
    return apps::exit_user;
  } catch (...) {
    return apps::report_exception("greatx");
  }
}
