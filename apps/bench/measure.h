// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Clocks, a sink and a scratch folder for benchmarks.
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/record.h"

namespace greatx::apps {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}
inline double milliseconds_since(Clock::time_point begin) { return 1e3 * seconds_since(begin); }

/// Returns the user and system time of all threads of this process so far, ms.
inline double cpu_milliseconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto of = [](const timeval& t) { return 1e3 * double(t.tv_sec) + 1e-3 * double(t.tv_usec); };
  return of(usage.ru_utime) + of(usage.ru_stime);
}

/// A sink that discards every packet.
struct Discard : RecordSink {
  void write(Packet) override {}
};

/// Names a folder for this process below the system's temporary folder. The destructor removes the folder.
class ScratchFolder {
 public:
  ScratchFolder()
      : path_(std::filesystem::temp_directory_path() / fmt::format("greatx-bench-{}", getpid())) {}
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Returns {"count", "min", "median", "max"} of the samples; only {"count": 0} if there are none.
inline nlohmann::json distribution(std::vector<double> samples) {
  if (samples.empty()) return {{"count", 0}};
  std::sort(samples.begin(), samples.end());
  return {{"count", samples.size()},
          {"min", samples.front()},
          {"median", samples[samples.size() / 2]},
          {"max", samples.back()}};
}

}  // namespace greatx::apps
