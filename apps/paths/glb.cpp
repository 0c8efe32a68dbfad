// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/paths/glb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/srgb.h"
#include "io/formats/glb_writer.h"

namespace greatx::apps {

namespace {

using Json = nlohmann::ordered_json;

Json triple(const dvec3& v) { return Json::array({v.x, v.y, v.z}); }

/// Converts a screen colour, which is sRGB (IEC 61966-2-1), to a vertex colour, which is linear in glTF.
vec3 linear(io::Color color) {
  const auto channel = [](uint8_t byte) { return linear_from_srgb(byte / 255.0f); };
  return {channel(color.r), channel(color.g), channel(color.b)};
}

/// Adds an octahedron to the triangles of `markers`.
void add_marker(io::GlbPrimitive& markers, const dvec3& center, double radius, const vec3& color) {
  const auto first = static_cast<uint32_t>(markers.positions.size());
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      dvec3 corner = center;
      corner[axis] += sign * radius;
      markers.positions.push_back(vec3(corner));
      markers.colors.push_back(color);
    }
  // Corners +x, -x, +y, -y, +z, -z; counter-clockwise from outside.
  constexpr uint32_t faces[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (const auto& face : faces)
    for (const uint32_t corner : face) markers.indices.push_back(first + corner);
}

class Exporter {
 public:
  Exporter(const PathScene& scene, const PathGlbOptions& options) : scene_(scene), options_(options) {
    lines_ = writer_.add_material({.name = "paths", .unlit = true});
    markers_ = writer_.add_material({.name = "markers", .unlit = true, .double_sided = true});
  }
  void links(std::span<const PathLink> links);
  void scene();
  io::Bytes finish();

 private:
  void link(const PathLink& link, int root);
  void path(const rf::Path& path, size_t number, int parent);
  void end(const std::string& name, const dvec3& world, const vec3& color);
  int instance_mesh(uint32_t instance, const std::vector<uint32_t>& primitives);
  int scene_material(uint32_t material);

