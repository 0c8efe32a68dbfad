// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "apps/commands.h"
#include "apps/console/exit_code.h"
#include "apps/console/json_text.h"
#include "apps/console/progress.h"
#include "apps/console/session.h"
#include "apps/console/watch.h"
#include "apps/selftest/report.h"
#include "core/error.h"
#include "io/files/file.h"

namespace greatx::apps {

namespace {

struct SelftestOptions {
  RunOptions run;
  std::string json;
  std::vector<uint32_t> only;
  bool list = false;
};

std::vector<selftest::Case> chosen_cases(const std::vector<uint32_t>& only) {
  std::vector<selftest::Case> cases = selftest::catalogue();
  for (const uint32_t number : only)
    if (std::ranges::find(cases, number, &selftest::Case::number) == cases.end())
      throw UserError(fmt::format("--only: expected the number of a case (--list), found {}", number));
  if (!only.empty())
    std::erase_if(cases, [&](const selftest::Case& item) {
      return std::ranges::find(only, item.number) == only.end();
    });
  return cases;
}

void run_selftest(const SelftestOptions& options) {
  const std::vector<selftest::Case> cases = chosen_cases(options.only);
  if (options.list) {
    for (const selftest::Case& item : cases) std::cout << fmt::format("{:>3}  {}\n", item.number, item.title);
    return;
  }
  gpu::Device device(options.run.device_options());
  const selftest::Lab lab(device);
  install_interrupt_handler();
  const TerminalWatch watch(true);
  const auto start = std::chrono::steady_clock::now();
  std::vector<selftest::Row> rows;
  std::cout << selftest::heading() << '\n';
  selftest::Verdict verdict;
  for (const selftest::Case& item : cases) {
    const size_t first = rows.size();
    selftest::run(item, lab, rows);
    std::cout << fmt::format("{:>11}  {}\n", item.number, item.title);
    for (size_t i = first; i < rows.size(); ++i) {
      std::cout << selftest::line_of(rows[i]) << '\n' << std::flush;
      verdict.failed += !rows[i].passed();
    }
  }
  verdict.cases = static_cast<uint32_t>(cases.size());
  verdict.rows = static_cast<uint32_t>(rows.size());
  verdict.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cout << selftest::summary_of(verdict, device.info()) << '\n';
  check_validation(device);
  if (!options.json.empty())
    io::write_file_atomically(options.json,
                              json_text(selftest::json_of(rows, verdict, device.info())) + "\n");
  if (verdict.failed > 0) throw Failed{exit_internal};
}

}  // namespace

void add_selftest(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "selftest", "compute the hard cases on this device and compare them with closed forms");
  auto options = std::make_shared<SelftestOptions>();
  options->run.add_to(*command);
  command->add_option("--json", options->json, "also write the rows to this file")->type_name("FILE");
  command->add_option("--only", options->only, "run these cases alone, e.g. --only 36,57")
      ->type_name("CASE")
      ->delimiter(',');
  command->add_flag("--list", options->list, "list the cases and run none");
  command->callback([options] { run_selftest(*options); });
}

}  // namespace greatx::apps
