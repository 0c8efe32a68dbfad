// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/radio_fields.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace greatx::scene {
namespace {

using Kind = RadioField::Kind;

std::string description_of(const RadioField& field) {
  switch (field.kind) {
    case Kind::null:
      return "nothing";
    case Kind::boolean:
      return field.boolean ? "true" : "false";
    case Kind::number:
      return fmt::format("{}", field.number);
    case Kind::text:
      return fmt::format("'{}'", field.text);
    case Kind::list:
      return "a list";
    case Kind::map:
      return "a map";
  }
  return "?";
}

[[noreturn]] void refuse(const RadioField& field, const std::string& expected) {
  throw_user_error_at(field.where, "{}: expected {}, found {}", field.path, expected, description_of(field));
}

/// Represents the members of a map. The reader asks for each one, and a member that it does not ask for is an
/// unknown key.
class Members {
 public:
  explicit Members(const RadioField& map) : map_(map) {
    if (map.kind != Kind::map) refuse(map, "a map of fields");
    for (auto member = map.members.begin(); member != map.members.end(); ++member) {
      for (auto other = map.members.begin(); other != member; ++other) {
        if (other->first == member->first) refuse(member->second, "the key once");
      }
    }
  }

  const RadioField* find(std::string_view key) {
    known_.emplace_back(key);
    for (const auto& [name, field] : map_.members) {
      if (name == key) return &field;
    }
    return nullptr;
  }
  std::optional<double> number(std::string_view key, double min, double max, const std::string& expected) {
    const RadioField* field = find(key);
    if (!field) return std::nullopt;
    const bool in_range = field->kind == Kind::number && field->number >= min && field->number <= max;
    if (!in_range || !std::isfinite(field->number)) refuse(*field, expected);
    return field->number;
  }
  std::optional<double> unit_interval(std::string_view key) {
    return number(key, 0.0, 1.0, "a number from 0 to 1");
  }
  std::optional<double> exponent(std::string_view key) {
    const auto value = number(key, 1.0, 100.0, "a whole number from 1 to 100");
    if (value && *value != std::floor(*value)) refuse(*find(key), "a whole number from 1 to 100");
    return value;
  }
  /// Reads a thickness in metres above 0.
  std::optional<double> thickness(std::string_view key) {
    const auto value = number(key, 0.0, 1e6, "a thickness in metres above 0 (leave it out for a half-space)");
    if (value && *value <= 0.0)
      refuse(*find(key), "a thickness in metres above 0 (leave it out for a half-space)");
    return value;
  }
  std::optional<bool> boolean(std::string_view key) {
    const RadioField* field = find(key);
    if (!field) return std::nullopt;
    if (field->kind != Kind::boolean) refuse(*field, "true or false");
    return field->boolean;
  }
  /// Must be called last. Throws for the first member that the reader did not ask for.
  void finish() const {
    for (const auto& [name, field] : map_.members) {
      if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
      throw_user_error_at(field.where, "{}: unknown key '{}'; expected one of {}", map_.path, name,
                          fmt::join(known_, ", "));
    }
  }
  const RadioField& map() const { return map_; }

