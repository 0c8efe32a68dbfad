// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/edit/schema.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text.h"

namespace greatx::view {

using nlohmann::ordered_json;

struct Schema::Document {
  ordered_json root;
};

namespace {

using Part = ordered_json;

const Part& target(const Part& root, const Part& part) {
  const Part* at = &part;
  while (at->is_object() && at->contains("$ref"))
    at = &root.at(ordered_json::json_pointer(at->at("$ref").get<std::string>().substr(1)));
  return *at;
}

const FieldValue* member_of(const FieldValue* value, const std::string& key) {
  if (value == nullptr) return nullptr;
  const auto member = std::ranges::find(value->members, key, &FieldValue::Member::key);
  return member == value->members.end() ? nullptr : member->value.get();
}

std::string scalar_text(const Part& part) { return part.is_string() ? part.get<std::string>() : part.dump(); }

/// Whether a value can be of this part of the schema: by its kind, and by what is constant in it.
bool fits(const Part& root, const Part& unresolved, const FieldValue& value) {
  const Part& part = target(root, unresolved);
  using Kind = FieldValue::Kind;
  if (part.contains("const")) return value.kind == Kind::scalar && value.text == scalar_text(part["const"]);
  if (part.contains("enum")) return value.kind == Kind::scalar;
  if (part.contains("type")) {
    const std::string type = part["type"].get<std::string>();
    const bool number = value.kind == Kind::scalar && !value.quoted && parse_number(value.text);
    if (type == "object" && value.kind != Kind::map) return false;
    if (type == "array" && value.kind != Kind::list) return false;
    if (type == "string" && value.kind != Kind::scalar) return false;
    if ((type == "number" || type == "integer") && !number) return false;
    if (type == "boolean" && (value.text != "true" && value.text != "false")) return false;
  }
  if (part.contains("properties"))
    for (const auto& [key, inner] : part["properties"].items()) {
      const Part& resolved = target(root, inner);
      const FieldValue* const member = member_of(&value, key);
      if (resolved.contains("const") && member != nullptr && !fits(root, resolved, *member)) return false;
    }
  for (const char* const alternatives : {"anyOf", "oneOf"})
    if (part.contains(alternatives) && !part.contains("type"))
      return std::ranges::any_of(part[alternatives], [&](const Part& p) { return fits(root, p, value); });
  return true;
}

/// Whether an alternative says of what kind a value is, and not only which keys go together.
bool is_shape(const Part& part) {
  return part.contains("type") || part.contains("const") || part.contains("enum") ||
         part.contains("properties") || part.contains("anyOf");
}

/// Gathers what the parts say of one value, from the outermost to the chosen alternative.
class Collector {
 public:
  Collector(const Part& root, const FieldValue* value) : root_(root), value_(value) {}

  void add(const Part& part) {
    layers_.push_back(&part);
    if (part.contains("$ref")) add(target(root_, part));
    for (const char* const alternatives : {"oneOf", "anyOf"}) {
      if (part.contains("$ref") || !part.contains(alternatives)) continue;
      const Part* chosen = nullptr;
      for (const Part& alternative : part[alternatives]) {
        const Part& resolved = target(root_, alternative);
        if (!is_shape(resolved)) continue;
        add_shape(resolved);
        if (chosen == nullptr ||
            (value_ != nullptr && !fits(root_, *chosen, *value_) && fits(root_, resolved, *value_)))
          chosen = &alternative;
      }
      if (chosen != nullptr) add(*chosen);
    }
  }

  /// Returns the innermost layer's value of a keyword; null if none has it.
  const Part* find(const char* keyword) const {
    for (auto layer = layers_.rbegin(); layer != layers_.rend(); ++layer)
      if ((*layer)->contains(keyword)) return &(**layer)[keyword];
    return nullptr;
  }
  const std::vector<const Part*>& layers() const { return layers_; }
  const std::string& shape_key() const { return shape_key_; }
  const std::vector<std::string>& shapes() const { return shapes_; }

 private:
  void add_shape(const Part& alternative) {
    if (!alternative.contains("properties")) return;
    for (const auto& [key, inner] : alternative["properties"].items()) {
      if (!inner.contains("const") || !inner["const"].is_string()) continue;
      shape_key_ = key;
      shapes_.push_back(inner["const"].get<std::string>());
      return;
    }
  }

