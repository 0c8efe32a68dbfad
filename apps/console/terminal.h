// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Escapes control characters in all text before it reaches a terminal. Tables, notes and errors contain names
// of scenes and files, and a terminal would obey control characters in them.
#pragma once

#include <memory>
#include <ostream>
#include <streambuf>
#include <string>

#include <spdlog/formatter.h>

namespace greatx::apps {

/// As long as this lives, text written to `stream` passes through printable_lines(). In JSON the escaped text
/// has the same meaning.
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
  std::string line_;  ///< text not yet passed on, since one character may come in two writes
};

/// Returns a format of log messages, "warning: message", that passes the message through printable_lines().
std::unique_ptr<spdlog::formatter> safe_log_format();

}  // namespace greatx::apps
