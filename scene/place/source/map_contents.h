// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds what a file of map objects says before it is placed in the scene's frame.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/budget.h"
#include "scene/place/config/place_config.h"
#include "scene/place/input/area_test.h"
#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

/// Bounds of what input may take; docs/places_reference.md lists them.
inline constexpr Budget map_file{"a map file", budget::gib};
inline constexpr Budget map_nodes{"the nodes of an OpenStreetMap file", 40'000'000, "nodes"};
inline constexpr Budget map_corners{"the corners of a map file", 20'000'000, "corners"};
inline constexpr Budget place_heights{"the heights of a place", 24'000'000, "samples"};
inline constexpr Budget place_pictures{"the pictures of a place", 768 * budget::mib};

struct MapContents {
  /// x is the longitude and y the latitude in degrees of WGS 84; z of faces is the height above the vertical
  /// datum in metres.
  std::vector<Feature> features;
  Box extent;  ///< degrees, of all objects of the file, also of those outside the area
  std::vector<Finding> findings;
  std::string licence;  ///< what the file states, or empty
};

/// Collects findings of one source.
class Notes {
 public:
  Notes(std::string source, std::vector<Finding>& findings)
      : source_(std::move(source)), findings_(findings) {}
  void add(Finding::Kind kind, std::string topic, const std::string& id, std::string detail) {
    findings_.push_back(
        {kind, std::move(topic), id.empty() ? source_ : source_ + ": " + id, std::move(detail)});
  }

 private:
  std::string source_;
  std::vector<Finding>& findings_;
};

/// The part of the Earth for which a source is read, in degrees. The longitudes are those nearest to the
/// box's middle, so that low.x < high.x across the antimeridian, too. Nothing: all of it.
using DegreesBox = std::optional<Box>;

/// Returns the longitude plus or minus full turns, within 180 degrees of `near`.
double longitude_near(double longitude_deg, double near_deg);
/// Returns whether two boxes in degrees meet, whatever full turns lie between their longitudes.
bool meets_turned(const Box& a, const Box& b);

/// Makes a part a building of its own.
void become_building(Feature& part);

/// Each reader throws UserError "file: ..." if it cannot read the file.
MapContents read_osm_file(const MapSource& source);
MapContents read_city_json(const MapSource& source);
MapContents read_table(const MapSource& source, const DegreesBox& part);

}  // namespace greatx::scene::place
