// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The options of `greatx scene build`. Reading maps needs GDAL and some hundred libraries below it, which no
// other command needs. They are therefore linked to a program of their own, greatx-places, which lies beside
// greatx; `greatx scene build` starts it with the same arguments.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace greatx::apps {

struct BuildCommand {
  std::string file, assets, output, report;
  std::optional<double> simplify_m;  ///< instead of the place's own
  bool quiet = false, json = false, print_materials = false;
};

/// Adds the options, which write to `command`.
void add_build_options(CLI::App& app, BuildCommand& command);
/// Returns the arguments that give `command` again.
std::vector<std::string> arguments_of(const BuildCommand& command);

/// Adds `build` to the command `scene`. Its callback replaces this process by greatx-places. Throws
/// UserError, which names the packages to install, if there is no such program.
void add_scene_build(CLI::App& scene_command);

}  // namespace greatx::apps
