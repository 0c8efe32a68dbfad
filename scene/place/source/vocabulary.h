// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Translates attributes of files into tags of OpenStreetMap.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "scene/place/source/map_contents.h"

namespace greatx::scene::place {

/// Attributes of one object by name; attributes without a value are left out. Numbers have the shortest text.
using Attributes = std::map<std::string, std::string, std::less<>>;

/// What a file's object is after translation.
struct Translated {
  std::map<std::string, std::string, std::less<>> tags;
  std::string id;         ///< "way/123", or empty if the attributes name none
  std::string part_of;    ///< id of the parent, or empty
  bool left_out = false;  ///< the vocabulary says that the object is not to be built
};

/// Translates by `vocabulary`, `keys` and `as` of a source.
///
/// - osm: attributes are tags; `tags` may hold them as a JSON object and `other_tags` as hstore, the forms of
///   Overpass and of GDAL. The id comes from `@id`, `id`, `osm_id`, `osm_way_id`, `full_id`.
/// - osm_buildings: the names of OSM Buildings' GeoJSON (roofShape, minHeight, ...). Each object is a
///   building, and a part if `building` names its parent.
/// - cityjson: names of CityJSON 2.0, section 2.2 (storeysAboveGround, ...).
class Vocabulary {
 public:
  explicit Vocabulary(const MapSource& source);
  Translated translate(const Attributes& attributes) const;

 private:
  void add_osm(const Attributes& attributes, Translated& result) const;
  void add_osm_buildings(const Attributes& attributes, Translated& result) const;
  const MapSource& source_;
};

/// Rewrites lengths whose numbers have no unit from the source's unit to metres ("height", "min_height",
/// ...). Returns the keys whose text is no length.
std::vector<std::string> lengths_to_metres(std::map<std::string, std::string, std::less<>>& tags,
                                           double unit_m);

/// Returns whether a tag is one of those that things are built of.
bool has_known_key(const std::map<std::string, std::string, std::less<>>& tags);

/// Counts the names that OSM Buildings has and OpenStreetMap has not.
size_t names_of_osm_buildings(const std::set<std::string>& names);

/// Returns the vocabulary that names like these belong to, with a reason, or an empty text.
std::string suggested_vocabulary(const std::set<std::string>& names);

}  // namespace greatx::scene::place
