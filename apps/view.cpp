// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/session.h"
#include "core/error.h"
#include "io/dataset/dataset_format.h"
#include "sim/scenario/parse/load_scenario.h"
#include "view/app/viewer.h"

namespace greatx::apps {

namespace {

struct ViewOptions {
  std::vector<std::string> what;
  ScenarioOptions scenario;
  RunOptions run;
  bool offscreen = false, paused = false;
  double scale = 0.0;
  std::string script, size, settings;
};

/// Returns the folder of the viewer's settings; nothing if there can be none.
std::filesystem::path settings_folder() {
  const char* const config = std::getenv("XDG_CONFIG_HOME");
  const char* const home = std::getenv("HOME");
  std::filesystem::path folder;
  if (config != nullptr && *config != '\0')
    folder = config;
  else if (home != nullptr && *home != '\0')
    folder = std::filesystem::path(home) / ".config";
  else
    return {};
  std::error_code error;
  std::filesystem::create_directories(folder / "greatx", error);
  return error ? std::filesystem::path{} : folder / "greatx";
}

bool is_dataset(const std::string& what) {
  std::error_code error;
  return std::filesystem::exists(std::filesystem::path(what) / io::dataset_file, error);
}

view::ViewerOptions viewer_options(const ViewOptions& options) {
  view::ViewerOptions viewer;
  for (const std::string& what : options.what) {
    if (std::filesystem::is_directory(what) && !is_dataset(what))
      throw_user_error("{}: expected a data set or a scenario, found a folder without {}", what,
                       io::dataset_file);
    if (is_dataset(what)) viewer.datasets.emplace_back(what);
    viewer.title += (viewer.title.empty() ? "" : ", ") + what;
  }
  if (viewer.datasets.size() != options.what.size() && options.what.size() > 1)
    throw_user_error("expected one scenario, or data sets alone, found {} things to view",
                     options.what.size());
  if (viewer.datasets.empty()) {
    ScenarioOptions scenario = options.scenario;
    if (!options.what.empty()) scenario.scenario = options.what.front();
    viewer.title = scenario.scenario;
    viewer.scenario = [scenario] { return load_scenario(scenario); };
    viewer.assets = options.scenario.assets;
    viewer.reparse = [assets = options.scenario.assets](const sim::Scenario& before,
                                                        const std::string& text) {
      const bool embedded = before.file.empty();
      sim::Scenario changed =
          sim::parse_scenario(text, embedded ? before.name + ".yaml" : before.file.string(),
                              embedded ? std::filesystem::path(".") : before.file.parent_path(), assets);
      changed.file = before.file;
      return changed;
    };
  }
  viewer.scenario_of = [assets = options.scenario.assets](const std::string& text,
                                                          const std::filesystem::path& dataset) {
    return sim::parse_scenario(text, (dataset / io::scenario_file).string(),
                               std::filesystem::absolute(dataset), assets);
  };
  viewer.device = options.run.device_options();
  viewer.paused = options.paused;
  viewer.chosen_size = !options.size.empty();
  if (viewer.chosen_size)
    std::tie(viewer.window.width, viewer.window.height) = parse_window_size(options.size);
  viewer.window.scale = options.scale;
  viewer.window.offscreen = options.offscreen;
  viewer.window.validation = options.run.validation;
  viewer.window.device = options.run.device;
  if (!options.script.empty()) {
    viewer.script = view::load_script(options.script);
    viewer.script_folder = ".";
  } else if (options.offscreen) {
    throw_user_error("--offscreen: expected a --script to drive the viewer, found none");
  } else {
    // Scripts draw the same on every machine, so they remember and know nothing unless they are told to.
    if (const std::filesystem::path folder = settings_folder(); !folder.empty()) {
      viewer.window.settings_file = (folder / "viewer.ini").string();
      viewer.settings_file = folder / "viewer.json";
    }
  }
  if (!options.settings.empty()) viewer.settings_file = options.settings;
  return viewer;
}

}  // namespace

void add_view(CLI::App& app) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* const command = app.add_subcommand(
      "view", "run a scenario live in a window, or replay data sets, and fly through the scene");
  command->add_option("WHAT", options->what,
                      "a scenario (a file, or an embedded one), or data sets to replay side by side [city]");
  command->add_option("--assets", options->scenario.assets,
                      "folder to look in for files that are not beside the scenario");
  command->add_option("--seed", options->scenario.seed, "instead of the scenario's seed");
  command->add_option("--ticks", options->scenario.ticks, "instead of the scenario's length")
      ->check(integer_of(1, 1'000'000'000'000));
  command
      ->add_option("--sequences", options->scenario.sequences,
                   "instead of the scenario's number of sequences")
      ->check(integer_of(1, 1'000'000));
  options->run.add_to(*command);
  command->add_flag("--paused", options->paused, "show the first tick and wait");
  command->add_option("--size", options->size, "of the window, pixels [that of the last time, or 1280x720]");
  command->add_option("--scale", options->scale, "of texts and buttons [as the display asks for]")
      ->check(number_of(0.5, 4.0));
  command->add_option("--settings", options->settings,
                      "file in which the viewer remembers its settings, for scripts, too "
                      "[~/.config/greatx/viewer.json; none for scripts]");
  command->add_option("--script", options->script, "actions to run instead of a person (docs/viewer.md)");
  command->add_flag("--offscreen", options->offscreen, "draw without a display; needs --script");
  command->callback([options] { view::run_viewer(viewer_options(*options)); });
}

}  // namespace greatx::apps
