// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/said_once.h"

#include <mutex>
#include <utility>

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

namespace greatx::apps {

namespace {

/// Passes only new messages on to the sinks of another logger.
class OnceSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit OnceSink(std::vector<spdlog::sink_ptr> sinks) : sinks_(std::move(sinks)) {}
  std::vector<std::string> said() {
    const std::lock_guard lock(mutex_);
    return {said_.begin(), said_.end()};
  }
  void add(const std::vector<std::string>& said) {
    const std::lock_guard lock(mutex_);
    said_.insert(said.begin(), said.end());
  }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (!said_.emplace(message.payload.data(), message.payload.size()).second) return;
    for (const spdlog::sink_ptr& inner : sinks_)
      if (inner->should_log(message.level)) inner->log(message);
  }
  void flush_() override {
    for (const spdlog::sink_ptr& inner : sinks_) inner->flush();
  }

  std::vector<spdlog::sink_ptr> sinks_;
  std::set<std::string> said_;
};

OnceSink* sink_in_force() {
  const auto& sinks = spdlog::default_logger_raw()->sinks();
  return sinks.empty() ? nullptr : dynamic_cast<OnceSink*>(sinks[0].get());
}

}  // namespace

SaidOnce::SaidOnce() : before_(spdlog::default_logger()) {
  auto logger =
      std::make_shared<spdlog::logger>(before_->name(), std::make_shared<OnceSink>(before_->sinks()));
  logger->set_level(before_->level());
  spdlog::set_default_logger(std::move(logger));
}

SaidOnce::~SaidOnce() { spdlog::set_default_logger(before_); }

std::vector<std::string> SaidOnce::said() {
  OnceSink* const sink = sink_in_force();
  return sink == nullptr ? std::vector<std::string>{} : sink->said();
}

void SaidOnce::add(const std::vector<std::string>& said) {
  if (OnceSink* const sink = sink_in_force()) sink->add(said);
}

}  // namespace greatx::apps
