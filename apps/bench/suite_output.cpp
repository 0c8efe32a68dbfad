// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/suite_output.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <fmt/format.h>

#include "apps/console/json_text.h"
#include "io/files/file.h"
#include "io/formats/png.h"

namespace greatx::apps {

namespace {

constexpr uint64_t summary_triangles = 100'000;
constexpr const char* suite_axes[] = {"triangles", "bodies", "lamps", "receivers"};

/// Returns a rate or a size with three digits: "1.23 M", "45.6 k".
std::string short_count(double value) {
  if (value >= 1e9) return fmt::format("{:.3g} G", value * 1e-9);
  if (value >= 1e6) return fmt::format("{:.3g} M", value * 1e-6);
  if (value >= 1e3) return fmt::format("{:.3g} k", value * 1e-3);
  return fmt::format("{:.3g}", value);
}

std::string axis_table(const nlohmann::json& result, const std::string& axis) {
  std::string text = fmt::format(
      "\n## {}\n\n| size | pass | tracer | units | median ms | min - max ms | per second | per core second | "
      "differing |\n|---:|---|---|---:|---:|---:|---:|---:|---:|\n",
      axis);
  size_t rows = 0;
  for (const nlohmann::json& row : result["rows"]) {
    if (row["axis"] != axis) continue;
    ++rows;
    const std::string head =
        fmt::format("| {} | {} |", short_count(row["size"].get<double>()), row["pass"].get<std::string>());
    if (row.contains("skipped")) {
      text += fmt::format("{} skipped: {} | | | | | | |\n", head, row["skipped"].get<std::string>());
      continue;
    }
    const nlohmann::json& wall = row["wall_ms"];
    text += fmt::format(
        "{} {} | {} {} | {:.3f} | {:.3f} - {:.3f} | {} | {} | {} |\n", head, row["tracer"].get<std::string>(),
        row["count"].get<uint64_t>(), row["unit"].get<std::string>(), wall["median"].get<double>(),
        wall["min"].get<double>(), wall["max"].get<double>(), short_count(row["per_second"].get<double>()),
        short_count(row["per_core_second"].get<double>()),
        row.contains("differing") ? fmt::to_string(row["differing"].get<uint64_t>()) : "");
  }
  return rows > 0 ? text : std::string();
}

}  // namespace

std::string version_after(const std::string& text, const std::string& word) {
  const size_t at = text.find(word + " ");
  if (at == std::string::npos) return {};
  size_t end = at + word.size() + 1;
  const size_t begin = end;
  while (end < text.size() && (std::isdigit(static_cast<unsigned char>(text[end])) != 0 || text[end] == '.'))
    ++end;
  return text.substr(begin, end - begin);
}

nlohmann::json suite_device(const gpu::DeviceInfo& info) {
  const std::string texts = info.driver + " " + info.name;
  return {{"name", info.name},
          {"type", info.type},
          {"driver", info.driver},
          {"api_version", info.api_version},
          {"memory_bytes", info.memory_bytes},
          {"ray_query", info.has_ray_query()},
          {"mesa", version_after(texts, "Mesa")},
          {"llvm", version_after(texts, "LLVM")}};
}

std::string suite_markdown(const nlohmann::json& result) {
  const nlohmann::json& device = result["device"];
  const auto or_dash = [](const nlohmann::json& value) {
    return value.get<std::string>().empty() ? std::string("-") : value.get<std::string>();
  };
  std::string text = fmt::format(
      "# greatx bench --suite\n\n| device | type | driver | Mesa | LLVM | Vulkan | cores | greatx | Embree | "
      "date |\n|---|---|---|---|---|---|---:|---|---|---|\n| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} "
      "|\n",
      device["name"].get<std::string>(), device["type"].get<std::string>(),
      device["driver"].get<std::string>(), or_dash(device["mesa"]), or_dash(device["llvm"]),
      device["api_version"].get<std::string>(), result["cores"].get<size_t>(),
      result["greatx"].get<std::string>(), or_dash(result["embree"]), result["date"].get<std::string>());
  if (result["embree"].get<std::string>().empty())
    text += "\nThis program was built without Embree (Debian: libembree-dev), so no row stands beside it.\n";
  if (!result["finished"].get<bool>()) text += "\nThe suite was not finished.\n";
  for (const char* axis : suite_axes) text += axis_table(result, axis);
  uint64_t peak = 0;
  for (const nlohmann::json& scene : result["scenes"])
    peak = std::max(peak, scene["peak_rss_bytes"].get<uint64_t>());
  return text + fmt::format("\nLargest resident memory: {} MiB.\n", peak >> 20);
}

nlohmann::json suite_summary(const nlohmann::json& result) {
  nlohmann::json summary;
  for (const char* key : {"greatx_suite", "greatx", "device", "cores", "date", "embree"})
    summary[key] = result[key];
  uint64_t size = 0;
  for (const nlohmann::json& row : result["rows"])
    if (row["axis"] == "triangles" && !row.contains("skipped") && row["size"] <= summary_triangles)
      size = std::max(size, row["size"].get<uint64_t>());
  summary["triangles"] = size;
  summary["note"] = "";
  summary["passes"] = nlohmann::json::array();
  for (const nlohmann::json& row : result["rows"]) {
    if (row["axis"] != "triangles" || row["size"] != size || row.contains("skipped")) continue;
    nlohmann::json pass;
    for (const char* key : {"pass", "tracer", "unit", "per_second", "per_core_second"}) pass[key] = row[key];
    summary["passes"].push_back(std::move(pass));
  }
  return summary;
}

void write_suite(const std::filesystem::path& folder, const nlohmann::json& result) {
  io::create_folders(folder);
  io::write_file_atomically(folder / "suite.json", json_text(result) + "\n");
  io::write_file_atomically(folder / "suite.md", suite_markdown(result));
  io::write_file_atomically(folder / "device.json", json_text(suite_summary(result)) + "\n");
  for (const char* axis : suite_axes) {
    const bool measured = std::ranges::any_of(result["rows"], [axis](const nlohmann::json& row) {
      return row["axis"] == axis && !row.contains("skipped");
    });
    if (measured)
      io::write_file_atomically(folder / (std::string(axis) + ".png"),
                                io::encode_png(suite_curves(result, axis), io::PngCoding::small));
  }
}

}  // namespace greatx::apps
