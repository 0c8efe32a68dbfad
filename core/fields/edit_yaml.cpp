// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/fields/edit_yaml.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <yaml-cpp/yaml.h>

#include "core/error.h"
#include "core/fields/yaml.h"
#include "core/fields/yaml_values.h"
#include "core/text.h"

namespace greatx {
namespace {

/// Holds where a value stands in the text: bytes from `begin` to before `end`.
struct Span {
  size_t begin = 0, end = 0;
};

size_t line_begin(const std::string& text, size_t at) {
  return at == 0 ? 0 : text.rfind('\n', at - 1) + 1;  // npos + 1 is the text's begin
}
/// Returns where the line of `at` ends: at its line feed, or at the end of the text.
size_t line_end(const std::string& text, size_t at) { return std::min(text.find('\n', at), text.size()); }

/// Returns the end of a quoted scalar that begins at `at`; none if its quote is not closed.
std::optional<size_t> quoted_end(const std::string& text, size_t at) {
  const char quote = text[at];
  for (size_t i = at + 1; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\')
      ++i;
    else if (text[i] == quote && quote == '\'' && i + 1 < text.size() && text[i + 1] == quote)
      ++i;
    else if (text[i] == quote)
      return i + 1;
  }
  return {};
}

/// Returns the end of a list or map in brackets that begins at `at`.
std::optional<size_t> flow_end(const std::string& text, size_t at) {
  int depth = 0;
  for (size_t i = at; i < text.size(); ++i) {
    const char before = i == 0 ? '\n' : text[i - 1], c = text[i];
    const bool spaced = before == ' ' || before == '\n' || before == '\t';
    if (c == '[' || c == '{') ++depth;
    if ((c == ']' || c == '}') && --depth == 0) return i + 1;
    if (c == '#' && spaced) i = line_end(text, i);
    if ((c == '"' || c == '\'') && (spaced || std::string_view("[{,:").find(before) != std::string::npos)) {
      const std::optional<size_t> end = quoted_end(text, i);
      if (!end) return {};
      i = *end - 1;
    }
  }
  return {};
}

std::optional<size_t> begin_of(const std::string& text, const YAML::Node& node) {
  const YAML::Mark mark = node.Mark();
  if (node.IsNull() || mark.is_null() || mark.pos < 0) return {};
  const auto at = static_cast<size_t>(mark.pos);
  return at < text.size() ? std::optional(at) : std::nullopt;
}

std::optional<Span> span_of(const std::string& text, const YAML::Node& node) {
  const std::optional<size_t> begin = begin_of(text, node);
  if (!begin) return {};
  const auto until = [&](const std::optional<size_t>& end) {
    return end ? std::optional(Span{*begin, *end}) : std::nullopt;
  };
  if (node.IsScalar()) {
    if (text[*begin] == '"' || text[*begin] == '\'') return until(quoted_end(text, *begin));
    const std::string& plain = node.Scalar();
    if (plain.empty() || text.compare(*begin, plain.size(), plain) != 0) return {};
    return Span{*begin, *begin + plain.size()};
  }
  if (node.Style() == YAML::EmitterStyle::Flow) {
    if (text[*begin] != (node.IsMap() ? '{' : '[')) return {};
    return until(flow_end(text, *begin));
  }
  if (node.size() == 0) return {};
  YAML::Node last;
  if (node.IsMap()) {
    for (const auto& entry : node) last.reset(entry.second);
  } else {
    last.reset(node[node.size() - 1]);
  }
  const std::optional<Span> inner = span_of(text, last);
  return inner && inner->end >= *begin ? std::optional(Span{*begin, inner->end}) : std::nullopt;
}

/// Returns the dash of an item of a list in block style.
std::optional<size_t> dash_of(const std::string& text, const YAML::Node& item) {
  const std::optional<size_t> begin = begin_of(text, item);
  if (!begin || *begin == 0) return {};
  const size_t before = text.find_last_not_of(" \t", *begin - 1);
  if (before == std::string::npos || text[before] != '-') return {};
  const size_t line = line_begin(text, before);
  return text.find_first_not_of(' ', line) == before ? std::optional(before) : std::nullopt;
}

/// One entry of a map, or one item of a list, from the key or the item to the value's end.
struct Entry {
  Span span;
  bool first_on_line = false;  ///< spaces alone stand before it; of a list in block style, before its dash
};

/// Returns all entries; none if the place of one of them is not known.
std::optional<std::vector<Entry>> entries_of(const std::string& text, const YAML::Node& parent) {
  std::vector<Entry> entries;
  const auto starts_line = [&](size_t at) { return text.find_first_not_of(' ', line_begin(text, at)) == at; };
  if (parent.IsMap()) {
    for (const auto& entry : parent) {
      const std::optional<Span> key = span_of(text, entry.first), value = span_of(text, entry.second);
      if (!key || !value || value->begin < key->end) return {};
      entries.push_back({{key->begin, value->end}, starts_line(key->begin)});
    }
  } else {
    const bool flow = parent.Style() == YAML::EmitterStyle::Flow;
    for (const auto& item : parent) {
      const std::optional<Span> value = span_of(text, item);
      const std::optional<size_t> begin = !value ? std::nullopt : flow ? value->begin : dash_of(text, item);
      if (!begin) return {};
      entries.push_back({{*begin, value->end}, starts_line(*begin)});
    }
  }
  return entries;
}

/// Puts `entry` ("key: value" or "value") before the index, into a map or list whose entries are known.
std::optional<std::string> with_entry(const std::string& text, const YAML::Node& parent, size_t index,
                                      const std::string& entry) {
  const std::optional<Span> all = span_of(text, parent);
  const std::optional<std::vector<Entry>> entries = entries_of(text, parent);
  if (!all || !entries) return {};
  std::string edited = text;
  const bool last = index == entries->size();
  if (parent.Style() == YAML::EmitterStyle::Flow) {
    if (entries->empty())
      edited.insert(all->begin + 1, entry);
    else if (last)
      edited.insert(entries->back().span.end, ", " + entry);
    else
      edited.insert((*entries)[index].span.begin, entry + ", ");
    return edited;
  }
  const size_t first = entries->front().span.begin;
  const std::string indent(first - line_begin(text, first), ' ');
  const std::string line = indent + (parent.IsMap() ? "" : "- ") + entry;
  if (last)
    edited.insert(line_end(text, entries->back().span.end), "\n" + line);
  else if ((*entries)[index].first_on_line)
    edited.insert(line_begin(text, (*entries)[index].span.begin), line + "\n");
  else
    return {};
  return edited;
}

std::optional<std::string> without_entry(const std::string& text, const YAML::Node& parent, size_t index) {
  const std::optional<Span> all = span_of(text, parent);
  const std::optional<std::vector<Entry>> entries = entries_of(text, parent);
  if (!all || !entries) return {};
  std::string edited = text;
  const Span gone = (*entries)[index].span;
  const bool last = index + 1 == entries->size();
  if (entries->size() == 1) {
    const bool flow = parent.Style() == YAML::EmitterStyle::Flow;
    const Span whole = flow ? *all : gone;
    return edited.replace(whole.begin, whole.end - whole.begin, parent.IsMap() ? "{}" : "[]");
  }
  if (parent.Style() == YAML::EmitterStyle::Flow) {
    const size_t begin = last ? (*entries)[index - 1].span.end : gone.begin;
    return edited.erase(begin, (last ? gone.end : (*entries)[index + 1].span.begin) - begin);
  }
  if (!(*entries)[index].first_on_line)  // behind a dash: the next one takes its place
    return last ? std::nullopt
                : std::optional(edited.erase(gone.begin, (*entries)[index + 1].span.begin - gone.begin));
  const size_t begin = line_begin(text, gone.begin);
  return edited.erase(begin, std::min(line_end(text, gone.end) + 1, text.size()) - begin);
}

/// Changes the text at the place alone; none if that is not possible.
std::optional<std::string> edited_in_place(const std::string& text, const YamlChange& change) {
  YAML::Node node = YAML::Load(text);
  for (size_t i = 0; i < change.path.size(); ++i) {
    const bool ends = i + 1 == change.path.size();
    if (const auto* const index = std::get_if<size_t>(&change.path[i])) {
      if (ends && change.kind == YamlChange::Kind::insert)
        return with_entry(text, node, *index, change.value);
      if (ends && change.kind == YamlChange::Kind::remove) return without_entry(text, node, *index);
      const YAML::Node item = node[*index];
      node.reset(item);
      continue;
    }
    const std::string& key = std::get<std::string>(change.path[i]);
    if (!node.IsMap()) return {};
    size_t place = 0;
    bool found = false;
    YAML::Node value;
    for (const auto& entry : node) {
      found = entry.first.Scalar() == key;
      if (found) {
        value.reset(entry.second);
        break;
      }
      ++place;
    }
    if (!found) {
      std::string made = change.value;
      for (size_t below = change.path.size(); --below > i;)
        made = "{" + yaml_text(std::get<std::string>(change.path[below])) + ": " + made + "}";
      return with_entry(text, node, node.size(), yaml_text(key) + ": " + made);
    }
    if (ends && change.kind == YamlChange::Kind::remove) return without_entry(text, node, place);
    node.reset(value);
  }
  const std::optional<Span> span = span_of(text, node);
  if (!span) return {};
  return std::string(text).replace(span->begin, span->end - span->begin, change.value);
}

bool holds(const std::string& text, const FieldValue& wanted) {
  try {
    return same_values(*read_yaml(text, "the edited text"), wanted);
  } catch (const UserError&) {
    return false;
  }
}

}  // namespace

EditedYaml edit_yaml(const std::string& text, const YamlChange& change) {
  const std::shared_ptr<const FieldValue> wanted = changed_value(read_yaml(text, "the scenario"), change);
  const std::optional<std::string> edited = edited_in_place(text, change);
  if (edited && holds(*edited, *wanted)) return {*edited, true};
  EditedYaml rewritten{yaml_block(*wanted), false};
  GREATX_CHECK(holds(rewritten.text, *wanted), "{}: no way to write the value", yaml_path_text(change.path));
  return rewritten;
}

}  // namespace greatx
