// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>

#include "apps/commands.h"
#include "io/contact_sheet.h"
#include "io/summary.h"

namespace greatx::apps {

void add_inspect(CLI::App& app) {
  CLI::App* command = app.add_subcommand("inspect", "summarise a data set and draw its contact sheet");
  struct Options {
    std::string folder, picture;
    uint32_t sequence = 0;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  command->add_option("DIR", options->folder, "folder of the data set")->required();
  command->add_option("--sequence", options->sequence, "the sequence to draw")->capture_default_str();
  command->add_option("--picture", options->picture, "where the contact sheet goes [DIR/contact_sheet.png]");
  command->add_flag("--json", options->json, "print one JSON object");
  command->callback([options] {
    const io::DatasetReader reader(options->folder);
    const io::Summary summary = io::summarize(reader);
    const std::filesystem::path picture = options->picture.empty()
                                              ? std::filesystem::path(options->folder) / "contact_sheet.png"
                                              : std::filesystem::path(options->picture);
    io::write_contact_sheet(reader, picture, options->sequence);
    if (options->json)
      std::cout << io::to_json(summary) << '\n';
    else
      std::cout << io::to_text(summary) << "contact sheet: " << picture.string() << '\n';
  });
}

}  // namespace greatx::apps
