// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/city_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <ogr_geometry.h>
#include <unordered_map>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "io/files/untrusted_json.h"
#include "scene/place/input/osm_values.h"
#include "scene/place/source/city_classes.h"
#include "scene/place/source/crs.h"
#include "scene/place/source/rings.h"

namespace greatx::scene::place {

namespace {

using Json = nlohmann::ordered_json;
using Kind = Finding::Kind;

/// How far the attribute measuredHeight may be from the solid's own height and still be a height above
/// ground.
constexpr double height_agreement_m = 0.1;
/// Surfaces whose normal is nearer to level than this are upright, and have no area in plan.
constexpr double least_plan_area = 1e-6;

/// The surfaces of one geometry, in the file's coordinates.
struct Surfaces {
  std::vector<SolidFace> faces;
  bool solid = false;
};

class CityJsonReader {
 public:
  CityJsonReader(const MapSource& source, MapContents& contents)
      : source_(source),
        contents_(contents),
        notes_(source.name, contents.findings),
        where_(source.file.string()),
        height_unit_m_(source.height_unit_m) {}

  void read() {
    const io::JsonDocument document(InputFile(source_.file, where_, map_file).text(), {where_, 0},
                                    {map_file.most, uint64_t{100'000'000}, 64});
    const Json& root = document.root().json();
    read_head(root);
    read_vertices(root);
    const Json& objects = member(root, "CityObjects", "");
    if (!objects.is_object()) fail("CityObjects", "an object");
    for (const auto& [id, object] : objects.items()) read_object(id, object);
    join_parents();
    if (const std::string use = projection_->outside_use(contents_.extent); !use.empty())
      notes_.add(Kind::doubtful, "crs_outside_its_area", "", use);
    if (contents_.features.empty() && !objects.empty())
      throw_user_error(
          "{}: none of its {} city objects has a geometry that is used (level of detail below 3)", where_,
          objects.size());
  }

 private:
  [[noreturn]] void fail(const std::string& path, const std::string& expected) const {
    throw_user_error("{}: {}: expected {}", where_, printable(path), expected);
  }
  const Json& member(const Json& json, const char* key, const std::string& path) const {
    const auto found = json.is_object() ? json.find(key) : json.end();
    if (!json.is_object() || found == json.end())
      fail(path.empty() ? key : path + "." + key, "a value, found nothing");
    return *found;
  }
  static const Json* find(const Json& json, const char* key) {
    if (!json.is_object()) return nullptr;
    const auto found = json.find(key);
    return found != json.end() ? &*found : nullptr;
  }
  double number(const Json& json, const std::string& path) const {
    if (!json.is_number() || !std::isfinite(json.get<double>())) fail(path, "a number");
    return json.get<double>();
  }
  dvec3 vector(const Json& json, const std::string& path) const {
    if (!json.is_array() || json.size() != 3) fail(path, "three numbers");
    return {number(json[0], path), number(json[1], path), number(json[2], path)};
  }

  void read_head(const Json& root) {
    const Json& version = member(root, "version", "");
    const std::string text = version.is_string() ? version.get<std::string>() : "";
    if (!text.starts_with("1.0") && !text.starts_with("1.1") && !text.starts_with("2.0"))
      throw_user_error("{}: version: expected CityJSON 1.0, 1.1 or 2.0, found {}", where_,
                       printable(version.dump()));
    OGRSpatialReference of_file;
    bool stated = false;
    if (const Json* metadata = find(root, "metadata")) {
      const Json* reference = find(*metadata, "referenceSystem");
      if (reference != nullptr && reference->is_string() && source_.crs.empty()) {
        prepare_gdal();
        const GdalMessages messages;
        const std::string crs = crs_of_reference(reference->get<std::string>());
        if (of_file.SetFromUserInput(crs.c_str()) != OGRERR_NONE)
          throw_user_error("{}: metadata.referenceSystem: expected a known coordinate system, found '{}'{}",
                           where_, printable(crs), messages.suffix());
        stated = true;
        if (of_file.IsCompound()) height_unit_m_ = of_file.GetTargetLinearUnits("COMPD_CS|VERT_CS");
      }
      for (const char* key : {"license", "licence"})
        if (const Json* licence = find(*metadata, key); licence != nullptr && licence->is_string())
          contents_.licence = printable(licence->get<std::string>());
    }
    projection_ = std::make_unique<Projection>(where_, source_.crs, stated ? &of_file : nullptr);
    if (const std::string grid = projection_->missing_grid(); !grid.empty())
      notes_.add(Kind::doubtful, "datum_grid_missing", "", grid);
  }

