// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/fields/yaml.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "core/budget.h"
#include "core/error.h"
#include "core/text.h"

namespace greatx {
namespace {

/// Returns the line on which a node begins. A null value has the place of the text that follows it.
int line_of(const YAML::Node& node) {
  return node.IsNull() || node.Mark().is_null() ? 0 : node.Mark().line + 1;
}

/// Identifies a node. The library does not say which nodes are the same, but an alias begins where the node
/// that it names begins. A map begins at the same place as its first key, but that key is not a map.
using Identity = std::pair<int, YAML::NodeType::value>;
Identity identity_of(const YAML::Node& node) { return {node.Mark().pos, node.Type()}; }

/// Counts the values of a document as if its aliases were written out. It visits each node once.
class Counter {
 public:
  explicit Counter(const std::string& name) : name_(name) {}

  uint64_t count(const YAML::Node& node) {
    if (!node.IsSequence() && !node.IsMap()) return 1;
    const auto [entry, is_new] = counts_.try_emplace(identity_of(node), open);
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
  std::map<Identity, uint64_t> counts_;
};

/// Makes the values of a counted document. Aliases share one value, so that the values take no more memory
/// than the text allows.
class Converter {
 public:
  explicit Converter(const std::string& name) : name_(name) {}

  std::shared_ptr<const FieldValue> convert(const YAML::Node& node) {
    if (node.IsNull() || !node.IsDefined()) return std::make_shared<FieldValue>();
    std::shared_ptr<const FieldValue>& known = values_[identity_of(node)];
    if (!known) known = make(node);
    return known;
  }

 private:
  std::shared_ptr<const FieldValue> make(const YAML::Node& node) {
    auto value = std::make_shared<FieldValue>();
    value->line = line_of(node);
    if (node.IsScalar()) {
      value->kind = FieldValue::Kind::scalar;
      value->text = node.Scalar();
      value->quoted = node.Tag() == "!";
    } else if (node.IsSequence()) {
      value->kind = FieldValue::Kind::list;
      for (const YAML::Node& item : node) value->items.push_back(convert(item));
    } else {
      value->kind = FieldValue::Kind::map;
      for (const auto& member : node) {
        const int line = line_of(member.first);
        if (!member.first.IsScalar())
          throw_user_error_at({name_, line}, "expected a text as key, found {}",
                              member.first.IsSequence() ? "a list"
                              : member.first.IsMap()    ? "a map"
                                                        : "nothing");
        value->members.push_back({member.first.Scalar(), line, convert(member.second)});
      }
    }
    return value;
  }

  const std::string& name_;
  std::map<Identity, std::shared_ptr<const FieldValue>> values_;
};

/// Takes the events of a parser and refuses a second document. YAML::LoadAll would take all: yaml-cpp 0.7
/// finds empty documents without end where a flow collection is closed that was never opened (",a}").
class OneDocument : public YAML::EventHandler {
 public:
  explicit OneDocument(const std::string& name) : name_(name) {}
  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 2) refuse(mark);
  }
  void OnDocumentEnd() override {}
  // The first value of the second document has a line, which its start may not have.
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { look(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { look(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string&) override {
    look(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    look(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    look(mark);
  }
  void OnMapEnd() override {}

 private:
  void look(const YAML::Mark& mark) const {
    if (documents_ > 1) refuse(mark);
  }
  [[noreturn]] void refuse(const YAML::Mark& mark) const {
    throw_user_error_at({name_, mark.is_null() ? 0 : mark.line + 1},
                        "expected one YAML document, found 2 or more");
  }

  const std::string& name_;
  int documents_ = 0;
};

/// Returns the only document, or an undefined node if there is none.
YAML::Node parsed(const std::string& text, const std::string& name) {
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    OneDocument one(name);
    bool any = false;
    while (parser.HandleNextDocument(one)) any = true;
    return any ? YAML::Load(text) : YAML::Node(YAML::NodeType::Undefined);
  } catch (const YAML::Exception& error) {
    throw_user_error_at({name, error.mark.is_null() ? 0 : error.mark.line + 1},
                        "expected well-formed YAML, found a fault: {}", error.msg);
  }
}

}  // namespace

std::shared_ptr<const FieldValue> read_yaml(const std::string& text, const std::string& name) {
  if (const auto bad = find_bad_utf8(text)) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(*bad);
    throw_user_error_at({name, 1 + static_cast<int>(std::count(text.begin(), end, '\n'))},
                        "expected UTF-8, found the byte 0x{:02x}", static_cast<unsigned char>(text[*bad]));
  }
  const YAML::Node document = parsed(text, name);
  if (!document.IsDefined()) return std::make_shared<FieldValue>();
  require_within(name, Counter(name).count(document), budget::yaml_values);
  return Converter(name).convert(document);
}

}  // namespace greatx
