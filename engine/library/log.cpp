// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <mutex>

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include "engine/library/greatx.h"

namespace greatx::embed {

namespace {

using Log = std::function<void(const std::string& level, const std::string& text)>;

/// Passes messages on to a function of the embedding program.
class CallingSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit CallingSink(Log log) : log_(std::move(log)) {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const spdlog::string_view_t level = spdlog::level::to_string_view(message.level);
    log_(std::string(level.data(), level.size()),
         std::string(message.payload.data(), message.payload.size()));
  }
  void flush_() override {}

  Log log_;
};

}  // namespace

void set_log(Log log) {
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("greatx", std::make_shared<CallingSink>(std::move(log))));
}

}  // namespace greatx::embed
