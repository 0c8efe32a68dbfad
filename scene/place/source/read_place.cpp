// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "core/units.h"
#include "scene/place/input/osm_values.h"
#include "scene/place/source/area.h"
#include "scene/place/source/city_json.h"
#include "scene/place/source/height_file.h"
#include "scene/place/source/picture_file.h"
#include "scene/place/source/source.h"
#include "scene/place/source/vocabulary.h"

namespace greatx::scene::place {

namespace {

using Kind = Finding::Kind;

/// Terrain is read this far beyond the area and the ground's margin: buildings at the edge stay whole.
constexpr double terrain_margin_m = 150.0;
constexpr double metres_per_degree = 111'000.0;

Box widened(const Box& box, double metres) {
  const double latitude = std::min(89.0, std::max(std::abs(box.low.y), std::abs(box.high.y)));
  const dvec2 more(metres / (metres_per_degree * std::cos(radians(latitude))), metres / metres_per_degree);
  return {box.low - more, {box.high + more}};
}

MapContents read_map(const MapSource& source, const DegreesBox& part) {
  const std::string name = source.file.filename().string();
  const auto ends = [&](std::string_view end) { return name.ends_with(end); };
  if (ends(".osm") || ends(".pbf") || ends(".osm.gz") || ends(".osm.bz2") || ends(".xml"))
    return read_osm_file(source);
  if (ends(".json")) {
    const std::string text = InputFile(source.file, source.file.string(), map_file).text();
    if (is_city_json(text)) return read_city_json(source);
    if (text.find("\"CityJSONFeature\"") != std::string::npos)
      throw_user_error(
          "{}: expected a CityJSON file, found a sequence of CityJSON features (cjio joins them)",
          source.file.string());
    if (text.find("\"elements\"") != std::string::npos && text.find("\"Overpass") != std::string::npos)
      throw_user_error("{}: Overpass' own JSON is not read: ask it for XML ([out:xml]) or export GeoJSON",
                       source.file.string());
  }
  return read_table(source, part);
}

class PlaceReader {
 public:
  PlaceReader(const PlaceConfig& config, const Progress& progress) : config_(config), progress_(progress) {}

  PlaceInput read() {
    find_area();
    read_terrain();
    input_.area = area_in_frame(*area_, *placement_);
    const AreaTest test(input_.area);
    place_maps(test);
    read_surface(test);
    read_pictures(test);
    return std::move(input_);
  }

 private:
  void say(const std::string& sentence) const {
    if (progress_) progress_(sentence);
  }
  void add_licence(const std::string& source, const std::string& given, const std::string& stated) {
    const std::string& text = given.empty() ? stated : given;
    if (!text.empty()) input_.licences.push_back(source + ": " + text);
  }

  /// Reads maps before the area if it is their extent, and after it otherwise, so that large files are cut.
  void find_area() {
    area_ = given_area(config_);
    for (const MapSource& source : config_.maps) {
      say(fmt::format("Reading {}.", source.file.string()));
      maps_.push_back(
          read_map(source, area_ ? DegreesBox(widened(area_->box, terrain_margin_m)) : std::nullopt));
    }
    if (area_) return;
    Box extent;
    const auto add = [&](const Box& box) {
      if (box.empty()) return;
      const double turn = extent.empty() ? 0.0 : longitude_near(box.low.x, extent.low.x) - box.low.x;
      extent.add(box.low + dvec2(turn, 0.0));
      extent.add(box.high + dvec2(turn, 0.0));
    };
    const std::string& name = config_.area.extent_of;
    for (size_t i = 0; i < maps_.size(); ++i)
      if (name.empty() || name == config_.maps[i].name) add(narrowest(maps_[i]));
    if (!name.empty()) {
      for (const auto* sources : {&config_.terrain, &config_.surface})
        for (const HeightSource& source : *sources)
          if (name == source.name) add(raster_extent(source.file, source.crs));
      for (const PictureSource& source : config_.pictures)
        if (name == source.name) add(raster_extent(source.file, source.crs));
    }
    area_ = area_of_extent(extent, config_.file.string() + ": area");
  }

