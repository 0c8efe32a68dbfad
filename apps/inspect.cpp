// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "draw/sheet/animation.h"
#include "draw/sheet/contact_sheet.h"
#include "io/dataset/summary.h"
#include "sim/scenario/scenario.h"

namespace greatx::apps {

void add_inspect(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("inspect", "summarise a data set and draw its contact sheet; compare several");
  struct InspectOptions {
    std::vector<std::string> folders;
    std::string picture, animation;
    size_t frames = 36;
    uint32_t sequence = 0;
    bool json = false;
  };
  auto options = std::make_shared<InspectOptions>();
  command
      ->add_option("DIR", options->folders, "folder of the data set; of several, all are drawn side by side")
      ->required();
  command->add_option("--sequence", options->sequence, "the sequence to draw")
      ->capture_default_str()
      ->check(integer_of(0, sim::most_sequences));
  command->add_option("--picture", options->picture, "where the contact sheet goes [DIR/contact_sheet.png]");
  CLI::Option* const animated =
      command->add_option("--animation", options->animation, "also write an animated picture, FILE.webp");
  command->add_option("--frames", options->frames, "of the animation, at most")
      ->capture_default_str()
      ->check(integer_of(1, 10'000))
      ->needs(animated);
  command->add_flag("--json", options->json, "print one JSON object a data set");
  command->callback([options] {
    std::vector<io::DatasetReader> readers;
    for (const std::string& folder : options->folders) readers.emplace_back(folder);
    if (readers.size() > 1 && options->picture.empty())
      throw_user_error("inspect: several data sets need --picture, for where their sheet goes");
    const std::filesystem::path picture =
        options->picture.empty() ? std::filesystem::path(options->folders[0]) / "contact_sheet.png"
                                 : std::filesystem::path(options->picture);
    if (readers.size() > 1 && !options->animation.empty())
      throw_user_error("inspect: --animation shows one data set, found {}", readers.size());
    std::optional<io::AnimationFile> shown;
    if (!options->animation.empty())
      shown = io::write_animation(readers[0], options->animation, options->frames, options->sequence);
    io::write_contact_sheet(readers, picture, options->sequence);
    for (const io::DatasetReader& reader : readers)
      std::cout << (options->json ? io::to_json(io::summarize(reader)) + "\n"
                                  : io::to_text(io::summarize(reader)));
    if (options->json) return;
    std::cout << "contact sheet: " << picture.string() << '\n';
    if (shown)
      std::cout << fmt::format("animation: {}, {} frames of {} x {} pixels, {:.3g} s, {:.2f} MB\n",
                               options->animation, shown->frames, shown->width, shown->height,
                               1e-3 * shown->duration_ms, 1e-6 * static_cast<double>(shown->bytes));
  });
}

}  // namespace greatx::apps
