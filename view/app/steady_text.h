// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace greatx::view {

/// Holds back texts that come and go within a few frames, because a text that flickers cannot be read.
class SteadyText {
 public:
  /// Returns the text to show at `now_s`: `text` if it has been the same for `shortest_s`, else nothing.
  const std::string& at(const std::string& text, double now_s) {
    if (text != text_) {
      text_ = text;
      since_s_ = now_s;
    }
    static const std::string nothing;
    return now_s - since_s_ >= shortest_s ? text_ : nothing;
  }

 private:
  static constexpr double shortest_s = 0.3;
  std::string text_;
  double since_s_ = 0.0;
};

}  // namespace greatx::view
