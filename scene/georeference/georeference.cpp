// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/georeference/georeference.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/budget.h"
#include "core/text.h"
#include "io/files/untrusted_json.h"

namespace greatx::scene {
namespace {

constexpr const char* extras_key = "greatx_georeference";

nlohmann::ordered_json json_of(const Georeference& reference) {
  return {{"latitude_deg", reference.origin.latitude_deg},
          {"longitude_deg", reference.origin.longitude_deg},
          {"height_m", reference.origin.height_m},
          {"undulation_m", reference.undulation_m},
          {"vertical_datum", reference.vertical_datum}};
}

std::string text_of(const nlohmann::ordered_json& json) {
  // A name in another encoding than UTF-8 must not stop a file from being written.
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

Georeference read(const io::JsonValue& value) {
  constexpr std::array members{"latitude_deg", "longitude_deg", "height_m", "undulation_m", "vertical_datum"};
  if (!value.is_object()) value.fail("an object with latitude_deg, longitude_deg and height_m");
  for (const auto& [name, member] : value.json().items())
    if (std::ranges::find(members, name) == members.end())
      value.at(name).fail(
          "nothing: the members are latitude_deg, longitude_deg, height_m, undulation_m and "
          "vertical_datum");
  Georeference reference;
  reference.origin.latitude_deg = value.at("latitude_deg").number(-90.0, 90.0);
  reference.origin.longitude_deg = value.at("longitude_deg").number(-180.0, 180.0);
  reference.origin.height_m = value.at("height_m").number(-most_origin_height_m, most_origin_height_m);
  if (value.has("undulation_m"))
    reference.undulation_m = value.at("undulation_m").number(-most_undulation_m, most_undulation_m);
  if (value.has("vertical_datum")) reference.vertical_datum = value.at("vertical_datum").text();
  return reference;
}

/// Returns the JSON of a .glb (glTF 2.0, section 4.4) or of a .gltf, or nothing if the file is neither.
std::string json_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 20> header{};
  in.read(header.data(), header.size());
  const auto word = [&](size_t index) {
    uint32_t value = 0;
    std::memcpy(&value, header.data() + 4 * index, sizeof value);
    return value;
  };
  std::error_code error;
  const uint64_t bytes = std::filesystem::file_size(file, error);
  if (error) return "";
  const bool binary = in.gcount() == header.size() && std::string_view(header.data(), 4) == "glTF";
  const uint64_t size = binary ? word(3) : bytes;
  if (size > budget::model_json.most || size > bytes) return "";
  if (!binary) {
    in.clear();
    in.seekg(0);
  }
  std::string text(size, '\0');
  in.read(text.data(), static_cast<std::streamsize>(size));
  return static_cast<uint64_t>(in.gcount()) == size ? text : "";
}

}  // namespace

std::string georeference_json(const Georeference& reference) { return text_of(json_of(reference)); }

std::string georeference_extras(const Georeference& reference) {
  nlohmann::ordered_json extras;
  extras[extras_key] = json_of(reference);
  return text_of(extras);
}

std::string georeference_words(const Georeference& reference) {
  const auto& [latitude_deg, longitude_deg, height_m] = reference.origin;
  return fmt::format(
      "latitude {:.8f}, longitude {:.8f}, {:.3f} m above the ellipsoid, {:.3f} m above {}", latitude_deg,
      longitude_deg, height_m, height_m - reference.undulation_m,
      reference.vertical_datum.empty() ? "the vertical datum" : printable(reference.vertical_datum));
}

std::optional<Georeference> georeference_of_document(std::string json, const SourceLocation& where) {
  if (json.find(extras_key) == std::string::npos) return std::nullopt;
  constexpr int most_depth = 128;  // as the loader's
  const io::JsonDocument document(std::move(json), where,
                                  {budget::model_json.most, budget::model_json.most, most_depth});
  const io::JsonValue root = document.root();
  if (!root.has("scenes")) return std::nullopt;
  constexpr int64_t most_scenes = 1 << 20;
  const std::vector<io::JsonValue> scenes = root.at("scenes").list(most_scenes);
  const int64_t chosen = root.has("scene") ? root.at("scene").integer(0, most_scenes) : 0;
  if (chosen >= static_cast<int64_t>(scenes.size())) return std::nullopt;  // the loader refuses it
  const io::JsonValue& scene = scenes[static_cast<size_t>(chosen)];
  if (!scene.has("extras") || !scene.at("extras").has(extras_key)) return std::nullopt;
  return read(scene.at("extras").at(extras_key));
}

std::optional<Georeference> georeference_of_file(const std::filesystem::path& file) {
  const bool names_lines = file.extension() == ".gltf";
  return georeference_of_document(json_text(file), {file.string(), names_lines ? 1 : 0});
}

}  // namespace greatx::scene
