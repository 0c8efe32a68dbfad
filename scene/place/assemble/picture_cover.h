// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Pictures from above as textures of the ground and of roofs.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/generator/paint/textures.h"
#include "scene/place/input/place_input.h"
#include "scene/place/plane/polygons.h"

namespace greatx::scene::place {

class PictureCover {
 public:
  /// Makes a texture of each picture. A picture wider or higher than `most_px` is halved until it is not,
  /// which a Finding says.
  PictureCover(const std::vector<GroundPicture>& pictures, uint32_t most_px, std::vector<Finding>& findings);

  /// Returns the first picture that covers a triangle with data, or nothing.
  std::optional<size_t> over(const dvec2& a, const dvec2& b, const dvec2& c) const;
  dvec2 uv(size_t picture, const dvec2& place) const;
  const std::string& name(size_t picture) const { return tiles_[picture].name; }
  /// Returns the borders, along which the mesh of the ground must be divided.
  std::vector<Ring> borders() const;
  /// Returns the pictures for SceneWriter.
  std::map<std::string, generator::TextureMaps> textures() const;
  bool empty() const { return tiles_.empty(); }

 private:
  struct Tile {
    std::string name;
    generator::Raster raster;
    std::vector<uint8_t> known;  ///< per pixel; empty: all
    glm::dmat3x2 uv_from_place{0.0};
    Ring border;
    bool holds(const dvec2& place) const;
  };
  std::vector<Tile> tiles_;
};

}  // namespace greatx::scene::place