  /// Returns the extent of a map. One that spans most of the globe lies on both sides of the antimeridian.
  static Box narrowest(const MapContents& contents) {
    if (contents.extent.empty() || contents.extent.high.x - contents.extent.low.x < 180.0)
      return contents.extent;
    Box turned;
    const auto add = [&](const dvec2& point) { turned.add({longitude_near(point.x, 180.0), point.y}); };
    for (const Feature& feature : contents.features) {
      for (const Polygon& polygon : feature.polygons) std::ranges::for_each(polygon.outer, add);
      for (const auto& line : feature.lines) std::ranges::for_each(line, add);
      if (feature.point) add(*feature.point);
      for (const SolidFace& face : feature.faces)
        for (const auto& ring : face.rings)
          for (const dvec3& point : ring) add(dvec2(point));
    }
    return turned;
  }

  std::vector<HeightSamples> read_samples(const std::vector<HeightSource>& sources, double margin_m,
                                          const char* topic) {
    const Box box = widened(area_->box, margin_m);
    std::vector<HeightTile> tiles;
    for (const HeightSource& source : sources) {
      say(fmt::format("Reading {}.", source.file.string()));
      Notes notes(source.name, input_.findings);
      tiles.push_back(read_heights(source, box, notes));
      add_licence(source.name, source.licence, tiles.back().licence);
      height_extents_ +=
          fmt::format("{}{} covers {}{}", height_extents_.empty() ? "" : "; ", printable(source.name),
                      extent_text(tiles.back().extent), swapped_hint(tiles.back().extent, area_->box));
      if (tiles.back().columns == 0)
        notes.add(Kind::left_out, fmt::format("{}_outside", topic), "",
                  fmt::format("The file covers {}, the area {}{}.", extent_text(tiles.back().extent),
                              extent_text(area_->box), swapped_hint(tiles.back().extent, area_->box)));
    }
    std::vector<HeightSamples> samples;
    for (const HeightTile& tile : join_tiles(std::move(tiles))) samples.push_back(samples_of(tile));
    return samples;
  }

  /// The origin: given, or the area's middle to 1e-5 degrees (1 m), at its ground to 0.1 m.
  Geodetic find_origin(const std::vector<HeightSamples>& samples) {
    if (config_.origin) return *config_.origin;
    Geodetic origin{std::round(area_->centre().y * 1e5) / 1e5,
                    longitude_near(std::round(area_->centre().x * 1e5) / 1e5, 0.0), 0.0};
    if (samples.empty()) return origin;
    const LocalFrame level({origin, 0.0, ""});
    HeightField field;
    for (const HeightSamples& one : samples) field.add(grid_in_frame(one, level));
    if (const auto z = field.at(dvec2(0.0))) {
      origin.height_m = std::round(*z * 10.0) / 10.0;
      return origin;
    }
    // The middle may lie in a void, below a building for example.
    double nearest = std::numeric_limits<double>::infinity();
    for (const HeightGrid& grid : field.grids())
      for (const dvec3& sample : grid.samples)
        if (!std::isnan(sample.z) && glm::length(dvec2(sample)) < nearest) {
          nearest = glm::length(dvec2(sample));
          origin.height_m = std::round(level.datum_place(sample).height_m * 10.0) / 10.0;
        }
    if (std::isfinite(nearest))
      Notes("terrain", input_.findings)
          .add(
              Kind::assumed, "origin_height", "",
              fmt::format(
                  "The terrain has no height at the origin; the nearest sample, {:.1f} m away, is {} m high.",
                  nearest, origin.height_m));
    return origin;
  }

