// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <utility>

#include "core/budget.h"
#include "core/fields/field.h"
#include "core/input_file.h"
#include "scene/place/config/place_config.h"

namespace greatx::scene::place {

namespace {

// Bounds of the fields (docs/places_reference.md lists them).
constexpr double most_height_m = 20'000.0;   // beyond the highest mountain and the deepest trench
constexpr double most_undulation_m = 200.0;  // the geoid lies within 110 m of the ellipsoid
constexpr uint64_t most_seed = std::numeric_limits<uint64_t>::max();

// The international foot and the foot of the United States' survey (NIST SP 811, table of appendix B.8).
constexpr double foot_m = 0.3048, survey_foot_m = 1200.0 / 3937.0;

double parse_unit(const Field& field) {
  constexpr double units[] = {1.0, foot_m, survey_foot_m, 0.01, 0.1};
  return units[field.choice({"m", "ft", "us-ft", "cm", "dm"})];
}

/// Returns the name of a source, which must be new.
std::string source_name(const FieldMap& map, const std::filesystem::path& file,
                        std::set<std::string>& names) {
  const auto given = map.find("name");
  std::string name = given ? given->text() : file.filename().string();
  if (!names.insert(name).second)
    (given ? *given : map.field()).fail("every source's name once", fmt::format("a second '{}'", name));
  return name;
}

std::string text_or_nothing(const FieldMap& map, std::string_view key) {
  const auto field = map.find(key);
  return field ? field->text() : std::string();
}

/// Checks that a text is a tag of OpenStreetMap: key=value.
std::string parse_tag(const Field& field) {
  const std::string tag = field.text();
  const auto sign = tag.find('=');
  if (sign == std::string::npos || sign == 0 || sign + 1 == tag.size())
    field.fail("a tag of OpenStreetMap, such as building=yes", fmt::format("'{}'", tag));
  return tag;
}

MapSource parse_map(const Field& field, std::set<std::string>& names) {
  const FieldMap map(field, {"file", "name", "layer", "crs", "keys", "vocabulary", "as", "id_field",
                             "height_unit", "heights", "licence"});
  MapSource source;
  source.file = map.require("file", "a file with buildings, roads and other objects").file();
  source.name = source_name(map, source.file, names);
  source.layer = text_or_nothing(map, "layer");
  source.crs = text_or_nothing(map, "crs");
  if (const auto keys = map.find("keys"))
    for (const auto& [key, attribute] : keys->entries()) source.keys[key] = attribute.text();
  if (const auto f = map.find("vocabulary"))
    source.vocabulary =
        std::array{"osm", "osm_buildings", "cityjson"}[f->choice({"osm", "osm_buildings", "cityjson"})];
  if (const auto f = map.find("as")) source.as = parse_tag(*f);
  source.id_field = text_or_nothing(map, "id_field");
  if (const auto f = map.find("height_unit")) source.height_unit_m = parse_unit(*f);
  if (const auto f = map.find("heights"))
    source.heights_above_datum = f->choice({"above_ground", "above_datum"}) == 1;
  source.licence = text_or_nothing(map, "licence");
  return source;
}

HeightSource parse_heights(const Field& field, std::set<std::string>& names) {
  const FieldMap map(field, {"file", "name", "crs", "unit", "no_data", "valid_m", "licence"});
  HeightSource source;
  source.file = map.require("file", "a file with heights").file();
  source.name = source_name(map, source.file, names);
  source.crs = text_or_nothing(map, "crs");
  if (const auto f = map.find("unit")) source.unit_m = parse_unit(*f);
  if (const auto f = map.find("no_data")) source.no_data = f->finite();
  if (const auto f = map.find("valid_m")) {
    const auto ends = f->list("numbers", 2);
    if (ends.size() != 2) f->fail("[lowest, highest]");
    source.valid_m = dvec2(ends[0].number(most_height_m), ends[1].number(most_height_m));
    if (!(source.valid_m->x < source.valid_m->y))
      f->fail("[lowest, highest] with lowest < highest",
              fmt::format("[{}, {}]", source.valid_m->x, source.valid_m->y));
  }
  source.licence = text_or_nothing(map, "licence");
  return source;
}

PictureSource parse_picture(const Field& field, std::set<std::string>& names) {
  const FieldMap map(field, {"file", "name", "crs", "licence"});
  PictureSource source;
  source.file = map.require("file", "a picture of the ground").file();
  source.name = source_name(map, source.file, names);
  source.crs = text_or_nothing(map, "crs");
  source.licence = text_or_nothing(map, "licence");
  return source;
}

std::array<double, 4> parse_bounds(const Field& field) {
  const auto items = field.list("numbers: [south, west, north, east]", 4);
  if (items.size() != 4) field.fail("[south, west, north, east] in degrees");
  const std::array bounds{items[0].between(-90.0, 90.0), items[1].between(-180.0, 180.0),
                          items[2].between(-90.0, 90.0), items[3].between(-180.0, 180.0)};
  if (!(bounds[0] < bounds[2]))
    field.fail("[south, west, north, east] with south < north",
               fmt::format("south {} and north {}", bounds[0], bounds[2]));
  if (bounds[1] == bounds[3])
    field.fail("[south, west, north, east] with west and east apart", fmt::format("{} for both", bounds[1]));
  return bounds;
}

std::vector<Geodetic> parse_polygon(const Field& field) {
  std::vector<Geodetic> corners;
  for (const Field& item : field.list("corners [latitude, longitude]", 3)) {
    const auto pair = item.list("numbers: [latitude, longitude]", 2);
    if (pair.size() != 2) item.fail("[latitude, longitude] in degrees");
    corners.push_back({pair[0].between(-90.0, 90.0), pair[1].between(-180.0, 180.0), 0.0});
  }
  if (corners.size() > 3 && corners.front() == corners.back()) corners.pop_back();
  return corners;
}

AreaConfig parse_area(const Field& field) {
  const Keys keys{"bounds_deg", "polygon_deg", "polygon_file", "extent_of"};
  const FieldMap map(field, keys);
  for (size_t i = 0; i < keys.size(); ++i)
    for (size_t k = i + 1; k < keys.size(); ++k) map.exclude(keys[i], keys[k]);
  AreaConfig area;
  if (const auto f = map.find("bounds_deg")) area.bounds_deg = parse_bounds(*f);
  if (const auto f = map.find("polygon_deg")) area.polygon = parse_polygon(*f);
  if (const auto f = map.find("polygon_file")) area.polygon_file = f->file();
  if (const auto f = map.find("extent_of")) area.extent_of = f->text();
  return area;
}

Geodetic parse_origin(const Field& field) {
  const FieldMap map(field, {"latitude_deg", "longitude_deg", "height_m"});
  return {map.require("latitude_deg", "degrees north").between(-90.0, 90.0),
          map.require("longitude_deg", "degrees east").between(-180.0, 180.0),
          map.require("height_m", "metres above the vertical datum").number(most_height_m)};
}

dvec2 parse_height_range(const Field& field) {
  const auto ends = field.list("numbers: [lowest, highest]", 2);
  if (ends.size() != 2) field.fail("[lowest, highest] in metres");
  const dvec2 range(ends[0].positive(0.5, 1000.0), ends[1].positive(0.5, 1000.0));
  if (range.x > range.y)
    field.fail("[lowest, highest] with lowest <= highest", fmt::format("[{}, {}]", range.x, range.y));
  return range;
}

BuildingConfig parse_buildings(const Field& field) {
  const FieldMap map(field, {"seed", "floor_height_m", "facades", "weld_m", "assumed_height_m"});
  BuildingConfig buildings;
  if (const auto f = map.find("seed")) buildings.seed = f->integer(0, most_seed);
  if (const auto f = map.find("floor_height_m")) buildings.floor_height_m = f->between(1.0, 20.0);
  if (const auto f = map.find("facades"))
    buildings.facades = static_cast<FacadeDetail>(f->choice({"plain", "texture", "geometry"}));
  if (const auto f = map.find("weld_m")) buildings.weld_m = f->between(0.0, 1.0);
  if (const auto f = map.find("assumed_height_m"))
    for (const auto& [kind, range] : f->entries())
      buildings.assumed_height_m[kind == "other" ? "" : kind] = parse_height_range(range);
  return buildings;
}

GroundConfig parse_ground(const Field& field) {
  const FieldMap map(field, {"error_m", "margin_m", "road_width_scale"});
  GroundConfig ground;
  if (const auto f = map.find("error_m")) ground.error_m = f->between(0.001, 100.0);
  if (const auto f = map.find("margin_m")) ground.margin_m = f->between(0.0, 10'000.0);
  if (const auto f = map.find("road_width_scale")) ground.road_width_scale = f->between(0.1, 10.0);
  return ground;
}

VegetationConfig parse_vegetation(const Field& field) {
  const FieldMap map(field, {"seed", "woods_per_hectare", "row_spacing_m"});
  VegetationConfig vegetation;
  if (const auto f = map.find("seed")) vegetation.seed = f->integer(0, most_seed);
  if (const auto f = map.find("woods_per_hectare")) vegetation.woods_per_hectare = f->between(0.0, 10'000.0);
  if (const auto f = map.find("row_spacing_m")) vegetation.row_spacing_m = f->between(0.5, 1000.0);
  return vegetation;
}

void parse_sources(const FieldMap& map, PlaceConfig& place) {
  std::set<std::string> names;
  if (const auto f = map.find("maps"))
    for (const Field& item : f->list("maps")) place.maps.push_back(parse_map(item, names));
  if (const auto f = map.find("terrain"))
    for (const Field& item : f->list("files with heights"))
      place.terrain.push_back(parse_heights(item, names));
  if (const auto f = map.find("surface"))
    for (const Field& item : f->list("files with heights"))
      place.surface.push_back(parse_heights(item, names));
  if (const auto f = map.find("pictures"))
    for (const Field& item : f->list("pictures")) place.pictures.push_back(parse_picture(item, names));
  if (names.empty()) map.field().fail("at least one source (maps, terrain, surface, pictures)", "none");
  const std::string& wanted = place.area.extent_of;
  if (!wanted.empty() && !names.contains(wanted))
    FieldMap(*map.find("area"), {"extent_of"})
        .require("extent_of", "")
        .fail("the name of a source",
              fmt::format("'{}'; the sources are {}", wanted, fmt::join(names, ", ")));
  const AreaConfig& area = place.area;
  if (place.maps.empty() && !area.bounds_deg && area.polygon.empty() && area.polygon_file.empty() &&
      area.extent_of.empty())
    map.field().fail("area, because no map gives an extent", "neither area nor maps");
}

}  // namespace

PlaceConfig load_place_config(const std::filesystem::path& file, const std::filesystem::path& assets) {
  const std::string text = InputFile(file, file.string(), budget::yaml_file).text();
  const Field root = Field::parse_yaml(text, {file.string(), file.parent_path(), assets});
  const FieldMap map(
      root, {"greatx_place", "name", "origin", "undulation_m", "vertical_datum", "area", "maps", "terrain",
             "surface", "pictures", "buildings", "ground", "vegetation", "materials", "simplify_m"});
  map.require("greatx_place", "1, the version of this format").integer(1, 1);
  PlaceConfig place;
  place.file = file;
  const auto name = map.find("name");
  place.name = name ? name->name() : file.stem().string();
  if (const auto f = map.find("origin")) place.origin = parse_origin(*f);
  if (const auto f = map.find("undulation_m")) place.undulation_m = f->number(most_undulation_m);
  place.vertical_datum = text_or_nothing(map, "vertical_datum");
  if (const auto f = map.find("area")) place.area = parse_area(*f);
  parse_sources(map, place);
  if (const auto f = map.find("buildings")) place.buildings = parse_buildings(*f);
  if (const auto f = map.find("ground")) place.ground = parse_ground(*f);
  if (const auto f = map.find("vegetation")) place.vegetation = parse_vegetation(*f);
  if (const auto f = map.find("materials")) place.materials = f->file();
  if (const auto f = map.find("simplify_m")) place.simplify_m = f->between(0.0, 10.0);
  return place;
}

}  // namespace greatx::scene::place
