// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/verify.h"

#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/commands.h"

namespace greatx::apps {

void add_verify(CLI::App& app) {
  CLI::App* command = app.add_subcommand("verify", "check a data set: files, hashes, index, lengths, values");
  struct Options {
    std::string folder;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  command->add_option("DIR", options->folder, "folder of the data set")->required();
  command->add_flag("--json", options->json, "print one JSON object");
  command->callback([options] {
    const std::vector<io::Problem> problems = io::verify(options->folder);
    if (options->json) {
      nlohmann::json json{{"folder", options->folder}, {"problems", nlohmann::json::array()}};
      for (const io::Problem& problem : problems)
        json["problems"].push_back({{"file", problem.file},
                                    {"what", problem.what},
                                    {"expected", problem.expected},
                                    {"found", problem.found}});
      std::cout << json.dump(2) << '\n';
    } else {
      for (const io::Problem& problem : problems) std::cout << problem.str() << '\n';
      std::cout << fmt::format(
          "{}: {}\n", options->folder,
          problems.empty() ? "complete and sound" : fmt::format("{} problems", problems.size()));
    }
    if (!problems.empty()) throw Failed{exit_user};
  });
}

}  // namespace greatx::apps
