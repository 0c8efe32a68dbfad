// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/error.h"

#include "core/text.h"

namespace greatx {

std::string SourceLocation::str() const {
  if (file.empty()) return "command line";
  return line > 0 ? fmt::format("{}:{}", file, line) : file;
}

UserError::UserError(const std::string& message) : std::runtime_error(printable_lines(message)) {}

UserError::UserError(const SourceLocation& where, const std::string& message)
    : std::runtime_error(printable_lines(fmt::format("{}: {}", where.str(), message))),
      located_(where.line > 0) {}

namespace detail {
void check_failed(const char* file, int line, const char* condition, const std::string& message) {
  throw ContractError(fmt::format("{}:{}: broken contract: {}: {}", file, line, condition, message));
}
}  // namespace detail

}  // namespace greatx
