// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <greatx_commit.h>
#include <iostream>

#include "apps/bench/bench.h"
#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/exit.h"
#include "apps/console/run_record.h"
#include "apps/console/terminal.h"
#include "core/activity.h"
#include "core/version.h"
#include "io/files/file.h"

int main(int argc, char** argv) {
  using namespace greatx;
  io::ignore_file_size_signal();  // so that a write beyond the shell's file size limit returns an error
  apps::set_up_logging("greatx");
  set_commit(GREATX_COMMIT);
  apps::set_command_line(argc, argv);
  watch_memory();
  const apps::SafeStream safe_out(std::cout), safe_err(std::cerr);
  CLI::App app{
      "greatx simulates sensing and communication in one scene on one clock: RGB, depth, ids, LiDAR and "
      "channel state "
      "information, aligned to the tick and the pixel."};
  app.set_version_flag("--version", "greatx " GREATX_VERSION " (" GREATX_COMMIT ")");
  app.require_subcommand(1);
  app.footer(
      "greatx COMMAND --help tells more. Exit codes: 0 success, 1 faulty input or data, 2 device or "
      "program, 130 interrupted.");
  apps::add_info(app);
  apps::add_generate(app);
  apps::add_view(app);
  apps::add_inspect(app);
  apps::add_verify(app);
  apps::add_check(app);
  apps::add_campaign(app);
  apps::add_scene(app);
  apps::add_explain(app);
  apps::add_paths(app);
  apps::add_map(app);
  apps::add_rcs(app);
  apps::add_cache(app);
  apps::add_tradeoff(app);
  apps::add_calibrate(app);
  apps::add_bench(app);
  apps::add_selftest(app);
  apps::add_manual(app);
  apps::read_numbers_strictly(app);
  try {
    app.parse(argc, argv);
    apps::check_printed();
    return apps::exit_success;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string unknown = apps::unknown_command(app, {argv + 1, argv + argc});
    std::cerr << "greatx: error: " << (unknown.empty() ? error.what() : unknown)
              << "\n--help tells what there is.\n";
    return apps::exit_user;
  } catch (...) {
    return apps::report_exception("greatx");
  }
}
