// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the tables of objects that GDAL opens: GeoJSON, GeoPackage, Shapefile.
#include <algorithm>
#include <cmath>
#include <gdal_priv.h>
#include <memory>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>
#include <set>
#include <unordered_map>

#include "core/error.h"
#include "core/expected.h"
#include "core/text.h"
#include "scene/place/input/osm_values.h"
#include "scene/place/source/crs.h"
#include "scene/place/source/map_contents.h"
#include "scene/place/source/rings.h"
#include "scene/place/source/vocabulary.h"

namespace greatx::scene::place {

namespace {

using Kind = Finding::Kind;

/// The formats of docs/places_reference.md. Others are not opened: some name further files, or addresses.
constexpr const char* table_drivers[] = {"GeoJSON",        "GeoJSONSeq", "GPKG",
                                         "ESRI Shapefile", "FlatGeobuf", nullptr};

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};

class TableReader {
 public:
  TableReader(const MapSource& source, const DegreesBox& part, MapContents& contents)
      : source_(source),
        part_(part),
        contents_(contents),
        notes_(source.name, contents.findings),
        vocabulary_(source),
        where_(source.file.string()) {}

  void read() {
    prepare_gdal();
    const std::string ending = source_.file.extension().string();
    if (ending == ".json" || ending == ".geojson")  // GDAL holds the whole text
      require_within(where_, std::filesystem::file_size(source_.file), map_file);
    const GdalMessages messages;
    const std::unique_ptr<GDALDataset, CloseDataset> dataset(
        GDALDataset::Open(source_.file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                          table_drivers, nullptr, nullptr));
    if (!dataset)
      throw_user_error(
          "{}: expected OpenStreetMap (.osm, .pbf), CityJSON, GeoJSON, GeoPackage or Shapefile{}", where_,
          messages.suffix());
    std::vector<std::string> layers;
    bool found = false;
    for (OGRLayer* layer : dataset->GetLayers()) {
      layers.push_back(printable(layer->GetName()));
      if (!source_.layer.empty() && source_.layer != layer->GetName()) continue;
      found = true;
      read_layer(*layer);
    }
    if (!found) throw_user_error("{}: layer: {}", where_, expected_one_of(layers, source_.layer));
    if (messages.failed()) throw_user_error("{}: the file is damaged{}", where_, messages.suffix());
    require_known_keys();
    join_parts();
    if (const char* text = dataset->GetMetadataItem("COPYRIGHT")) contents_.licence = printable(text);
  }

 private:
  void read_layer(OGRLayer& layer) {
    if (layer.GetGeomType() == wkbNone) return;  // a table of attributes alone, as GeoPackages have
    const Projection projection(where_, source_.crs, layer.GetSpatialRef());
    if (const std::string grid = projection.missing_grid(); !grid.empty())
      notes_.add(Kind::doubtful, "datum_grid_missing", printable(layer.GetName()), grid);
    OGREnvelope all;
    if (layer.GetExtent(&all, TRUE) == OGRERR_NONE && std::isfinite(all.MinX)) {
      std::vector<dvec2> corners{
          {all.MinX, all.MinY}, {all.MaxX, all.MinY}, {all.MaxX, all.MaxY}, {all.MinX, all.MaxY}};
      projection.to_degrees(corners);
      for (const dvec2& corner : corners) contents_.extent.add(corner);
      if (const std::string use = projection.outside_use(box_of(corners)); !use.empty())
        notes_.add(Kind::doubtful, "crs_outside_its_area", printable(layer.GetName()), use);
      filter(layer, projection, all);
    }
    for (const auto& feature : layer) read_feature(*feature, projection);
  }

  /// Restricts a layer to the part, so that a country's file is not held in memory. The part's outline is
  /// curved in the file's coordinates, so it is sampled, and the box around it gets a tenth more.
  void filter(OGRLayer& layer, const Projection& projection, const OGREnvelope& all) const {
    if (!part_ || (part_->low.x < -180.0 || part_->high.x > 180.0)) return;
    std::vector<dvec2> grid;
    for (int row = 0; row <= 10; ++row)
      for (int column = 0; column <= 10; ++column)
        grid.push_back(part_->low + (part_->high - part_->low) * dvec2(column, row) / 10.0);
    projection.from_degrees(grid);
    Box box;
    for (const dvec2& point : grid) {
      if (std::isnan(point.x)) return;
      box.add(point);
    }
    const dvec2 more = (box.high - box.low) / 10.0;
    if (box.meets({{all.MinX, all.MinY}, {all.MaxX, all.MaxY}}))
      layer.SetSpatialFilterRect(box.low.x - more.x, box.low.y - more.y, box.high.x + more.x,
                                 box.high.y + more.y);
  }

