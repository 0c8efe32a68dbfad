// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The last thing that text passes before a terminal: names of scenes and files are in tables, notes and
// errors, and a terminal obeys control characters.
#pragma once

#include <memory>
#include <ostream>
#include <streambuf>
#include <string>

#include <spdlog/formatter.h>

namespace greatx::apps {

/// While it lives, what goes to `stream` goes through printable_lines(): in JSON the same text, written
/// otherwise.
class SafeStream : public std::streambuf {
 public:
  explicit SafeStream(std::ostream& stream);
  ~SafeStream() override;
  SafeStream(const SafeStream&) = delete;
  SafeStream& operator=(const SafeStream&) = delete;

 protected:
  int_type overflow(int_type character) override;
  std::streamsize xsputn(const char* text, std::streamsize size) override;
  int sync() override;

 private:
  bool pass_on();
  std::ostream& stream_;
  std::streambuf* target_;
  std::string line_;  ///< not passed on yet: a character may come in two writes
};

/// "warning: message", the message through printable_lines().
std::unique_ptr<spdlog::formatter> safe_log_format();

}  // namespace greatx::apps
