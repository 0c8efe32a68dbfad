// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/generate.h"

#include <algorithm>
#include <cmath>

#include <fmt/ranges.h>

#include "core/error.h"
#include "core/expected.h"
#include "scene/generator/canyon.h"
#include "scene/generator/city/city.h"
#include "scene/generator/country/country.h"
#include "scene/generator/objects/objects.h"
#include "scene/generator/objects/people.h"
#include "scene/generator/objects/vehicles.h"
#include "scene/generator/office.h"

namespace greatx::scene {

namespace {

using namespace generator;

struct Kind {
  const char* name;
  const char* words;
  double min_size_m, max_size_m;  ///< both 0: the kind has no size
  std::vector<std::string> variants;
  bool seeded = false;  ///< has a seed, but no size
  const char* variant_word = "variant";
};

template <typename Shape>
std::vector<std::string> variants_of(const std::vector<Shape>& shapes) {
  std::vector<std::string> names;
  for (const Shape& shape : shapes) names.push_back(shape.variant);
  return names;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> list{
      {"city", "a part of a city: streets, buildings, park, trees, lamps, parked cars", 100, 1000,
       season_names(), true, "season"},
      {"country", "hills, a winding road, fields, hedges, farms, woods", 160, 2000, season_names(), true,
       "season"},
      {"canyon", "a street between two rows of houses", 60, 1000, {}},
      {"room", "a closed room of 12 x 8 x 3.2 m, lit by its lamps", 0, 0, {"bare", "office"}},
      {"mast", "a base-station mast of 24.6 m", 0, 0, {}},
      {"car", "a car or a van", 0, 0, {"hatchback", "van"}},
      {"vehicle", "a vehicle with wheels that turn", 0, 0, variants_of(vehicle_shapes()), true},
      {"person", "a person with limbs that move", 0, 0, variants_of(person_shapes()), true},
      {"quadrotor", "a drone with four rotors", 0, 0, {"medium", "small", "large"}}};
  return list;
}

const Kind& find_kind(const std::string& name) {
  for (const Kind& kind : kinds())
    if (name == kind.name) return kind;
  throw_user_error("scene generator: kind: {}", expected_one_of(generator_kinds(), name));
}

std::string checked_variant(const Kind& kind, const std::string& variant) {
  if (variant.empty()) return kind.variants.empty() ? "" : kind.variants.front();
  if (kind.variants.empty())
    throw_user_error("scene generator: variant: \"{}\" has none, found \"{}\"", kind.name, variant);
  if (std::find(kind.variants.begin(), kind.variants.end(), variant) == kind.variants.end())
    throw_user_error("scene generator: {} of {}: {}", kind.variant_word, kind.name,
                     expected_one_of(kind.variants, variant));
  return variant;
}

/// Returns the season of this name, or summer if there is none.
Season season_of(const std::string& name) {
  const auto found = std::ranges::find(season_names(), name);
  return found == season_names().end() ? Season::summer : static_cast<Season>(found - season_names().begin());
}

void write_quadrotor(SceneWriter& writer, const std::string& variant) {
  const double diagonal = variant == "small" ? 0.35 : variant == "medium" ? 0.9 : 2.2;
  const Quadrotor parts = make_quadrotor(diagonal);
  const int body = writer.add_node({.name = "quadrotor",
                                    .mesh = writer.add_mesh("quadrotor_body", parts.body),
                                    .semantic_class = SemanticClass::uav});
  const int rotor = writer.add_mesh("rotor", parts.rotor);
  for (size_t i = 0; i < parts.rotor_centers.size(); ++i)
    writer.add_node({.name = fmt::format("rotor_{}", i),
                     .mesh = rotor,
                     .position = parts.rotor_centers[i],
                     .yaw = 0.5 + 0.7 * static_cast<double>(i),
                     .semantic_class = SemanticClass::uav,
                     .parent = body});
}

}  // namespace

std::vector<std::string> generator_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds()) names.emplace_back(kind.name);
  return names;
}

std::vector<GeneratorKind> generators() {
  std::vector<GeneratorKind> list;
  for (const Kind& kind : kinds())
    list.push_back({kind.name, kind.words, kind.min_size_m, kind.max_size_m,
                    kind.seeded || kind.max_size_m > 0, kind.variant_word});
  return list;
}

std::vector<std::string> generator_variants(const std::string& kind) { return find_kind(kind).variants; }

std::vector<std::byte> generate_glb(const GenerateOptions& options) {
  const Kind& kind = find_kind(options.kind);
  const std::string variant = checked_variant(kind, options.variant);
  const double size = options.size_m;
  if (kind.max_size_m > 0 && !(size >= kind.min_size_m && size <= kind.max_size_m))
    throw_user_error("scene generator: size of \"{}\": expected {} to {} m, found {}", kind.name,
                     kind.min_size_m, kind.max_size_m, size);
  const Season season = season_of(variant);
  SceneWriter writer(seasonal_library(season));
  writer.set_quick(options.quick);
  if (options.kind == "city") {
    write_city(writer, size, options.seed, season);
  } else if (options.kind == "country") {
    write_country(writer, size, options.seed, season);
  } else if (options.kind == "canyon") {
    write_canyon(writer, size, options.seed);
  } else if (options.kind == "room") {
    write_room(writer);
    if (variant == "office") add_furniture(writer);
  } else if (options.kind == "quadrotor") {
    write_quadrotor(writer, variant);
  } else if (options.kind == "car") {
    write_car(writer, variant);
  } else if (options.kind == "vehicle") {
    write_vehicle(writer, variant, options.seed);
  } else if (options.kind == "person") {
    write_person(writer, variant, options.seed);
  } else {
    writer.add_node({.name = "mast",
                     .mesh = writer.add_mesh("mast", make_mast()),
                     .semantic_class = SemanticClass::mast});
  }
  const bool plain = variant.empty() || variant == "bare" || variant == "summer";
  return writer.finish(plain ? options.kind : options.kind + "_" + variant);
}

}  // namespace greatx::scene
