// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/city_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "io/files/untrusted_json.h"
#include "scene/place/input/osm_values.h"
#include "scene/place/source/city_classes.h"
#include "scene/place/source/city_geometry.h"
#include "scene/place/source/crs.h"

namespace greatx::scene::place {

namespace {

using Json = nlohmann::ordered_json;
using Kind = Finding::Kind;

/// How far the attribute measuredHeight may be from the solid's own height and still be a height above
/// ground.
constexpr double height_agreement_m = 0.1;
class CityJsonReader {
 public:
  CityJsonReader(const MapSource& source, MapContents& contents)
      : source_(source),
        contents_(contents),
        notes_(source.name, contents.findings),
        where_(source.file.string()),
        text_(where_),
        height_unit_m_(source.height_unit_m) {}

  void read() {
    const io::JsonDocument document(InputFile(source_.file, where_, map_file).text(), {where_, 0},
                                    {map_file.most, uint64_t{100'000'000}, 64});
    const Json& root = document.root().json();
    read_head(root);
    geometry_ = std::make_unique<CityGeometry>(text_, root, *projection_, height_unit_m_);
    const Json& objects = text_.member(root, "CityObjects", "");
    if (!objects.is_object()) text_.fail("CityObjects", "an object");
    for (const auto& [id, object] : objects.items()) read_object(id, object);
    join_parents();
    contents_.extent = geometry_->extent();
    if (const std::string use = projection_->outside_use(geometry_->extent()); !use.empty())
      notes_.add(Kind::doubtful, "crs_outside_its_area", "", use);
    if (contents_.features.empty() && !objects.empty())
      throw_user_error(
          "{}: none of its {} city objects has a geometry that is used (level of detail below 3)", where_,
          objects.size());
  }

 private:
  void read_head(const Json& root) {
    const Json& version = text_.member(root, "version", "");
    const std::string text = version.is_string() ? version.get<std::string>() : "";
    if (!text.starts_with("1.0") && !text.starts_with("1.1") && !text.starts_with("2.0"))
      throw_user_error("{}: version: expected CityJSON 1.0, 1.1 or 2.0, found {}", where_,
                       printable(version.dump()));
    OGRSpatialReference of_file;
    bool stated = false;
    if (const Json* metadata = CityJsonText::find(root, "metadata")) {
      const Json* reference = CityJsonText::find(*metadata, "referenceSystem");
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
        if (const Json* licence = CityJsonText::find(*metadata, key);
            licence != nullptr && licence->is_string())
          contents_.licence = printable(licence->get<std::string>());
    }
    projection_ = std::make_unique<Projection>(where_, source_.crs, stated ? &of_file : nullptr);
    if (const std::string grid = projection_->missing_grid(); !grid.empty())
      notes_.add(Kind::doubtful, "datum_grid_missing", "", grid);
  }

  Attributes attributes_of(const Json& object) const {
    Attributes attributes;
    const Json* given = CityJsonText::find(object, "attributes");
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

  /// Returns the geometry of the highest level of detail below 3.
  const Json* best_geometry(const std::string& id, const Json& object) {
    const Json* geometries = CityJsonText::find(object, "geometry");
    if (geometries == nullptr || !geometries->is_array() || geometries->empty()) return nullptr;
    const Json* best = nullptr;
    for (const Json& geometry : *geometries) {
      const double lod = CityGeometry::lod_of(geometry);
      if (lod < 0.0 || lod >= 3.0) continue;
      if (best == nullptr || lod > CityGeometry::lod_of(*best)) best = &geometry;
    }
    if (best == nullptr)
      notes_.add(Kind::left_out, "level_of_detail", id,
                 "It has no geometry of a level of detail from 0 to 2.");
    return best;
  }

  void read_object(const std::string& id, const Json& object) {
    if (!source_.layer.empty()) {
      const Json* type = CityJsonText::find(object, "type");
      if (type == nullptr || !type->is_string() || type->get<std::string>() != source_.layer) return;
    }
    const Json& type = text_.member(object, "type", "CityObjects." + id);
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
    if (const Json* parents = CityJsonText::find(object, "parents");
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
    CitySurfaces surfaces = geometry_->surfaces_of(id, *geometry, notes_);
    if (surfaces.faces.empty()) return;
    const bool flat = CityGeometry::lod_of(*geometry) < 1.0 && !surfaces.solid;
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
      feature.polygons = surfaces.plan();
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

  /// measuredHeight is the height of the roof above the lowest ground (CityGML 2.0, 10.3.1). Some files have
  /// the roof's z there, so that it counts only where the solid agrees.
  void check_height(const std::string& id, const Attributes& attributes, const CitySurfaces& surfaces,
                    Feature& feature) {
    const dvec2 range = surfaces.heights();
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
    const Json* geometries = CityJsonText::find(object, "geometry");
    if (geometries == nullptr || !geometries->is_array()) return false;
    for (const Json& geometry : *geometries) {
      const Json* type = CityJsonText::find(geometry, "type");
      const std::string name = type != nullptr && type->is_string() ? type->get<std::string>() : "";
      if (name != "GeometryInstance" && name != "MultiPoint") continue;
      const std::string path = fmt::format("CityObjects.{}.geometry", feature.id);
      const std::vector<size_t> points =
          geometry_->ring_of(text_.member(geometry, "boundaries", path), path + ".boundaries");
      if (points.empty()) continue;
      feature.point = dvec2(geometry_->place(points.front()));
      return true;
    }
    return false;
  }

  void make_tree(const CitySurfaces& surfaces, Feature& feature) const {
    const Box box = surfaces.plan_box();
    feature.point = (box.low + box.high) / 2.0;
    const dvec2 range = surfaces.heights();
    if (!feature.tags.contains("height") && range.y > range.x)
      feature.tags["height"] = number_text(range.y - range.x);
  }

  /// A part whose parent has no geometry is a building of its own: it has no outline to belong to.
  void join_parents() {
    std::unordered_map<std::string, size_t> by_id;
    for (size_t i = 0; i < contents_.features.size(); ++i) by_id.emplace(contents_.features[i].id, i);
    for (Feature& feature : contents_.features) {
      if (feature.part_of.empty() || by_id.contains(feature.part_of)) continue;
      become_building(feature);
    }
  }

  const MapSource& source_;
  MapContents& contents_;
  Notes notes_;
  std::string where_;
  CityJsonText text_;
  double height_unit_m_;  ///< of z; a compound CRS states it
  std::unique_ptr<Projection> projection_;
  std::unique_ptr<CityGeometry> geometry_;
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
