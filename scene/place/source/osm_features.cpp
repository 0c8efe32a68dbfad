// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <set>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "core/geodesy.h"
#include "scene/place/input/osm_values.h"
#include "scene/place/source/osm_data.h"

namespace greatx::scene::place {

namespace {

using Kind = Finding::Kind;

/// Keys whose closed ways are areas, and the values of them that are lines nevertheless (OpenStreetMap wiki,
/// "Key:area" and the pages of the keys).
const std::map<std::string, std::set<std::string>, std::less<>> area_keys{
    {"building", {}},
    {"building:part", {}},
    {"landuse", {}},
    {"natural", {"coastline", "cliff", "ridge", "arete", "tree_row", "valley", "gully", "earth_bank"}},
    {"leisure", {"track", "slipway"}},
    {"amenity", {}},
    {"shop", {}},
    {"tourism", {}},
    {"historic", {"citywalls"}},
    {"office", {}},
    {"craft", {}},
    {"place", {}},
    {"military", {"trench"}},
    {"water", {}},
    {"area:highway", {}},
    {"man_made", {"pipeline", "embankment", "dyke", "cutline", "breakwater", "groyne", "goods_conveyor"}},
    {"aeroway", {"runway", "taxiway", "parking_position"}},
    {"parking", {}},
    {"golf", {"hole", "path", "cartpath"}},
    {"landcover", {}}};
/// Keys whose closed ways are lines, but for these values.
const std::map<std::string, std::set<std::string>, std::less<>> line_keys{
    {"waterway", {"riverbank", "dock", "boatyard", "dam"}},
    {"highway", {"rest_area", "services", "platform"}},
    {"railway", {"platform", "station", "turntable", "roundhouse"}},
    {"public_transport", {"platform", "station"}},
    {"power", {"plant", "substation", "generator", "transformer", "switchgear"}}};
/// Keys that say nothing about what is there.
const std::set<std::string, std::less<>> silent_keys{"created_by", "source",      "note", "fixme",
                                                     "FIXME",      "attribution", "type"};

/// A chain of an open ring is closed by a straight line if the gap is at most this share of its length; at 1
/// the chain is straight. A square without one side has a third.
constexpr double most_gap = 0.6;

/// Returns the length of a line in degrees in metres, to 1 %: it only sizes messages and gaps.
double length_m(std::span<const dvec2> line) {
  double length = 0.0;
  for (size_t i = 1; i < line.size(); ++i)
    length += glm::distance(geocentric({line[i - 1].y, line[i - 1].x, 0.0}),
                            geocentric({line[i].y, line[i].x, 0.0}));
  return length;
}

class FeatureMaker {
 public:
  FeatureMaker(const OsmData& data, MapContents& contents, Notes& notes)
      : data_(data), contents_(contents), notes_(notes) {
    for (size_t i = 0; i < data.ways.size(); ++i) way_at_.emplace(data.ways[i].id, i);
  }

  void make() {
    for (const auto& [id, place] : data_.nodes) contents_.extent.add(place);
    for (const auto& [id, tags] : data_.tagged_nodes)
      if (const dvec2* place = data_.node(id)) {
        Feature& feature = add(fmt::format("node/{}", id), tags);
        feature.point = *place;
      }
    for (const OsmRelation& relation : data_.relations)
      if (relation.tags.at("type") == "multipolygon") claim_outlines(relation);
    for (const OsmWay& way : data_.ways) make_way(way);
    for (const OsmRelation& relation : data_.relations)
      if (relation.tags.at("type") == "multipolygon") make_multipolygon(relation);
    for (const OsmRelation& relation : data_.relations)
      if (relation.tags.at("type") == "building") join_parts(relation);
  }

 private:
  Feature& add(std::string id, Tags tags) {
    Feature feature;
    feature.id = std::move(id);
    feature.tags = std::move(tags);
    contents_.features.push_back(std::move(feature));
    return contents_.features.back();
  }

  /// Returns the places of nodes, without those that the file lacks.
  std::vector<dvec2> places(const NodeIds& nodes, size_t& missing) const {
    std::vector<dvec2> line;
    for (const int64_t id : nodes) {
      if (const dvec2* place = data_.node(id))
        line.push_back(*place);
      else
        ++missing;
    }
    return line;
  }

