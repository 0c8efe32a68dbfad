// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses scene: the main file or generator, objects, radio materials.
#include <algorithm>
#include <array>
#include <set>

#include "core/text.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

/// The names of scene::semantic_class_names, which this library does not link. A test compares the two.
constexpr std::array semantic_classes = {"unlabeled",   "ground", "road",    "pavement",   "lane_marking",
                                         "building",    "roof",   "window",  "vegetation", "pole",
                                         "street_lamp", "mast",   "vehicle", "uav",        "water",
                                         "furniture",   "person"};

/// Returns the variants of a kind of the scene generator, the default first. Room scene/generator, which this
/// library does not link, has the same lists. A test compares them.
std::vector<std::string_view> variants_of(const std::string& kind) {
  if (kind == "car") return {"hatchback", "van"};
  if (kind == "city" || kind == "country") return {"summer", "spring", "autumn", "winter"};
  if (kind == "room") return {"bare", "office"};
  std::vector<std::string_view> names;
  for (const TrafficVariant& variant : traffic_variants())
    if (kind == generator_kind(variant.kind)) names.emplace_back(variant.name);
  return names.empty() ? std::vector<std::string_view>{"medium", "small", "large"} : names;
}

Generated parse_generated(const Field& field) {
  constexpr std::array kinds = {"city", "country", "canyon", "room",     "mast",
                                "car",  "vehicle", "person", "quadrotor"};
  enum { city, country, canyon, room, mast, car, vehicle, person, quadrotor };
  const size_t kind = kind_of(
      field, "kind", {"city", "country", "canyon", "room", "mast", "car", "vehicle", "person", "quadrotor"});
  Generated generated;
  generated.kind = kinds[kind];
  if (kind == city || kind == country || kind == canyon) {  // the others look the same for every seed
    const FieldMap map(
        field, kind == canyon ? Keys{"kind", "seed", "size_m"} : Keys{"kind", "seed", "size_m", "season"});
    if (const auto f = map.find("seed")) generated.seed = f->integer(0);
    if (const auto f = map.find("size_m"))
      generated.size_m = f->between(kind == canyon    ? 60.0
                                    : kind == country ? 160.0
                                                      : 100.0,
                                    kind == country ? 2000.0 : 1000.0);
    if (kind == canyon) return generated;
    const std::vector<std::string_view> seasons = variants_of(generated.kind);
    generated.variant = seasons.front();
    if (const auto f = map.find("season")) generated.variant = seasons[f->choice(seasons)];
    return generated;
  }
  if (kind == mast) {
    const FieldMap map(field, {"kind"});
    return generated;
  }
  const bool seeded = kind == vehicle || kind == person;  // the seed picks paint and clothes
  const FieldMap map(field, seeded ? Keys{"kind", "variant", "seed"} : Keys{"kind", "variant"});
  const std::vector<std::string_view> variants = variants_of(generated.kind);
  generated.variant = variants.front();
  if (const auto f = map.find("variant")) generated.variant = variants[f->choice(variants)];
  if (const auto f = map.find("seed")) generated.seed = f->integer(0);
  return generated;
}

/// Parses all but the position, which may need the georeference of the files of all objects.
StaticObject parse_object(const FieldMap& map) {
  StaticObject object;
  object.name = map.require("name", "a name").name();
  object.model = parse_model_source(map);
  if (const auto f = map.find("rotation_deg")) object.rotation = angles_of(*f);
  if (const auto f = map.find("scale")) object.scale = parse_scale(*f);
  if (const auto f = map.find("class")) object.semantic_class = parse_semantic_class(*f);
  return object;
}

/// Parses `objects` behind the scene's main file.
void parse_objects(const Field& field, SceneConfig& scene, std::vector<FieldMap>& maps) {
  std::set<std::string> names;
  for (const Field& item : field.list("objects")) {
    maps.emplace_back(item, Keys{"name", "file", "generate", "position_m", "position_deg", "heights",
                                 "rotation_deg", "scale", "class"});
    scene.objects.push_back(parse_object(maps.back()));
    const std::string& name = scene.objects.back().name;
    if (!names.insert(name).second) item.fail("every object's name once", fmt::format("a second '{}'", name));
  }
}

