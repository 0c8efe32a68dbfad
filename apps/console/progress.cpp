// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/progress.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

namespace greatx::apps {

namespace {

volatile std::sig_atomic_t stop_requested = 0;

void on_signal(int) { stop_requested = 1; }

std::string duration(double seconds) {
  const auto whole = static_cast<int64_t>(seconds + 0.5);
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02} h", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02} min", whole / 60, whole % 60);
}

}  // namespace

Progress::Progress(std::string what, int64_t total, bool quiet, std::string unit)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      total_(total),
      visible_(!quiet && isatty(STDERR_FILENO) == 1),
      begin_(std::chrono::steady_clock::now()),
      last_(begin_ - std::chrono::seconds(1)) {}

Progress::~Progress() {
  if (visible_ && first_ >= 0) std::fputc('\n', stderr);
}

void Progress::update(int64_t done) {
  if (!visible_) return;
  const auto now = std::chrono::steady_clock::now();
  if (first_ < 0) {
    first_ = done;
    begin_ = now;
  }
  if (done < total_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  const double rate = seconds > 0.0 ? static_cast<double>(done - first_) / seconds : 0.0;
  constexpr int width = 30;
  const int filled = static_cast<int>(width * done / std::max<int64_t>(1, total_));
  const std::string left = rate > 0.0 ? duration(static_cast<double>(total_ - done) / rate) + " left" : "";
  const std::string count =
      unit_.empty() ? fmt::format("{:.0f} %", 100.0 * static_cast<double>(done) / static_cast<double>(total_))
                    : fmt::format("{}/{}  {:.2f} {}/s", done, total_, rate, unit_);
  const std::string line = fmt::format("\r{} [{}{}] {}  {}   ", what_, std::string(filled, '#'),
                                       std::string(width - filled, ' '), count, left);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

std::string progress_line(const std::string& what, double share, double seconds) {
  if (share < 0.0) return fmt::format("\r{}  {}   ", what, duration(seconds));
  constexpr int width = 30;
  const int filled = static_cast<int>(width * share);
  const std::string left =
      share > 0.0 ? fmt::format(", {} left", duration(seconds * (1.0 - share) / share)) : "";
  return fmt::format("\r{} [{}{}] about {:.0f} %{}   ", what, std::string(filled, '#'),
                     std::string(width - filled, ' '), 100.0 * share, left);
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