  const Part& root_;
  const FieldValue* value_;
  std::vector<const Part*> layers_;
  std::string shape_key_;
  std::vector<std::string> shapes_;
};

std::string flow(const Part& part) {
  if (part.is_string()) return part.get<std::string>();
  if (!part.is_array()) return part.dump();
  std::string out;
  for (const Part& item : part) out += (out.empty() ? "" : ", ") + flow(item);
  return "[" + out + "]";
}

std::vector<std::string> texts(const Part& list) {
  std::vector<std::string> all;
  for (const Part& item : list) all.push_back(scalar_text(item));
  return all;
}

/// Returns the keys that a part's first alternative requires, if the alternatives say which keys go together
/// (position_m or position_deg) and the value has the keys of none. A new value gets these keys.
std::vector<std::string> first_of_several(const Part& part, const FieldValue* value) {
  std::vector<std::string> keys;
  if (part.contains("allOf"))
    for (const Part& one : part["allOf"])
      for (std::string& key : first_of_several(one, value)) keys.push_back(std::move(key));
  if (!part.contains("oneOf") || std::ranges::any_of(part["oneOf"], is_shape)) return keys;
  const auto there = [&](const Part& alternative) {
    if (value == nullptr || !alternative.contains("required")) return false;
    return std::ranges::all_of(alternative["required"], [&](const Part& key) {
      return member_of(value, key.get<std::string>()) != nullptr;
    });
  };
  const Part& first = part["oneOf"][0];
  if (std::ranges::none_of(part["oneOf"], there) && first.contains("required"))
    for (const std::string& key : texts(first["required"])) keys.push_back(key);
  return keys;
}

void read_list(const Part& root, const Collector& from, FormType& type) {
  const Part* const items = from.find("items");
  type.kind = FormType::Kind::list;
  if (items == nullptr) return;
  const Part& item = target(root, *items);
  const Part *const least = from.find("minItems"), *const most = from.find("maxItems");
  const bool numbers = item.contains("type") && item["type"] == "number";
  if (item.contains("enum")) {
    type.kind = FormType::Kind::choices;
    type.choices = texts(item["enum"]);
  } else if (numbers && least != nullptr && most != nullptr && *least == *most && *most <= 4) {
    type.kind = FormType::Kind::numbers;
    type.count = most->get<size_t>();
  }
}

void read_kind(const Part& root, const Collector& from, FormType& type) {
  using Kind = FormType::Kind;
  if (const Part* const choices = from.find("enum")) {
    type.kind = Kind::choice;
    type.choices = texts(*choices);
  } else if (from.find("const") != nullptr) {
    type.kind = Kind::fixed;
  } else if (const Part* const name = from.find("type")) {
    if (*name == "string") type.kind = Kind::text;
    if (*name == "number") type.kind = Kind::number;
    if (*name == "integer") type.kind = Kind::integer;
    if (*name == "boolean") type.kind = Kind::boolean;
    if (*name == "object") type.kind = Kind::map;
    if (*name == "array") read_list(root, from, type);
  } else if (from.find("properties") != nullptr) {
    type.kind = Kind::map;
  }
}

}  // namespace

Schema::Schema(std::string_view text)
    : document_(std::make_unique<const Document>(Document{ordered_json::parse(text)})) {}
Schema::~Schema() = default;

SchemaPart Schema::root() const {
  SchemaPart part;
  part.part_ = &document_->root;
  return part;
}

FormType Schema::type_of(const SchemaPart& part, const FieldValue* value) const {
  FormType type;
  type.part = part;
  if (!part.known()) return type;
  const auto at = [](const Part& json) {
    SchemaPart made;
    made.part_ = &json;
    return made;
  };
  Collector from(document_->root, value);
  from.add(*static_cast<const Part*>(part.part_));
  read_kind(document_->root, from, type);
  if (const Part* const text = from.find("description")) type.description = text->get<std::string>();
  if (const Part* const least = from.find("minimum")) type.least = least->get<double>();
  if (const Part* const most = from.find("maximum")) type.most = most->get<double>();
  if (const Part* const value_of = from.find("default")) type.default_line = flow(*value_of);
  if (const Part* const items = from.find("items")) type.items = at(*items);
  if (type.kind != FormType::Kind::map) return type;
  type.shape_key = from.shape_key();
  type.shapes = from.shapes();
  const auto member = [&](const std::string& key) {
    const auto found = std::ranges::find(type.members, key, &FormType::Member::key);
    return found != type.members.end() ? &*found
                                       : &type.members.emplace_back(FormType::Member{key, {}, false, {}});
  };
  for (const Part* const layer : from.layers()) {
    if (layer->contains("properties"))
      for (const auto& [key, inner] : (*layer)["properties"].items()) member(key)->part = at(inner);
    if (layer->contains("propertyNames") && (*layer)["propertyNames"].contains("enum"))
      for (const std::string& key : texts((*layer)["propertyNames"]["enum"]))
        member(key)->part = at((*layer)["additionalProperties"]);
  }
  for (const Part* const layer : from.layers())
    if (value != nullptr && layer->contains("additionalProperties") &&
        (*layer)["additionalProperties"].is_object())
      for (const FieldValue::Member& given : value->members)
        if (FormType::Member* const known = member(given.key); !known->part.known())
          known->part = at((*layer)["additionalProperties"]);
  for (const Part* const layer : from.layers())
    if (layer->contains("required"))
      for (const std::string& key : texts((*layer)["required"])) member(key)->required = true;
  for (const Part* const layer : from.layers())
    for (const std::string& key : first_of_several(*layer, value)) member(key)->required = true;
  for (const Part* const layer : from.layers())
    if (layer->contains("dependentRequired"))
      for (const auto& [key, others] : (*layer)["dependentRequired"].items())
        member(key)->together = texts(others);
  return type;
}

}  // namespace greatx::view
