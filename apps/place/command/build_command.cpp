// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/place/command/build_command.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <unistd.h>

#include <fmt/format.h>

#include "core/error.h"
#include "core/expected.h"
#include "core/text.h"

namespace greatx::apps {

namespace {

constexpr const char* program_name = "greatx-places";
constexpr double most_simplify_m = 10.0;

[[noreturn]] void start_program(const BuildCommand& command) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / program_name;
  if (!std::filesystem::exists(program))
    throw_user_error(
        "scene build: {} was not built, because GDAL, PROJ, GEOS or libosmium was missing: install "
        "libgdal-dev "
        "libproj-dev libgeos-dev libosmium2-dev libexpat1-dev libbz2-dev (scripts/setup.sh does so on Debian "
        "and "
        "Ubuntu), then configure and build again (GREATX_PLACES=ON)",
        program.string());
  std::vector<std::string> words = arguments_of(command);
  words.insert(words.begin(), program.string());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  throw_user_error("{}: cannot be started: {}", program.string(), std::strerror(errno));
}

}  // namespace

void add_build_options(CLI::App& app, BuildCommand& command) {
  app.add_option("FILE", command.file, "the place, .yaml; needed unless --print-materials is there");
  app.add_option("--assets", command.assets, "folder to look in for files that are not beside place.yaml");
  app.add_option("-o,--output", command.output, ".glb to write [NAME.glb]");
  app.add_option("--report", command.report, "folder of the report [NAME_report, beside the output]");
  app.add_option("--simplify", command.simplify_m, "detail of outlines below this many metres may go")
      ->check(CLI::Validator(
          [](std::string& text) {
            const std::optional<double> value = parse_number(text);
            if (value && *value >= 0.0 && *value <= most_simplify_m) return std::string();
            return fmt::format("expected {}, found '{}'", number_range(0.0, most_simplify_m),
                               printable(text));
          },
          fmt::format("0 to {}", number_words(most_simplify_m))));
  app.add_flag("--json", command.json, "print the report as JSON");
  app.add_flag("-q,--quiet", command.quiet, "show no progress");
  app.add_flag("--print-materials", command.print_materials,
               "print greatx's table of materials, to be edited");
}

std::vector<std::string> arguments_of(const BuildCommand& command) {
  std::vector<std::string> words;
  if (!command.assets.empty()) words.push_back("--assets=" + command.assets);
  if (!command.output.empty()) words.push_back("--output=" + command.output);
  if (!command.report.empty()) words.push_back("--report=" + command.report);
  if (command.simplify_m) words.push_back(fmt::format("--simplify={}", *command.simplify_m));
  if (command.json) words.emplace_back("--json");
  if (command.quiet) words.emplace_back("--quiet");
  if (command.print_materials) words.emplace_back("--print-materials");
  if (!command.file.empty()) {
    words.emplace_back("--");  // a name may begin with a dash
    words.push_back(command.file);
  }
  return words;
}

void add_scene_build(CLI::App& scene_command) {
  CLI::App* app = scene_command.add_subcommand(
      "build", "make a real place from maps, terrain and imagery (docs/places.md)");
  auto command = std::make_shared<BuildCommand>();
  add_build_options(*app, *command);
  app->callback([command] { start_program(*command); });
}

}  // namespace greatx::apps
