// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/run_record.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <sys/utsname.h>
#include <unistd.h>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "apps/console/json_text.h"
#include "core/parallel.h"
#include "core/utc.h"
#include "core/version.h"
#include "io/files/file.h"
#include "io/files/untrusted_json.h"

namespace greatx::apps {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t most_record_bytes = 64u << 20;
constexpr size_t most_runs = 1'000'000;

std::vector<std::string>& command_line() {
  static std::vector<std::string> kept;
  return kept;
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::time_t whole(double seconds) { return static_cast<std::time_t>(seconds); }

/// Returns the value of the first line "KEY : VALUE" or "KEY=VALUE" of a file of the system; empty if there
/// is none.
std::string system_value(const char* file, const std::string& key, char separator) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const size_t at = line.find(separator);
    if (!line.starts_with(key) || at == std::string::npos) continue;
    const size_t begin = line.find_first_not_of(" \t\"", at + 1), end = line.find_last_not_of(" \t\"");
    return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
  }
  return "";
}

/// Returns the runs of a file that write_to() wrote; an empty list if there is none.
nlohmann::json runs_of(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return nlohmann::json::array();
  try {
    const io::JsonDocument document(io::read_text_file(file, most_record_bytes), {file.string(), 0});
    nlohmann::json runs = nlohmann::json::array();
    for (const io::JsonValue& run : document.root().at("runs").list(most_runs))
      runs.push_back(nlohmann::json::parse(run.dump()));
    return runs;
  } catch (const UserError& fault) {
    spdlog::warn("{}; the records in it are lost", fault.what());
    return nlohmann::json::array();
  }
}

}  // namespace

void set_command_line(int argc, char** argv) { command_line().assign(argv, argv + argc); }

RunRecord::RunRecord() {
  const double begin = now_s();
  utsname system{};
  uname(&system);
  std::error_code ignored;
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  json_ = {{"command_line", command_line()},
           {"folder", fs::current_path(ignored).string()},
           {"host", system.nodename},
           {"system", fmt::format("{} {}, {}", system.sysname, system.release,
                                  system_value("/etc/os-release", "PRETTY_NAME", '='))},
           {"processor", system_value("/proc/cpuinfo", "model name", ':')},
           {"cores", usable_cores()},
           {"memory_bytes",
            pages > 0 && page > 0 ? static_cast<uint64_t>(pages) * static_cast<uint64_t>(page) : 0},
           {"greatx", GREATX_VERSION},
           {"commit", commit()},
           {"begin", utc_text(whole(begin))},
           {"begin_unix_s", begin},
           {"process", ::getpid()},
           {"complete", false}};
  name_ = fmt::format("{}_{}_{}.json", utc_text(whole(begin), "%Y%m%dT%H%M%SZ"), system.nodename, ::getpid());
  std::ranges::replace(name_, '/', '_');
}

void RunRecord::set_device(const gpu::Device& device) {
  json_["device"] = device.info().name;
  json_["driver"] = device.info().driver;
  json_["vulkan"] = device.info().api_version;
  json_["tracer"] = gpu::name_of(device.tracer());
}

void RunRecord::end(bool complete, const std::vector<std::string>& warnings) {
  const double end = now_s();
  json_["end"] = utc_text(whole(end));
  json_["seconds"] = end - json_["begin_unix_s"].get<double>();
  json_["complete"] = complete;
  json_["warnings"] = warnings;
}

void RunRecord::write_to(const fs::path& file) {
  nlohmann::json runs = runs_of(file);
  const auto is_this = [&](const nlohmann::json& run) {
    return run.is_object() && run.contains("begin_unix_s") && run["begin_unix_s"] == json_["begin_unix_s"] &&
           run.contains("process") && run["process"] == json_["process"];
  };
  const auto before = std::ranges::find_if(runs, is_this);
  if (before == runs.end())
    runs.push_back(json_);
  else
    *before = json_;
  io::write_file_atomically(file, json_text(nlohmann::json{{"runs", std::move(runs)}}));
}

std::string last_value(const fs::path& file, const std::string& name) {
  const nlohmann::json runs = runs_of(file);
  if (runs.empty() || !runs.back().is_object() || !runs.back().contains(name)) return "";
  const nlohmann::json& value = runs.back()[name];
  return value.is_string() ? value.get<std::string>() : "";
}

void RunRecord::write_into(const fs::path& folder) const {
  io::create_folders(folder);
  io::write_file_atomically(folder / name_, json_text(json_));
}

}  // namespace greatx::apps
