// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/sim/sweep_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <regex>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace greatx::sim::test {
namespace {

/// Keys that tell the kinds of a map apart, in texts and in the schema.
constexpr std::array discriminators = {"type", "kind", "by"};

/// Cuts off the path before "generate:", because generated models have the same fields wherever they stand.
std::string name_of(const std::string& path) {
  const size_t at = path.find("generate:");
  return at == std::string::npos ? path : path.substr(at);
}

std::string joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

bool is_number(const YAML::Node& node) {
  static const std::regex number(R"([-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?(/[0-9]+)?)");
  return node.Tag() != "!" && std::regex_match(node.Scalar(), number);
}

void collect(const YAML::Node& node, std::string name, const std::string& element,
             std::vector<Number>& numbers) {
  if (node.IsMap()) {
    for (const char* discriminator : discriminators)
      if (const YAML::Node kind = node[discriminator]; kind && kind.IsScalar()) name += ":" + kind.Scalar();
    for (const auto& entry : node) {
      const std::string& key = entry.first.Scalar();
      if (element.empty() && key == "greatx") continue;
      collect(entry.second, joined(name, key), joined(element, key), numbers);
    }
  } else if (node.IsSequence()) {
    for (size_t i = 0; i < node.size(); ++i)
      collect(node[i], name + "[]", fmt::format("{}[{}]", element, i), numbers);
  } else if (node.IsScalar() && is_number(node)) {
    numbers.push_back(
        {name_of(name), element, static_cast<size_t>(node.Mark().pos), node.Scalar().size(), node.Scalar()});
  }
}

class SchemaWalk {
 public:
  explicit SchemaWalk(const nlohmann::json& schema) : root_(schema) { walk(schema, ""); }
  Ranges ranges;

 private:
  void walk(const nlohmann::json& schema, std::string path) {
    if (!schema.is_object()) return;
    if (schema.contains("$ref"))
      walk(root_.at(nlohmann::json::json_pointer(schema["$ref"].get<std::string>().substr(1))), path);
    if (const std::string type = schema.value("type", ""); type == "number" || type == "integer")
      add(schema, type == "integer", path);
    if (schema.contains("enum") && schema["enum"][0].is_number())
      ranges[name_of(path)].push_back({true, {}, {}});
    for (const char* several : {"oneOf", "anyOf", "allOf"})
      if (schema.contains(several))
        for (const auto& one : schema[several]) walk(one, path);
    if (schema.contains("items")) walk(schema["items"], path + "[]");
    if (!schema.contains("properties")) return;
    for (const char* discriminator : discriminators) {
      const auto kind = schema["properties"].find(discriminator);
      if (kind != schema["properties"].end() && kind->contains("const"))
        path += ":" + (*kind)["const"].get<std::string>();
    }
    for (const auto& [key, property] : schema["properties"].items()) walk(property, joined(path, key));
  }

  void add(const nlohmann::json& schema, bool integer, const std::string& path) {
    Range range;
    range.integer = integer;
    const auto end = [&](const char* key, std::optional<double>& value, bool* excluded) {
      if (!schema.contains(key)) return;
      value = schema[key].get<double>();
      if (excluded != nullptr) *excluded = true;
    };
    end("minimum", range.least, nullptr);
    end("exclusiveMinimum", range.least, &range.least_excluded);
    end("maximum", range.most, nullptr);
    end("exclusiveMaximum", range.most, &range.most_excluded);
    ranges[name_of(path)].push_back(range);
  }

  const nlohmann::json& root_;
};

std::string text_of(double value, bool integer) {
  return integer && std::abs(value) < 1e18 ? fmt::format("{}", static_cast<int64_t>(value))
                                           : fmt::format("{:.17g}", value);
}

}  // namespace

std::vector<Number> numbers_of(const std::string& yaml) {
  std::vector<Number> numbers;
  collect(YAML::Load(yaml), "", "", numbers);
  return numbers;
}

bool Range::holds(double value) const {
  if (integer && value != std::floor(value)) return false;
  if (least && (value < *least || (least_excluded && value == *least))) return false;
  return !(most && (value > *most || (most_excluded && value == *most)));
}

Ranges ranges_of(const nlohmann::json& schema) { return SchemaWalk(schema).ranges; }

std::vector<std::string> ends_and_beyond(const std::vector<Range>& ranges) {
  std::vector<std::string> texts = {"0",
                                    "-1",
                                    "1e-300",
                                    "-1e-300",
                                    "1e300",
                                    "-1e300",
                                    "1e20",
                                    "1e9",
                                    ".nan",
                                    ".inf",
                                    "nan",
                                    "1e999",
                                    "2147483648",
                                    "4294967296",
                                    "9223372036854775808",
                                    "18446744073709551616",
                                    "\"\"",
                                    "north",
                                    "[]",
                                    "{}"};
  const auto add = [&](std::optional<double> end, double outwards, bool integer) {
    if (!end) return;
    texts.push_back(text_of(*end, integer));
    const double far = outwards * std::numeric_limits<double>::infinity();
    texts.push_back(text_of(integer ? *end + outwards : std::nextafter(*end, far), integer));
    texts.push_back(text_of(integer ? *end - outwards : std::nextafter(*end, -far), integer));
  };
  for (const Range& range : ranges) {
    add(range.least, -1.0, range.integer);
    add(range.most, 1.0, range.integer);
  }
  std::sort(texts.begin(), texts.end());
  texts.erase(std::unique(texts.begin(), texts.end()), texts.end());
  return texts;
}

}  // namespace greatx::sim::test
