// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A list of actions that drive the viewer instead of a person: tests and the pictures of the documentation
// use it. docs/viewer.md lists the actions. One line is one action; `#` begins a comment.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "view/window/window.h"

namespace greatx::view {

struct ScriptStep {
  enum class Kind : uint8_t {
    wait_ready,    ///< until the run has loaded, or has failed
    wait_scene,    ///< until a picture of the scene is shown, whatever its quality, or loading has failed
    wait_picture,  ///< until the main view shows the tick and the view that are wanted, at full quality
    wait_tick,     ///< until tick `number` is shown, or a run that plays is past it
    wait_frames,   ///< `number` frames
    input,         ///< `events`, one for each frame
    act,           ///< the command `text` of the menus, with `argument`
    screenshot,    ///< into the file `text`
    print,         ///< the fact `text` on standard output
    quit,
  };
  Kind kind = Kind::quit;
  int line = 0;
  int64_t number = 0;
  std::string text, argument;
  std::vector<InputEvent> events;
};

/// Parses a script; `name` is the file's name in messages. Throws UserError "name:line: ..." for an unknown
/// action, a wrong number of arguments, or a value out of range.
std::vector<ScriptStep> parse_script(const std::string& text, const std::string& name);
/// Reads and parses the file. Throws UserError.
std::vector<ScriptStep> load_script(const std::filesystem::path& file);

/// Returns GLFW's code of a key by its name ("F1", "space", "a", "left"), or 0 if there is none.
int key_of(const std::string& name);

}  // namespace greatx::view
