// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/file.h"
#include "io/formats/png.h"
#include "view/app/viewer_window.h"

namespace greatx::view {

ScriptHost Viewer::script_host() {
  return {
      [this] {
        const RunStatus status = shown().run().status();
        if (edit_.busy()) return false;
        return status.phase == RunStatus::Phase::failed ||
               (status.phase == RunStatus::Phase::ready && shown().run().shown() != nullptr);
      },
      [this] {
        return main_.settled() && world_.idle() && drawn_ != nullptr && drawn_ == shown().run().shown();
      },
      [this] { return shown().run().status().tick; },
      [this](const InputEvent& event) { window_->inject(event); },
      [this](const std::string& command, const std::string& argument) { commands_.run(command, argument); },
      [this](const std::string& file) { write_screenshot(options_.script_folder / file); },
      [this](const std::string& fact) { print(fact); },
      [this] {
        return FrameContent{drawn_, main_.picture(), main_.asked()};
      },
      [this] { window_->finish(); },
      [this]() -> Run& { return shown().run(); }};
}

void Viewer::write_screenshot(const std::filesystem::path& file) {
  io::write_file_atomically(file, io::encode_png(window_->screenshot()));
}

void Viewer::print(const std::string& fact) {
  const RunStatus status = shown().run().status();
  if (fact == "tick") {
    std::cout << status.tick << '\n';
  } else if (fact == "error") {
    const std::string& error = status.error.empty() ? edit_.error() : status.error;
    std::cout << (error.empty() ? "none" : error) << '\n';
  } else if (fact == "picked") {
    for (const auto& [name, value] : main_.picked_facts(side_.carrier_hz(shown())))
      std::cout << name << ": " << value << '\n';
    if (!main_.picked()) std::cout << "nothing\n";
  } else if (fact == "hovered") {
    std::cout << fmt::format("{:016x}\n", main_.hovered_id());
  } else if (fact == "path") {
    print_path();
  } else if (fact == "scenario") {
    std::cout << (edit_.document() != nullptr ? edit_.document()->text() : "none\n");
  } else if (fact == "command") {
    std::cout << edit_.command() << '\n';
  } else if (fact == "handle") {
    std::cout << gizmo_.arrows();
  } else if (fact == "comparison") {
    print_comparison();
  } else {
    throw_user_error(
        "print: expected tick, error, picked, hovered, path, scenario, command, handle or comparison, "
        "found "
        "'{}'",
        printable(fact));
  }
  std::cout.flush();
}

void Viewer::print_path() {
  const std::shared_ptr<const ShownTick> tick = shown().run().shown();
  const std::optional<PathStory> story = tick ? pinned_story(*tick) : std::nullopt;
  if (!story) std::cout << "nothing\n";
  if (story)
    for (const std::string& line : words_of(*story)) std::cout << line << '\n';
}

void Viewer::print_comparison() {
  if (!edit_.comparison()) {
    std::cout << "none\n";
    return;
  }
  std::cout << edit_.comparison()->label << ", tick " << edit_.comparison()->tick << '\n';
  for (const Difference& row : edit_.comparison()->rows)
    std::cout << row.sensor << ' ' << row.array << ": " << (row.equal ? "equal" : row.text) << '\n';
}

}  // namespace greatx::view
