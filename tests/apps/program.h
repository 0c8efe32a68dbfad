// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs the program `greatx` as a user does, and returns its exit code and output.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/wait.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {

inline std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

struct Outcome {
  int code = -1;
  std::string out, err;
};

/// Runs the program through the shell. `arguments` follows the program's name, `before` stands in front of it
/// (environment, ulimit).
inline Outcome greatx(const std::string& arguments, const std::string& before = "") {
  setenv("GREATX_CACHE", "off", 0);  // does not overwrite what a test has set
  const greatx::test::TemporaryFolder temporary;
  const std::string folder = temporary.path().string();
  const std::string command =
      fmt::format("{} exec '{}' {} >{}/out 2>{}/err", before, GREATX_PROGRAM, arguments, folder, folder);
  const int status = std::system(fmt::format("/bin/sh -c \"{}\"", command).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(folder + "/out"),
          read_file(folder + "/err")};
}

}  // namespace greatx::apps::test
