// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What rows in processes of their own have to say: each would say it again.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include <spdlog/logger.h>

namespace greatx::apps {

/// As long as this lives, the default logger says nothing twice. A process forked meanwhile knows what was
/// said before.
class SaidOnce {
 public:
  SaidOnce();
  ~SaidOnce();
  SaidOnce(const SaidOnce&) = delete;
  SaidOnce& operator=(const SaidOnce&) = delete;

  /// What the logger that is in force has said; empty if that is none of a SaidOnce.
  static std::vector<std::string> said();
  /// Another process has said it.
  static void add(const std::vector<std::string>& said);

 private:
  std::shared_ptr<spdlog::logger> before_;
};

}  // namespace greatx::apps