  void read_feature(const OGRFeature& feature, const Projection& projection) {
    Attributes attributes;
    for (int i = 0; i < feature.GetFieldCount(); ++i) {
      const char* name = feature.GetFieldDefnRef(i)->GetNameRef();
      names_.insert(name);
      if (!feature.IsFieldSetAndNotNull(i)) continue;
      const OGRFieldType type = feature.GetFieldDefnRef(i)->GetType();
      attributes[name] =
          type == OFTReal ? number_text(feature.GetFieldAsDouble(i)) : feature.GetFieldAsString(i);
      if (find_bad_utf8(attributes[name])) attributes[name] = printable(attributes[name]);
    }
    ++objects_;
    Translated translated = vocabulary_.translate(attributes);
    if (translated.id.empty()) translated.id = fmt::format("{}", feature.GetFID());
    known_ += translated.left_out || has_known_key(translated.tags);
    if (translated.left_out) {
      notes_.add(Kind::left_out, "marked_as_not_built", translated.id, "Its shape is 'none'.");
      return;
    }
    const OGRGeometry* geometry = feature.GetGeometryRef();
    if (geometry == nullptr || geometry->IsEmpty()) {
      notes_.add(Kind::left_out, "without_geometry", translated.id, "The object has no geometry.");
      return;
    }
    const std::unique_ptr<OGRGeometry> linear(geometry->getLinearGeometry());
    Feature read;
    read.id = unique_id(translated.id);
    read.tags = std::move(translated.tags);
    read.part_of = std::move(translated.part_of);
    add_geometry(*linear, projection, std::move(read), 0);
  }

  std::string unique_id(const std::string& id) {
    const int count = ++ids_[id];
    if (count == 1) return id;
    if (count == 2)
      notes_.add(Kind::doubtful, "id_not_unique", id,
                 "Several objects have this id; the later ones get '#2' and so on.");
    return fmt::format("{}#{}", id, count);
  }

  std::vector<dvec2> points_of(const OGRSimpleCurve& curve, const Projection& projection) {
    corners_.plan(where_, static_cast<uint64_t>(curve.getNumPoints()));
    std::vector<dvec2> points;
    for (int i = 0; i < curve.getNumPoints(); ++i) points.emplace_back(curve.getX(i), curve.getY(i));
    projection.to_degrees(points);
    return points;
  }

  std::optional<Ring> ring_of(const OGRLinearRing& curve, const Projection& projection,
                              const std::string& id) {
    Ring ring = points_of(curve, projection);
    const bool open = ring.size() > 1 && ring.front() != ring.back();
    drop_repeated(ring);
    if (distinct_corners(ring) < 3) {
      notes_.add(Kind::left_out, "ring_of_too_few_corners", id,
                 fmt::format("A ring has {} different corners.", distinct_corners(ring)));
      return std::nullopt;
    }
    if (open)
      notes_.add(Kind::repaired, "ring_not_closed", id,
                 "The last corner of a ring is not its first; a straight line closes it.");
    return ring;
  }

  void add_polygon(const OGRPolygon& polygon, const Projection& projection, Feature& feature) {
    if (polygon.getExteriorRing() == nullptr) return;
    auto outer = ring_of(*polygon.getExteriorRing(), projection, feature.id);
    if (!outer) return;
    Polygon read{std::move(*outer), {}};
    for (int i = 0; i < polygon.getNumInteriorRings(); ++i)
      if (auto hole = ring_of(*polygon.getInteriorRing(i), projection, feature.id))
        read.holes.push_back(std::move(*hole));
    feature.polygons.push_back(std::move(read));
  }

