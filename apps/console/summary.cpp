// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/summary.h"

#include <sys/resource.h>

#include <fmt/format.h>

namespace greatx::apps {

uint64_t peak_rss_bytes() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

nlohmann::json summary_of(const sim::RunStatistics& statistics, const gpu::Device& device, double seconds) {
  const gpu::Counters& counters = device.counters();
  nlohmann::json summary;
  summary["ticks"] = statistics.ticks;
  summary["submits"] = counters.submits;
  summary["packets"] = statistics.packets;
  summary["seconds"] = seconds;
  summary["ticks_per_second"] = seconds > 0.0 ? static_cast<double>(statistics.ticks) / seconds : 0.0;
  summary["peak_rss_bytes"] = peak_rss_bytes();
  summary["device"] = device.info().name;
  summary["driver"] = device.info().driver;
  summary["records"] = statistics.records;
  summary["counters"] = statistics.counters;
  summary["notes"] = nlohmann::json::object();
  for (const auto& [name, text] : statistics.notes) summary["notes"][name] = text;
  summary["warnings"] = statistics.warnings;
  summary["gpu"] = {{"pipelines_built", counters.pipelines_built},
                    {"pipelines", counters.pipelines},
                    {"passes", counters.passes},
                    {"dispatches", counters.dispatches},
                    {"draws", counters.draws},
                    {"setup_submits", counters.setup_submits},
                    {"tlas_builds", counters.tlas_builds},
                    {"tlas_refits", counters.tlas_refits}};
  summary["pass_ms"] = nlohmann::json::object();
  for (const auto& [name, pass] : statistics.passes)
    summary["pass_ms"][name] = {{"count", pass.count},
                                {"mean", pass.milliseconds / static_cast<double>(pass.count)}};
  const auto errors = [](const sim::ErrorStatistics& e) {
    return nlohmann::json{
        {"compared", e.count()}, {"max_relative_error", e.max()}, {"q99_relative_error", e.quantile(0.99)}};
  };
  summary["consistency"] = nlohmann::json::object();
  for (const auto& [figure, total] : statistics.consistency) summary["consistency"][figure] = errors(total);
  return summary;
}

std::string summary_text(const nlohmann::json& summary) {
  std::string text = fmt::format(
      "{} ticks, {} submits, {} packets in {:.2f} s ({:.2f} ticks/s), peak memory {:.0f} MiB, {}\n",
      summary["ticks"].get<int64_t>(), summary["submits"].get<uint64_t>(), summary["packets"].get<int64_t>(),
      summary["seconds"].get<double>(), summary["ticks_per_second"].get<double>(),
      summary["peak_rss_bytes"].get<double>() / (1 << 20), summary["device"].get<std::string>());
  text += "GPU time per pass, ms:\n";
  for (const auto& [name, pass] : summary["pass_ms"].items())
    text += fmt::format("  {:<28} {:8.2f}  x {}\n", name, pass["mean"].get<double>(),
                        pass["count"].get<uint64_t>());
  if (!summary["counters"].empty()) text += "Counted:\n";
  for (const auto& [name, count] : summary["counters"].items())
    text += fmt::format("  {:<36} {:12}\n", name, count.get<uint64_t>());
  for (const auto& [name, note] : summary["notes"].items())
    text += fmt::format("  {}: {}\n", name, note.get<std::string>());
  text += "One world:\n";
  for (const auto& [name, check] : summary["consistency"].items())
    text += fmt::format("  {:<32} {:9} compared, relative difference 99 % <= {:.1e}, largest {:.1e}\n", name,
                        check["compared"].get<uint64_t>(), check["q99_relative_error"].get<double>(),
                        check["max_relative_error"].get<double>());
  return text;
}

}  // namespace greatx::apps
