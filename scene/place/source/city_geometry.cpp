// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/city_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <ogr_geometry.h>

#include "core/error.h"
#include "core/text.h"
#include "scene/place/source/rings.h"

namespace greatx::scene::place {

namespace {

using CityJson = CityJsonText::Json;

/// Surfaces of less area in plan than this are upright, m2.
constexpr double least_plan_area = 1e-6;
/// One degree of a meridian, squared; of a parallel it is less, so that the area is one from above.
constexpr double metres_per_degree_2 = 111'000.0 * 111'000.0;

SolidFace::Kind face_kind(const CityJson& semantics, const CityJson& value) {
  const CityJson* surfaces = CityJsonText::find(semantics, "surfaces");
  if (surfaces == nullptr || !surfaces->is_array() || !value.is_number_unsigned() ||
      value.get<size_t>() >= surfaces->size())
    return SolidFace::Kind::unknown;
  const CityJson* type = CityJsonText::find((*surfaces)[value.get<size_t>()], "type");
  const std::string name = type != nullptr && type->is_string() ? type->get<std::string>() : "";
  if (name == "RoofSurface" || name == "OuterCeilingSurface") return SolidFace::Kind::roof;
  if (name == "GroundSurface" || name == "OuterFloorSurface") return SolidFace::Kind::ground;
  if (name == "WallSurface" || name == "Window" || name == "Door") return SolidFace::Kind::wall;
  return SolidFace::Kind::unknown;
}

/// Returns a polygon of OGR without repeated corners; without outline if it has fewer than three.
Polygon polygon_of(const OGRPolygon& polygon) {
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
  return read;
}

}  // namespace

void CityJsonText::fail(const std::string& path, const std::string& expected) const {
  throw_user_error("{}: {}: expected {}", where_, printable(path), expected);
}

const CityJsonText::Json& CityJsonText::member(const Json& json, const char* key,
                                               const std::string& path) const {
  const auto found = json.is_object() ? json.find(key) : json.end();
  if (!json.is_object() || found == json.end())
    fail(path.empty() ? key : path + "." + key, "a value, found nothing");
  return *found;
}

const CityJsonText::Json* CityJsonText::find(const Json& json, const char* key) {
  if (!json.is_object()) return nullptr;
  const auto found = json.find(key);
  return found != json.end() ? &*found : nullptr;
}

double CityJsonText::number(const Json& json, const std::string& path) const {
  if (!json.is_number() || !std::isfinite(json.get<double>())) fail(path, "a number");
  return json.get<double>();
}

dvec3 CityJsonText::vector(const Json& json, const std::string& path) const {
  if (!json.is_array() || json.size() != 3) fail(path, "three numbers");
  return {number(json[0], path), number(json[1], path), number(json[2], path)};
}

std::string CityJsonText::text(const Json& json, const char* key) {
  const Json* found = find(json, key);
  return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
}

dvec2 CitySurfaces::heights() const {
  dvec2 range(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
  for (const SolidFace& face : faces)
    for (const auto& ring : face.rings)
      for (const dvec3& point : ring) range = {std::min(range.x, point.z), std::max(range.y, point.z)};
  return range;
}

Box CitySurfaces::plan_box() const {
  Box box;
  for (const SolidFace& face : faces)
    for (const dvec3& point : face.rings[0]) box.add(dvec2(point));
  return box;
}

std::vector<Polygon> CitySurfaces::plan() const {
  OGRMultiPolygon all;
  for (const SolidFace& face : faces) {
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
  // Without a union, which GEOS refuses for surfaces that cross themselves, they stay single.
  const std::unique_ptr<OGRGeometry> joined(all.IsEmpty() ? nullptr : all.UnionCascaded());
  const OGRGeometry* geometry = joined ? joined.get() : &all;
  std::vector<Polygon> polygons;
  const auto add = [&](const OGRGeometry& part) {
    if (wkbFlatten(part.getGeometryType()) != wkbPolygon) return;
    if (Polygon read = polygon_of(*part.toPolygon()); !read.outer.empty())
      polygons.push_back(std::move(read));
  };
  if (OGR_GT_IsSubClassOf(wkbFlatten(geometry->getGeometryType()), wkbGeometryCollection) != 0)
    for (const auto* part : *geometry->toGeometryCollection()) add(*part);
  else
    add(*geometry);
  return polygons;
}

CityGeometry::CityGeometry(const CityJsonText& text, const Json& root, const Projection& projection,
                           double height_unit_m)
    : text_(text), projection_(projection), height_unit_m_(height_unit_m) {
  dvec3 scale(1.0), translate(0.0);
  if (const Json* transform = CityJsonText::find(root, "transform")) {
    scale = text.vector(text.member(*transform, "scale", "transform"), "transform.scale");
    translate = text.vector(text.member(*transform, "translate", "transform"), "transform.translate");
  }
  const Json& vertices = text.member(root, "vertices", "");
  if (!vertices.is_array()) text.fail("vertices", "a list");
  require_within(text.where(), vertices.size(), map_corners);
  for (size_t i = 0; i < vertices.size(); ++i)
    vertices_.push_back(text.vector(vertices[i], fmt::format("vertices[{}]", i)) * scale + translate);
  for (const dvec3& vertex : vertices_) degrees_.emplace_back(vertex);
  // Vertices that no object uses may lie anywhere, so that each is converted when it is used.
  converted_.assign(vertices_.size(), false);
}

dvec3 CityGeometry::place(size_t vertex) {
  if (!converted_[vertex]) {
    degrees_[vertex] = projection_.to_degrees(degrees_[vertex]);
    converted_[vertex] = true;
    extent_.add(degrees_[vertex]);
  }
  return {degrees_[vertex], vertices_[vertex].z * height_unit_m_};
}

double CityGeometry::lod_of(const Json& geometry) {
  const Json* lod = CityJsonText::find(geometry, "lod");
  if (lod == nullptr) return -1.0;
  if (lod->is_number()) return lod->get<double>();
  return lod->is_string() ? parse_number(lod->get<std::string>()).value_or(-1.0) : -1.0;
}

std::vector<size_t> CityGeometry::ring_of(const Json& json, const std::string& path) const {
  if (!json.is_array()) text_.fail(path, "a list of indices");
  std::vector<size_t> ring;
  for (const Json& index : json) {
    if (!index.is_number_unsigned() || index.get<uint64_t>() >= vertices_.size())
      text_.fail(path, fmt::format("indices below {}, found {}", vertices_.size(), printable(index.dump())));
    ring.push_back(index.get<size_t>());
  }
  return ring;
}

/// Walks the nested lists of boundaries down to surfaces, with the semantic values beside them. `depth` is
/// the number of lists above a surface.
void CityGeometry::add_surfaces(const Json& boundaries, const Json* values, const Json* semantics, int depth,
                                const std::string& path, CitySurfaces& result) {
  if (!boundaries.is_array()) text_.fail(path, "a list");
  for (size_t i = 0; i < boundaries.size(); ++i) {
    const std::string at = fmt::format("{}[{}]", path, i);
    const Json* value =
        values != nullptr && values->is_array() && i < values->size() ? &(*values)[i] : nullptr;
    if (depth > 1) {
      add_surfaces(boundaries[i], value, semantics, depth - 1, at, result);
      continue;
    }
    if (!boundaries[i].is_array()) text_.fail(at, "a list of rings");
    SolidFace face;
    if (value != nullptr && semantics != nullptr) face.kind = face_kind(*semantics, *value);
    corners_.plan(text_.where(), boundaries[i].size());
    for (const Json& ring : boundaries[i]) {
      std::vector<dvec3> points;
      std::vector<size_t> distinct = ring_of(ring, at);
      for (const size_t vertex : distinct) points.push_back(place(vertex));
      std::ranges::sort(distinct);
      const auto corners = std::unique(distinct.begin(), distinct.end()) - distinct.begin();
      if (corners >= 3) {
        face.rings.push_back(std::move(points));
      } else {
        ++result.thin_rings;
        if (face.rings.empty()) break;  // a face without an outer ring is none
      }
    }
    if (!face.rings.empty()) result.faces.push_back(std::move(face));
  }
}

CitySurfaces CityGeometry::surfaces_of(const std::string& id, const Json& geometry, Notes& notes) {
  const std::string path = fmt::format("CityObjects.{}.geometry", id);
  const Json& type = text_.member(geometry, "type", path);
  const std::string name = type.is_string() ? type.get<std::string>() : "";
  CitySurfaces surfaces;
  int depth = 0;
  if (name == "MultiSurface" || name == "CompositeSurface") depth = 1;
  if (name == "Solid") depth = 2;
  if (name == "MultiSolid" || name == "CompositeSolid") depth = 3;
  if (depth == 0) {
    notes.add(Finding::Kind::left_out, "geometry_of_unknown_kind", id,
              fmt::format("It is a {}.", printable(name)));
    return surfaces;
  }
  surfaces.solid = depth >= 2;
  const Json* semantics = CityJsonText::find(geometry, "semantics");
  const Json* values = semantics != nullptr ? CityJsonText::find(*semantics, "values") : nullptr;
  add_surfaces(text_.member(geometry, "boundaries", path), values, semantics, depth, path + ".boundaries",
               surfaces);
  if (surfaces.thin_rings > 0)
    notes.add(Finding::Kind::left_out, "ring_of_too_few_corners", id,
              fmt::format("{} rings of its surfaces have fewer than three corners.", surfaces.thin_rings));
  return surfaces;
}

}  // namespace greatx::scene::place
