// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// greatx-places: `greatx scene build` in a program of its own (apps/place/command/build_command.h).
#include <iostream>

#include "apps/console/command_line.h"
#include "apps/console/exit.h"
#include "apps/console/help.h"
#include "apps/console/parse_error.h"
#include "apps/console/terminal.h"
#include "apps/place/scene_build.h"
#include "io/files/file.h"

int main(int argc, char** argv) {
  using namespace greatx;
  io::ignore_file_size_signal();
  apps::set_up_logging("greatx");
  const apps::SafeStream safe_out(std::cout), safe_err(std::cerr);
  CLI::App app{"greatx-places does the work of `greatx scene build`, which starts it.", "greatx scene build"};
  app.formatter(apps::help_formatter());
  apps::BuildCommand command;
  apps::add_build_options(app, command);
  apps::read_numbers_strictly(app);
  try {
    app.parse(argc, argv);
    apps::build_scene(command);
    apps::check_printed();
    return apps::exit_success;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::cerr << "greatx: error: " << apps::parse_error_words(app, error) << '\n';
    return apps::exit_user;
  } catch (...) {
    return apps::report_exception("greatx");
  }
}
