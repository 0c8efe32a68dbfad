// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the nodes, ways and relations of an OpenStreetMap file as they are there, and makes features of them.
// Data flow: file ─► OsmData (osm_file.cpp, libosmium) ─► features (osm_features.cpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/place/source/map_contents.h"
#include "scene/place/source/rings.h"

namespace greatx::scene::place {

using Tags = std::map<std::string, std::string, std::less<>>;

struct OsmWay {
  int64_t id = 0;
  NodeIds nodes;
  Tags tags;
};
struct OsmMember {
  enum class Kind { node, way, relation } kind = Kind::way;
  int64_t id = 0;
  std::string role;
};
struct OsmRelation {
  int64_t id = 0;
  Tags tags;  ///< with "type"
  std::vector<OsmMember> members;
};

struct OsmData {
  std::vector<std::pair<int64_t, dvec2>> nodes;  ///< by id, degrees (longitude, latitude)
  std::vector<std::pair<int64_t, Tags>> tagged_nodes;
  std::vector<OsmWay> ways;            ///< with tags, or members of a relation below; in the file's order
  std::vector<OsmRelation> relations;  ///< of the types multipolygon and building
  const dvec2* node(int64_t id) const;
};

/// Reads a file of OpenStreetMap: XML or PBF, plain, .gz or .bz2.
OsmData read_osm_data(const std::filesystem::path& file);

/// Returns whether a closed way with these tags is an area ("Key:area" of the wiki), and not a line.
bool is_area(const Tags& tags);
/// Returns whether tags say more than where they come from.
bool says_anything(const Tags& tags);

/// Makes features: tagged nodes, then ways, then relations, each in the file's order.
void make_osm_features(const OsmData& data, MapContents& contents, Notes& notes);

}  // namespace greatx::scene::place
