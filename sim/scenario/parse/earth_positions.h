// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads positions that people give on the Earth. Wherever a scenario takes a position in metres, `KEY_m:
// [x, y, z]`, it takes `KEY_deg: [latitude, longitude, height]` instead, and tables take columns for them.
// Every such place goes through EarthPositions::local(), so that all of them mean the same and have the same
// bounds. What leaves the parser is in metres: nothing behind it knows how a position was written.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "core/fields/field.h"
#include "core/geodesy.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// A position whose height is below this limit is within 100 km of the origin, over ground. Positions that
/// are farther away are faults, most often a latitude in the place of a longitude. Spacecraft are exempt.
inline constexpr double most_ground_distance_m = 100e3, least_space_height_m = 100e3;

class EarthPositions {
 public:
  /// Makes the positions of a scene without a georeference: each is a fault.
  EarthPositions() = default;
  explicit EarthPositions(const SceneConfig& scene);
  /// Returns the same with heights above `heights`.
  EarthPositions with(HeightOf heights) const;

  /// Throws an error that says what was expected and found.
  using Fail = std::function<void(const std::string& expected, const std::string& found)>;
  /// Returns the position in the scene. `place` has the heights of this object. It calls `fail` if the scene
  /// has no georeference, or the place is not on the Earth or farther than most_ground_distance_m.
  dvec3 local(const Geodetic& place, const Fail& fail) const;

 private:
  std::optional<LocalFrame> frame_;
  HeightOf heights_ = HeightOf::datum;
};

/// The key of a position in metres, and that of the same position on the Earth.
struct PositionKeys {
  std::string_view metres = "position_m", degrees = "position_deg";
};

/// Reads [latitude, longitude, height].
dvec3 place_of(const Field& field, const EarthPositions& earth);
/// Returns the position of a map that has one of the two keys, or nothing if it has none. Throws if it has
/// both.
std::optional<dvec3> find_position(const FieldMap& map, const EarthPositions& earth,
                                   const PositionKeys& keys = {});
/// Does the same, and throws if the map has none.
dvec3 require_position(const FieldMap& map, const EarthPositions& earth, const PositionKeys& keys = {});
/// Returns `earth` with the heights that the map's key `heights` says, if it has it.
EarthPositions with_heights_of(const FieldMap& map, const EarthPositions& earth);

/// Reads `heights`: datum or ellipsoid.
HeightOf heights_of(const Field& field);

/// A file of the static scene, which may have a georeference.
struct SceneFile {
  std::filesystem::path file;
  SourceLocation where;
  bool in_place = true;  ///< it is not moved, turned or scaled, so that its frame is the world's
};
/// Reads the georeference of a scene from `scene.georeference` and from its files, all of which may have one
/// if all are the same. `map` is that of the scene. Throws UserError if they differ, or if a file with a
/// georeference is not in place.
std::optional<Georeference> parse_georeference(const FieldMap& map, const std::vector<SceneFile>& files);

}  // namespace greatx::sim
