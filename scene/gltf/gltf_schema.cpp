// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_schema.h"

#include <algorithm>
#include <string_view>

#include <climits>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace greatx::scene {
namespace {

using nlohmann::json;

enum class Kind { index, size, number, boolean, text, object, numbers, indices, index_map };

/// Gives the place of a field ('/' between members, '*' for every element of a list) and the kind that it
/// must have.
struct Rule {
  std::string_view path;
  Kind kind;
};

constexpr Rule rules[] = {
    {"scene", Kind::index},
    {"scenes/*", Kind::object},
    {"scenes/*/nodes", Kind::indices},
    {"nodes/*", Kind::object},
    {"nodes/*/name", Kind::text},
    {"nodes/*/mesh", Kind::index},
    {"nodes/*/skin", Kind::index},
    {"nodes/*/children", Kind::indices},
    {"nodes/*/matrix", Kind::numbers},
    {"nodes/*/translation", Kind::numbers},
    {"nodes/*/rotation", Kind::numbers},
    {"nodes/*/scale", Kind::numbers},
    {"nodes/*/extensions/KHR_lights_punctual/light", Kind::index},
    {"meshes/*", Kind::object},
    {"meshes/*/name", Kind::text},
    {"meshes/*/primitives/*", Kind::object},
    {"meshes/*/primitives/*/attributes", Kind::index_map},
    {"meshes/*/primitives/*/indices", Kind::index},
    {"meshes/*/primitives/*/material", Kind::index},
    {"meshes/*/primitives/*/mode", Kind::index},
    {"accessors/*", Kind::object},
    {"accessors/*/bufferView", Kind::index},
    {"accessors/*/byteOffset", Kind::size},
    {"accessors/*/componentType", Kind::index},
    {"accessors/*/count", Kind::size},
    {"accessors/*/normalized", Kind::boolean},
    {"accessors/*/type", Kind::text},
    {"accessors/*/sparse/count", Kind::index},
    {"accessors/*/sparse/indices/bufferView", Kind::index},
    {"accessors/*/sparse/indices/byteOffset", Kind::index},
    {"accessors/*/sparse/indices/componentType", Kind::index},
    {"accessors/*/sparse/values/bufferView", Kind::index},
    {"accessors/*/sparse/values/byteOffset", Kind::index},
    {"bufferViews/*", Kind::object},
    {"bufferViews/*/buffer", Kind::index},
    {"bufferViews/*/byteOffset", Kind::size},
    {"bufferViews/*/byteLength", Kind::size},
    {"bufferViews/*/byteStride", Kind::index},
    {"buffers/*", Kind::object},
    {"buffers/*/byteLength", Kind::size},
    {"buffers/*/uri", Kind::text},
    {"images/*", Kind::object},
    {"images/*/name", Kind::text},
    {"images/*/uri", Kind::text},
    {"images/*/bufferView", Kind::index},
    {"textures/*", Kind::object},
    {"textures/*/source", Kind::index},
    {"textures/*/sampler", Kind::index},
    {"samplers/*", Kind::object},
    {"samplers/*/wrapS", Kind::index},
    {"samplers/*/wrapT", Kind::index},
    {"materials/*", Kind::object},
    {"materials/*/name", Kind::text},
    {"materials/*/doubleSided", Kind::boolean},
    {"materials/*/alphaMode", Kind::text},
    {"materials/*/alphaCutoff", Kind::number},
    {"materials/*/emissiveFactor", Kind::numbers},
    {"materials/*/emissiveTexture/index", Kind::index},
    {"materials/*/emissiveTexture/texCoord", Kind::index},
    {"materials/*/normalTexture/index", Kind::index},
    {"materials/*/normalTexture/texCoord", Kind::index},
    {"materials/*/normalTexture/scale", Kind::number},
    {"materials/*/pbrMetallicRoughness/baseColorFactor", Kind::numbers},
    {"materials/*/pbrMetallicRoughness/metallicFactor", Kind::number},
    {"materials/*/pbrMetallicRoughness/roughnessFactor", Kind::number},
    {"materials/*/pbrMetallicRoughness/baseColorTexture/index", Kind::index},
    {"materials/*/pbrMetallicRoughness/baseColorTexture/texCoord", Kind::index},
    {"materials/*/pbrMetallicRoughness/metallicRoughnessTexture/index", Kind::index},
    {"materials/*/pbrMetallicRoughness/metallicRoughnessTexture/texCoord", Kind::index},
    {"materials/*/extensions", Kind::object},
    {"extensions/KHR_lights_punctual/lights/*", Kind::object},
    {"extensions/KHR_lights_punctual/lights/*/type", Kind::text},
    {"extensions/KHR_lights_punctual/lights/*/name", Kind::text},
    {"extensions/KHR_lights_punctual/lights/*/color", Kind::numbers},
    {"extensions/KHR_lights_punctual/lights/*/intensity", Kind::number},
    {"extensions/KHR_lights_punctual/lights/*/range", Kind::number},
    {"extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", Kind::number},
    {"extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", Kind::number},
    {"extensionsUsed/*", Kind::text},
    {"extensionsRequired/*", Kind::text},
};

bool is_index(const json& value) { return value.is_number_unsigned() && value.get<uint64_t>() <= INT_MAX; }

template <typename Predicate>
bool is_list_of(const json& value, const Predicate& predicate) {
  return value.is_array() && std::all_of(value.begin(), value.end(), predicate);
}

bool matches(const json& value, Kind kind) {
  switch (kind) {
    case Kind::index:
      return is_index(value);
    case Kind::size:
      return value.is_number_unsigned();
    case Kind::number:
      return value.is_number();
    case Kind::boolean:
      return value.is_boolean();
    case Kind::text:
      return value.is_string();
    case Kind::object:
      return value.is_object();
    case Kind::numbers:
      return is_list_of(value, [](const json& item) { return item.is_number(); });
    case Kind::indices:
      return is_list_of(value, is_index);
    case Kind::index_map:
      return value.is_object() && std::all_of(value.begin(), value.end(), is_index);
  }
  return false;
}

const char* expectation(Kind kind) {
  switch (kind) {
    case Kind::index:
      return "a whole number from 0 to 2147483647";
    case Kind::size:
      return "a whole number of 0 or more";
    case Kind::number:
      return "a number";
    case Kind::boolean:
      return "true or false";
    case Kind::text:
      return "a string";
    case Kind::object:
      return "an object";
    case Kind::numbers:
      return "a list of numbers";
    case Kind::indices:
      return "a list of whole numbers from 0 to 2147483647";
    case Kind::index_map:
      return "an object of whole numbers from 0 to 2147483647";
  }
  return "?";
}

/// The position of the walk in the document. Its text is made only for an error message.
struct Trail {
  const Trail* parent = nullptr;
  std::string_view member;
  size_t element = 0;