 private:
  const RadioField& map_;
  std::vector<std::string> known_;
};

constexpr double any = std::numeric_limits<double>::max();

/// Reads a, b, c, d and the range of one row. If `optional`, the result is empty if none of them is given.
std::optional<RadioRow> read_row(Members& members, bool optional) {
  static constexpr const char* keys[] = {"a", "b", "c", "d", "min_hz", "max_hz"};
  double values[6];
  size_t given = 0;
  const char* missing = nullptr;
  for (size_t index = 0; index < 6; ++index) {
    const bool signed_value = index == 1 || index == 3;
    const auto value = members.number(keys[index], signed_value ? -any : 0.0, any,
                                      signed_value ? "a number" : "a number of 0 or more");
    if (value) {
      values[index] = *value;
      ++given;
    } else {
      missing = keys[index];
    }
  }
  if (given == 0 && optional) return std::nullopt;
  if (missing) {
    throw_user_error_at(members.map().where, "{}: a row needs a, b, c, d, min_hz and max_hz; '{}' is missing",
                        members.map().path, missing);
  }
  if (values[4] >= values[5]) {
    throw_user_error_at(members.map().where, "{}: expected min_hz below max_hz, found {} and {}",
                        members.map().path, values[4], values[5]);
  }
  return RadioRow{values[0], values[1], values[2], values[3], values[4], values[5]};
}

std::optional<RadioMedium> read_itu(Members& members) {
  const RadioField* field = members.find("itu");
  if (!field) return std::nullopt;
  const std::string expected =
      fmt::format("a material of ITU-R P.2040-4, Table 3 ({})", fmt::join(itu_names(), ", "));
  if (field->kind != Kind::text) refuse(*field, expected);
  auto medium = itu_medium(field->text);
  if (!medium) refuse(*field, expected);
  return medium;
}

std::optional<RadioMedium> read_rows(Members& members) {
  const RadioField* field = members.find("rows");
  if (!field) return std::nullopt;
  if (field->kind != Kind::list || field->items.empty())
    refuse(*field, "a list of rows {a, b, c, d, min_hz, max_hz}");
  RadioMedium medium;
  medium.source = "explicit a, b, c, d";
  for (const RadioField& item : field->items) {
    Members row(item);
    medium.rows.push_back(*read_row(row, false));
    row.finish();
  }
  return medium;
}

std::optional<RadioMedium> read_flat_row(Members& members) {
  const auto row = read_row(members, true);
  if (!row) return std::nullopt;
  return RadioMedium{"explicit a, b, c, d", {*row}, false};
}

std::optional<RadioMedium> read_permittivity(Members& members) {
  const auto permittivity = members.number("relative_permittivity", 1.0, any, "a number of 1 or more");
  const auto conductivity = members.number("conductivity", 0.0, any, "S/m of 0 or more");
  if (!permittivity && !conductivity) return std::nullopt;
  if (!permittivity || !conductivity) {
    throw_user_error_at(members.map().where,
                        "{}: relative_permittivity and conductivity go together; '{}' is missing",
                        members.map().path, permittivity ? "conductivity" : "relative_permittivity");
  }
  RadioRow row{*permittivity, 0.0, *conductivity, 0.0, 0.0, std::numeric_limits<double>::infinity()};
  return RadioMedium{"explicit permittivity", {row}, false};
}

/// Reads the medium by exactly one of its four ways. The result is empty if none of them is used.
std::optional<RadioMedium> read_medium(Members& members) {
  std::optional<RadioMedium> medium;
  for (auto* read : {read_itu, read_rows, read_flat_row, read_permittivity}) {
    auto candidate = read(members);
    if (candidate && medium) {
      throw_user_error_at(members.map().where,
                          "{}: the medium is given twice ({}; {}); expected one of itu, rows, "
                          "a/b/c/d, relative_permittivity + conductivity",
                          members.map().path, medium->source, candidate->source);
    }
    if (candidate) medium = std::move(candidate);
  }
  return medium;
}

RadioLayer read_layer(const RadioField& field) {
  Members members(field);
  RadioLayer layer;
  auto medium = read_medium(members);
  if (!medium) {
    throw_user_error_at(field.where,
                        "{}: a layer needs a medium (itu, rows, a/b/c/d, or relative_permittivity + "
                        "conductivity)",
                        field.path);
  }
  medium->extrapolate = members.boolean("extrapolate").value_or(false);
  layer.medium = std::move(*medium);
  const auto thickness = members.thickness("thickness_m");
  if (!thickness) throw_user_error_at(field.where, "{}: a layer needs its thickness_m", field.path);
  layer.thickness_m = *thickness;
  members.finish();
  return layer;
}

std::optional<std::vector<RadioLayer>> read_layers(Members& members) {
  const RadioField* field = members.find("layers");
  if (!field) return std::nullopt;
  if (field->kind != Kind::list || field->items.empty()) refuse(*field, "a list of layers");
  std::vector<RadioLayer> layers;
  for (const RadioField& item : field->items) layers.push_back(read_layer(item));
  return layers;
}

/// Reads the wall itself: medium and thickness, or layers, or changes to the statements of the sources below.
void read_wall(Members& members, std::optional<RadioMaterial>& radio) {
  auto medium = read_medium(members);
  auto layers = read_layers(members);
  const auto thickness = members.thickness("thickness_m");
  const auto extrapolate = members.boolean("extrapolate");
  const RadioField& map = members.map();
  if (layers && (medium || thickness || extrapolate)) {
    throw_user_error_at(map.where, "{}: layers exclude a medium, thickness_m and extrapolate beside them",
                        map.path);
  }
  if (layers || medium) {
    if (!radio) radio.emplace();
    radio->foliage.reset();
    radio->layers = layers ? std::move(*layers) : std::vector<RadioLayer>{{std::move(*medium), 0.0}};
  }
  if (!thickness && !extrapolate) return;
  if (!radio || radio->foliage) {
    throw_user_error_at(map.where,
                        "{}: thickness_m and extrapolate need a medium (itu, rows, a/b/c/d, or "
                        "relative_permittivity + conductivity)",
                        map.path);
  }
  if (thickness) {
    if (radio->layers.size() != 1) {
      throw_user_error_at(map.where, "{}: thickness_m cannot change a material of {} layers", map.path,
                          radio->layers.size());
    }
    radio->layers.front().thickness_m = *thickness;
  }
  if (extrapolate) {
    for (RadioLayer& layer : radio->layers) layer.medium.extrapolate = *extrapolate;
  }
}

std::optional<ScatteringPattern> read_pattern(Members& members) {
  const RadioField* field = members.find("pattern");
  if (!field) return std::nullopt;
  if (field->kind == Kind::text && field->text == "lambertian") return ScatteringPattern::lambertian;
  if (field->kind == Kind::text && field->text == "directive") return ScatteringPattern::directive;
  if (field->kind == Kind::text && field->text == "backscattering") return ScatteringPattern::backscattering;
  refuse(*field, "lambertian, directive or backscattering");
}

/// Reads foliage. It is a volume, so one source cannot combine it with fields that describe a wall or its
/// surface.
std::optional<Foliage> read_foliage(Members& members) {
  const RadioField* field = members.find("foliage");
  if (!field) return std::nullopt;
  for (const auto& [key, other] : members.map().members) {
    if (key == "foliage" || key.starts_with("reflectance_")) continue;
    throw_user_error_at(other.where, "{}: foliage has no wall and no surface: expected no '{}' beside it",
                        members.map().path, key);
  }
  if (field->kind == Kind::text && field->text == "weissberger") return Foliage{};
  const std::string expected = "weissberger or {attenuation_db_per_m: dB/m}";
  if (field->kind != Kind::map) refuse(*field, expected);
  Members own(*field);
  const auto attenuation = own.number("attenuation_db_per_m", 0.0, 1000.0, "dB/m from 0 to 1000");
  own.finish();
  if (!attenuation) refuse(*field, expected);
  return Foliage{attenuation};
}

void read_surface(Members& members, std::optional<RadioMaterial>& radio) {
  const auto scattering = members.unit_interval("scattering_coefficient");
  const auto pattern = read_pattern(members);
  const auto exponent = members.exponent("pattern_exponent");
  const auto back_exponent = members.exponent("backscatter_exponent");
  const auto back_share = members.unit_interval("backscatter_share");
  const auto cross_polarization = members.unit_interval("cross_polarization");
  const auto roughness = members.number("roughness_m", 0.0, 10.0, "an rms height from 0 to 10 m");
  const bool any_given =
      scattering || pattern || exponent || back_exponent || back_share || cross_polarization || roughness;
  if (!any_given) return;
  if (!radio || radio->foliage) {
    throw_user_error_at(members.map().where,
                        "{}: these fields need a medium (itu, rows, a/b/c/d, "
                        "relative_permittivity + conductivity, or layers)",
                        members.map().path);
  }
  if (scattering) radio->scattering_coefficient = *scattering;
  if (pattern) radio->pattern = *pattern;
  if (exponent) radio->pattern_exponent = *exponent;
  if (back_exponent) radio->backscatter_exponent = *back_exponent;
  if (back_share) radio->backscatter_share = *back_share;
  if (cross_polarization) radio->cross_polarization = *cross_polarization;
  if (roughness) radio->roughness_m = *roughness;
}

}  // namespace

