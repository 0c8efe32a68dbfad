// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/progress.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "apps/console/command_line.h"
#include "core/error.h"
#include "core/text.h"

namespace greatx::apps {

namespace {

volatile std::sig_atomic_t stop_requested = 0;

void on_signal(int) { stop_requested = 1; }

std::string duration(double seconds) {
  const auto whole = static_cast<int64_t>(seconds + 0.5);
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02} h", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02} min", whole / 60, whole % 60);
}

/// Returns, for example, "about 41 %, 0:32 min left".
std::string share_words(double share, double seconds) {
  return fmt::format("about {:.0f} %{}", 100.0 * share,
                     share > 0.0 ? fmt::format(", {} left", duration(seconds * (1.0 - share) / share)) : "");
}

}  // namespace

ProgressPlace progress_place(bool quiet) {
  if (quiet) return ProgressPlace::nowhere;
  return isatty(STDERR_FILENO) == 1 ? ProgressPlace::terminal : ProgressPlace::log;
}

std::chrono::duration<double> log_interval() {
  static const double interval = [] {
    const char* const value = std::getenv("GREATX_PROGRESS_S");
    if (value == nullptr || *value == '\0') return 30.0;
    const std::optional<double> seconds = parse_number(value);
    if (!seconds || !(*seconds > 0.0) || *seconds > 1e9)
      throw_user_error("GREATX_PROGRESS_S: expected a number of seconds above 0, found '{}'",
                       printable(value));
    return *seconds;
  }();
  return std::chrono::duration<double>(interval);
}

Progress::Progress(std::string what, int64_t total, bool quiet, std::string unit)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      total_(total),
      place_(progress_place(quiet)),
      begin_(std::chrono::steady_clock::now()),
      last_(place_ == ProgressPlace::log ? begin_ : begin_ - std::chrono::seconds(1)) {}

Progress::~Progress() {
  if (place_ == ProgressPlace::terminal && first_ >= 0) std::fputc('\n', stderr);
}

void Progress::update(int64_t done) {
  if (place_ == ProgressPlace::nowhere) return;
  const auto now = std::chrono::steady_clock::now();
  if (first_ < 0) {
    first_ = done;
    begin_ = now;
  }
  const bool in_log = place_ == ProgressPlace::log;
  if (in_log ? now - last_ < log_interval() : done < total_ && now - last_ < std::chrono::milliseconds(100))
    return;
  last_ = now;
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  const double rate = seconds > 0.0 ? static_cast<double>(done - first_) / seconds : 0.0;
  const std::string left = rate > 0.0 ? duration(static_cast<double>(total_ - done) / rate) + " left" : "";
  const std::string count =
      unit_.empty() ? fmt::format("{:.0f} %", 100.0 * static_cast<double>(done) / static_cast<double>(total_))
                    : fmt::format("{}/{}  {:.2f} {}/s", done, total_, rate, unit_);
  if (in_log) {
    spdlog::info("{}: {}  {}", what_, count, left);
    return;
  }
  constexpr int width = 30;
  const int filled = static_cast<int>(width * done / std::max<int64_t>(1, total_));
  const std::string line = fmt::format("\r{} [{}{}] {}  {}   ", what_, std::string(filled, '#'),
                                       std::string(width - filled, ' '), count, left);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

std::string progress_line(const std::string& what, double share, double seconds) {
  if (share < 0.0) return fmt::format("\r{}  {}   ", what, duration(seconds));
  constexpr int width = 30;
  const int filled = static_cast<int>(width * share);
  return fmt::format("\r{} [{}{}] {}   ", what, std::string(filled, '#'), std::string(width - filled, ' '),
                     share_words(share, seconds));
}

std::string progress_message(const std::string& what, double share, double seconds) {
  return fmt::format("{}: {}", what,
                     share < 0.0 ? fmt::format("for {}", duration(seconds)) : share_words(share, seconds));
}

void interrupt() noexcept { stop_requested = 1; }

bool interrupted() { return stop_requested != 0; }

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second Ctrl-C ends the program at once
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace greatx::apps