  void read_terrain() {
    auto samples = read_samples(config_.terrain, config_.ground.margin_m + terrain_margin_m, "terrain");
    const bool any = std::ranges::any_of(samples, [](const HeightSamples& one) {
      return std::ranges::any_of(one.samples, [](const dvec3& sample) { return !std::isnan(sample.z); });
    });
    if (!config_.terrain.empty() && !any)
      throw_user_error("{}: terrain: no file has a height in or around the area ({}): {}",
                       config_.file.string(), extent_text(area_->box), height_extents_);
    Geodetic origin = find_origin(samples);
    origin.height_m += config_.undulation_m;
    input_.reference = {origin, config_.undulation_m, config_.vertical_datum};
    const Placement level(input_.reference, input_.terrain);
    const AreaTest test(area_in_frame(*area_, level));
    input_.terrain = join_samples(std::move(samples), level.frame(), test, true, "terrain", input_.findings);
    placement_.emplace(input_.reference, input_.terrain);
    if (!config_.terrain.empty()) report_cover(input_.terrain, test, "terrain");
  }

  void report_cover(const HeightField& field, const AreaTest& test, const char* topic) {
    constexpr int steps = 100;
    size_t inside = 0, missing = 0;
    for (int row = 0; row < steps; ++row)
      for (int column = 0; column < steps; ++column) {
        const dvec2 point =
            test.box().low + (test.box().high - test.box().low) * (dvec2(column, row) + 0.5) / double(steps);
        if (!test.contains(point)) continue;
        ++inside;
        missing += !field.at(point).has_value();
      }
    if (missing > 0)
      Notes(topic, input_.findings)
          .add(Kind::doubtful, fmt::format("{}_does_not_cover", topic), "",
               fmt::format("{:.1f} % of the area has no height (of {} points).",
                           100.0 * static_cast<double>(missing) / static_cast<double>(inside), inside));
  }

  void place_maps(const AreaTest& test) {
    say("Placing the objects of the maps.");
    size_t kept = 0, read = 0;
    for (size_t i = 0; i < maps_.size(); ++i) {
      const MapSource& source = config_.maps[i];
      add_licence(source.name, source.licence, maps_[i].licence);
      const size_t before = kept;
      read += maps_[i].features.size();
      size_t in_area = 0;
      for (Feature& feature : maps_[i].features) {
        if (!meets_turned(box_of(feature), widened(area_->box, 1.0))) continue;
        feature.source = source.name;
        placement_->place(feature);
        if (!test.meets(feature)) continue;
        ++in_area;
        translate_heights(source, feature);
        input_.features.push_back(std::move(feature));
      }
      kept += in_area;
      join_parts(source, input_.features.size() - in_area);
      drop_findings_elsewhere(maps_[i]);
      if (kept == before && !maps_[i].features.empty()) report_outside(source, maps_[i]);
      maps_[i] = {};
    }
    if (!config_.maps.empty() && kept == 0) {
      std::string extents;
      for (size_t i = 0; i < config_.maps.size(); ++i)
        extents +=
            fmt::format("{}{} covers {}", i > 0 ? "; " : "", printable(config_.maps[i].name), outside_[i]);
      throw_user_error("{}: none of {} objects of the maps lies in the area ({}): {}", config_.file.string(),
                       read, extent_text(area_->box), extents);
    }
  }

  /// A part in the area whose building is outside of it is a building of its own.
  void join_parts(const MapSource& source, size_t first) {
    std::set<std::string_view> ids;
    for (size_t i = first; i < input_.features.size(); ++i) ids.insert(input_.features[i].id);
    for (size_t i = first; i < input_.features.size(); ++i) {
      Feature& part = input_.features[i];
      if (part.part_of.empty() || ids.contains(part.part_of)) continue;
      Notes(source.name, input_.findings)
          .add(Kind::doubtful, "part_without_building", part.id,
               fmt::format("It is a part of '{}', which is not in the area; it counts as a building.",
                           printable(part.part_of)));
      become_building(part);
    }
  }

  /// Findings of single objects count whether or not the object is in the area: the reader cannot tell where
  /// an object without corners lies.
  void drop_findings_elsewhere(MapContents& contents) {
    outside_.push_back(extent_text(contents.extent));
    std::ranges::move(contents.findings, std::back_inserter(input_.findings));
  }

