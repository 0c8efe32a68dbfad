// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/version.h"

#include <utility>

namespace greatx {
namespace {

std::string& kept() {
  static std::string commit = "unknown";
  return commit;
}

}  // namespace

const std::string& commit() { return kept(); }
void set_commit(std::string commit) { kept() = std::move(commit); }

}  // namespace greatx
