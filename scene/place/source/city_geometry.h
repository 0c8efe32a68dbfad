// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the vertices and the geometry of a CityJSON file (specification 2.0.1, chapters 3 and 4): nested
// lists of indices become faces, x and y in degrees and z in metres above the vertical datum.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/place/source/crs.h"
#include "scene/place/source/map_contents.h"

namespace greatx::scene::place {

/// Gives the members of a JSON value, with errors "FILE: PATH: expected ...".
class CityJsonText {
 public:
  using Json = nlohmann::ordered_json;
  explicit CityJsonText(std::string where) : where_(std::move(where)) {}

  const std::string& where() const { return where_; }
  [[noreturn]] void fail(const std::string& path, const std::string& expected) const;
  /// Returns a member that must be there.
  const Json& member(const Json& json, const char* key, const std::string& path) const;
  /// Returns a member, or null.
  static const Json* find(const Json& json, const char* key);
  /// Returns the text of a member, or an empty text.
  static std::string text(const Json& json, const char* key);
  double number(const Json& json, const std::string& path) const;
  dvec3 vector(const Json& json, const std::string& path) const;

 private:
  std::string where_;
};

/// The surfaces of one geometry.
struct CitySurfaces {
  std::vector<SolidFace> faces;
  bool solid = false;     ///< of a solid or several; false: of surfaces
  size_t thin_rings = 0;  ///< rings that were left out, because they have fewer than three corners

  /// Returns the least and the greatest z.
  dvec2 heights() const;
  Box plan_box() const;
  /// Returns the union of the surfaces in plan. Corners stay those of the file, so that neighbours, whose
  /// corners are the same vertices, have no gaps. Upright surfaces have no area.
  std::vector<Polygon> plan() const;
};

class CityGeometry {
 public:
  using Json = CityJsonText::Json;
  /// Reads the vertices and their transform. `height_unit_m` is that of z.
  CityGeometry(const CityJsonText& text, const Json& root, const Projection& projection,
               double height_unit_m);

  /// Returns the number of a level of detail, "2.2" and 2 alike; -1 if there is none.
  static double lod_of(const Json& geometry);
  /// Returns the place of a vertex.
  dvec3 place(size_t vertex);
  std::vector<size_t> ring_of(const Json& json, const std::string& path) const;
  /// Returns the surfaces of a geometry; none and a finding if it has no surfaces.
  CitySurfaces surfaces_of(const std::string& id, const Json& geometry, Notes& notes);
  /// Returns the extent of all vertices that were used.
  const Box& extent() const { return extent_; }

 private:
  void add_surfaces(const Json& boundaries, const Json* values, const Json* semantics, int depth,
                    const std::string& path, CitySurfaces& result);

  const CityJsonText& text_;
  const Projection& projection_;
  double height_unit_m_;
  std::vector<dvec3> vertices_;
  std::vector<dvec2> degrees_;
  std::vector<bool> converted_;
  Box extent_;
  Spending corners_{map_corners};
};

}  // namespace greatx::scene::place
