// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/place/scene_build.h"

#include <chrono>
#include <iostream>

#include <fmt/format.h>

#include "apps/console/progress.h"
#include "apps/place/report.h"
#include "io/files/file.h"
#include "io/formats/png.h"
#include "scene/gltf/model.h"
#include "scene/place/source/source.h"
#include "scene/place/surfaces/material_table.h"

namespace greatx::apps {

namespace {

void write_text(const std::filesystem::path& file, const std::string& text) {
  io::write_file_atomically(file, std::as_bytes(std::span(text)));
}

/// Loads what was built as any scene is loaded, and checks it.
LoadedPlace load(const std::string& name, const scene::place::BuiltPlace& built) {
  const scene::Model model =
      scene::load_model(name, built.glb, {.radio_materials = {}, .optical_only = true, .keep_faults = true});
  LoadedPlace loaded;
  loaded.check = scene::check_scene(model);
  loaded.facets = loaded.check.figures.facets;
  return loaded;
}

}  // namespace

void build_scene(const BuildCommand& command) {
  if (command.print_materials) {
    std::cout << scene::place::MaterialTable::default_text();
    return;
  }
  if (command.file.empty())
    throw_user_error("scene build: expected the file of a place, place.yaml, found nothing");
  scene::place::PlaceConfig config = scene::place::load_place_config(command.file, command.assets);
  if (command.simplify_m) config.simplify_m = *command.simplify_m;
  const std::filesystem::path output = command.output.empty() ? std::filesystem::path(config.name + ".glb")
                                                              : std::filesystem::path(command.output);
  const std::filesystem::path folder = command.report.empty()
                                           ? output.parent_path() / (output.stem().string() + "_report")
                                           : std::filesystem::path(command.report);
  const auto begin = std::chrono::steady_clock::now();
  scene::place::BuiltPlace built;
  scene::place::PlaceInput input;
  {
    Progress progress(config.name, 100, command.quiet || command.json, "");
    // Reading takes some two fifths of the time.
    input = scene::place::read_place(config, [&](const std::string&) { progress.update(5); });
    progress.update(40);
    built = scene::place::build_place(input, config, [&](const std::string&, double share) {
      progress.update(40 + static_cast<int64_t>(60.0 * share));
    });
  }
  const LoadedPlace loaded = load(output.string(), built);
  io::create_folder_of(output);
  io::write_file_atomically(output, built.glb);
  std::filesystem::create_directories(folder);
  const nlohmann::json json = json_of(built.report, loaded);
  write_text(folder / "report.json",
             json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  write_text(folder / "report.md", markdown_of(built.report, loaded));
  io::write_file_atomically(folder / "plan.png",
                            io::encode_png(picture_of(built, input), io::PngCoding::small));
  if (command.json) {
    std::cout << json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    return;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::cout << fmt::format("wrote {} ({:.1f} MiB) in {:.1f} s, and {}/\n", output.string(),
                           static_cast<double>(built.glb.size()) / 1048576.0, seconds, folder.string())
            << summary_of(built.report, loaded);
}

}  // namespace greatx::apps
