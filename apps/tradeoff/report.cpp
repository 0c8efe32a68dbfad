// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/tradeoff/report.h"

#include <fmt/format.h>

#include "apps/tradeoff/report_parts.h"
#include "io/files/file.h"

namespace greatx::apps {

namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string csv_of(const nlohmann::json& report) {
  std::string csv =
      "modality,knob,context,setting,default,reference,tick_ms,tick_ms_low,tick_ms_high,cpu_ms,start_ms,"
      "exact,"
      "sensor,figure,unit,error\n";
  for (const nlohmann::json& knob : report["knobs"])
    for (const nlohmann::json& setting : knob["settings"]) {
      const std::string label = setting["label"];
      const std::string head =
          fmt::format("{},{},{},{},{:d},{:d},{},{},{},{},{},{:d}", knob["modality"].get<std::string>(),
                      quoted(knob["name"]), quoted(knob["context"]), quoted(label), label == knob["default"],
                      label == knob["reference"], setting["tick_ms"]["median"].get<double>(),
                      setting["tick_ms"]["low"].get<double>(), setting["tick_ms"]["high"].get<double>(),
                      setting["cpu_ms"]["median"].get<double>(), setting["start_ms"].get<double>(),
                      setting["exact"].get<bool>());
      if (setting["errors"].empty()) csv += head + ",,,,\n";
      for (const nlohmann::json& error : setting["errors"])
        csv +=
            fmt::format("{},{},{},{},{}\n", head, quoted(error["sensor"]), error["name"].get<std::string>(),
                        error["unit"].get<std::string>(),
                        error["value"].is_null() ? "-inf" : fmt::format("{}", error["value"].get<double>()));
    }
  return csv;
}

std::string plot_file(const nlohmann::json& knob) {
  std::string name = knob["modality"].get<std::string>() + "-" + knob["name"].get<std::string>();
  for (char& c : name)
    if (c == ' ' || c == '/' || c == '.') c = '_';
  return name + ".svg";
}

}  // namespace

void write_report(const nlohmann::json& report, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "plots");
  io::write_file_atomically(folder / "tradeoff.csv", csv_of(report));
  for (const nlohmann::json& knob : report["knobs"])
    if (!knob["settings"].empty())
      io::write_file_atomically(folder / "plots" / plot_file(knob), plot_of_knob(knob, device_line(report)));
  for (const nlohmann::json& front : report["fronts"])
    if (!front["points"].empty())
      io::write_file_atomically(folder / "plots" / (front["modality"].get<std::string>() + "-joint.svg"),
                                plot_of_front(front, device_line(report)));
  io::write_file_atomically(folder / "overview.svg", overview_plot(report));
  io::write_file_atomically(folder / "index.html", html_of(report, folder));
}

}  // namespace greatx::apps
