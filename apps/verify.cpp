// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/verify.h"

#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/console/exit_code.h"
#include "apps/console/json_text.h"
#include "apps/files/consistency_files.h"

namespace greatx::apps {

void add_verify(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "verify",
      "check a data set: files, hashes, index, lengths, values, and that its sensors see one world");
  struct VerifyOptions {
    std::string folder;
    bool json = false;
  };
  auto options = std::make_shared<VerifyOptions>();
  command->add_option("DIR", options->folder, "folder of the data set")->required();
  command->add_flag("--json", options->json, "print one JSON object");
  command->callback([options] {
    std::vector<io::Problem> problems = io::verify(options->folder);
    ConsistencyReport world;
    if (problems.empty()) world = verify_consistency(options->folder);
    problems.insert(problems.end(), world.problems.begin(), world.problems.end());
    if (options->json) {
      nlohmann::json json{{"folder", options->folder},
                          {"problems", nlohmann::json::array()},
                          {"consistency", nlohmann::json::object()},
                          {"notes", world.notes}};
      for (const ConsistencyReport::Figure& figure : world.figures)
        json["consistency"][figure.name] = {{"records", figure.records},
                                            {"compared", figure.compared},
                                            {"max_relative_error", figure.largest},
                                            {"records_unwritten", figure.unwritten}};
      for (const io::Problem& problem : problems)
        json["problems"].push_back({{"file", problem.file},
                                    {"what", problem.what},
                                    {"expected", problem.expected},
                                    {"found", problem.found}});
      std::cout << json_text(json) << '\n';
    } else {
      for (const io::Problem& problem : problems) std::cout << problem.str() << '\n';
      for (const ConsistencyReport::Figure& figure : world.figures)
        if (figure.records > 0)
          std::cout << fmt::format(
              "{}: recomputed from disk: {} records, {} compared, largest relative error {:.1e}{}\n",
              figure.name, figure.records, figure.compared, figure.largest,
              world.problems.empty() ? ": agrees with the run" : "");
      for (const std::string& note : world.notes) std::cout << note << '\n';
      std::cout << fmt::format(
          "{}: {}\n", options->folder,
          problems.empty() ? "complete and sound" : fmt::format("{} problems", problems.size()));
    }
    if (!problems.empty()) throw Failed{exit_user};
  });
}

}  // namespace greatx::apps