  const PathScene& scene_;
  const PathGlbOptions& options_;
  GainScale scale_;
  io::GlbWriter writer_;
  int lines_ = -1, markers_ = -1;
  std::map<uint32_t, int> scene_materials_;
};

void Exporter::links(std::span<const PathLink> links) {
  scale_ = gain_scale(links, scene_.carrier_hz);
  const int root = writer_.add_node({.name = "paths",
                                     .extras_json = Json{{"carrier_hz", scene_.carrier_hz},
                                                         {"tick", options_.tick},
                                                         {"time_s", options_.time_s},
                                                         {"local_origin_m", triple(scene_.scene->origin)}}
                                                        .dump()});
  for (const PathLink& each : links) link(each, root);
  if (!links.empty()) end("transmitter", links[0].transmitter_m, linear({255, 92, 92}));
  for (const PathLink& each : links) end(each.name, each.receiver_m, linear({96, 200, 255}));
}

void Exporter::link(const PathLink& link, int root) {
  const LinkFigures figures = figures_of(link, scene_.carrier_hz);
  Json extras{{"index", link.index},
              {"position_m", triple(link.receiver_m)},
              {"distance_m", link.distance_m},
              {"paths", figures.paths},
              {"line_of_sight", figures.line_of_sight}};
  if (figures.gain > 0.0) extras["gain_db"] = gain_db(figures.gain);
  if (figures.delay_spread_s) extras["delay_spread_s"] = *figures.delay_spread_s;
  const int parent =
      writer_.add_node({.name = "paths to " + link.name, .parent = root, .extras_json = extras.dump()});
  for (size_t i = 0; i < link.paths.size(); ++i) path(link.paths[i], i + 1, parent);
}

void Exporter::path(const rf::Path& path, size_t number, int parent) {
  const double path_gain_db = gain_db(path_gain(path, scene_.carrier_hz));
  const vec3 color = linear(options_.colors == PathColors::gain ? color_of_gain(scale_, path_gain_db)
                                                                : color_of_kind(kind_of(path)));
  io::GlbPrimitive lines, markers;
  lines.mode = io::GlbPrimitive::Mode::lines;
  lines.material = lines_;
  markers.material = markers_;
  for (size_t i = 0; i < path.vertices.size(); ++i) {
    lines.positions.push_back(vec3(path.vertices[i]));
    lines.colors.push_back(color);
    if (i + 1 < path.vertices.size())
      for (const size_t end : {i, i + 1}) lines.indices.push_back(static_cast<uint32_t>(end));
  }
  for (size_t i = 0; i < path.interactions.size(); ++i)
    add_marker(markers, path.vertices[i + 1], options_.marker_m,
               linear(color_of_kind(path.interactions[i].type)));

  const std::string name = fmt::format("path {} {} {}", number, chain_of(path), id_text(path.id()));
  std::vector<io::GlbPrimitive> primitives{std::move(lines)};
  if (!markers.positions.empty()) primitives.push_back(std::move(markers));
  Json extras{{"id", id_text(path.id())},
              {"chain", chain_of(path)},
              {"interactions", describe_interactions(path, scene_)},
              {"length_m", path.length_m},
              {"delay_s", path.delay_s},
              {"doppler_hz", path.doppler_hz}};
  if (std::isfinite(path_gain_db)) extras["gain_db"] = path_gain_db;
  writer_.add_node({.name = name,
                    .mesh = writer_.add_mesh(name, primitives),
                    .parent = parent,
                    .extras_json = extras.dump()});
}

void Exporter::end(const std::string& name, const dvec3& world, const vec3& color) {
  io::GlbPrimitive marker;
  marker.material = markers_;
  add_marker(marker, dvec3(0.0), 2.0 * options_.marker_m, color);
  writer_.add_node({.name = name,
                    .mesh = writer_.add_mesh(name, {marker}),
                    .pose = {world - scene_.scene->origin, dquat(1.0, 0.0, 0.0, 0.0)}});
}

int Exporter::scene_material(uint32_t material) {
  const auto found = scene_materials_.find(material);
  if (found != scene_materials_.end()) return found->second;
  const scene::Material& source = scene_.scene->materials[material];
  const int index = writer_.add_material({.name = source.name,
                                          .base_color = dvec3(source.pbr.base_color),
                                          .metallic = source.pbr.metallic,
                                          .roughness = source.pbr.roughness,
                                          .double_sided = source.pbr.double_sided});
  return scene_materials_[material] = index;
}

int Exporter::instance_mesh(uint32_t instance, const std::vector<uint32_t>& primitives) {
  const scene::Scene& scene = *scene_.scene;
  std::vector<io::GlbPrimitive> parts;
  for (const uint32_t index : primitives) {
    const scene::Primitive& source = scene.primitives[index];
    if (source.index_count == 0) continue;
    io::GlbPrimitive part;
    part.material = scene_material(source.material);
    std::map<uint32_t, uint32_t> places;  // index of a vertex in the scene -> its index in the part
    for (uint32_t i = 0; i < source.index_count; ++i) {
      const uint32_t vertex = scene.indices[source.first_index + i];
      const auto [place, added] = places.emplace(vertex, static_cast<uint32_t>(part.positions.size()));
      if (added) {
        part.positions.push_back(scene.positions[vertex]);
        part.normals.push_back(scene.normals[vertex]);
      }
      part.indices.push_back(place->second);
    }
    parts.push_back(std::move(part));
  }
  return parts.empty() ? -1 : writer_.add_mesh(scene.instances[instance].name, parts);
}

void Exporter::scene() {
  const scene::Scene& scene = *scene_.scene;
  GREATX_CHECK(options_.bodies.size() == scene.bodies.size(), "{} poses of {} bodies", options_.bodies.size(),
               scene.bodies.size());
  std::vector<std::vector<uint32_t>> primitives(scene.instances.size());
  for (uint32_t i = 0; i < scene.primitives.size(); ++i)
    primitives[scene.primitives[i].instance].push_back(i);
  const int root = writer_.add_node({.name = "scene"});
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const int mesh = instance_mesh(i, primitives[i]);
    if (mesh < 0) continue;
    writer_.add_node({.name = scene.instances[i].name,
                      .mesh = mesh,
                      .parent = root,
                      .pose = options_.bodies[scene.instances[i].body]});
  }
}

io::Bytes Exporter::finish() {
  return writer_.finish(options_.name, Json{{"local_origin_m", triple(scene_.scene->origin)},
                                            {"tick", options_.tick},
                                            {"time_s", options_.time_s}}
                                           .dump());
}

}  // namespace

io::Bytes paths_glb(std::span<const PathLink> links, const PathScene& scene, const PathGlbOptions& options) {
  Exporter exporter(scene, options);
  exporter.links(links);
  if (!options.bodies.empty()) exporter.scene();
  return exporter.finish();
}

}  // namespace greatx::apps
