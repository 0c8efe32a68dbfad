// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "python/src/log.h"

#include <cstdlib>
#include <memory>
#include <mutex>

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

namespace greatx::python {

namespace {

using Messages = std::vector<std::pair<int, std::string>>;

int python_level(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::trace:
    case spdlog::level::debug:
      return 10;
    case spdlog::level::info:
      return 20;
    case spdlog::level::warn:
      return 30;
    default:
      return 40;
  }
}

class KeepingSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  Messages take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
  }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    messages_.emplace_back(python_level(message.level),
                           std::string(message.payload.data(), message.payload.size()));
  }
  void flush_() override {}

  Messages messages_;
};

KeepingSink& sink() {
  static const auto only = std::make_shared<KeepingSink>();
  static const bool set = [] {
    auto logger = std::make_shared<spdlog::logger>("greatx", only);
    logger->set_level(std::getenv("GREATX_DEBUG") != nullptr ? spdlog::level::debug : spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
    return true;
  }();
  static_cast<void>(set);
  return *only;
}

}  // namespace

void keep_log() { sink(); }

Messages take_log() { return sink().take(); }

}  // namespace greatx::python