  /// Returns the tags of a multipolygon: its own, or if they say nothing, those of its outer ways (the form
  /// of before 2010).
  Tags multipolygon_tags(const OsmRelation& relation) const {
    Tags tags = relation.tags;
    tags.erase("type");
    if (says_anything(tags)) return tags;
    for (const OsmMember& member : relation.members) {
      const OsmWay* way = outer_way(member);
      if (way != nullptr && says_anything(way->tags)) return way->tags;
    }
    return tags;
  }
  const OsmWay* outer_way(const OsmMember& member) const {
    if (member.kind != OsmMember::Kind::way || member.role == "inner") return nullptr;
    const auto found = way_at_.find(member.id);
    return found != way_at_.end() ? &data_.ways[found->second] : nullptr;
  }

  /// An outer way that carries the same building or the relation's own tags is the relation's outline, and no
  /// second object.
  void claim_outlines(const OsmRelation& relation) {
    const Tags own = multipolygon_tags(relation);
    const bool tags_of_way = !says_anything([&] {
      Tags tags = relation.tags;
      tags.erase("type");
      return tags;
    }());
    for (const OsmMember& member : relation.members) {
      const OsmWay* way = outer_way(member);
      if (way == nullptr || !says_anything(way->tags)) continue;
      const bool same_building = (own.contains("building") && way->tags.contains("building")) ||
                                 (own.contains("building:part") && way->tags.contains("building:part"));
      if (!(tags_of_way && way->tags == own) && !same_building && way->tags != own) continue;
      claimed_.insert(way->id);
      if (!tags_of_way)
        notes_.add(Kind::repaired, "outline_tagged_twice", fmt::format("way/{}", way->id),
                   fmt::format("The way has the tags of relation/{}, whose outline it is, and counts once.",
                               relation.id));
    }
  }

  void make_way(const OsmWay& way) {
    if (!says_anything(way.tags) || claimed_.contains(way.id)) return;
    const std::string id = fmt::format("way/{}", way.id);
    size_t missing = 0;
    std::vector<dvec2> line = places(way.nodes, missing);
    if (missing > 0)
      notes_.add(Kind::doubtful, "nodes_missing", id,
                 fmt::format("{} of {} nodes are not in the file.", missing, way.nodes.size()));
    const bool closed = way.nodes.size() > 1 && way.nodes.front() == way.nodes.back();
    const bool area = is_area(way.tags);
    const bool must_be_area = way.tags.contains("building") || way.tags.contains("building:part") ||
                              way.tags.contains("landuse") || way.tags.contains("area:highway");
    const size_t corners = distinct_corners(line), least = (area && closed) || must_be_area ? 3 : 2;
    if (corners < least) {
      notes_.add(Kind::left_out, "way_of_too_few_nodes", id,
                 fmt::format("The way has {} different nodes, and {} needs {}; the file may be clipped.",
                             corners, least == 3 ? "an area" : "a line", least));
      return;
    }
    if (area && closed) {
      drop_repeated(line);
      add(id, way.tags).polygons.push_back({std::move(line), {}});
    } else if (must_be_area && area) {
      if (auto ring = close_open(id, std::move(line))) add(id, way.tags).polygons.push_back({*ring, {}});
    } else {
      add(id, way.tags).lines.push_back(std::move(line));
    }
  }

  /// Closes an open chain with a straight line, or gives it up if that would be most of the ring.
  std::optional<Ring> close_open(const std::string& id, std::vector<dvec2> chain) {
    if (distinct_corners(chain) < 3) {
      notes_.add(Kind::left_out, "ring_of_too_few_nodes", id,
                 fmt::format("An open ring has {} different nodes.", distinct_corners(chain)));
      return std::nullopt;
    }
    const double length = length_m(chain), gap = length_m(std::array{chain.front(), chain.back()});
    if (gap > most_gap * length) {
      notes_.add(
          Kind::left_out, "ring_not_closed", id,
          fmt::format("A ring is open: its ends are {:.1f} m apart, it is {:.1f} m long.", gap, length));
      return std::nullopt;
    }
    notes_.add(
        Kind::repaired, "ring_not_closed", id,
        fmt::format("A ring of {:.1f} m is open; a straight line of {:.1f} m closes it.", length, gap));
    drop_repeated(chain);
    return chain;
  }