  void add_geometry(const OGRGeometry& geometry, const Projection& projection, Feature feature, int depth) {
    const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
    switch (type) {
      case wkbPoint:
        feature.point = projection.to_degrees({geometry.toPoint()->getX(), geometry.toPoint()->getY()});
        break;
      case wkbLineString:
        add_line(*geometry.toLineString(), projection, feature);
        break;
      case wkbMultiLineString:
        for (const auto* line : *geometry.toMultiLineString()) add_line(*line, projection, feature);
        break;
      case wkbPolygon:
      case wkbTriangle:
        add_polygon(*geometry.toPolygon(), projection, feature);
        break;
      case wkbMultiPolygon:
        for (const auto* polygon : *geometry.toMultiPolygon()) add_polygon(*polygon, projection, feature);
        break;
      case wkbMultiPoint:
      case wkbGeometryCollection: {
        if (depth > 8) throw_user_error("{}: {}: collections nested too deep", where_, printable(feature.id));
        const OGRGeometryCollection& parts = *geometry.toGeometryCollection();
        for (int i = 0; i < parts.getNumGeometries(); ++i) {
          Feature part = feature;
          part.id = fmt::format("{}.{}", feature.id, i + 1);
          add_geometry(*parts.getGeometryRef(i), projection, std::move(part), depth + 1);
        }
        return;
      }
      default:
        notes_.add(Kind::left_out, "geometry_of_unknown_kind", feature.id,
                   fmt::format("It is a {}.", OGRGeometryTypeToName(type)));
        return;
    }
    if (feature.point || !feature.lines.empty() || !feature.polygons.empty())
      contents_.features.push_back(std::move(feature));
  }

  /// A closed line with the tags of a building is an area, as in files of ways that became lines.
  void add_line(const OGRLineString& curve, const Projection& projection, Feature& feature) {
    std::vector<dvec2> line = points_of(curve, projection);
    if (distinct_corners(line) < 2) {
      notes_.add(Kind::left_out, "way_of_too_few_nodes", feature.id,
                 fmt::format("A line has {} different points.", distinct_corners(line)));
      return;
    }
    const bool closed = line.size() > 3 && line.front() == line.back();
    if (closed && (feature.tag("building") != nullptr || feature.tag("building:part") != nullptr)) {
      drop_repeated(line);
      feature.polygons.push_back({std::move(line), {}});
    } else {
      feature.lines.push_back(std::move(line));
    }
  }

  /// A file in another vocabulary may have a few names in common with OpenStreetMap.
  void require_known_keys() {
    if (objects_ == 0 || contents_.features.empty() || known_ == objects_) return;
    const bool other = source_.vocabulary == "osm" && names_of_osm_buildings(names_) >= 2;
    if (known_ == 0 || (other && 2 * known_ <= objects_))
      throw_user_error("{}: {} of its {} objects says what it is; their attributes are {}: {}", where_,
                       known_ == 0 ? "none" : fmt::format("only {}", known_), objects_,
                       names_.empty() ? "none" : printable(fmt::format("{}", fmt::join(names_, ", "))),
                       suggested_vocabulary(names_));
    notes_.add(
        Kind::left_out, "object_without_kind", "",
        fmt::format("{} of {} objects have no tag that says what they are.", objects_ - known_, objects_));
  }

  /// A part without its building is a building of its own.
  void join_parts() {
    std::set<std::string> ids;
    for (const Feature& feature : contents_.features) ids.insert(feature.id);
    for (Feature& feature : contents_.features) {
      if (feature.part_of.empty() || ids.contains(feature.part_of)) continue;
      notes_.add(Kind::doubtful, "part_without_building", feature.id,
                 fmt::format("It is a part of '{}', which is not in the file; it counts as a building.",
                             printable(feature.part_of)));
      become_building(feature);
    }
  }

  const MapSource& source_;
  const DegreesBox& part_;
  MapContents& contents_;
  Notes notes_;
  Vocabulary vocabulary_;
  std::string where_;
  std::set<std::string> names_;
  std::unordered_map<std::string, int> ids_;
  Spending corners_{map_corners};
  uint64_t objects_ = 0;
  uint64_t known_ = 0;  ///< objects that say what they are
};

}  // namespace

void become_building(Feature& part) {
  part.part_of.clear();
  const auto tag = part.tags.find("building:part");
  if (tag == part.tags.end()) return;
  part.tags["building"] = tag->second;
  part.tags.erase("building:part");
}

MapContents read_table(const MapSource& source, const DegreesBox& part) {
  MapContents contents;
  TableReader(source, part, contents).read();
  return contents;
}

}  // namespace greatx::scene::place
