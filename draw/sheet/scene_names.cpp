// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/scene_names.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "io/files/untrusted_json.h"

namespace greatx::io {

namespace {

constexpr size_t most_names = 4'000'000;

std::string with_name(uint32_t id, const std::string& name) {
  return name.empty() ? std::to_string(id) : fmt::format("{} {}", id, name);
}

std::unique_ptr<const JsonDocument> description_of(const RecordSource& records) {
  const SourceLocation place{
      fmt::format("{}: run", (std::filesystem::path(records.place()) / dataset_file).string()), 0};
  const std::string& text = records.info().run_json;
  return std::make_unique<JsonDocument>(text.empty() ? "{}" : text, place);
}

std::vector<std::string> texts(const JsonValue& root, const char* key) {
  std::vector<std::string> list;
  if (!root.has(key)) return list;
  for (const JsonValue& value : root.at(key).list(most_names)) list.push_back(value.text());
  return list;
}

constexpr double farthest_outline_m = 1e9;
constexpr size_t most_outline_lines = 1'000'000;

void add_sides(const JsonValue& box, std::vector<OutlineLine>& lines) {
  dvec3 corners[2];
  const std::vector<JsonValue> both = box.tuple(2);
  for (int c = 0; c < 2; ++c)
    for (int axis = 0; axis < 3; ++axis)
      corners[c][axis] = both[static_cast<size_t>(c)].tuple(3)[static_cast<size_t>(axis)].number(
          -farthest_outline_m, farthest_outline_m);
  const double level = 0.5 * (corners[0].z + corners[1].z);
  const dvec3 ring[] = {{corners[0].x, corners[0].y, level},
                        {corners[1].x, corners[0].y, level},
                        {corners[1].x, corners[1].y, level},
                        {corners[0].x, corners[1].y, level}};
  for (size_t i = 0; i < 4; ++i) lines.push_back({ring[i], ring[(i + 1) % 4]});
}

}  // namespace

std::string SceneNames::short_instance(uint32_t id) const {
  if (id == 0 || id > instances.size()) return id == 0 ? "nothing" : std::to_string(id);
  const Instance& found = instances[id - 1];
  return !found.node.empty() ? found.node : !found.name.empty() ? found.name : std::to_string(id);
}

std::vector<OutlineLine> scene_outlines(const RecordSource& records) {
  const std::unique_ptr<const JsonDocument> run = description_of(records);
  const JsonValue root = run->root();
  std::vector<OutlineLine> lines;
  if (!root.has("instances")) return lines;
  const std::vector<JsonValue> instances = root.at("instances").list(most_names);
  // A roof of its own has no outline, and its box would be a false one.
  const bool outlined = std::ranges::any_of(instances, [](const JsonValue& i) { return i.has("outline_m"); });
  for (const JsonValue& instance : instances) {
    if (instance.has("node")) continue;
    if (instance.has("outline_m")) {
      const double level = instance.at("outline_height_m").number(-farthest_outline_m, farthest_outline_m);
      for (const JsonValue& line : instance.at("outline_m").list(most_outline_lines)) {
        double ends[4];
        const std::vector<JsonValue> numbers = line.tuple(4);
        for (size_t i = 0; i < 4; ++i) ends[i] = numbers[i].number(-farthest_outline_m, farthest_outline_m);
        lines.push_back({{ends[0], ends[1], level}, {ends[2], ends[3], level}});
      }
    } else if (!outlined && instance.has("box_m") && instance.has("class") &&
               instance.at("class").text() == "building") {
      add_sides(instance.at("box_m"), lines);
    }
    if (lines.size() > most_outline_lines)
      instance.fail(fmt::format("at most {} lines of outlines in all", most_outline_lines));
  }
  return lines;
}

std::string SceneNames::instance(uint32_t id) const {
  if (id == 0) return "nothing";
  if (id > instances.size()) return std::to_string(id);
  const Instance& found = instances[id - 1];
  const std::string text = with_name(id, found.name);
  return found.semantic_class.empty() ? text : fmt::format("{} ({})", text, found.semantic_class);
}

std::string SceneNames::semantic_class(uint32_t id) const {
  return with_name(id, id < semantic_classes.size() ? semantic_classes[id] : "");
}

std::string SceneNames::material(uint32_t id) const {
  if (id == 0) return "nothing";
  return with_name(id, id <= materials.size() ? materials[id - 1] : "");
}

SceneNames scene_names(const RecordSource& records) {
  const std::unique_ptr<const JsonDocument> run = description_of(records);
  const JsonValue root = run->root();
  SceneNames names;
  names.semantic_classes = texts(root, "semantic_classes");
  names.materials = texts(root, "materials");
  if (!root.has("instances")) return names;
  for (const JsonValue& instance : root.at("instances").list(most_names)) {
    SceneNames::Instance& found = names.instances.emplace_back();
    if (instance.has("name")) found.name = instance.at("name").text();
    if (instance.has("class")) found.semantic_class = instance.at("class").text();
    if (instance.has("node")) found.node = instance.at("node").text();
  }
  return names;
}

SceneFacts scene_facts(const RecordSource& records) {
  return {scene_names(records), scene_outlines(records)};
}

}  // namespace greatx::io
