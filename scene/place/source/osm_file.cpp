// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <osmium/io/bzip2_compression.hpp>
#include <osmium/io/gzip_compression.hpp>
#include <osmium/io/pbf_input.hpp>
#include <osmium/io/reader.hpp>
#include <osmium/io/xml_input.hpp>
#include <osmium/osm.hpp>
#include <set>
#include <unordered_set>

#include "core/error.h"
#include "core/text.h"
#include "scene/place/source/osm_data.h"

namespace greatx::scene::place {

namespace {

Tags tags_of(const osmium::TagList& list, const std::string& where, int64_t id) {
  Tags tags;
  for (const osmium::Tag& tag : list) {
    for (const char* text : {tag.key(), tag.value()})
      if (find_bad_utf8(text))
        throw_user_error("{}: object {}: expected UTF-8, found the tag '{}={}'", where, id,
                         printable(tag.key()), printable(tag.value()));
    tags[tag.key()] = tag.value();
  }
  return tags;
}

/// Returns libosmium's name of the format, by the name's ending.
std::string format_of(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  if (name.ends_with(".pbf")) return "pbf";
  const std::string packing = name.ends_with(".gz") ? ".gz" : name.ends_with(".bz2") ? ".bz2" : "";
  return "osm" + packing;
}

OsmMember member_of(const osmium::RelationMember& member) {
  const auto kind = member.type() == osmium::item_type::node  ? OsmMember::Kind::node
                    : member.type() == osmium::item_type::way ? OsmMember::Kind::way
                                                              : OsmMember::Kind::relation;
  return {kind, member.ref(), member.role()};
}

class OsmReader {
 public:
  explicit OsmReader(const std::filesystem::path& file)
      : where_(file.string()), file_(file.string(), format_of(file)) {}

  OsmData read() {
    // Relations come last in a file, but they say which ways without tags are needed.
    each(osmium::osm_entity_bits::relation,
         [&](const osmium::OSMObject& object) { relation(static_cast<const osmium::Relation&>(object)); });
    each(osmium::osm_entity_bits::node | osmium::osm_entity_bits::way, [&](const osmium::OSMObject& object) {
      if (object.type() == osmium::item_type::node)
        node(static_cast<const osmium::Node&>(object));
      else if (object.type() == osmium::item_type::way)
        way(static_cast<const osmium::Way&>(object));
    });
    const auto by_id = [](const auto& node) { return node.first; };
    if (!std::ranges::is_sorted(data_.nodes, {}, by_id)) std::ranges::stable_sort(data_.nodes, {}, by_id);
    return std::move(data_);
  }

 private:
  template <typename Visit>
  void each(osmium::osm_entity_bits::type kinds, const Visit& visit) {
    try {
      osmium::io::Reader reader(file_, kinds, osmium::io::read_meta::no);
      while (const osmium::memory::Buffer buffer = reader.read())
        for (const osmium::OSMObject& object : buffer.select<osmium::OSMObject>())
          if (object.visible()) visit(object);
      reader.close();
    } catch (const UserError&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      throw_user_error("{}: expected a file of OpenStreetMap (XML or PBF): {}", where_,
                       printable(error.what()));
    }
  }

  void node(const osmium::Node& node) {
    const osmium::Location& at = node.location();
    if (at.is_undefined()) throw_user_error("{}: node {}: expected lat and lon", where_, node.id());
    if (!at.valid())
      throw_user_error(
          "{}: node {}: expected a latitude up to 90 and a longitude up to 180 degrees, found {} and {}{}",
          where_, node.id(), at.y() / 1e7, at.x() / 1e7,
          std::abs(at.y()) > 900'000'000 && std::abs(at.x()) <= 900'000'000
              ? ": latitude and longitude seem to be swapped"
              : "");
    add_node(node.id(), at);
    if (node.tags().empty()) return;
    if (Tags tags = tags_of(node.tags(), where_, node.id()); says_anything(tags))
      data_.tagged_nodes.emplace_back(node.id(), std::move(tags));
  }

  void add_node(int64_t id, const osmium::Location& at) {
    nodes_.plan(where_, 1);
    data_.nodes.emplace_back(id, dvec2(at.lon(), at.lat()));
  }

  void way(const osmium::Way& way) {
    Tags tags = tags_of(way.tags(), where_, way.id());
    if (!says_anything(tags) && !members_.contains(way.id())) return;
    corners_.plan(where_, way.nodes().size());
    OsmWay kept{way.id(), {}, std::move(tags)};
    for (const osmium::NodeRef& node : way.nodes()) {
      kept.nodes.push_back(node.ref());
      // Overpass' "out geom" and osmium's "locations on ways" give places here, and perhaps no nodes.
      if (node.location().valid()) add_node(node.ref(), node.location());
    }
    data_.ways.push_back(std::move(kept));
  }

  void relation(const osmium::Relation& relation) {
    Tags tags = tags_of(relation.tags(), where_, relation.id());
    const auto type = tags.find("type");
    if (type == tags.end() || (type->second != "multipolygon" && type->second != "building")) return;
    OsmRelation kept{relation.id(), std::move(tags), {}};
    corners_.plan(where_, relation.members().size());
    for (const osmium::RelationMember& member : relation.members()) {
      kept.members.push_back(member_of(member));
      if (kept.members.back().kind == OsmMember::Kind::way) members_.insert(member.ref());
    }
    data_.relations.push_back(std::move(kept));
  }

  std::string where_;
  osmium::io::File file_;
  OsmData data_;
  std::unordered_set<int64_t> members_;
  Spending nodes_{map_nodes}, corners_{map_corners};
};

/// Returns an attribute of the root element of an XML file, such as license; empty for other files.
std::string root_attribute(const std::string& head, const std::string& name) {
  const auto root = head.find("<osm");
  if (root == std::string::npos) return {};
  const std::string element = head.substr(root, head.find('>', root) - root);
  for (const char quote : {'"', '\''}) {
    const std::string begin = " " + name + "=" + quote;
    const auto at = element.find(begin);
    if (at == std::string::npos) continue;
    const auto end = element.find(quote, at + begin.size());
    if (end != std::string::npos) return element.substr(at + begin.size(), end - at - begin.size());
  }
  return {};
}

std::string licence_of(const std::filesystem::path& file) {
  std::string head(2000, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(stream.gcount()));
  std::string licence;
  for (const char* name : {"copyright", "license"})
    if (const std::string text = root_attribute(head, name); !text.empty())
      licence += (licence.empty() ? "" : ", ") + printable(text);
  return licence;
}

}  // namespace

const dvec2* OsmData::node(int64_t id) const {
  const auto found = std::ranges::lower_bound(nodes, id, {}, [](const auto& node) { return node.first; });
  return found != nodes.end() && found->first == id ? &found->second : nullptr;
}

OsmData read_osm_data(const std::filesystem::path& file) { return OsmReader(file).read(); }

MapContents read_osm_file(const MapSource& source) {
  if (!source.crs.empty() && source.crs != "EPSG:4326")
    throw_user_error("{}: crs: expected none, because files of OpenStreetMap are in EPSG:4326, found '{}'",
                     source.file.string(), printable(source.crs));
  require_within(source.file.string(), std::filesystem::file_size(source.file), map_file);
  MapContents contents;
  Notes notes(source.name, contents.findings);
  make_osm_features(read_osm_data(source.file), contents, notes);
  contents.licence = licence_of(source.file);
  if (contents.licence.empty())
    contents.licence = "the file states none; data of OpenStreetMap are under ODbL 1.0";
  return contents;
}

}  // namespace greatx::scene::place