  void read_vertices(const Json& root) {
    dvec3 scale(1.0), translate(0.0);
    if (const Json* transform = find(root, "transform")) {
      scale = vector(member(*transform, "scale", "transform"), "transform.scale");
      translate = vector(member(*transform, "translate", "transform"), "transform.translate");
    }
    const Json& vertices = member(root, "vertices", "");
    if (!vertices.is_array()) fail("vertices", "a list");
    require_within(where_, vertices.size(), map_corners);
    for (size_t i = 0; i < vertices.size(); ++i)
      vertices_.push_back(vector(vertices[i], fmt::format("vertices[{}]", i)) * scale + translate);
    for (const dvec3& vertex : vertices_) degrees_.emplace_back(vertex);
    // Vertices that no object uses may lie anywhere, so that each is converted when it is used.
    converted_.assign(vertices_.size(), false);
  }

  dvec3 place(size_t vertex) {
    if (!converted_[vertex]) {
      degrees_[vertex] = projection_->to_degrees(degrees_[vertex]);
      converted_[vertex] = true;
      contents_.extent.add(degrees_[vertex]);
    }
    return {degrees_[vertex], vertices_[vertex].z * height_unit_m_};
  }

  Attributes attributes_of(const Json& object) const {
    Attributes attributes;
    const Json* given = find(object, "attributes");
    if (given == nullptr || !given->is_object()) return attributes;
    for (const auto& [name, value] : given->items()) {
      if (value.is_string())
        attributes[name] = value.get<std::string>();
      else if (value.is_number_integer())
        attributes[name] = fmt::format("{}", value.get<int64_t>());
      else if (value.is_number())
        attributes[name] = number_text(value.get<double>());
      else if (value.is_boolean())
        attributes[name] = value.get<bool>() ? "yes" : "no";
    }
    return attributes;
  }

  /// Returns the number of a level of detail: "2.2" and 2 alike.
  static double lod_of(const Json& geometry) {
    const Json* lod = find(geometry, "lod");
    if (lod == nullptr) return -1.0;
    if (lod->is_number()) return lod->get<double>();
    return lod->is_string() ? parse_number(lod->get<std::string>()).value_or(-1.0) : -1.0;
  }

  /// Returns the geometry of the highest level of detail below 3.
  const Json* best_geometry(const std::string& id, const Json& object) {
    const Json* geometries = find(object, "geometry");
    if (geometries == nullptr || !geometries->is_array() || geometries->empty()) return nullptr;
    const Json* best = nullptr;
    for (const Json& geometry : *geometries) {
      const double lod = lod_of(geometry);
      if (lod < 0.0 || lod >= 3.0) continue;
      if (best == nullptr || lod > lod_of(*best)) best = &geometry;
    }
    if (best == nullptr)
      notes_.add(Kind::left_out, "level_of_detail", id,
                 "It has no geometry of a level of detail from 0 to 2.");
    return best;
  }

  std::vector<size_t> ring_of(const Json& json, const std::string& path) const {
    if (!json.is_array()) fail(path, "a list of indices");
    std::vector<size_t> ring;
    for (const Json& index : json) {
      if (!index.is_number_unsigned() || index.get<uint64_t>() >= vertices_.size())
        fail(path, fmt::format("indices below {}, found {}", vertices_.size(), printable(index.dump())));
      ring.push_back(index.get<size_t>());
    }
    return ring;
  }

  static SolidFace::Kind kind_of(const Json& semantics, const Json& value) {
    const Json* surfaces = find(semantics, "surfaces");
    if (surfaces == nullptr || !surfaces->is_array() || !value.is_number_unsigned() ||
        value.get<size_t>() >= surfaces->size())
      return SolidFace::Kind::unknown;
    const Json* type = find((*surfaces)[value.get<size_t>()], "type");
    const std::string name = type != nullptr && type->is_string() ? type->get<std::string>() : "";
    if (name == "RoofSurface" || name == "OuterCeilingSurface") return SolidFace::Kind::roof;
    if (name == "GroundSurface" || name == "OuterFloorSurface") return SolidFace::Kind::ground;
    if (name == "WallSurface" || name == "Window" || name == "Door") return SolidFace::Kind::wall;
    return SolidFace::Kind::unknown;
  }

