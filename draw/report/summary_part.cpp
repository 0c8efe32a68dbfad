// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The parts that hold for the whole data set: what it is, its scenario, warnings, effects, names, objects.
#include <algorithm>
#include <filesystem>

#include "core/text.h"
#include "draw/report/parts.h"
#include "io/dataset/summary.h"

namespace greatx::io::report {

namespace {

constexpr size_t longest_scenario = 256 * 1024, most_warnings = 100, most_runs = 10'000;
constexpr size_t most_instances = 4'000'000;

/// Returns text without control characters and marks that change the direction of writing.
std::string shown_text(const std::string& text, Collected& collected) {
  if (text.size() <= longest_scenario) return printable_lines(text);
  collected.notes.insert(fmt::format("The scenario is cut off behind {} bytes.", longest_scenario));
  return printable_lines(text.substr(0, longest_scenario)) + "\n...";
}

/// The warnings of all runs of the program that wrote to the data set.
Json warnings_of(const DatasetReader& reader, Collected& collected) {
  Json list = Json::array();
  const std::filesystem::path file = reader.folder() / run_file;
  if (!std::filesystem::exists(file)) return list;
  const JsonDocument document(read_text_file(file, uint64_t{64} << 20), {file.string(), 1});
  if (!document.root().has("runs")) return list;
  for (const JsonValue& run : document.root().at("runs").list(most_runs)) {
    if (!run.has("warnings")) continue;
    for (const JsonValue& warning : run.at("warnings").list(most_runs)) {
      const std::string text = printable(warning.text());
      if (list.size() == most_warnings) {
        collected.notes.insert(fmt::format("The first {} warnings are listed.", most_warnings));
        return list;
      }
      if (std::ranges::find(list, Json(text)) == list.end()) list.push_back(text);
    }
  }
  return list;
}

void add_fact(Json& facts, const char* name, const std::string& text) {
  if (!text.empty()) facts.push_back({name, printable(text)});
}

std::string text_of(const JsonValue& root, const char* key) {
  if (!root.has(key)) return {};
  const nlohmann::ordered_json& json = root.at(key).json();
  return json.is_string() ? json.get<std::string>() : root.at(key).dump();
}

}  // namespace

Json summary_json(const DatasetReader& reader, Collected& collected) {
  const Summary summary = summarize(reader);
  const JsonDocument run(reader.info().run_json,
                         {fmt::format("{}: run", (reader.folder() / dataset_file).string()), 0});
  const JsonValue root = run.root();
  Json facts = Json::array();
  add_fact(facts, "Scenario", summary.title);
  add_fact(facts, "State", summary.finished ? "finished" : "unfinished: only its complete ticks are shown");
  add_fact(facts, "Made by",
           fmt::format("greatx {}{}", text_of(root, "greatx"),
                       root.has("commit") ? " (" + text_of(root, "commit") + ")" : ""));
  add_fact(facts, "Device", text_of(root, "device"));
  add_fact(facts, "Driver", text_of(root, "driver"));
  add_fact(facts, "Seed", text_of(root, "seed"));
  add_fact(facts, "Sequences",
           summary.sequences == summary.sequences_present
               ? fmt::format("{}", summary.sequences)
               : fmt::format("{} of {}", summary.sequences_present, summary.sequences));
  add_fact(facts, "Ticks",
           fmt::format("{} a sequence, {} a second ({:.4g} s)", summary.ticks_per_sequence,
                       summary.tick_rate_hz, summary.duration_s));
  add_fact(facts, "Records", fmt::format("{}", summary.records));
  if (summary.finished)
    add_fact(facts, "Size",
             fmt::format("{:.1f} MB in {} files", 1e-6 * static_cast<double>(summary.bytes), summary.files));
  if (root.has("georeference")) {
    const JsonValue place = root.at("georeference");
    std::string text;
    for (const auto& [key, words] : {std::pair{"latitude_deg", "latitude {:.8g}\u00b0"},
                                     {"longitude_deg", ", longitude {:.8g}\u00b0"},
                                     {"height_m", ", {:.6g} m above the ellipsoid"}})
      if (place.has(key)) text += fmt::format(fmt::runtime(words), place.at(key).number(-1e9, 1e9));
    add_fact(facts, "Origin of the scene", text);
  }
  Json sensors = Json::array();
  for (size_t i = 0; i < summary.sensors.size(); ++i) {
    const Summary::Sensor& sensor = summary.sensors[i];
    Json arrays = Json::array();
    for (const ArraySpec& array : reader.sensors()[i].arrays) {
      std::vector<std::string> shape;
      for (const int64_t extent : array.shape) shape.push_back(extent < 0 ? "n" : std::to_string(extent));
      arrays.push_back({shown_name(array.name),
                        fmt::format("{} [{}]", numpy_name(array.dtype), fmt::join(shape, ", ")),
                        shown_name(array.unit), shown_name(array.description)});
    }
    sensors.push_back({{"name", shown_name(sensor.name)},
                       {"kind", shown_name(sensor.kind)},
                       {"rate_hz", shown_name(sensor.rate_hz)},
                       {"records", sensor.records},
                       {"bytes", sensor.bytes},
                       {"arrays", std::move(arrays)}});
  }
  Json effects = {{"on", Json::array()}, {"off", Json::array()}};
  if (root.has("effects") && root.at("effects").is_object())
    for (const auto& [name, on] : root.at("effects").json().items())
      if (on.is_boolean()) effects[on.get<bool>() ? "on" : "off"].push_back(shown_name(name));
  return {{"title", shown_name(summary.title)},
          {"finished", summary.finished},
          {"facts", std::move(facts)},
          {"sensors", std::move(sensors)},
          {"warnings", warnings_of(reader, collected)},
          {"effects", std::move(effects)},
          {"scenario", shown_text(reader.info().scenario_text, collected)}};
}

Json names_json(const DatasetReader& reader, const Collected& collected) {
  const SceneNames names = scene_names(reader);
  Json instances = Json::object(), materials = Json::object(), classes = Json::object();
  for (const uint32_t id : collected.instances)
    if (id > 0 && id <= names.instances.size())
      instances[std::to_string(id)] = {shown_name(names.instances[id - 1].name),
                                       shown_name(names.instances[id - 1].semantic_class)};
  for (const uint32_t id : collected.materials)
    if (id > 0 && id <= names.materials.size())
      materials[std::to_string(id)] = shown_name(names.materials[id - 1]);
  for (const uint32_t id : collected.classes)
    if (id < names.semantic_classes.size())
      classes[std::to_string(id)] = shown_name(names.semantic_classes[id]);
  return {{"instance", std::move(instances)},
          {"material", std::move(materials)},
          {"semantic", std::move(classes)}};
}

Json objects_json(const DatasetReader& reader, const dvec3& origin, Collected& collected) {
  const JsonDocument run(reader.info().run_json,
                         {fmt::format("{}: run", (reader.folder() / dataset_file).string()), 0});
  Json list = Json::array();
  if (!run.root().has("instances")) return list;
  size_t all = 0;
  uint32_t id = 0;
  for (const JsonValue& instance : run.root().at("instances").list(most_instances)) {
    ++id;
    // A box in the frame of a node moves with it; the page shows those of the cameras' boxes.
    if (!instance.has("box_m") || (instance.has("node") && instance.at("node").json().is_string())) continue;
    if (++all > most_objects) continue;
    const std::vector<JsonValue> corners = instance.at("box_m").tuple(2);
    Json box = {id, instance.has("class") ? shown_name(instance.at("class").text()) : ""};
    for (const JsonValue& corner : corners)
      for (size_t i = 0; i < 3; ++i)
        box.push_back(rounded(corner.tuple(3)[i].number(-1e12, 1e12) - origin[static_cast<int>(i)], 2));
    list.push_back(std::move(box));
  }
  if (all > most_objects)
    collected.notes.insert(
        fmt::format("The boxes of the first {} of {} objects of the scene are drawn.", most_objects, all));
  return list;
}

}  // namespace greatx::io::report
