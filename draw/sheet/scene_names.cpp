// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/scene_names.h"

#include <filesystem>

#include "io/files/untrusted_json.h"

namespace greatx::io {

namespace {

constexpr size_t most_names = 4'000'000;

std::string with_name(uint32_t id, const std::string& name) {
  return name.empty() ? std::to_string(id) : fmt::format("{} {}", id, name);
}

std::vector<std::string> texts(const JsonValue& root, const char* key) {
  std::vector<std::string> list;
  if (!root.has(key)) return list;
  for (const JsonValue& value : root.at(key).list(most_names)) list.push_back(value.text());
  return list;
}

}  // namespace

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
  const JsonDocument run(
      records.info().run_json,
      {fmt::format("{}: run", (std::filesystem::path(records.place()) / dataset_file).string()), 0});
  const JsonValue root = run.root();
  SceneNames names;
  names.semantic_classes = texts(root, "semantic_classes");
  names.materials = texts(root, "materials");
  if (!root.has("instances")) return names;
  for (const JsonValue& instance : root.at("instances").list(most_names)) {
    SceneNames::Instance& found = names.instances.emplace_back();
    if (instance.has("name")) found.name = instance.at("name").text();
    if (instance.has("class")) found.semantic_class = instance.at("class").text();
  }
  return names;
}

}  // namespace greatx::io