  std::vector<Ring> rings_of(const std::string& id, const std::vector<NodeIds>& ways) {
    const JoinedRings joined = join_ways(ways);
    std::vector<Ring> rings;
    for (const NodeIds& nodes : joined.closed) {
      size_t missing = 0;
      Ring ring = places(nodes, missing);
      if (missing > 0)
        notes_.add(Kind::doubtful, "nodes_missing", id,
                   fmt::format("{} of {} nodes of a ring are not in the file.", missing, nodes.size()));
      drop_repeated(ring);
      if (distinct_corners(ring) >= 3)
        rings.push_back(std::move(ring));
      else
        notes_.add(Kind::left_out, "ring_of_too_few_nodes", id,
                   fmt::format("A ring has {} different nodes.", distinct_corners(ring)));
    }
    for (const NodeIds& nodes : joined.open) {
      size_t missing = 0;
      if (auto ring = close_open(id, places(nodes, missing))) rings.push_back(std::move(*ring));
    }
    return rings;
  }

  void make_multipolygon(const OsmRelation& relation) {
    const std::string id = fmt::format("relation/{}", relation.id);
    Tags tags = multipolygon_tags(relation);
    if (!says_anything(tags)) return;
    std::vector<NodeIds> outer, inner;
    size_t missing = 0;
    for (const OsmMember& member : relation.members) {
      if (member.kind != OsmMember::Kind::way) continue;
      const auto found = way_at_.find(member.id);
      if (found == way_at_.end())
        ++missing;
      else
        (member.role == "inner" ? inner : outer).push_back(data_.ways[found->second].nodes);
    }
    if (outer.empty() && inner.empty()) {
      notes_.add(Kind::left_out, "relation_without_members", id,
                 fmt::format("None of its {} members is in the file.", relation.members.size()));
      return;
    }
    if (missing > 0)
      notes_.add(Kind::doubtful, "members_missing", id,
                 fmt::format("{} of {} members are not in the file.", missing, relation.members.size()));
    std::vector<Ring> outer_rings = rings_of(id, outer), inner_rings = rings_of(id, inner);
    if (outer_rings.empty()) {
      notes_.add(Kind::left_out, "relation_without_outline", id, "No outer ring could be made of its ways.");
      return;
    }
    std::vector<size_t> lost;
    std::vector<Polygon> polygons = nest_rings(std::move(outer_rings), std::move(inner_rings), lost);
    if (!lost.empty())
      notes_.add(Kind::left_out, "hole_outside", id,
                 fmt::format("{} inner rings lie in no outer ring.", lost.size()));
    add(id, std::move(tags)).polygons = std::move(polygons);
  }

  /// A relation of the type building names the outline and the parts.
  void join_parts(const OsmRelation& relation) {
    const auto id_of = [](const OsmMember& member) {
      return fmt::format("{}/{}", member.kind == OsmMember::Kind::way ? "way" : "relation", member.id);
    };
    const auto outline = std::ranges::find(relation.members, "outline", &OsmMember::role);
    if (outline == relation.members.end()) return;
    std::unordered_map<std::string, Feature*> by_id;
    for (Feature& feature : contents_.features) by_id.emplace(feature.id, &feature);
    if (!by_id.contains(id_of(*outline))) return;
    for (const OsmMember& member : relation.members)
      if (member.role == "part")
        if (const auto found = by_id.find(id_of(member)); found != by_id.end())
          found->second->part_of = id_of(*outline);
  }

  const OsmData& data_;
  MapContents& contents_;
  Notes& notes_;
  std::unordered_map<int64_t, size_t> way_at_;
  std::set<int64_t> claimed_;
};

}  // namespace

bool is_area(const Tags& tags) {
  if (const auto area = tags.find("area"); area != tags.end()) {
    if (means_yes(area->second)) return true;
    if (area->second == "no") return tags.contains("building") && tags.at("building") != "no";
  }
  for (const auto& [key, value] : tags) {
    if (const auto found = area_keys.find(key); found != area_keys.end() && value != "no")
      if (!found->second.contains(value)) return true;
    if (const auto found = line_keys.find(key); found != line_keys.end())
      if (found->second.contains(value)) return true;
  }
  return false;
}

bool says_anything(const Tags& tags) {
  return std::ranges::any_of(tags, [](const auto& tag) {
    return !silent_keys.contains(tag.first) && !tag.first.starts_with("source:");
  });
}

void make_osm_features(const OsmData& data, MapContents& contents, Notes& notes) {
  FeatureMaker(data, contents, notes).make();
}

}  // namespace greatx::scene::place
