// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds all that the sources of a place say, in the scene's frame and in one vocabulary: the tags of
// OpenStreetMap. What a place is built of follows from it alone; no file is opened afterwards.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geodesy.h"
#include "core/vec.h"
#include "scene/place/input/height_field.h"

namespace greatx::scene::place {

/// Corners in metres, x east and y north. The first corner is not repeated. Rings come as they were read: of
/// either orientation, perhaps crossing themselves.
using Ring = std::vector<dvec2>;
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

/// A planar piece of a solid with its semantic class (CityJSON 2.0, section 3.3).
struct SolidFace {
  enum class Kind { unknown, ground, wall, roof } kind = Kind::unknown;
  std::vector<std::vector<dvec3>> rings;  ///< m, outer ring first, not repeated; z in the scene's frame
};

/// One object of a source. Exactly one of `polygons`, `lines`, `point` and `faces` is given.
struct Feature {
  std::string source;  ///< name of the source, for reports
  std::string id;      ///< id in the source, "way/275490779"; unique within the source
  std::map<std::string, std::string, std::less<>> tags;  ///< in OpenStreetMap's vocabulary
  std::vector<Polygon> polygons;                         ///< an area
  std::vector<std::vector<dvec2>> lines;                 ///< open or closed lines, m
  std::optional<dvec2> point;                            ///< m
  std::vector<SolidFace> faces;                          ///< the boundary of a solid, open or closed
  std::string part_of;                                   ///< id of the feature whose part this is, or empty

  const std::string* tag(std::string_view key) const {
    const auto found = tags.find(key);
    return found != tags.end() ? &found->second : nullptr;
  }
};

/// Returns how findings name an object.
inline std::string object_label(const std::string& source, const std::string& id) {
  return source + ": " + id;
}

/// A picture of the ground: sRGB, and where its corners lie. Pixels are addressed by (column, row), row 0
/// first; pixel centres are at half-integers.
struct GroundPicture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb;    ///< [height, width, 3]
  std::vector<uint8_t> known;  ///< [height, width], 0 where the picture has no data; empty: all known
  /// (column, row) = pixel_from_local * (x, y, 1). Reading resamples a picture to a grid along x and y if its
  /// own coordinates are not affine in the scene's frame to a quarter of a pixel.
  glm::dmat3x2 pixel_from_local{0.0};
  std::string source;
};

/// An entry of the report: what was found in the input and what was done about it.
struct Finding {
  enum class Kind {
    repaired,  ///< the input had a fault, and the scene has it mended
    left_out,  ///< the scene lacks it
    assumed,   ///< the input does not say it, and a stated rule does
    doubtful,  ///< the scene has it as the input says it, which may be wrong
  } kind = Kind::repaired;
  std::string topic;   ///< a fixed short name, "ring_crosses_itself", under which entries are counted
  std::string object;  ///< "source: id"
  std::string detail;  ///< one sentence, with the numbers
};

/// All input of a place.
struct PlaceInput {
  Georeference reference;
  std::vector<Feature> features;  ///< in the order of the sources, and of each file
  HeightField terrain;            ///< empty: the ground is level
  HeightField surface;            ///< heights of roofs and crowns; may be empty
  std::vector<GroundPicture> pictures;
  Polygon area;  ///< the area asked for; sources are cut to it, whole buildings stay
  std::vector<Finding> findings;
  std::vector<std::string> licences;  ///< "source: text" of each source that states one
};

}  // namespace greatx::scene::place