RadioField field_from_json(const nlohmann::json& value, const std::string& what, const std::string& path) {
  RadioField field;
  field.where.file = what;
  field.path = path;
  if (value.is_boolean()) {
    field.kind = Kind::boolean;
    field.boolean = value.get<bool>();
  } else if (value.is_number()) {
    field.kind = Kind::number;
    field.number = value.get<double>();
  } else if (value.is_string()) {
    field.kind = Kind::text;
    field.text = value.get<std::string>();
  } else if (value.is_array()) {
    field.kind = Kind::list;
    for (size_t index = 0; index < value.size(); ++index) {
      field.items.push_back(field_from_json(value[index], what, fmt::format("{}[{}]", path, index)));
    }
  } else if (value.is_object()) {
    field.kind = Kind::map;
    for (const auto& [key, member] : value.items()) {
      field.members.emplace_back(key, field_from_json(member, what, path + "." + key));
    }
  }
  return field;
}

RadioSources read_radio_fields(const RadioField& fields, const RadioSources& below) {
  Members members(fields);
  RadioSources result = below;
  if (const auto foliage = read_foliage(members)) {
    result.radio.emplace();
    result.radio->foliage = foliage;
  }
  read_wall(members, result.radio);
  read_surface(members, result.radio);
  if (const auto value = members.unit_interval("reflectance_905nm")) {
    result.reflectance_905nm = static_cast<float>(*value);
  }
  if (const auto value = members.unit_interval("reflectance_1550nm")) {
    result.reflectance_1550nm = static_cast<float>(*value);
  }
  members.finish();
  return result;
}

std::optional<std::string> itu_part_of_name(const std::string& material_name) {
  std::string name = material_name;
  // Blender numbers copies: "itu_concrete.001".
  const size_t dot = name.rfind('.');
  const bool numbered = dot != std::string::npos && dot + 1 < name.size() &&
                        std::all_of(name.begin() + static_cast<std::ptrdiff_t>(dot) + 1, name.end(),
                                    [](unsigned char character) { return std::isdigit(character); });
  if (numbered) name.erase(dot);
  if (name.starts_with("mat-")) name.erase(0, 4);  // Mitsuba's export
  if (name.size() < 5) return std::nullopt;
  const auto lower = [&](size_t index) { return std::tolower(static_cast<unsigned char>(name[index])); };
  const bool prefix = lower(0) == 'i' && lower(1) == 't' && lower(2) == 'u' &&
                      (name[3] == '_' || name[3] == '-' || name[3] == ' ');
  if (!prefix) return std::nullopt;
  return name.substr(4);
}

}  // namespace greatx::scene
