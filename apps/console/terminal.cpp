// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/terminal.h"

#include <string_view>

#include <spdlog/pattern_formatter.h>

#include "core/text.h"

namespace greatx::apps {

namespace {

class SafeMessage : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
    const std::string text =
        printable_lines(std::string_view(message.payload.data(), message.payload.size()));
    out.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<SafeMessage>(); }
};

}  // namespace

SafeStream::SafeStream(std::ostream& stream) : stream_(stream), target_(stream.rdbuf(this)) {}

SafeStream::~SafeStream() {
  sync();
  stream_.rdbuf(target_);
}

SafeStream::int_type SafeStream::overflow(int_type character) {
  if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(character);
  const char c = traits_type::to_char_type(character);
  return xsputn(&c, 1) == 1 ? character : traits_type::eof();
}

std::streamsize SafeStream::xsputn(const char* text, std::streamsize size) {
  line_.append(text, static_cast<size_t>(size));
  const bool ends = size > 0 && text[size - 1] == '\n';
  return !ends || pass_on() ? size : 0;
}

bool SafeStream::pass_on() {
  const std::string shown = printable_lines(line_);
  line_.clear();
  return target_->sputn(shown.data(), static_cast<std::streamsize>(shown.size())) ==
         static_cast<std::streamsize>(shown.size());
}

int SafeStream::sync() { return pass_on() && target_->pubsync() == 0 ? 0 : -1; }

std::unique_ptr<spdlog::formatter> safe_log_format() {
  auto format = std::make_unique<spdlog::pattern_formatter>();
  format->add_flag<SafeMessage>('*').set_pattern("%^%l%$: %*");
  return format;
}

}  // namespace greatx::apps
