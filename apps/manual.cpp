// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/manual/completion.h"
#include "apps/manual/manual_page.h"
#include "assets/assets.h"

namespace greatx::apps {

namespace {

/// Returns the whole command line. A callback calls it, when all commands have been added.
CommandTree tree_of(const CLI::App& app) {
  std::vector<std::string> scenarios;
  for (const EmbeddedScenario& scenario : embedded_scenarios()) scenarios.emplace_back(scenario.name);
  return command_tree(app, scenarios);
}

}  // namespace

void add_manual(CLI::App& app) {
  CLI::App* manual = app.add_subcommand("manual", "print the manual page (greatx manual | man -l -)");
  manual->callback([&app] { std::cout << manual_page(tree_of(app), GREATX_VERSION); });
  CLI::App* completion =
      app.add_subcommand("completion", "print the completion of a shell: source <(greatx completion bash)");
  auto shell = std::make_shared<std::string>();
  completion->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}));
  completion->callback([&app, shell] {
    const CommandTree tree = tree_of(app);
    std::cout << (*shell == "bash"  ? bash_completion(tree)
                  : *shell == "zsh" ? zsh_completion(tree)
                                    : fish_completion(tree));
  });
}

}  // namespace greatx::apps
