// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Three tiers (CONTRIBUTING.md): bad input throws UserError, a broken contract throws ContractError through
// GREATX_CHECK, a failed Vulkan call throws gpu::VulkanError. All derive from std::exception and reach
// main().
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace greatx {

/// Where a piece of input stands.
struct SourceLocation {
  std::string file;  ///< as the user named it; empty: the command line
  int line = 0;      ///< 1-based; 0: unknown
  std::string str() const;
};

/// Bad input: the message names file:line and field, what was expected and what was found. Exit code 1. It may quote what
/// it complains of: a terminal obeys none of it (printable_lines() of core/text.h).
class UserError : public std::runtime_error {
 public:
  explicit UserError(const std::string& message);
  UserError(const SourceLocation& where, const std::string& message);
  /// Whether the message begins with a file's line.
  bool located() const { return located_; }

 private:
  bool located_ = false;
};

/// The user stopped it (Ctrl-C, SIGTERM): the message says what was done and how to go on. Exit code 130.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A broken contract inside the program. Exit code 2.
class ContractError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

template <typename... Args>
[[noreturn]] void throw_user_error(fmt::format_string<Args...> format, Args&&... args) {
  throw UserError(fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
[[noreturn]] void throw_user_error_at(const SourceLocation& where, fmt::format_string<Args...> format,
                                      Args&&... args) {
  throw UserError(where, fmt::format(format, std::forward<Args>(args)...));
}

namespace detail {
[[noreturn]] void check_failed(const char* file, int line, const char* condition, const std::string& message);
}

}  // namespace greatx

/// GREATX_CHECK(condition, "format", values...): holds in every build; prints the values when it does not.
#define GREATX_CHECK(condition, ...)                                                              \
  do {                                                                                            \
    if (!(condition)) [[unlikely]]                                                                \
      ::greatx::detail::check_failed(__FILE__, __LINE__, #condition, ::fmt::format(__VA_ARGS__)); \
  } while (false)
