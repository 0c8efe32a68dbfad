// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/yaml/yaml.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/budget.h"
#include "core/error.h"
#include "core/text.h"

namespace greatx {
namespace {

bool is_plain(const YAML::Node& node) { return node.IsScalar() && node.Tag() != "!"; }

/// Counts the values of a document as if its aliases were written out. It visits each node once.
class Counter {
 public:
  explicit Counter(const std::string& name) : name_(name) {}

  uint64_t count(const YAML::Node& node) {
    if (!node.IsSequence() && !node.IsMap()) return 1;
    // An alias is the node that it names. The library does not say which nodes are the same, but the place
    // where a node begins does. A map begins at the same place as its first key, but that key is not a map.
    const auto [entry, is_new] = counts_.try_emplace({node.Mark().pos, node.Type()}, open);
    if (!is_new && entry->second == open)
      throw_user_error_at({name_, line_of(node)},
                          "expected values, found an alias inside what it stands for");
    if (!is_new) return entry->second;
    uint64_t total = 1;
    for (const auto& item : node) {
      if (node.IsSequence())
        total = saturating_sum(total, count(item));
      else
        total = saturating_sum(total, saturating_sum(count(item.first), count(item.second)));
    }
    // A saturated sum must differ from `open`.
    total = std::min(total, open - 1);
    require_within(SourceLocation{name_, line_of(node)}.str(), total, budget::yaml_values);
    entry->second = total;
    return total;
  }

 private:
  static constexpr uint64_t open = UINT64_MAX;
  const std::string& name_;
  std::map<std::pair<int, YAML::NodeType::value>, uint64_t> counts_;
};

}  // namespace

std::vector<YAML::Node> load_yaml(const std::string& text, const std::string& name) {
  if (const auto bad = find_bad_utf8(text)) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(*bad);
    throw_user_error_at({name, 1 + static_cast<int>(std::count(text.begin(), end, '\n'))},
                        "expected UTF-8, found the byte 0x{:02x}", static_cast<unsigned char>(text[*bad]));
  }
  std::vector<YAML::Node> documents = YAML::LoadAll(text);
  uint64_t total = 0;
  Counter counter(name);
  for (const YAML::Node& document : documents) total = saturating_sum(total, counter.count(document));
  require_within(name, total, budget::yaml_values);
  return documents;
}

int line_of(const YAML::Node& node, int fallback) {
  return node.Mark().is_null() ? fallback : node.Mark().line + 1;
}

int line_of(const YAML::Exception& error) { return error.mark.is_null() ? 0 : error.mark.line + 1; }

std::optional<double> plain_number(const YAML::Node& node) {
  return is_plain(node) ? parse_number(node.Scalar()) : std::nullopt;
}

std::optional<bool> plain_boolean(const YAML::Node& node) {
  if (!is_plain(node)) return std::nullopt;
  const std::string& text = node.Scalar();
  if (text == "true" || text == "True" || text == "TRUE") return true;
  if (text == "false" || text == "False" || text == "FALSE") return false;
  return std::nullopt;
}

}  // namespace greatx
