// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Suppresses repeated log messages. Rows that run in processes of their own would each print the same
// messages.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include <spdlog/logger.h>

namespace greatx::apps {

/// As long as this lives, the default logger prints no message twice. A process that is forked meanwhile
/// knows the messages printed before.
class SaidOnce {
 public:
  SaidOnce();
  ~SaidOnce();
  SaidOnce(const SaidOnce&) = delete;
  SaidOnce& operator=(const SaidOnce&) = delete;

  /// Returns the messages that the current default logger has printed; empty if it is not that of a SaidOnce.
  static std::vector<std::string> said();
  /// Marks messages as printed, because another process has printed them.
  static void add(const std::vector<std::string>& said);

 private:
  std::shared_ptr<spdlog::logger> before_;
};

}  // namespace greatx::apps
