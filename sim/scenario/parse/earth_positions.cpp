// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/earth_positions.h"

#include <cmath>

#include "scene/georeference/georeference.h"
#include "sim/scenario/parse/scenario_values.h"

namespace greatx::sim {
namespace {

std::string text_of(const Geodetic& place) {
  return fmt::format("[{}, {}, {}]", place.latitude_deg, place.longitude_deg, place.height_m);
}

Geodetic swapped(const Geodetic& place) { return {place.longitude_deg, place.latitude_deg, place.height_m}; }

bool on_earth(const Geodetic& place) {
  return std::abs(place.latitude_deg) <= 90.0 && std::abs(place.longitude_deg) <= 180.0 &&
         std::abs(place.height_m) <= most_position_m;
}

/// Returns the distance from the origin along a chord at the height of the origin.
double ground_distance_m(const LocalFrame& frame, const Geodetic& place) {
  return glm::length(
      frame.local({place.latitude_deg, place.longitude_deg, frame.reference().origin.height_m}));
}

/// Asks whether latitude and longitude are swapped, if the swapped place is near the origin.
std::string suggestion_of_swap(const LocalFrame& frame, const Geodetic& place) {
  const Geodetic other = swapped(place);
  if (!on_earth(other) || ground_distance_m(frame, other) > most_ground_distance_m) return "";
  return fmt::format("; did you mean {}? The latitude comes first", text_of(other));
}

Georeference read_scene_reference(const Field& field) {
  const FieldMap map(field, {"latitude_deg", "longitude_deg", "height_m", "undulation_m", "vertical_datum"});
  Georeference reference;
  reference.origin.latitude_deg = map.require("latitude_deg", "degrees, north positive").between(-90.0, 90.0);
  reference.origin.longitude_deg =
      map.require("longitude_deg", "degrees, east positive").between(-180.0, 180.0);
  reference.origin.height_m = map.require("height_m", "the height of the scene's origin above the ellipsoid")
                                  .number(most_origin_height_m);
  if (const auto f = map.find("undulation_m")) reference.undulation_m = f->number(most_undulation_m);
  if (const auto f = map.find("vertical_datum")) reference.vertical_datum = f->text();
  return reference;
}

std::string reference_text(const Georeference& reference) { return scene::georeference_json(reference); }

}  // namespace

EarthPositions::EarthPositions(const SceneConfig& scene) : heights_(scene.heights) {
  if (scene.georeference) frame_.emplace(*scene.georeference);
}

EarthPositions EarthPositions::with(HeightOf heights) const {
  EarthPositions other = *this;
  other.heights_ = heights;
  return other;
}

dvec3 EarthPositions::local(const Geodetic& place, const Fail& fail) const {
  const auto refuse = [&](const std::string& expected, const std::string& found) {
    fail(expected, found);
    GREATX_CHECK(false, "a fault of a position was not reported: expected {}, found {}", expected, found);
  };
  if (!frame_)
    refuse("a position in metres, since the scene has no georeference (scene.georeference)",
           "a latitude and a longitude");
  if (!on_earth(place))
    refuse("a latitude of -90 to 90 degrees, a longitude of -180 to 180 degrees and a height in m",
           text_of(place) + suggestion_of_swap(*frame_, place));
  const double distance = ground_distance_m(*frame_, place);
  if (distance > most_ground_distance_m && place.height_m < least_space_height_m) {
    const Geodetic& origin = frame_->reference().origin;
    refuse(fmt::format("a place within {:g} km of the scene's origin at latitude {}, longitude {}",
                       most_ground_distance_m / 1e3, origin.latitude_deg, origin.longitude_deg),
           fmt::format("{}, {:.0f} km away{}", text_of(place), distance / 1e3,
                       suggestion_of_swap(*frame_, place)));
  }
  return frame_->local(place, heights_);
}

dvec3 place_of(const Field& field, const EarthPositions& earth) {
  const std::string expected = "a list of 3 numbers: latitude and longitude in degrees, height in m";
  if (!field.is_list() || field.list(expected).size() != 3) field.fail(expected);
  const dvec3 place = field.vector3(most_position_m);
  return earth.local({place.x, place.y, place.z},
                     [&](const std::string& wanted, const std::string& found) { field.fail(wanted, found); });
}

std::optional<dvec3> find_position(const FieldMap& map, const EarthPositions& earth,
                                   const PositionKeys& keys) {
  map.exclude(keys.metres, keys.degrees);
  if (const auto field = map.find(keys.degrees)) return place_of(*field, earth);
  if (const auto field = map.find(keys.metres)) return position_of(*field);
  return std::nullopt;
}

dvec3 require_position(const FieldMap& map, const EarthPositions& earth, const PositionKeys& keys) {
  if (const auto position = find_position(map, earth, keys)) return *position;
  map.require(keys.metres, fmt::format("a list of 3 numbers (or '{}')", keys.degrees));
  return dvec3(0.0);  // not reached: the key is missing
}

HeightOf heights_of(const Field& field) {
  return field.choice({"datum", "ellipsoid"}) == 0 ? HeightOf::datum : HeightOf::ellipsoid;
}

EarthPositions with_heights_of(const FieldMap& map, const EarthPositions& earth) {
  const auto field = map.find("heights");
  return field ? earth.with(heights_of(*field)) : earth;
}

std::optional<Georeference> parse_georeference(const FieldMap& map, const std::vector<SceneFile>& files) {
  std::optional<Georeference> reference;
  std::string source;
  if (const auto field = map.find("georeference")) {
    reference = read_scene_reference(*field);
    source = "scene.georeference";
  }
  for (const auto& [file, where, in_place] : files) {
    const std::optional<Georeference> own = scene::georeference_of_file(file);
    if (!own) continue;
    if (!in_place)
      throw_user_error_at(
          where,
          "scene.objects: expected no position, rotation_deg and scale of the file '{}', which "
          "has a georeference, found one of them",
          file.string());
    if (reference && *reference != *own)
      throw_user_error_at(where, "scene: expected one georeference, found {} in {} and {} in {}",
                          reference_text(*reference), source, reference_text(*own), file.string());
    reference = own;
    source = file.string();
  }
  return reference;
}

}  // namespace greatx::sim
