// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/import/mitsuba_materials.h"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/text.h"
#include "scene/material/material.h"

namespace greatx::scene {

namespace {

using Json = nlohmann::ordered_json;

/// Describes the look of a medium where the file gives none.
struct Look {
  const char* itu;
  vec3 color;
};
const Look looks[] = {
    {"concrete", vec3(0.45f)},
    {"brick", {0.40f, 0.17f, 0.11f}},
    {"plasterboard", vec3(0.72f)},
    {"wood", {0.35f, 0.21f, 0.11f}},
    {"glass", {0.10f, 0.14f, 0.16f}},
    {"clear_acrylic", {0.55f, 0.58f, 0.60f}},
    {"ceiling_board", vec3(0.70f)},
    {"chipboard", {0.48f, 0.35f, 0.22f}},
    {"plywood", {0.50f, 0.37f, 0.23f}},
    {"marble", {0.62f, 0.58f, 0.50f}},
    {"floorboard", {0.38f, 0.25f, 0.14f}},
    {"vinyl_tile", {0.45f, 0.44f, 0.40f}},
    {"carpet_tile", {0.18f, 0.20f, 0.24f}},
    {"asphalt_concrete", vec3(0.09f)},
    {"metal", vec3(0.56f)},
    {"very_dry_ground", {0.42f, 0.33f, 0.22f}},
    {"medium_dry_ground", {0.28f, 0.21f, 0.13f}},
    {"wet_ground", {0.14f, 0.10f, 0.07f}},
};

/// Returns the canonical name of a medium ("Wet-Ground.001" -> "wet_ground"), or an empty text.
std::string itu_name(std::string name) {
  if (const size_t dot = name.find('.'); dot != std::string::npos) name.resize(dot);
  const std::optional<RadioMedium> medium = itu_medium(name);
  if (!medium) return {};
  for (const std::string& known : itu_names())
    if (itu_medium(known)->source == medium->source) return known;
  return {};
}

/// Returns the first colour that a BSDF, or one nested in it, has.
std::optional<vec3> color_of(const MitsubaXml& xml, const pugi::xml_node& bsdf) {
  for (const char* name : {"color", "reflectance", "base_color"}) {
    const pugi::xml_node found = bsdf.find_node([&](const pugi::xml_node& node) {
      return std::string(node.name()) == "rgb" && std::string(node.attribute("name").value()) == name;
    });
    if (found) return xml.rgb(found);
  }
  return std::nullopt;
}

double thickness_of(const MitsubaXml& xml, const pugi::xml_node& bsdf, const MitsubaOptions& options) {
  const double thickness = xml.real(bsdf, "thickness").value_or(options.default_thickness_m);
  if (!(thickness > 0.0)) xml.fail(bsdf, "thickness: expected metres above 0, found {}", thickness);
  return thickness;
}

/// Adds the fields that the plugins call by other names than GREATX_radio_material.
void add_scattering(const MitsubaXml& xml, const pugi::xml_node& bsdf, Json& radio) {
  if (const auto value = xml.real(bsdf, "scattering_coefficient"); value && *value != 0.0)
    radio["scattering_coefficient"] = *value;
  if (const auto value = xml.real(bsdf, "xpd_coefficient"); value && *value != 0.0)
    radio["cross_polarization"] = *value;
}

}  // namespace

std::string without_prefix(std::string name, const std::string& prefix) {
  if (name.starts_with(prefix)) name.erase(0, prefix.size());
  return name;
}

ImportedMaterial read_mitsuba_material(const MitsubaXml& xml, const pugi::xml_node& bsdf,
                                       const MitsubaOptions& options) {
  ImportedMaterial material;
  material.name = without_prefix(xml.text(bsdf, "id"), "mat-");
  const std::string plugin = bsdf.attribute("type").value();
  const bool by_name = material.name.starts_with("itu_") || material.name.starts_with("itu-");
  Json radio;
  if (by_name || plugin == "itu-radio-material") {
    const std::optional<std::string> type = xml.string(bsdf, "type");
    if (!type && !by_name)
      xml.fail(bsdf, "material '{}': expected <string name=\"type\">", printable(material.name));
    const std::string medium = type.value_or(material.name.substr(by_name ? 4 : 0));
    const std::string itu = itu_name(medium);
    if (itu.empty())
      xml.fail(bsdf, "material '{}': expected one of ITU-R P.2040's ({}), found '{}'{}", material.name,
               fmt::join(itu_names(), ", "), medium, suggestion(medium, itu_names()));
    radio["itu"] = itu;
    for (const Look& look : looks)
      if (itu == look.itu) material.base_color = look.color;
    if (itu == "metal") material.metallic = 1.0f;
  } else if (plugin == "radio-material") {
    radio["relative_permittivity"] = xml.real(bsdf, "relative_permittivity").value_or(1.0);
    radio["conductivity"] = xml.real(bsdf, "conductivity").value_or(0.0);
  } else {
    xml.fail(bsdf,
             "material '{}': a BSDF of type '{}' says nothing of radio; expected a name that begins with "
             "itu_ or mat-itu_ (itu_concrete), or the type itu-radio-material or radio-material",
             material.name, plugin);
  }
  radio["thickness_m"] = thickness_of(xml, bsdf, options);
  add_scattering(xml, bsdf, radio);
  material.radio_json = radio.dump();
  if (const std::optional<vec3> color = color_of(xml, bsdf)) material.base_color = *color;
  return material;
}

}  // namespace greatx::scene