  std::string str() const {
    if (!parent) return "";
    const std::string before = parent->str();
    if (member == "*") return fmt::format("{}[{}]", before, element);
    return before.empty() ? std::string(member) : fmt::format("{}.{}", before, member);
  }
};

std::string excerpt(const json& value) {
  std::string text = value.dump(-1, ' ', true);
  if (text.size() > 60) text = text.substr(0, 60) + "…";
  return text;
}

void walk(const std::string& name, const json& value, std::string_view path, Kind kind, const Trail& trail) {
  if (path.empty()) {
    if (matches(value, kind)) return;
    throw_user_error("{}: {}: expected {}, found {}", name, trail.str(), expectation(kind), excerpt(value));
  }
  const size_t slash = path.find('/');
  const std::string_view member = path.substr(0, slash);
  const std::string_view rest = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  if (member == "*") {
    if (!value.is_array())
      throw_user_error("{}: {}: expected a list, found {}", name, trail.str(), excerpt(value));
    for (size_t element = 0; element < value.size(); ++element) {
      walk(name, value[element], rest, kind, {&trail, member, element});
    }
    return;
  }
  if (!value.is_object())
    throw_user_error("{}: {}: expected an object, found {}", name, trail.str(), excerpt(value));
  const auto found = value.find(member);
  if (found != value.end()) walk(name, *found, rest, kind, {&trail, member, 0});
}

}  // namespace

void check_gltf_types(const std::string& name, const json& document) {
  for (const Rule& rule : rules) walk(name, document, rule.path, rule.kind, {});
}

}  // namespace greatx::scene