  void report_outside(const MapSource& source, const MapContents& contents) {
    if (!swapped_hint(contents.extent, area_->box).empty())
      throw_user_error(
          "{}: all objects lie outside the area, and inside it if latitude and longitude change places: they "
          "seem "
          "to be swapped; the file covers {}, the area {}",
          source.file.string(), extent_text(contents.extent), extent_text(area_->box));
    Notes(source.name, input_.findings)
        .add(Kind::left_out, "map_outside", "",
             fmt::format("None of its {} objects lies in the area: it covers {}, the area {}.",
                         contents.features.size(), extent_text(contents.extent), extent_text(area_->box)));
  }

  /// Makes lengths metres, and heights above the datum heights above the lowest ground at the object.
  void translate_heights(const MapSource& source, Feature& feature) {
    Notes notes(source.name, input_.findings);
    if (feature.faces.empty())
      for (const std::string& key : lengths_to_metres(feature.tags, source.height_unit_m))
        notes.add(Kind::left_out, "not_a_length", feature.id,
                  fmt::format("{} is '{}', which is no length.", key, printable(feature.tags[key])));
    if (!source.heights_above_datum || !feature.faces.empty()) return;
    double ground = std::numeric_limits<double>::infinity();
    for (const Polygon& polygon : feature.polygons)
      for (const dvec2& corner : polygon.outer)
        ground = std::min(ground, placement_->ground_height_m(corner));
    if (feature.point) ground = placement_->ground_height_m(*feature.point);
    if (!std::isfinite(ground)) return;
    for (const char* key : {"height", "min_height"}) {
      const auto tag = feature.tags.find(std::string_view(key));
      const auto height = tag != feature.tags.end() ? parse_length_m(tag->second) : std::nullopt;
      if (!height) continue;
      if (*height <= ground && std::string_view(key) == "height")
        notes.add(
            Kind::doubtful, "height_below_ground", feature.id,
            fmt::format("Its top is at {} m, the ground at {:.2f} m above the datum.", *height, ground));
      tag->second = number_text(*height - ground);
    }
  }

  void read_surface(const AreaTest& test) {
    if (config_.surface.empty()) return;
    auto samples = read_samples(config_.surface, config_.ground.margin_m + terrain_margin_m, "surface");
    input_.surface =
        join_samples(std::move(samples), placement_->frame(), test, false, "surface", input_.findings);
    report_cover(input_.surface, test, "surface");
  }

  void read_pictures(const AreaTest& test) {
    Spending spent(place_pictures);
    for (const PictureSource& source : config_.pictures) {
      say(fmt::format("Reading {}.", source.file.string()));
      PictureRead read =
          read_picture(source, widened(area_->box, config_.ground.margin_m), *placement_, spent);
      add_licence(source.name, source.licence, read.licence);
      if (!read.missing_grid.empty())
        Notes(source.name, input_.findings).add(Kind::doubtful, "datum_grid_missing", "", read.missing_grid);
      if (!read.outside_use.empty())
        Notes(source.name, input_.findings).add(Kind::doubtful, "crs_outside_its_area", "", read.outside_use);
      if (read.picture)
        input_.pictures.push_back(std::move(*read.picture));
      else
        Notes(source.name, input_.findings)
            .add(Kind::left_out, "picture_outside", "",
                 fmt::format("The picture covers {}, the area {}{}.", extent_text(read.extent),
                             extent_text(area_->box), swapped_hint(read.extent, area_->box)));
    }
    if (config_.pictures.empty()) return;
    const double share = covered_share(input_.pictures, test);
    if (share < 1.0)
      Notes("pictures", input_.findings)
          .add(Kind::doubtful, "pictures_do_not_cover", "",
               fmt::format("The pictures cover {:.1f} % of the area.", 100.0 * share));
  }

  const PlaceConfig& config_;
  const Progress& progress_;
  std::optional<DegreesArea> area_;
  std::vector<MapContents> maps_;
  std::vector<std::string> outside_;
  std::string height_extents_;  ///< for messages
  std::optional<Placement> placement_;
  PlaceInput input_;
};

}  // namespace

PlaceInput read_place(const PlaceConfig& config, const Progress& progress) {
  return PlaceReader(config, progress).read();
}

}  // namespace greatx::scene::place
