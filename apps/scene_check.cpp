// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/scene_check.h"

#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "apps/check/scene_report.h"
#include "apps/console/command_line.h"
#include "apps/console/exit_code.h"
#include "apps/console/json_text.h"
#include "apps/files/scene_import.h"
#include "core/error.h"
#include "io/files/file.h"
#include "io/formats/png.h"
#include "scene/check/check.h"

namespace greatx::apps {
namespace {

struct SceneCheckCommand {
  std::string file, json, png;
  scene::LoadOptions load;
  scene::CheckOptions check;
  uint32_t places = 5;
  bool quiet = false;
};

std::string counted(uint64_t count, const char* word) {
  return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
}

void write_files(const SceneCheckCommand& command, const scene::Model& model,
                 const scene::SceneFaults& faults) {
  if (!command.png.empty() && faults.figures.bounds.empty())
    throw_user_error("{}: there is no triangle to draw", command.file);
  if (!command.json.empty()) {
    io::create_folder_of(command.json);
    io::write_file_atomically(command.json, json_text(scene_check_json(command.file, faults)) + "\n");
  }
  if (command.png.empty()) return;
  io::create_folder_of(command.png);
  io::write_file_atomically(command.png, io::encode_png(draw_faults(model, faults, 1200)));
}

void check_file(const SceneCheckCommand& command) {
  scene::LoadOptions load = command.load;
  load.optical_only = load.keep_faults = true;
  const scene::Model model = scene::load_model(std::filesystem::path(command.file), load);
  scene::CheckOptions options = command.check;
  options.radio = !command.load.optical_only;
  options.most_places = std::max<size_t>(options.most_places, command.places);
  const scene::SceneFaults faults = scene::check_scene(model, options);
  write_files(command, model, faults);
  std::cout << scene_check_text(command.file, faults, command.places, !command.quiet);
  const uint64_t bad = faults.count(scene::FaultSeverity::fault),
                 doubtful = faults.count(scene::FaultSeverity::doubt);
  if (!command.quiet)
    std::cout << fmt::format("{}: {}, {}\n", command.file, bad == 0 ? "no faults" : counted(bad, "fault"),
                             doubtful == 0 ? "no doubts" : counted(doubtful, "doubt"));
  if (bad > 0) throw Failed{exit_user};
}

void add_limits(CLI::App& command, scene::CheckOptions& check) {
  const auto length = [&](const char* name, double& value, const char* words) {
    command.add_option(name, value, words)->capture_default_str()->check(number_of(0.0, 1000.0));
  };
  length("--weld", check.weld_m, "distance within which corners and open edges meet, m");
  length("--gap", check.gap_m, "gap below which faces flicker, m");
  length("--overlap", check.overlap_m2, "least area of an overlap of faces, m2");
  length("--sliver", check.sliver_m, "height below which a triangle is a sliver, m");
  length("--facet", check.facet_m, "mean width below which a facet is tiny, m");
  command.add_option("--rays", check.rays, "rays from within each solid; 0: none")
      ->capture_default_str()
      ->check(integer_of(0, 1'000'000));
  command.add_option("--seed", check.seed, "of these rays")->capture_default_str();
}

}  // namespace

void add_scene_check(CLI::App& scene_command) {
  CLI::App* command =
      scene_command.add_subcommand("check",
                                   "look for faults of a glTF file: leaks, coincident faces, wrong "
                                   "sides, slivers, materials (docs/check.md)");
  auto options = std::make_shared<SceneCheckCommand>();
  command->add_option("FILE", options->file, ".gltf or .glb")->required();
  command->add_option("--radio-materials", options->load.radio_materials,
                      "YAML with radio properties (docs/materials.md)");
  command->add_flag("--optical-only", options->load.optical_only, "materials need no radio properties");
  add_limits(*command, options->check);
  command->add_option("--places", options->places, "places that are printed of each kind")
      ->capture_default_str()
      ->check(integer_of(0, 1'000'000));
  command->add_option("--json", options->json, "also write everything as JSON, up to 1000 places of a kind");
  command->add_option("--png", options->png, "also draw the scene from above with its faults");
  command->add_flag("-q,--quiet", options->quiet, "print nothing but what is found");
  command->callback([options] { check_file(*options); });
}

}  // namespace greatx::apps