  /// Walks the nested lists of boundaries down to surfaces, with the semantic values beside them. `depth` is
  /// the number of lists above a surface.
  void add_surfaces(const Json& boundaries, const Json* values, const Json* semantics, int depth,
                    const std::string& path, Surfaces& result) {
    if (!boundaries.is_array()) fail(path, "a list");
    for (size_t i = 0; i < boundaries.size(); ++i) {
      const std::string at = fmt::format("{}[{}]", path, i);
      const Json* value =
          values != nullptr && values->is_array() && i < values->size() ? &(*values)[i] : nullptr;
      if (depth > 1) {
        add_surfaces(boundaries[i], value, semantics, depth - 1, at, result);
        continue;
      }
      if (!boundaries[i].is_array()) fail(at, "a list of rings");
      SolidFace face;
      if (value != nullptr && semantics != nullptr) face.kind = kind_of(*semantics, *value);
      corners_.plan(where_, boundaries[i].size());
      for (const Json& ring : boundaries[i]) {
        std::vector<dvec3> points;
        std::vector<size_t> distinct = ring_of(ring, at);
        for (const size_t vertex : distinct) points.push_back(place(vertex));
        std::ranges::sort(distinct);
        const auto corners = std::unique(distinct.begin(), distinct.end()) - distinct.begin();
        if (corners >= 3) {
          face.rings.push_back(std::move(points));
        } else {
          ++thin_rings_;
          if (face.rings.empty()) break;  // a face without an outer ring is none
        }
      }
      if (!face.rings.empty()) result.faces.push_back(std::move(face));
    }
  }

  Surfaces surfaces_of(const std::string& id, const Json& geometry) {
    const std::string path = fmt::format("CityObjects.{}.geometry", id);
    const Json& type = member(geometry, "type", path);
    const std::string name = type.is_string() ? type.get<std::string>() : "";
    Surfaces surfaces;
    int depth = 0;
    if (name == "MultiSurface" || name == "CompositeSurface") depth = 1;
    if (name == "Solid") depth = 2;
    if (name == "MultiSolid" || name == "CompositeSolid") depth = 3;
    if (depth == 0) {
      notes_.add(Kind::left_out, "geometry_of_unknown_kind", id, fmt::format("It is a {}.", printable(name)));
      return surfaces;
    }
    surfaces.solid = depth >= 2;
    const Json* semantics = find(geometry, "semantics");
    const Json* values = semantics != nullptr ? find(*semantics, "values") : nullptr;
    thin_rings_ = 0;
    add_surfaces(member(geometry, "boundaries", path), values, semantics, depth, path + ".boundaries",
                 surfaces);
    if (thin_rings_ > 0)
      notes_.add(Kind::left_out, "ring_of_too_few_corners", id,
                 fmt::format("{} rings of its surfaces have fewer than three corners.", thin_rings_));
    return surfaces;
  }

  void read_object(const std::string& id, const Json& object) {
    if (!source_.layer.empty()) {
      const Json* type = find(object, "type");
      if (type == nullptr || !type->is_string() || type->get<std::string>() != source_.layer) return;
    }
    const Json& type = member(object, "type", "CityObjects." + id);
    const std::string name = type.is_string() ? type.get<std::string>() : "";
    const Attributes attributes = attributes_of(object);
    const CityClass city = city_class(name, attributes);
    if (city.shape == CityClass::Shape::none) {
      if (name != "CityObjectGroup")
        notes_.add(Kind::left_out, "city_object_of_other_kind", id,
                   fmt::format("Objects of the type {} are not built.", printable(name)));
      return;
    }
    Feature feature;
    feature.id = id;
    if (const Json* parents = find(object, "parents");
        parents != nullptr && parents->is_array() && !parents->empty() && parents->front().is_string())
      feature.part_of = parents->front().get<std::string>();
    feature.tags = city.tags;
    add_attributes(attributes, feature);
    if (city.shape == CityClass::Shape::point && make_tree_at_point(object, feature)) {
      contents_.features.push_back(std::move(feature));
      return;
    }
    const Json* geometry = best_geometry(id, object);
    if (geometry == nullptr) return;
    Surfaces surfaces = surfaces_of(id, *geometry);
    if (surfaces.faces.empty()) return;
    const bool flat = lod_of(*geometry) < 1.0 && !surfaces.solid;
    if (city.shape == CityClass::Shape::solid && !flat) {
      check_height(id, attributes, surfaces, feature);
      feature.faces = std::move(surfaces.faces);
    } else if (city.shape == CityClass::Shape::point) {
      make_tree(surfaces, feature);
    } else {
      if (city.shape == CityClass::Shape::solid && attributes.contains("measuredHeight") &&
          !feature.tags.contains("height"))
        notes_.add(
            Kind::left_out, "measured_height_not_used", id,
            "It has a footprint alone, and files differ in whether measuredHeight is above the ground or the "
            "datum: say so by keys: {height: measuredHeight} and heights.");
      feature.polygons = plan_of(surfaces);
      if (feature.polygons.empty()) {
        notes_.add(Kind::left_out, "without_area", id, "All of its surfaces are upright.");
        return;
      }
    }
    contents_.features.push_back(std::move(feature));
  }

