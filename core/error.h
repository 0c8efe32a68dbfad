// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Errors have three tiers (CONTRIBUTING.md). Bad input throws UserError, a broken contract throws
// ContractError through GREATX_CHECK, and a failed Vulkan call throws gpu::VulkanError. All derive from
// std::exception and reach main().
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace greatx {

/// Names the place of a piece of input.
struct SourceLocation {
  std::string file;  ///< as the user named it; empty: the command line
  int line = 0;      ///< 1-based; 0: unknown
  std::string str() const;
};

/// Reports bad input. The message names file:line and field, and says which value was expected and which was
/// found. The exit code is 1. The message may quote the faulty input: printable_lines() of core/text.h
/// escapes it, so that no terminal obeys it.
class UserError : public std::runtime_error {
 public:
  explicit UserError(const std::string& message);
  UserError(const SourceLocation& where, const std::string& message);
  /// Returns whether the message begins with a line of a file.
  bool located() const { return located_; }

 private:
  bool located_ = false;
};

/// Reports that the user stopped the run (Ctrl-C, SIGTERM). The message says how far the run came and how to
/// go on. The exit code is 130.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reports a broken contract inside the program. The exit code is 2.
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

/// GREATX_CHECK(condition, "format", values...) is active in every build. It prints the values if the
/// condition is false.
#define GREATX_CHECK(condition, ...)                                                              \
  do {                                                                                            \
    if (!(condition)) [[unlikely]]                                                                \
      ::greatx::detail::check_failed(__FILE__, __LINE__, #condition, ::fmt::format(__VA_ARGS__)); \
  } while (false)
