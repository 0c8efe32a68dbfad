// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs the real viewer by a script, without a display.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <glm/glm.hpp>
#include <gmock/gmock.h>

#include "io/formats/png.h"
#include "tests/apps/program.h"

namespace greatx {

class ViewProgramTest : public testing::Test {
 protected:
  std::filesystem::path folder() const { return temporary_.path(); }
  static const char* size_of(const std::string& what) {
    return what.find("--size") == std::string::npos ? "--size 800x500 " : "";
  }
  /// Runs `greatx view WHAT --offscreen` with a script, in the test's folder.
  apps::test::Outcome view(const std::string& what, const std::string& script) const {
    std::ofstream(folder() / "script.txt") << script;
    return apps::test::greatx(fmt::format("view {} --offscreen --validation {}--script {}/script.txt", what,
                                          size_of(what), folder().string()),
                              fmt::format("cd {} &&", folder().string()));
  }
  /// Runs the same in a real window, under Xvfb.
  apps::test::Outcome view_x11(const std::string& what, const std::string& script) const {
    std::ofstream(folder() / "script.txt") << script;
    // What follows begins with the shell's `exec`, which is no program that xvfb-run could start.
    std::ofstream(folder() / "without_exec.sh") << "shift\nexec \"$@\"\n";
    return apps::test::greatx(
        fmt::format("view {} --validation {}--script {}/script.txt", what, size_of(what), folder().string()),
        fmt::format("cd {} && {} -a -s '-screen 0 1000x800x24 -noreset' sh ./without_exec.sh",
                    folder().string(), GREATX_XVFB_RUN));
  }
  Array picture(const std::string& name) const {
    const std::string bytes = apps::test::read_file(folder() / name);
    return io::decode_png(std::as_bytes(std::span(bytes)), name);
  }
  static double mean(const Array& picture, int x0, int y0, int x1, int y1) {
    double sum = 0.0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        for (int c = 0; c < 3; ++c)
          sum += static_cast<double>(picture.bytes[static_cast<size_t>((y * picture.shape[1] + x) * 3 + c)]);
    return sum / (3.0 * (x1 - x0) * (y1 - y0));
  }

 private:
  greatx::test::TemporaryFolder temporary_;
};

}  // namespace greatx
