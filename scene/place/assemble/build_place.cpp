// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/assemble/build_place.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/units.h"
#include "scene/generator/mesh/scene_writer.h"
#include "scene/generator/objects/objects.h"
#include "scene/generator/objects/street_furniture.h"
#include "scene/generator/objects/trees.h"
#include "scene/georeference/georeference.h"
#include "scene/place/assemble/bands.h"
#include "scene/place/assemble/building_mesh.h"
#include "scene/place/assemble/picture_cover.h"
#include "scene/place/assemble/street_network.h"
#include "scene/place/buildings/complex.h"
#include "scene/place/buildings/make_buildings.h"
#include "scene/place/ground/bridges.h"
#include "scene/place/ground/terrain.h"

namespace greatx::scene::place {

namespace {

using generator::MeshBuilder;
using generator::NodeSpec;
using generator::SceneWriter;

constexpr uint32_t most_picture_px = 4096;
constexpr double least_detail_m = 0.01;  // corners that bend a wall by less make slivers alone

/// Returns a text as a member of a JSON object, "key":"text".
std::string member(const char* key, const std::string& text) {
  return fmt::format("\"{}\":{}", key,
                     nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

SemanticClass class_of(Cover cover) {
  switch (cover) {
    case Cover::road:
    case Cover::parking:
      return SemanticClass::road;
    case Cover::path:
    case Cover::square:
      return SemanticClass::pavement;
    case Cover::water:
      return SemanticClass::water;
    default:
      return SemanticClass::ground;
  }
}

class Assembly {
 public:
  Assembly(const PlaceInput& input, const PlaceConfig& config, const PlaceProgress& progress)
      : input_(input), config_(config), progress_(progress), level_(input.terrain) {}

  BuiltPlace run() {
    PlaceReport& report = out_.report;
    report.name = config_.name;
    report.reference = input_.reference;
    report.findings = input_.findings;
    report.licences = input_.licences;
    if (!config_.materials.empty()) table_.read(config_.materials);
    pictures_.emplace(input_.pictures, most_picture_px, report.findings);
    say("buildings", 0.05);
    make_solids();
    say("ground", 0.4);
    make_ground();
    say("objects", 0.7);
    find_all_objects();
    say("writing", 0.8);
    write();
    report.ground_filled = level_.filled();
    report.materials = table_.listing();
    say("done", 1.0);
    return std::move(out_);
  }

 private:
  void say(const char* step, double share) const {
    if (progress_) progress_(step, share);
  }

  void make_solids() {
    PlaceReport& report = out_.report;
    out_.buildings = make_buildings(
        input_, config_.buildings, [this](const dvec2& p) { return level_(p); }, report.findings);
    // Foundations reach below the ground's mesh, which is off by its bound.
    complex_ = make_complex(out_.buildings,
                            {std::max(0.5, 2.0 * config_.ground.error_m), config_.buildings.weld_m,
                             std::max(least_detail_m, config_.simplify_m)},
                            report.findings);
    report.most_welded_m = complex_.most_welded_m;
    report.most_moved_m = complex_.most_moved_m;
    for (size_t i = 0; i < out_.buildings.size(); ++i) {
      const Building& building = out_.buildings[i];
      report.source_area_m2 += building.plan_area_m2;
      report.source_volume_m3 += building.plan_volume_m3;
      report.built_area_m2 += complex_.built_area_m2[i];
      if (complex_.built_area_m2[i] <= 0.0) {
        report.findings.push_back({Finding::Kind::left_out, "within_another", label(building),
                                   "all of it lies within a higher building"});
        continue;
      }
      ++report.buildings;
      report.parts += building.parts.size();
      for (const Part& part : building.parts)
        for (const Polygon& polygon : part.area) report.courts += polygon.holes.size();
      constexpr std::array<const char*, 5> sources{"tag height", "storeys", "solid", "surface model",
                                                   "assumed"};
      ++report.heights[sources[static_cast<size_t>(building.height_from)]];
    }
    measure_volume();
  }

  /// Volume above the lowest ground of each building, from its faces (divergence theorem).
  void measure_volume() {
    const auto column = [&](const std::array<dvec3, 3>& t, double low) {
      const dvec2 a(t[1] - t[0]), b(t[2] - t[0]);
      return 0.5 * (a.x * b.y - a.y * b.x) * (std::max({0.0, (t[0].z + t[1].z + t[2].z) / 3.0 - low}));
    };
    for (const FlatFace& face : complex_.flats) {
      const double volume = column(face.corners, out_.buildings[face.building].ground_z);
      // A slab is the roof of one building and the floor of the other one.
      out_.report.built_volume_m3 += volume;
      if (face.neighbour != no_building)
        out_.report.built_volume_m3 -= column(face.corners, out_.buildings[face.neighbour].ground_z);
    }
  }

  void make_ground() {
    out_.ground = ground_plan(input_, config_.ground, out_.report.findings);
    streets_unknown_ =
        !out_.buildings.empty() &&
        std::none_of(out_.ground.areas.begin(), out_.ground.areas.end(), [](const GroundArea& area) {
          return area.cover == Cover::road || area.cover == Cover::path || area.cover == Cover::square;
        });
    if (streets_unknown_)
      out_.report.findings.push_back(
          {Finding::Kind::assumed, "streets_unknown", config_.name,
           "no source has roads: the ground where nothing is said is asphalt, as among houses"});
    Box& box = out_.report.rectangle;
    box = box_of(input_.area);
    for (const Building& building : out_.buildings)
      for (const Part& part : building.parts) box.add(box_of(part.area));
    if (box.empty())
      throw_user_error("{}: nothing to build: no area and no buildings", config_.file.string());
    box = box.grown(config_.ground.margin_m);
    box = {glm::floor(box.low), glm::ceil(box.high)};
    // The borders of pictures divide the mesh, and do not change what covers the ground.
    std::vector<GroundArea> areas = out_.ground.areas;
    for (const Ring& border : pictures_->borders()) {
      const Polygon polygon{border, {}};
      areas.push_back({Cover::base, {polygon}, box_of(polygon)});
    }
    terrain_.emplace(make_terrain(input_.terrain, level_, areas, {box, config_.ground.error_m}));
    out_.report.terrain_error_m = terrain_->largest_error_m;
    out_.report.terrain_samples = terrain_->samples;
  }

  void find_all_objects() {
    const Box& box = out_.report.rectangle;
    const CoverMap covers(out_.ground.areas, box);
    std::vector<GroundArea> footprints;
    for (const Building& building : out_.buildings) {
      GroundArea area{Cover::road, {}, {}};
      for (const Part& part : building.parts)
        area.polygons.insert(area.polygons.end(), part.area.begin(), part.area.end());
      area.box = box_of(area.polygons);
      footprints.push_back(std::move(area));
    }
    const CoverMap built(footprints, box);
    objects_ = find_objects(
        input_, config_.vegetation, out_.ground, covers, box,
        [&](const dvec2& p) { return built.at(p) != Cover::base; },
        [&](const dvec2& p) { return terrain_->height_at(p); }, out_.report.findings);
    streets_ = place_streets(
        input_, out_.ground, box, [&](const dvec2& p) { return terrain_->height_at(p); },
        [&](const dvec2& p) { return built.at(p) != Cover::base; });
  }

  void write() {
    const std::vector<PlaceMesh> houses =
        building_meshes(out_.buildings, complex_, config_.buildings, *pictures_, table_);
    std::vector<std::pair<std::string, PlaceMesh>> ground = ground_meshes();
    const std::vector<PlaceMesh> decks = deck_meshes();
    const std::vector<PlaceMesh> hedges = hedge_meshes();
    SceneWriter writer(table_.materials(), pictures_->textures(), "greatx scene build");
    for (const auto& [name, mesh] : ground) add(writer, name, mesh, ground_class_.at(name), "", "ground");
    for (size_t i = 0; i < houses.size(); ++i) {
      const Building& building = out_.buildings[i];
      if (houses[i].empty()) continue;
      add(writer, "building_" + building.id, houses[i], SemanticClass::building,
          member("source", building.source) + "," + member("source_id", building.id), "buildings");
    }
    for (size_t i = 0; i < decks.size(); ++i)
      if (!decks[i].empty())
        add(writer, "bridge_" + out_.ground.bridges[i].id, decks[i], class_of(out_.ground.bridges[i].cover),
            member("source", out_.ground.bridges[i].source) + "," +
                member("source_id", out_.ground.bridges[i].id),
            "ground");
    for (size_t i = 0; i < hedges.size(); ++i)
      if (!hedges[i].empty())
        add(writer, "hedge_" + objects_.hedges[i].id, hedges[i], SemanticClass::vegetation,
            member("source", objects_.hedges[i].source) + "," + member("source_id", objects_.hedges[i].id),
            "objects");
    write_objects(writer);
    out_.glb = writer.finish(config_.name, extras());
  }

  /// Where the place lies on the Earth, and its streets if there are any.
  std::string extras() const {
    std::string json = georeference_extras(input_.reference);
    if (streets_.lanes.empty() && streets_.walks.empty()) return json;
    json.pop_back();  // of its closing brace
    return fmt::format(R"({},"{}":{}}})", json, street_network_key, street_network_json(streets_));
  }

  /// Returns a name that no other node has.
  std::string unique(std::string name) {
    for (char& c : name)
      if (c == '/' || c == ' ') c = '_';
    const std::string base = name;
    for (int number = 2; !names_.insert(name).second; ++number) name = fmt::format("{}_{}", base, number);
    return name;
  }

  void add(SceneWriter& writer, const std::string& name, const PlaceMesh& mesh, SemanticClass semantic_class,
           const std::string& extras, const char* kind) {
    const std::string own = unique(name);
    NodeSpec node;
    node.name = own;
    node.mesh = writer.add_mesh(own, mesh.primitives());
    node.position = mesh.anchor();
    node.semantic_class = semantic_class;
    node.extras = extras;
    writer.add_node(node);
    count(kind, mesh.triangle_count());
  }
  void count(const char* kind, size_t triangles) {
    out_.report.triangles += triangles;
    out_.report.triangles_by_kind[kind] += triangles;
  }

  /// One mesh for each semantic class, about the middle of the rectangle.
  std::vector<std::pair<std::string, PlaceMesh>> ground_meshes() {
    const Box& box = out_.report.rectangle;
    const dvec3 anchor(glm::floor(0.5 * (box.low + box.high)), 0.0);
    std::map<SemanticClass, PlaceMesh> meshes;
    // Normals are smooth, as the terrain is.
    std::vector<dvec3> normals(terrain_->heights.size(), dvec3(0.0));
    const auto& triangles = terrain_->plan.triangles();
    for (const auto& triangle : triangles) {
      const auto& c = triangle.corners;
      const dvec3 a = terrain_->point(c[0]);
      const dvec3 normal = glm::cross(terrain_->point(c[1]) - a, terrain_->point(c[2]) - a);
      for (const uint32_t corner : c) normals[corner] += normal;
    }
    for (dvec3& normal : normals) normal = glm::normalize(normal);
    for (size_t t = 0; t < triangles.size(); ++t) {
      const auto& c = triangles[t].corners;
      const std::array<dvec3, 3> corners{terrain_->point(c[0]), terrain_->point(c[1]), terrain_->point(c[2])};
      const Cover cover = terrain_->covers[t];
      int material =
          table_.of(cover == Cover::base && streets_unknown_ ? "ground/base_built"
                                                             : std::string("ground/") + name_of(cover));
      const auto picture = pictures_->over(dvec2(corners[0]), dvec2(corners[1]), dvec2(corners[2]));
      if (picture) material = table_.pictured(material, pictures_->name(*picture), *picture);
      std::array<dvec2, 3> uvs;
      const dvec2 tile = table_[material].tile_m;
      for (size_t i = 0; i < 3; ++i)
        uvs[i] = picture ? pictures_->uv(*picture, dvec2(corners[i]))
                         : dvec2(corners[i].x - anchor.x, -(corners[i].y - anchor.y)) / tile;
      meshes.try_emplace(class_of(cover), anchor)
          .first->second.triangle(material, corners, {normals[c[0]], normals[c[1]], normals[c[2]]}, uvs);
      const dvec2 u(corners[1] - corners[0]), v(corners[2] - corners[0]);
      out_.report.cover_m2[name_of(cover)] += 0.5 * (u.x * v.y - u.y * v.x);
    }
    std::vector<std::pair<std::string, PlaceMesh>> result;
    for (auto& [semantic_class, mesh] : meshes) {
      const std::string name = fmt::format("ground_{}", greatx::scene::name_of(semantic_class));
      ground_class_[name] = semantic_class;
      result.emplace_back(name, std::move(mesh));
    }
    return result;
  }

  std::vector<PlaceMesh> deck_meshes() {
    std::vector<PlaceMesh> meshes;
    for (const Bridge& bridge : out_.ground.bridges) {
      const std::string object = object_label(bridge.source, bridge.id);
      const Deck deck = make_deck(bridge, level_);
      const bool whole = deck.sections.size() >= 2 &&
                         out_.report.rectangle.holds(deck.sections.front().left) &&
                         out_.report.rectangle.holds(deck.sections.back().left);
      if (!whole) {
        out_.report.findings.push_back({Finding::Kind::left_out, "bridge_leaves_area", object,
                                        "one of its ends lies outside the ground, so its height is unknown"});
        meshes.emplace_back();
        continue;
      }
      if (deck.lift_m > 0.0)
        out_.report.findings.push_back(
            {Finding::Kind::assumed, "bridge_raised", object,
             fmt::format("layer {}: its middle was raised by {:.1f} m, for 5 m of clearance per layer",
                         bridge.layer, deck.lift_m)});
      meshes.push_back(band_mesh(deck, table_.of(std::string("ground/") + name_of(bridge.cover)),
                                 table_.of("bridge"), table_));
    }
    return meshes;
  }

  std::vector<PlaceMesh> hedge_meshes() {
    std::vector<PlaceMesh> meshes;
    const int leaves = generator::material("hedge");
    for (const Hedge& hedge : objects_.hedges)
      meshes.push_back(band_mesh(hedge_band(hedge, [&](const dvec2& p) { return terrain_->height_at(p); }),
                                 leaves, leaves, table_));
    return meshes;
  }

  void write_objects(SceneWriter& writer) {
    struct Made {
      int mesh = -1, light = -1;
      dvec3 light_position{0.0};
      double height_m = 1.0;
      size_t triangles = 0;
    };
    std::map<std::array<int, 3>, Made> made;
    const auto make = [&](const PlacedObject& object) -> const Made& {
      const auto [found, is_new] =
          made.try_emplace({static_cast<int>(object.kind), object.variant, object.shape});
      Made& entry = found->second;
      if (!is_new) return entry;
      MeshBuilder mesh;
      switch (object.kind) {
        case ObjectKind::tree:
          mesh = generator::make_tree(object.variant, object.shape);
          break;
        case ObjectKind::conifer:
          mesh = generator::make_conifer();
          break;
        case ObjectKind::signal:
          mesh = generator::make_signal();
          break;
        case ObjectKind::mast:
          mesh = generator::make_mast();
          break;
        case ObjectKind::bench:
          mesh = generator::make_bench();
          break;
        case ObjectKind::bin:
          mesh = generator::make_bin();
          break;
        case ObjectKind::lamp: {
          generator::Lamp lamp = generator::make_lamp(generator::LampKind::street);
          entry.light = writer.add_light(lamp.light);
          entry.light_position = lamp.light_position;
          mesh = std::move(lamp.mesh);
          break;
        }
      }
      for (const generator::PrimitiveData& data : mesh.primitives()) {
        for (const vec3& p : data.positions) entry.height_m = std::max(entry.height_m, double{p.z});
        entry.triangles += data.indices.size() / 3;
      }
      entry.mesh = writer.add_mesh(
          unique(fmt::format("{}_{}_{}", name_of(object.kind), object.variant, object.shape)), mesh);
      return entry;
    };
    constexpr std::array<SemanticClass, object_kinds> classes{
        SemanticClass::vegetation, SemanticClass::vegetation, SemanticClass::street_lamp, SemanticClass::pole,
        SemanticClass::mast,       SemanticClass::furniture,  SemanticClass::furniture};
    for (const PlacedObject& object : objects_.objects) {
      const Made& entry = make(object);
      NodeSpec node;
      node.name = unique(object.id.empty() ? fmt::format("{}_{:.0f}_{:.0f}", name_of(object.kind),
                                                         object.foot.x * 10.0, object.foot.y * 10.0)
                                           : fmt::format("{}_{}", name_of(object.kind), object.id));
      node.mesh = entry.mesh;
      node.position = object.foot;
      node.yaw = object.yaw;
      if (object.height_m > 0.0) node.scale = object.height_m / entry.height_m;
      node.semantic_class = classes[static_cast<size_t>(object.kind)];
      if (!object.id.empty())
        node.extras = member("source", object.source) + "," + member("source_id", object.id);
      const int index = writer.add_node(node);
      if (entry.light >= 0) {
        NodeSpec light;
        light.name = node.name + "_light";
        light.position = entry.light_position;
        light.parent = index;
        light.light = entry.light;
        light.shine = dvec3(0.0, 0.0, -1.0);
        writer.add_node(light);
      }
      ++out_.report.objects[name_of(object.kind)];
      count("objects", entry.triangles);
    }
  }

  const PlaceInput& input_;
  const PlaceConfig& config_;
  const PlaceProgress& progress_;
  GroundLevel level_;
  MaterialTable table_;
  std::optional<PictureCover> pictures_;
  Complex complex_;
  std::optional<TerrainMesh> terrain_;
  ObjectPlan objects_;
  StreetNetwork streets_;
  bool streets_unknown_ = false;
  std::set<std::string> names_;
  std::map<std::string, SemanticClass> ground_class_;
  BuiltPlace out_;
};

}  // namespace

BuiltPlace build_place(const PlaceInput& input, const PlaceConfig& config, const PlaceProgress& progress) {
  return Assembly(input, config, progress).run();
}

}  // namespace greatx::scene::place
