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

#include "core/expected.h"
#include "core/text.h"
#include "scene/material/conductors.h"

namespace greatx::scene {
namespace {

constexpr const char* row_keys[] = {"a", "b", "c", "d", "min_hz", "max_hz"};
const Keys medium_keys{"itu",         "conductor", "rows",   "a",      "b",
                       "c",           "d",         "min_hz", "max_hz", "relative_permittivity",
                       "conductivity"};
const Keys layer_keys = medium_keys + Keys{"thickness_m", "extrapolate"};
const Keys material_keys = Keys{"foliage", "layers", "windows"} + layer_keys +
                           Keys{"scattering_coefficient",
                                "pattern",
                                "pattern_exponent",
                                "backscatter_exponent",
                                "backscatter_share",
                                "cross_polarization",
                                "roughness_m",
                                "deviation_m",
                                "clutter",
                                "reflectance_905nm",
                                "reflectance_1550nm"};

std::optional<double> number(const FieldMap& map, std::string_view key, double min, double max,
                             const std::string& expected) {
  const std::optional<Field> field = map.find(key);
  if (!field) return std::nullopt;
  const double value = field->finite(expected);
  if (value < min || value > max) field->fail(expected);
  return value;
}

std::optional<double> unit_interval(const FieldMap& map, std::string_view key) {
  return number(map, key, 0.0, 1.0, "a number from 0 to 1");
}

std::optional<double> exponent(const FieldMap& map, std::string_view key) {
  const std::string expected = "a whole number from 1 to 100";
  const auto value = number(map, key, 1.0, 100.0, expected);
  if (value && *value != std::floor(*value)) map.find(key)->fail(expected);
  return value;
}

/// Reads a thickness in metres above 0.
std::optional<double> thickness_of(const FieldMap& map) {
  const std::string expected = "a thickness in metres above 0 (leave it out for a half-space)";
  const auto value = number(map, "thickness_m", 0.0, 1e6, expected);
  if (value && *value <= 0.0) map.find("thickness_m")->fail(expected);
  return value;
}

std::optional<bool> boolean(const FieldMap& map, std::string_view key) {
  const std::optional<Field> field = map.find(key);
  return field ? std::optional(field->boolean()) : std::nullopt;
}

constexpr double any = std::numeric_limits<double>::max();

/// Reads a, b, c, d and the range of one row. If `optional`, the result is empty if none of them is given.
std::optional<RadioRow> read_row(const FieldMap& map, bool optional) {
  double values[std::size(row_keys)];
  size_t given = 0;
  const char* missing = nullptr;
  for (size_t index = 0; index < std::size(row_keys); ++index) {
    const bool signed_value = index == 1 || index == 3;
    const auto value = number(map, row_keys[index], signed_value ? -any : 0.0, any,
                              signed_value ? "a number" : "a number of 0 or more");
    if (value) {
      values[index] = *value;
      ++given;
    } else {
      missing = row_keys[index];
    }
  }
  if (given == 0 && optional) return std::nullopt;
  if (missing)
    map.field().refuse(fmt::format("a row needs a, b, c, d, min_hz and max_hz; '{}' is missing", missing));
  if (values[4] >= values[5])
    map.field().refuse(fmt::format("expected min_hz below max_hz, found {} and {}", values[4], values[5]));
  return RadioRow{values[0], values[1], values[2], values[3], values[4], values[5]};
}

std::optional<RadioMedium> read_itu(const FieldMap& map) {
  const std::optional<Field> field = map.find("itu");
  if (!field) return std::nullopt;
  auto medium = itu_medium(std::string(field->scalar()));
  if (!medium)
    field->fail(fmt::format("a material of ITU-R P.2040-4, Table 3 ({})", fmt::join(itu_names(), ", ")),
                fmt::format("'{}'{}", printable(field->scalar()), suggestion(field->scalar(), itu_names())));
  return medium;
}

std::optional<RadioMedium> read_conductor(const FieldMap& map) {
  const std::optional<Field> field = map.find("conductor");
  if (!field) return std::nullopt;
  auto medium = conductor_medium(std::string(field->scalar()));
  if (!medium) field->refuse(expected_one_of(conductor_names(), field->scalar()));
  return medium;
}

std::optional<RadioMedium> read_rows(const FieldMap& map) {
  const std::optional<Field> field = map.find("rows");
  if (!field) return std::nullopt;
  RadioMedium medium;
  medium.source = "explicit a, b, c, d";
  for (const Field& item : field->list("rows {a, b, c, d, min_hz, max_hz}", 1))
    medium.rows.push_back(*read_row(FieldMap(item, {std::begin(row_keys), std::end(row_keys)}), false));
  return medium;
}

std::optional<RadioMedium> read_flat_row(const FieldMap& map) {
  const auto row = read_row(map, true);
  if (!row) return std::nullopt;
  return RadioMedium{"explicit a, b, c, d", {*row}, false};
}

std::optional<RadioMedium> read_permittivity(const FieldMap& map) {
  const auto permittivity = number(map, "relative_permittivity", 1.0, any, "a number of 1 or more");
  const auto conductivity = number(map, "conductivity", 0.0, any, "S/m of 0 or more");
  if (!permittivity && !conductivity) return std::nullopt;
  if (!permittivity || !conductivity)
    map.field().refuse(fmt::format("relative_permittivity and conductivity go together; '{}' is missing",
                                   permittivity ? "conductivity" : "relative_permittivity"));
  RadioRow row{*permittivity, 0.0, *conductivity, 0.0, 0.0, std::numeric_limits<double>::infinity()};
  return RadioMedium{"explicit permittivity", {row}, false};
}

/// Reads the medium by exactly one of its five ways. The result is empty if none of them is used.
std::optional<RadioMedium> read_medium(const FieldMap& map) {
  std::optional<RadioMedium> medium;
  for (auto* read : {read_itu, read_conductor, read_rows, read_flat_row, read_permittivity}) {
    auto candidate = read(map);
    if (candidate && medium)
      map.field().refuse(
          fmt::format("the medium is given twice ({}; {}); expected one of itu, conductor, rows, "
                      "a/b/c/d, relative_permittivity + conductivity",
                      medium->source, candidate->source));
    if (candidate) medium = std::move(candidate);
  }
  return medium;
}

/// Reads a layer. Its medium has `extrapolate` unless it says otherwise itself.
RadioLayer read_layer(const Field& field, bool extrapolate) {
  const FieldMap map(field, layer_keys);
  RadioLayer layer;
  auto medium = read_medium(map);
  if (!medium)
    field.refuse(
        "a layer needs a medium (itu, conductor, rows, a/b/c/d, or relative_permittivity + conductivity)");
  medium->extrapolate = boolean(map, "extrapolate").value_or(extrapolate);
  layer.medium = std::move(*medium);
  const auto thickness = thickness_of(map);
  if (!thickness) field.refuse("a layer needs its thickness_m");
  layer.thickness_m = *thickness;
  return layer;
}

std::optional<std::vector<RadioLayer>> read_layers(const FieldMap& map, bool extrapolate) {
  const std::optional<Field> field = map.find("layers");
  if (!field) return std::nullopt;
  std::vector<RadioLayer> layers;
  for (const Field& item : field->list("layers", 1)) layers.push_back(read_layer(item, extrapolate));
  return layers;
}

/// Reads the wall itself: medium and thickness, or layers, or changes to the statements of the sources below.
void read_wall(const FieldMap& map, std::optional<RadioMaterial>& radio) {
  auto medium = read_medium(map);
  auto layers = read_layers(map, false);
  const auto thickness = thickness_of(map);
  const auto extrapolate = boolean(map, "extrapolate");
  if (layers && (medium || thickness || extrapolate))
    map.field().refuse("layers exclude a medium, thickness_m and extrapolate beside them");
  if (layers || medium) {
    if (!radio) radio.emplace();
    radio->foliage.reset();
    radio->layers = layers ? std::move(*layers) : std::vector<RadioLayer>{{std::move(*medium), 0.0}};
  }
  if (!thickness && !extrapolate) return;
  if (!radio || radio->foliage)
    map.field().refuse(
        "thickness_m and extrapolate need a medium (itu, conductor, rows, a/b/c/d, or relative_permittivity "
        "+ "
        "conductivity)");
  if (thickness) {
    if (radio->layers.size() != 1)
      map.field().refuse(
          fmt::format("thickness_m cannot change a material of {} layers", radio->layers.size()));
    radio->layers.front().thickness_m = *thickness;
  }
  if (extrapolate) set_extrapolate(*radio, *extrapolate);
}

/// Reads windows, or changes to those of the sources below. Their media extrapolate if all media of the wall
/// do, unless a layer says otherwise itself.
void read_windows(const FieldMap& map, std::optional<RadioMaterial>& radio) {
  const std::optional<Field> field = map.find("windows");
  if (!field) return;
  const FieldMap windows(*field, {"share", "layers"});
  if (!radio || radio->foliage)
    field->refuse(
        "windows need a wall around them (itu, conductor, rows, a/b/c/d, relative_permittivity + "
        "conductivity, or layers)");
  const bool extrapolate =
      std::ranges::all_of(radio->layers, [](const RadioLayer& layer) { return layer.medium.extrapolate; });
  const auto share = unit_interval(windows, "share");
  auto layers = read_layers(windows, extrapolate);
  if (!share && !layers)
    field->refuse("expected the windows' share of the wall's area, their layers, or both");
  if (!radio->windows) {
    if (!share || !layers)
      field->refuse(
          fmt::format("windows need their share of the wall's area and their layers; '{}' is missing",
                      share ? "layers" : "share"));
    radio->windows.emplace();
  }
  if (share) radio->windows->share = *share;
  if (layers) radio->windows->layers = std::move(*layers);
}

std::optional<ScatteringPattern> read_pattern(const FieldMap& map) {
  static constexpr ScatteringPattern patterns[] = {
      ScatteringPattern::lambertian, ScatteringPattern::directive, ScatteringPattern::backscattering};
  const std::optional<Field> field = map.find("pattern");
  if (!field) return std::nullopt;
  return patterns[field->choice({"lambertian", "directive", "backscattering"})];
}

/// Reads foliage. It is a volume, so one source cannot combine it with fields that describe a wall or its
/// surface.
std::optional<Foliage> read_foliage(const FieldMap& map) {
  const std::optional<Field> field = map.find("foliage");
  if (!field) return std::nullopt;
  for (const auto& [key, other] : map.field().entries()) {
    if (key == "foliage" || key == "clutter" || key.starts_with("reflectance_")) continue;
    throw_user_error_at(other.where(), "{}: foliage has no wall and no surface: expected no '{}' beside it",
                        map.field().path(), key);
  }
  if (field->scalar() == "weissberger") return Foliage{};
  const std::string expected = "weissberger or {attenuation_db_per_m: dB/m}";
  if (!field->is_map()) field->fail(expected);
  const auto attenuation = number(FieldMap(*field, {"attenuation_db_per_m"}), "attenuation_db_per_m", 0.0,
                                  1000.0, "dB/m from 0 to 1000");
  if (!attenuation) field->fail(expected);
  return Foliage{attenuation};
}

void read_surface(const FieldMap& map, std::optional<RadioMaterial>& radio) {
  const auto scattering = unit_interval(map, "scattering_coefficient");
  const auto pattern = read_pattern(map);
  const auto pattern_exponent = exponent(map, "pattern_exponent");
  const auto back_exponent = exponent(map, "backscatter_exponent");
  const auto back_share = unit_interval(map, "backscatter_share");
  const auto cross_polarization = unit_interval(map, "cross_polarization");
  const auto roughness = number(map, "roughness_m", 0.0, 10.0, "an rms height from 0 to 10 m");
  const auto deviation =
      number(map, "deviation_m", 0.0, 10.0, "an rms distance of the surface from its facet from 0 to 10 m");
  const bool any_given = scattering || pattern || pattern_exponent || back_exponent || back_share ||
                         cross_polarization || roughness || deviation;
  if (!any_given) return;
  if (!radio || radio->foliage)
    map.field().refuse(
        "these fields need a medium (itu, conductor, rows, a/b/c/d, relative_permittivity + conductivity, or "
        "layers)");
  if (scattering) radio->scattering_coefficient = *scattering;
  if (pattern) radio->pattern = *pattern;
  if (pattern_exponent) radio->pattern_exponent = *pattern_exponent;
  if (back_exponent) radio->backscatter_exponent = *back_exponent;
  if (back_share) radio->backscatter_share = *back_share;
  if (cross_polarization) radio->cross_polarization = *cross_polarization;
  if (roughness) radio->roughness_m = *roughness;
  if (deviation) radio->deviation_m = *deviation;
}

/// Reads the numbers of a clutter model, of which a form has those that it needs.
SurfaceClutter read_clutter_numbers(const Field& field) {
  const FieldMap map(field, {"level_db", "gamma_db", "angle_db", "frequency_db", "sea_state", "cross_db"});
  SurfaceClutter clutter;
  const auto decibels = [&](const char* key) {
    return number(map, key, -200.0, 100.0, "dB from -200 to 100");
  };
  const auto level = decibels("level_db"), gamma = decibels("gamma_db"), angle = decibels("angle_db"),
             frequency = decibels("frequency_db"), cross = decibels("cross_db");
  const auto state = number(map, "sea_state", 0.0, 6.0, "a sea state from 0 to 6");
  if ((level ? 1 : 0) + (gamma ? 1 : 0) + (state ? 1 : 0) != 1)
    field.refuse("a clutter model has one of level_db, gamma_db and sea_state");
  if (angle && !level) field.refuse("angle_db belongs to level_db");
  if (frequency && state) field.refuse("frequency_db belongs to level_db and gamma_db");
  clutter.form = level ? ClutterForm::kulemin : gamma ? ClutterForm::constant_gamma : ClutterForm::sea;
  clutter.level_db = level.value_or(gamma.value_or(0.0));
  clutter.angle_db = angle.value_or(0.0);
  clutter.frequency_db = frequency.value_or(0.0);
  clutter.sea_state = state.value_or(0.0);
  if (cross) clutter.cross_db = *cross;
  return clutter;
}

/// Reads the clutter of a surface or of foliage.
void read_clutter(const FieldMap& map, std::optional<RadioMaterial>& radio) {
  const std::optional<Field> field = map.find("clutter");
  if (!field) return;
  if (!radio) map.field().refuse("clutter needs a medium, layers or foliage");
  if (field->is_map()) {
    radio->clutter = read_clutter_numbers(*field);
    return;
  }
  radio->clutter = clutter_called(std::string(field->scalar()));
  if (!radio->clutter)
    field->fail(fmt::format("one of {}, or a map of numbers", fmt::join(clutter_names(), ", ")));
}

std::shared_ptr<const FieldValue> value_from_json(const nlohmann::json& json) {
  auto value = std::make_shared<FieldValue>();
  if (json.is_array()) {
    value->kind = FieldValue::Kind::list;
    for (const nlohmann::json& item : json) value->items.push_back(value_from_json(item));
  } else if (json.is_object()) {
    value->kind = FieldValue::Kind::map;
    for (const auto& [key, member] : json.items())
      value->members.push_back({key, 0, value_from_json(member)});
  } else if (!json.is_null()) {
    value->kind = FieldValue::Kind::scalar;
    value->quoted = json.is_string();
    value->text = json.is_string() ? json.get<std::string>() : json.dump();
  }
  return value;
}

}  // namespace

Field field_from_json(const nlohmann::json& json, const std::string& what, const std::string& path) {
  return Field(value_from_json(json), {what, {}, {}}, path);
}

RadioSources read_radio_fields(const Field& fields, const RadioSources& below) {
  const FieldMap map(fields, material_keys);
  RadioSources result = below;
  if (const auto foliage = read_foliage(map)) {
    result.radio.emplace();
    result.radio->foliage = foliage;
  }
  read_wall(map, result.radio);
  read_windows(map, result.radio);
  read_surface(map, result.radio);
  read_clutter(map, result.radio);
  if (const auto value = unit_interval(map, "reflectance_905nm"))
    result.reflectance_905nm = static_cast<float>(*value);
  if (const auto value = unit_interval(map, "reflectance_1550nm"))
    result.reflectance_1550nm = static_cast<float>(*value);
  return result;
}

void set_extrapolate(RadioMaterial& material, bool extrapolate) {
  for (RadioLayer& layer : material.layers) layer.medium.extrapolate = extrapolate;
  if (!material.windows) return;
  for (RadioLayer& layer : material.windows->layers) layer.medium.extrapolate = extrapolate;
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
