// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/surfaces/material_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/fields/field.h"
#include "core/input_file.h"
#include "core/srgb.h"
#include "scene/generator/paint/textures.h"
#include "scene/material/radio_fields.h"

namespace greatx::scene::place {

namespace {

using generator::MaterialSpec;

/// Returns a value of YAML as JSON. Plain scalars that are numbers or booleans stay that.
nlohmann::json json_of(const FieldValue& value) {
  switch (value.kind) {
    case FieldValue::Kind::list: {
      nlohmann::json list = nlohmann::json::array();
      for (const auto& item : value.items) list.push_back(json_of(*item));
      return list;
    }
    case FieldValue::Kind::map: {
      nlohmann::json map = nlohmann::json::object();
      for (const FieldValue::Member& member : value.members) map[member.key] = json_of(*member.value);
      return map;
    }
    case FieldValue::Kind::scalar: {
      if (value.quoted) return value.text;
      const nlohmann::json parsed = nlohmann::json::parse(value.text, nullptr, false);
      return parsed.is_number() || parsed.is_boolean() ? parsed : nlohmann::json(value.text);
    }
    default:
      return nullptr;
  }
}

/// Finds a material by name among those that are there.
int find(const std::vector<MaterialSpec>& materials, const Field& field) {
  const std::string name = field.text();
  for (size_t i = 0; i < materials.size(); ++i)
    if (materials[i].name == name) return static_cast<int>(i);
  std::vector<std::string> names;
  for (const MaterialSpec& material : materials) names.push_back(material.name);
  field.fail(fmt::format("one of {}", fmt::join(names, ", ")));
}

vec3 color_of(const Field& field) {
  if (field.is_list()) {
    vec3 color;
    const std::vector<Field> items = field.list("linear red, green, blue");
    if (items.size() != 3) field.fail("3 numbers from 0 to 1");
    for (int i = 0; i < 3; ++i)
      color[i] = static_cast<float>(items[static_cast<size_t>(i)].between(0.0, 1.0));
    return color;
  }
  const std::string text = field.text();
  if (text.size() != 7 || text[0] != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    field.fail("\"#rrggbb\" (sRGB) or 3 linear numbers");
  vec3 color;
  for (int i = 0; i < 3; ++i)
    color[i] = static_cast<float>(
        linear_from_srgb(std::stoi(text.substr(1 + 2 * static_cast<size_t>(i), 2), nullptr, 16) / 255.0));
  return color;
}

/// Adds windows to the radio properties of a wall: double glazing over `share` of its area.
std::string with_glass(const std::string& radio, double share) {
  nlohmann::json json = nlohmann::json::parse(radio);
  const nlohmann::json pane{{"itu", "glass"}, {"thickness_m", 0.006}};
  const nlohmann::json air{{"relative_permittivity", 1.0}, {"conductivity", 0.0}, {"thickness_m", 0.016}};
  json["windows"] = {{"share", share}, {"layers", nlohmann::json::array({pane, air, pane})}};
  return json.dump();
}

MaterialSpec spec_of(const Field& field, const std::vector<MaterialSpec>& materials) {
  const FieldMap map(
      field, {"name", "like", "color", "roughness", "metallic", "texture", "tile_m", "glass", "radio"});
  MaterialSpec spec = materials[static_cast<size_t>(
      find(materials, map.require("like", "the name of a material to start from")))];
  const std::string like = spec.name;
  if (const auto f = map.find("color")) spec.color = color_of(*f);
  if (const auto f = map.find("roughness")) spec.roughness = static_cast<float>(f->between(0.0, 1.0));
  if (const auto f = map.find("metallic")) spec.metallic = static_cast<float>(f->between(0.0, 1.0));
  if (const auto f = map.find("tile_m")) {
    const std::vector<Field> items = f->list("width and height of the texture");
    if (items.size() != 2) f->fail("2 numbers");
    spec.tile_m = {items[0].positive(0.01, 1e4), items[1].positive(0.01, 1e4)};
  }
  if (const auto f = map.find("texture")) {
    const bool none = f->text() == "none";
    if (none)
      spec.texture.clear();
    else {
      const MaterialSpec& other = materials[static_cast<size_t>(find(materials, *f))];
      spec.texture = other.texture;
      spec.bays = other.bays;
      spec.lit = other.lit;
      if (!map.has("tile_m")) spec.tile_m = other.tile_m;
    }
  }
  if (const auto f = map.find("radio")) {
    if (!f->is_map()) f->fail("a map of radio properties");
    read_radio_fields(*f, {});  // throws with file, line and field
    spec.radio = json_of(f->value()).dump();
  }
  if (const auto f = map.find("glass"))
    if (const double share = f->between(0.0, 1.0); share > 0.0) spec.radio = with_glass(spec.radio, share);
  spec.name = map.has("name") ? map.find("name")->text() : fmt::format("place_{}", like);
  return spec;
}

}  // namespace

MaterialTable::MaterialTable() : materials_(generator::material_library()) {
  read_text(default_text(), "greatx's table of materials");
}

int MaterialTable::add(MaterialSpec spec) {
  // The same definition under the same name is one material; another one gets a number.
  const std::string name = spec.name;
  for (int number = 2;; ++number) {
    const auto found = std::find_if(materials_.begin(), materials_.end(),
                                    [&](const MaterialSpec& other) { return other.name == spec.name; });
    if (found == materials_.end()) break;
    if (found->texture == spec.texture && found->color == spec.color && found->radio == spec.radio &&
        found->roughness == spec.roughness && found->metallic == spec.metallic &&
        found->tile_m == spec.tile_m)
      return static_cast<int>(found - materials_.begin());
    spec.name = fmt::format("{}_{}", name, number);
  }
  materials_.push_back(std::move(spec));
  return static_cast<int>(materials_.size()) - 1;
}

void MaterialTable::read(const std::filesystem::path& file) {
  read_text(InputFile(file, "materials of places", budget::yaml_file).text(), file.string());
}

void MaterialTable::read_text(const std::string& text, const std::string& name) {
  const FieldMap root(Field::parse_yaml(text, {name, {}, {}}), {"greatx_place_materials", "classes"});
  root.require("greatx_place_materials", "the version, 1").integer(1, 1);
  const bool first = classes_.empty();
  for (const auto& [key, field] : root.require("classes", "a map of classes").entries()) {
    if (!first && classes_.find(key) == classes_.end()) {
      std::vector<std::string> names;
      for (const auto& [known, choices] : classes_) names.push_back(known);
      field.fail(fmt::format("one of the classes {}", fmt::join(names, ", ")), fmt::format("\"{}\"", key));
    }
    std::vector<int> choices;
    for (const Field& item : field.list("materials", 1))
      choices.push_back(item.is_map() ? add(spec_of(item, materials_)) : find(materials_, item));
    classes_[key] = std::move(choices);
  }
}

int MaterialTable::of(const std::string& material_class, double draw) const {
  const auto found = classes_.find(material_class);
  GREATX_CHECK(found != classes_.end(), "no class \"{}\"", material_class);
  const size_t count = found->second.size();
  return found->second[std::min(count - 1, static_cast<size_t>(draw * static_cast<double>(count)))];
}

vec3 MaterialTable::median_of(const std::string& texture) {
  if (texture.empty()) return vec3(1.0f);
  const auto [found, is_new] = medians_.try_emplace(texture, vec3(1.0f));
  if (!is_new) return found->second;
  const generator::Raster raster = generator::make_texture(texture).color;
  for (size_t channel = 0; channel < 3; ++channel) {
    std::array<size_t, 256> counts{};
    for (size_t i = channel; i < raster.rgb.size(); i += 3) ++counts[raster.rgb[i]];
    size_t below = 0, value = 0;
    while (below + counts[value] < raster.rgb.size() / 6) below += counts[value++];
    found->second[static_cast<int>(channel)] =
        static_cast<float>(linear_from_srgb(std::max<double>(static_cast<double>(value), 1.0) / 255.0));
  }
  return found->second;
}

int MaterialTable::coloured(int material, const std::array<unsigned char, 3>& srgb) {
  MaterialSpec spec = (*this)[material];
  const std::string name = fmt::format("{}_{:02x}{:02x}{:02x}", spec.name, srgb[0], srgb[1], srgb[2]);
  if (const auto found = variants_.find(name); found != variants_.end()) return found->second;
  const vec3 median = median_of(spec.texture);
  for (int i = 0; i < 3; ++i)
    spec.color[i] = std::min(
        1.0f, static_cast<float>(linear_from_srgb(srgb[static_cast<size_t>(i)] / 255.0)) / median[i]);
  spec.name = name;
  return variants_[name] = add(spec);
}

int MaterialTable::pictured(int material, const std::string& picture, size_t number) {
  MaterialSpec spec = (*this)[material];
  const std::string name = fmt::format("{}_picture_{}", spec.name, number);
  if (const auto found = variants_.find(name); found != variants_.end()) return found->second;
  spec.name = name;
  spec.texture = picture;
  spec.color = vec3(1.0f);
  spec.metallic = 0.0f;
  spec.roughness = 0.95f;
  spec.bays = 0;
  spec.lit = -1;
  spec.relief = false;
  spec.emissive = vec3(0.0f);
  return variants_[name] = add(spec);
}

std::vector<std::pair<std::string, std::vector<std::string>>> MaterialTable::listing() const {
  std::vector<std::pair<std::string, std::vector<std::string>>> result;
  for (const auto& [name, choices] : classes_) {
    std::vector<std::string> names;
    for (const int choice : choices) names.push_back((*this)[choice].name);
    result.emplace_back(name, std::move(names));
  }
  return result;
}

}  // namespace greatx::scene::place