  void add_attributes(const Attributes& attributes, Feature& feature) const {
    MapSource plain = source_;
    plain.vocabulary = "cityjson";
    for (auto& [key, value] : Vocabulary(plain).translate(attributes).tags)
      if (key != "building" || !feature.tags.contains("building:part")) feature.tags[key] = value;
    lengths_to_metres(feature.tags, source_.height_unit_m);
  }

  static dvec2 heights_of(const Surfaces& surfaces) {
    dvec2 range(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
    for (const SolidFace& face : surfaces.faces)
      for (const auto& ring : face.rings)
        for (const dvec3& point : ring) range = {std::min(range.x, point.z), std::max(range.y, point.z)};
    return range;
  }

  /// measuredHeight is the height of the roof above the lowest ground (CityGML 2.0, 10.3.1). Some files have
  /// the roof's z there, so that it counts only where the solid agrees.
  void check_height(const std::string& id, const Attributes& attributes, const Surfaces& surfaces,
                    Feature& feature) {
    const dvec2 range = heights_of(surfaces);
    if (!feature.tags.contains("height")) feature.tags["height"] = number_text(range.y - range.x);
    const auto given = attributes.find("measuredHeight");
    if (given == attributes.end()) return;
    const auto measured = parse_length_m(given->second, source_.height_unit_m);
    if (measured && std::abs(*measured - (range.y - range.x)) > height_agreement_m)
      notes_.add(Kind::doubtful, "measured_height_disagrees", id,
                 fmt::format(
                     "measuredHeight is {} m, its solid is {:.2f} m high, from {:.2f} to {:.2f} m{}; the "
                     "solid counts.",
                     *measured, range.y - range.x, range.x, range.y,
                     std::abs(*measured - range.y) < height_agreement_m ? ": it seems to be the z of the roof"
                                                                        : ""));
  }

  /// A tree may be a point, or a template at a place (CityJSON 2.0, section 3.4).
  bool make_tree_at_point(const Json& object, Feature& feature) {
    const Json* geometries = find(object, "geometry");
    if (geometries == nullptr || !geometries->is_array()) return false;
    for (const Json& geometry : *geometries) {
      const Json* type = find(geometry, "type");
      const std::string name = type != nullptr && type->is_string() ? type->get<std::string>() : "";
      if (name != "GeometryInstance" && name != "MultiPoint") continue;
      const std::string path = fmt::format("CityObjects.{}.geometry", feature.id);
      const std::vector<size_t> points = ring_of(member(geometry, "boundaries", path), path + ".boundaries");
      if (points.empty()) continue;
      feature.point = dvec2(place(points.front()));
      return true;
    }
    return false;
  }

  void make_tree(const Surfaces& surfaces, Feature& feature) const {
    Box box;
    for (const SolidFace& face : surfaces.faces)
      for (const dvec3& point : face.rings[0]) box.add(dvec2(point));
    feature.point = (box.low + box.high) / 2.0;
    const dvec2 range = heights_of(surfaces);
    if (!feature.tags.contains("height") && range.y > range.x)
      feature.tags["height"] = number_text(range.y - range.x);
  }

  /// Returns the union of the surfaces in plan. Corners stay those of the file, so that neighbours, whose
  /// corners are the same vertices, have no gaps. Upright surfaces have no area.
  std::vector<Polygon> plan_of(const Surfaces& surfaces) const {
    OGRMultiPolygon all;
    for (const SolidFace& face : surfaces.faces) {
      OGRPolygon polygon;
      for (const auto& points : face.rings) {
        OGRLinearRing ring;
        for (const dvec3& point : points) ring.addPoint(point.x, point.y);
        ring.closeRings();
        polygon.addRing(&ring);
      }
      if (polygon.get_Area() * metres_per_degree_2 > least_plan_area) all.addGeometry(&polygon);
    }
    const GdalMessages messages;
    const std::unique_ptr<OGRGeometry> joined(all.IsEmpty() ? nullptr : all.UnionCascaded());
    std::vector<Polygon> polygons;
    const OGRGeometry* geometry = joined ? joined.get() : &all;
    const auto add = [&](const OGRPolygon& polygon) {
      Polygon read;
      for (int i = -1; i < polygon.getNumInteriorRings(); ++i) {
        const OGRLinearRing* curve = i < 0 ? polygon.getExteriorRing() : polygon.getInteriorRing(i);
        if (curve == nullptr) continue;
        Ring ring;
        for (int k = 0; k < curve->getNumPoints(); ++k) ring.emplace_back(curve->getX(k), curve->getY(k));
        drop_repeated(ring);
        if (distinct_corners(ring) < 3) continue;
        if (i < 0)
          read.outer = std::move(ring);
        else
          read.holes.push_back(std::move(ring));
      }
      if (!read.outer.empty()) polygons.push_back(std::move(read));
    };
    if (wkbFlatten(geometry->getGeometryType()) == wkbPolygon) add(*geometry->toPolygon());
    if (wkbFlatten(geometry->getGeometryType()) == wkbMultiPolygon ||
        wkbFlatten(geometry->getGeometryType()) == wkbGeometryCollection)
      for (const auto* part : *geometry->toGeometryCollection())
        if (wkbFlatten(part->getGeometryType()) == wkbPolygon) add(*part->toPolygon());
    return polygons;
  }

  /// A part whose parent has no geometry is a building of its own: it has no outline to belong to.
  void join_parents() {
    std::unordered_map<std::string, size_t> by_id;
    for (size_t i = 0; i < contents_.features.size(); ++i) by_id.emplace(contents_.features[i].id, i);
    for (Feature& feature : contents_.features) {
      if (feature.part_of.empty() || by_id.contains(feature.part_of)) continue;
      feature.part_of.clear();
      if (const auto part = feature.tags.find("building:part");
          part != feature.tags.end() && part->second == "yes") {
        feature.tags.erase(part);
        feature.tags["building"] = "yes";
      }
    }
  }

  /// One degree of a meridian, squared; of a parallel it is less, so that the threshold is one from above.
  static constexpr double metres_per_degree_2 = 111'000.0 * 111'000.0;

  const MapSource& source_;
  MapContents& contents_;
  Notes notes_;
  std::string where_;
  double height_unit_m_;  ///< of z; a compound CRS states it
  std::unique_ptr<Projection> projection_;
  std::vector<dvec3> vertices_;
  std::vector<dvec2> degrees_;
  std::vector<bool> converted_;
  Spending corners_{map_corners};
  size_t thin_rings_ = 0;
};

}  // namespace

bool is_city_json(std::string_view text) {
  for (size_t at = text.find("\"CityJSON\""); at != std::string_view::npos;
       at = text.find("\"CityJSON\"", at + 1)) {
    size_t before = at;
    const auto skip = [&] {
      while (before > 0 && (text[before - 1] == ' ' || text[before - 1] == '\n' || text[before - 1] == '\r' ||
                            text[before - 1] == '\t'))
        --before;
    };
    skip();
    if (before == 0 || text[before - 1] != ':') continue;
    --before;
    skip();
    if (text.substr(0, before).ends_with("\"type\"")) return true;
  }
  return false;
}

std::string crs_of_reference(const std::string& reference) {
  const auto number = [&](std::string_view mark) -> std::string {
    const auto at = reference.rfind(mark);
    if (at == std::string::npos) return {};
    const std::string code = reference.substr(at + mark.size());
    return !code.empty() && std::ranges::all_of(code, [](char c) { return c >= '0' && c <= '9'; })
               ? "EPSG:" + code
               : std::string();
  };
  if (reference.find("/EPSG/") != std::string::npos)
    if (const std::string crs = number("/"); !crs.empty()) return crs;
  if (reference.starts_with("urn:ogc:def:crs:EPSG:"))
    if (const std::string crs = number(":"); !crs.empty()) return crs;
  return reference;
}

MapContents read_city_json(const MapSource& source) {
  MapContents contents;
  CityJsonReader(source, contents).read();
  return contents;
}

}  // namespace greatx::scene::place