/// Returns the files among the objects. The last of them have `maps`.
std::vector<SceneFile> files_of(const SceneConfig& scene, const std::vector<FieldMap>& maps) {
  std::vector<SceneFile> files;
  const size_t first = scene.objects.size() - maps.size();
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const auto* const file = std::get_if<std::filesystem::path>(&scene.objects[i].model.source);
    if (!file) continue;
    bool in_place = true;
    if (i >= first)
      for (const char* key : {"position_m", "position_deg", "rotation_deg", "scale"})
        in_place = in_place && !maps[i - first].has(key);
    files.push_back({*file, scene.objects[i].model.where, in_place});
  }
  return files;
}

}  // namespace

size_t kind_of(const Field& field, std::string_view key, std::span<const std::string_view> choices) {
  std::string expected = "one of";
  for (const std::string_view choice : choices)
    expected += fmt::format("{} {}", choice == choices.front() ? "" : ",", choice);
  for (const auto& [name, value] : field.entries())
    if (name == key) return value.choice(choices);
  throw_user_error_at(field.where(), "{}.{}: expected {}, found nothing", field.path(), key, expected);
}

std::string parse_semantic_class(const Field& field) {
  const std::string name = field.text();
  if (std::find(semantic_classes.begin(), semantic_classes.end(), name) == semantic_classes.end())
    field.fail(
        fmt::format("a semantic class ({})", fmt::join(semantic_classes, ", ")),
        fmt::format("'{}'{}", name, suggestion(name, {semantic_classes.begin(), semantic_classes.end()})));
  return name;
}

dvec3 parse_scale(const Field& field) {
  constexpr double least = 1e-6, most = 1e6;
  const dvec3 scale = field.is_scalar() ? dvec3(field.number(most)) : field.vector3(most);
  if (scale.x == 0.0 || scale.y == 0.0 || scale.z == 0.0)
    field.fail("scale factors other than 0", fmt::format("[{}, {}, {}]", scale.x, scale.y, scale.z));
  if (glm::any(glm::lessThan(glm::abs(scale), dvec3(least))))
    field.fail(fmt::format("scale factors of a magnitude of {:g} or more", least),
               fmt::format("[{}, {}, {}]", scale.x, scale.y, scale.z));
  return scale;
}

ModelSource parse_model_source(const FieldMap& map) {
  map.exclude("file", "generate");
  ModelSource model;
  if (const auto f = map.find("generate")) {
    model.source = parse_generated(*f);
    model.where = f->where();
    return model;
  }
  const Field file = map.require("file", "a glTF file (or 'generate')");
  model.source = file.file();
  model.where = file.where();
  return model;
}

SceneConfig parse_scene(const Field& field) {
  const FieldMap map(field, {"file", "generate", "objects", "radio_materials", "optical_only", "origin_m",
                             "georeference", "heights"});
  SceneConfig scene;
  if (map.has("file") || map.has("generate")) {
    StaticObject whole;  // instances keep the names of the file, without a prefix
    whole.model = parse_model_source(map);
    scene.objects.push_back(std::move(whole));
  }
  std::vector<FieldMap> maps;
  if (const auto objects = map.find("objects")) parse_objects(*objects, scene, maps);
  if (const auto f = map.find("heights")) scene.heights = heights_of(*f);
  scene.georeference = parse_georeference(map, files_of(scene, maps));
  const EarthPositions earth(scene);
  const size_t first = scene.objects.size() - maps.size();
  for (size_t i = 0; i < maps.size(); ++i)
    if (const auto position = find_position(maps[i], with_heights_of(maps[i], earth)))
      scene.objects[first + i].position_m = *position;
  if (const auto f = map.find("radio_materials")) scene.radio_materials = f->file();
  if (const auto f = map.find("optical_only")) scene.optical_only = f->boolean();
  if (const auto f = map.find("origin_m")) scene.origin_m = position_of(*f);
  return scene;
}

}  // namespace greatx::sim
