// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines place.yaml: where a place lies, its sources, and how it is built (docs/places.md).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geodesy.h"
#include "core/vec.h"

namespace greatx::scene::place {

/// A file with buildings, roads and other objects.
struct MapSource {
  std::string name;  ///< for reports; the file's name unless given
  std::filesystem::path file;
  std::string layer;  ///< of a file with several; empty: all layers
  std::string crs;    ///< replaces what the file says, or says it: "EPSG:25833"; empty: as the file says
  /// Names of attributes by OpenStreetMap key, {"building:levels": "levels"}. `vocabulary` gives a whole set.
  std::map<std::string, std::string> keys;
  std::string vocabulary = "osm";  ///< "osm", "osm_buildings", "cityjson"
  std::string as;                  ///< every object gets this tag: "building=yes"; empty: none
  std::string id_field;            ///< attribute with the id; empty: the file's own ids
  double height_unit_m = 1.0;      ///< of numbers without a unit: 0.3048 for feet
  /// Whether an attribute `height` is a height above the ground or a z above the vertical datum.
  bool heights_above_datum = false;
  std::string licence;
};

/// A file with heights.
struct HeightSource {
  std::string name;
  std::filesystem::path file;
  std::string crs;
  /// 0.3048 for feet; a file that states another unit is an error. Nothing: the file's unit, or metres if it
  /// states none.
  std::optional<double> unit_m;
  std::optional<double> no_data;  ///< beside what the file says
  std::optional<dvec2> valid_m;   ///< values outside [low, high] count as no data, and are counted
  std::string licence;
};

struct PictureSource {
  std::string name;
  std::filesystem::path file;
  std::string crs;
  std::string licence;
};

/// What to build. At most one of the alternatives is given; none: the extent of all map sources.
struct AreaConfig {
  std::optional<std::array<double, 4>> bounds_deg;  ///< south, west, north, east; west > east crosses 180
  std::vector<Geodetic> polygon;                    ///< heights unused; at least three corners
  std::filesystem::path polygon_file;               ///< its first polygon
  std::string extent_of;                            ///< name of a source
};

enum class FacadeDetail {
  plain,     ///< one wall material per building
  texture,   ///< floors and windows painted; the radio material has the share of glass
  geometry,  ///< windows and walls are faces of their own
};

struct BuildingConfig {
  uint64_t seed = 1;
  double floor_height_m = 3.0;  ///< of storeys whose height is not given
  FacadeDetail facades = FacadeDetail::texture;
  double weld_m = 0.05;  ///< corners and walls of neighbours nearer than this become one
  /// Heights where nothing says them, by value of `building`: {"house": {6, 9}}, drawn uniformly; "" is for
  /// all others.
  std::map<std::string, dvec2> assumed_height_m;
};

struct GroundConfig {
  double error_m = 0.25;   ///< bound of the mesh's error at every sample of the terrain
  double margin_m = 20.0;  ///< ground beyond the area and its buildings
  double road_width_scale = 1.0;
};

struct VegetationConfig {
  uint64_t seed = 1;
  double woods_per_hectare = 200.0;  ///< trees of woods
  double row_spacing_m = 8.0;        ///< of rows of trees
};

struct PlaceConfig {
  std::string name;
  std::filesystem::path file;      ///< where this was read
  std::optional<Geodetic> origin;  ///< height above the vertical datum; none: centre of the area, its ground
  double undulation_m = 0.0;
  std::string vertical_datum;
  AreaConfig area;
  std::vector<MapSource> maps;
  std::vector<HeightSource> terrain, surface;
  std::vector<PictureSource> pictures;
  BuildingConfig buildings;
  GroundConfig ground;
  VegetationConfig vegetation;
  std::filesystem::path materials;  ///< YAML with the table of materials; empty: the one of greatx
  double simplify_m = 0.0;          ///< detail smaller than this may go; 0: none
};

/// Reads place.yaml. Files in it are relative to its folder, and are looked for in `assets` next. Throws
/// UserError "file:line: field: expected ..., found ...".
PlaceConfig load_place_config(const std::filesystem::path& file, const std::filesystem::path& assets = {});

}  // namespace greatx::scene::place
