// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "apps/commands.h"
#include "io/contact_sheet.h"
#include "io/summary.h"

namespace greatx::apps {

void add_inspect(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("inspect", "summarise a data set and draw its contact sheet; compare several");
  struct Options {
    std::vector<std::string> folders;
    std::string picture;
    uint32_t sequence = 0;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  command
      ->add_option("DIR", options->folders, "folder of the data set; of several, all are drawn side by side")
      ->required();
  command->add_option("--sequence", options->sequence, "the sequence to draw")->capture_default_str();
  command->add_option("--picture", options->picture, "where the contact sheet goes [DIR/contact_sheet.png]");
  command->add_flag("--json", options->json, "print one JSON object a data set");
  command->callback([options] {
    std::vector<io::DatasetReader> readers;
    for (const std::string& folder : options->folders) readers.emplace_back(folder);
    if (readers.size() > 1 && options->picture.empty())
      throw_user_error("inspect: several data sets need --picture, for where their sheet goes");
    const std::filesystem::path picture =
        options->picture.empty() ? std::filesystem::path(options->folders[0]) / "contact_sheet.png"
                                 : std::filesystem::path(options->picture);
    io::write_contact_sheet(readers, picture, options->sequence);
    for (const io::DatasetReader& reader : readers)
      std::cout << (options->json ? io::to_json(io::summarize(reader)) + "\n"
                                  : io::to_text(io::summarize(reader)));
    if (!options->json) std::cout << "contact sheet: " << picture.string() << '\n';
  });
}

}  // namespace greatx::apps
