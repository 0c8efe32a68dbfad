// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/summary.h"

#include <nlohmann/json.hpp>

#include "core/text.h"
#include "io/dataset/manifest.h"

namespace greatx::io {

using Json = nlohmann::ordered_json;

namespace {

std::string title_of(const DatasetReader& reader) {
  const Json run = Json::parse(reader.info().run_json, nullptr, false);
  for (const char* key : {"scenario", "name", "scenario_name"}) {
    if (!run.is_object() || !run.contains(key)) continue;
    if (run[key].is_string()) return run[key];
    if (run[key].is_object() && run[key].contains("name") && run[key]["name"].is_string())
      return run[key]["name"];
  }
  return std::filesystem::absolute(reader.folder() / ".").parent_path().filename().string();
}

std::string describe(const SensorSpec& sensor, const OutputSpec& output) {
  std::string text = fmt::format("{}: {}", output.name, name_of(output.format));
  for (const size_t i : arrays_of(sensor, output)) {
    const ArraySpec& array = sensor.arrays[i];
    std::vector<std::string> shape;
    for (const int64_t extent : array.shape) shape.push_back(extent < 0 ? "n" : std::to_string(extent));
    text += fmt::format("{} {} [{}]", output.arrays.size() > 1 ? " " + array.name : "",
                        numpy_name(array.dtype), fmt::join(shape, ", "));
  }
  return text;
}

std::string size_text(uint64_t bytes) {
  if (bytes < 1000) return fmt::format("{} B", bytes);
  double value = static_cast<double>(bytes);
  const char* unit = "B";
  for (const char* next : {"kB", "MB", "GB", "TB"}) {
    if (value < 1000.0) break;
    value /= 1000.0;
    unit = next;
  }
  return fmt::format("{:.1f} {}", value, unit);
}

}  // namespace

Summary summarize(const DatasetReader& reader) {
  const DatasetInfo& info = reader.info();
  Summary summary;
  summary.folder = reader.folder().string();
  summary.title = title_of(reader);
  summary.finished = reader.finished();
  summary.sequences = info.sequences;
  summary.sequences_present = reader.sequences();
  summary.ticks_per_sequence = info.ticks_per_sequence;
  summary.tick_rate_hz = info.tick_rate;
  summary.duration_s =
      1e-9 * static_cast<double>(SampleClock(info.tick_rate, "1").time_ns(info.ticks_per_sequence));
  for (const SensorSpec& sensor : info.sensors) {
    summary.sensors.push_back({sensor.name, sensor.kind, sensor.rate, 0, 0, {}});
    for (const OutputSpec& output : sensor.outputs)
      summary.sensors.back().outputs.push_back(describe(sensor, output));
  }
  for (uint32_t sequence = 0; sequence < reader.sequences(); ++sequence) {
    for (const IndexRow& row : reader.records(sequence))
      ++summary.sensors[static_cast<size_t>(row.sensor)].records;
    summary.records += static_cast<int64_t>(reader.records(sequence).size());
  }
  if (!reader.finished()) return summary;
  for (const FileEntry& file : read_manifest(reader.folder())) {
    ++summary.files;
    summary.bytes += file.size;
    const size_t below = file.path.find('/');
    for (Summary::Sensor& sensor : summary.sensors)
      if (below != file.path.npos &&
          file.path.compare(below + 1, sensor.name.size() + 1, sensor.name + "/") == 0)
        sensor.bytes += file.size;
  }
  return summary;
}

std::string to_text(const Summary& summary) {
  // Names come from the data set, so they are made printable for a terminal.
  std::string text = fmt::format("{}: {}{}\n", printable(summary.folder), printable(summary.title),
                                 summary.finished ? "" : " (unfinished)");
  text += fmt::format("  {} of {} sequences, {} ticks of 1/{} s each ({:.4g} s), {} records",
                      summary.sequences_present, summary.sequences, summary.ticks_per_sequence,
                      summary.tick_rate_hz, summary.duration_s, summary.records);
  text += summary.finished ? fmt::format(", {} files, {}\n", summary.files, size_text(summary.bytes)) : "\n";
  for (const Summary::Sensor& sensor : summary.sensors) {
    text += fmt::format("  {} ({}{}): {} records{}\n", printable(sensor.name), printable(sensor.kind),
                        sensor.rate_hz.empty() ? "" : ", " + sensor.rate_hz + " Hz", sensor.records,
                        summary.finished ? ", " + size_text(sensor.bytes) : "");
    for (const std::string& output : sensor.outputs) text += fmt::format("    {}\n", printable(output));
  }
  return text;
}

std::string to_json(const Summary& summary) {
  Json sensors = Json::array();
  for (const Summary::Sensor& sensor : summary.sensors) {
    sensors.push_back({{"name", sensor.name},
                       {"kind", sensor.kind},
                       {"rate_hz", sensor.rate_hz},
                       {"records", sensor.records},
                       {"bytes", sensor.bytes},
                       {"outputs", sensor.outputs}});
  }
  return Json({{"folder", summary.folder},
               {"title", summary.title},
               {"finished", summary.finished},
               {"sequences", summary.sequences},
               {"sequences_present", summary.sequences_present},
               {"ticks_per_sequence", summary.ticks_per_sequence},
               {"tick_rate_hz", summary.tick_rate_hz},
               {"duration_s", summary.duration_s},
               {"records", summary.records},
               {"files", summary.files},
               {"bytes", summary.bytes},
               {"sensors", std::move(sensors)}})
      .dump(-1, ' ', false, Json::error_handler_t::replace);  // the folder's name may not be valid UTF-8
}

}  // namespace greatx::io
