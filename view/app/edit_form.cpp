// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/edit_form.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <imgui.h>
#include <utility>

#include <fmt/format.h>

#include "core/text.h"
#include "view/edit/handles.h"

namespace greatx::view {

namespace {

using Kind = FormType::Kind;

YamlPath below(const YamlPath& path, YamlStep step) {
  YamlPath longer = path;
  longer.push_back(std::move(step));
  return longer;
}

const FieldValue* member_of(const FieldValue& value, const std::string& key) {
  const auto member = std::ranges::find(value.members, key, &FieldValue::Member::key);
  return member == value.members.end() ? nullptr : member->value.get();
}

/// A name for an item of a list: its name, its kind, or its number.
std::string item_label(const FieldValue& item, size_t index) {
  for (const char* const key : {"name", "type", "t_s", "nodes"})
    if (const FieldValue* const value = member_of(item, key)) return yaml_line(*value);
  return fmt::format("[{}]", index);
}

/// Returns a copy of an item whose name, if it has one, ends in `suffix`.
FieldValue renamed(const FieldValue& item, const std::string& suffix) {
  FieldValue copy = item;
  for (FieldValue::Member& member : copy.members)
    if (member.key == "name") {
      FieldValue name = *member.value;
      name.text += suffix;
      member.value = std::make_shared<const FieldValue>(std::move(name));
    }
  return copy;
}

/// The width of the widget, so that its label fits to the right of it.
float widget_width() { return std::max(80.0f, 0.58f * ImGui::GetContentRegionAvail().x); }

std::string hint_of(const FormType& type) {
  std::string text = type.description;
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "\n") + more; };
  if (type.least && type.most)
    add(fmt::format("{:g} to {:g}", *type.least, *type.most));
  else if (type.least)
    add(fmt::format("at least {:g}", *type.least));
  if (!type.default_line.empty()) add("default: " + type.default_line);
  return text;
}

void show_hint(const FormType& type) {
  if (!ImGui::IsItemHovered()) return;
  const std::string text = hint_of(type);
  if (!text.empty()) ImGui::SetTooltip("%s", printable_lines(text).c_str());
}

/// A step of a drag by one pixel.
float drag_speed(const FormType& type, double value) {
  if (type.least && type.most && *type.most - *type.least < 1e4)
    return static_cast<float>((*type.most - *type.least) / 400.0);
  return static_cast<float>(std::max(std::abs(value) / 200.0, 1e-3));
}

/// The least that a value of this type can be, where the scenario does not have it and there is no default.
std::string first_value(const FormType& type) {
  if (!type.default_line.empty()) return type.default_line;
  switch (type.kind) {
    case Kind::number:
    case Kind::integer:
      return number_text(std::clamp(0.0, type.least.value_or(0.0), std::max(0.0, type.most.value_or(0.0))));
    case Kind::boolean:
      return "true";
    case Kind::choice:
      return type.choices.empty() ? "x" : yaml_text(type.choices.front());
    case Kind::choices:
      return "[" + (type.choices.empty() ? "" : yaml_text(type.choices.front())) + "]";
    case Kind::numbers: {
      std::string all;
      for (size_t i = 0; i < type.count; ++i) all += i == 0 ? "0" : ", 0";
      return "[" + all + "]";
    }
    case Kind::list:
      return "[]";
    case Kind::map:
      return "{}";
    default:
      return "";
  }
}

}  // namespace

std::string number_text(double value) {
  std::string text = fmt::format("{:.10g}", value);
  return text == "-0" ? "0" : text;
}

std::vector<YamlChange> EditForm::draw(const std::shared_ptr<const FieldValue>& root, const YamlPath& path) {
  changes_.clear();
  root_ = root;
  const std::shared_ptr<const FieldValue> value = value_at(root, path);
  if (value == nullptr) return {};
  const FormType type = schema_.type_of(part_at(*root, path), value.get());
  ImGui::PushID(yaml_path_text(path).c_str());
  if (value->kind == FieldValue::Kind::map)
    map(type, *value, path);
  else if (value->kind == FieldValue::Kind::list)
    list(type, *value, path);
  ImGui::PopID();
  return std::move(changes_);
}

std::vector<YamlChange> EditForm::draw_members(const std::shared_ptr<const FieldValue>& root,
                                               const YamlPath& path, const std::vector<std::string>& keys) {
  changes_.clear();
  root_ = root;
  const std::shared_ptr<const FieldValue> value = value_at(root, path);
  if (value == nullptr) return {};
  const FormType type = schema_.type_of(part_at(*root, path), value.get());
  ImGui::PushID(yaml_path_text(path).c_str());
  for (const FormType::Member& m : type.members)
    if (std::ranges::find(keys, m.key) != keys.end())
      member(m.key, m.part, member_of(*value, m.key), below(path, m.key), true);
  ImGui::PopID();
  return std::move(changes_);
}

bool EditForm::has_members(const std::shared_ptr<const FieldValue>& root, const YamlPath& path,
                           const std::vector<std::string>& keys) const {
  const std::shared_ptr<const FieldValue> value = value_at(root, path);
  if (value == nullptr) return false;
  return std::ranges::any_of(
      schema_.type_of(part_at(*root, path), value.get()).members,
      [&](const FormType::Member& m) { return std::ranges::find(keys, m.key) != keys.end(); });
}

std::vector<YamlChange> EditForm::draw_found(const std::shared_ptr<const FieldValue>& root,
                                             const std::string& words) {
  changes_.clear();
  root_ = root;
  found(schema_.root(), root.get(), {}, words);
  return std::move(changes_);
}

void EditForm::found(const SchemaPart& part, const FieldValue* value, const YamlPath& path,
                     const std::string& words) {
  const FormType type = schema_.type_of(part, value);
  const std::string place = path.empty() ? "" : yaml_path_text(path);
  const bool inner = value != nullptr && (value->kind == FieldValue::Kind::map ||
                                          (value->kind == FieldValue::Kind::list && type.kind == Kind::list));
  if (!inner) {
    if (place.find(words) != std::string::npos) member(place, part, value, path, true);
    return;
  }
  for (size_t i = 0; i < value->items.size(); ++i)
    found(type.items, value->items[i].get(), below(path, i), words);
  for (const FormType::Member& m : type.members)
    found(m.part, member_of(*value, m.key), below(path, m.key), words);
}

SchemaPart EditForm::part_at(const FieldValue& root, const YamlPath& path) const {
  SchemaPart part = schema_.root();
  const FieldValue* value = &root;
  for (const YamlStep& step : path) {
    const FormType type = schema_.type_of(part, value);
    if (const auto* const index = std::get_if<size_t>(&step)) {
      part = type.items;
      value = value != nullptr && *index < value->items.size() ? value->items[*index].get() : nullptr;
    } else {
      const std::string& key = std::get<std::string>(step);
      const auto member = std::ranges::find(type.members, key, &FormType::Member::key);
      part = member == type.members.end() ? SchemaPart() : member->part;
      value = value != nullptr ? member_of(*value, key) : nullptr;
    }
  }
  return part;
}

void EditForm::map(const FormType& type, const FieldValue& value, const YamlPath& path) {
  if (!type.shape_key.empty()) shape(type, value, path);
  for (const FieldValue::Member& m : value.members) {
    if (m.key == type.shape_key) continue;
    const auto known = std::ranges::find(type.members, m.key, &FormType::Member::key);
    const bool required = known != type.members.end() && known->required;
    member(m.key, known == type.members.end() ? SchemaPart() : known->part, m.value.get(), below(path, m.key),
           !required);
  }
  absent_members(type, value, path);
}

void EditForm::absent_members(const FormType& type, const FieldValue& value, const YamlPath& path) {
  const auto absent = [&](const FormType::Member& m) {
    return member_of(value, m.key) == nullptr && m.key != type.shape_key;
  };
  const auto count = std::ranges::count_if(type.members, absent);
  if (count == 0 || !ImGui::TreeNode("more", "%d more", static_cast<int>(count))) return;
  for (const FormType::Member& m : type.members) {
    if (!absent(m)) continue;
    const size_t changes = changes_.size();
    member(m.key, m.part, nullptr, below(path, m.key), false);
    if (changes_.size() == changes) continue;
    for (const FormType::Member& other : type.members)
      if (absent(other) && std::ranges::find(m.together, other.key) != m.together.end())
        set(below(path, other.key), first_value(schema_.type_of(other.part, nullptr)));
  }
  ImGui::TreePop();
}

void EditForm::member(const std::string& label, const SchemaPart& part, const FieldValue* value,
                      const YamlPath& path, bool removable) {
  const FormType type = schema_.type_of(part, value);
  ImGui::PushID(yaml_path_text(path).c_str());
  if (value == nullptr) {
    const std::string first = first_value(type);
    if (first.empty()) {
      ImGui::SetNextItemWidth(widget_width());
      line("", path, type.kind == Kind::text, "not given");
    } else if (ImGui::SmallButton("set")) {
      set(path, first);
    }
    show_hint(type);
    ImGui::SameLine();
    ImGui::TextDisabled("%s%s%s", printable(label).c_str(), type.default_line.empty() ? "" : ": ",
                        type.default_line.c_str());
    show_hint(type);
  } else if (value->kind == FieldValue::Kind::map ||
             (value->kind == FieldValue::Kind::list && type.kind == Kind::list)) {
    const bool open = ImGui::TreeNode("branch", "%s", printable(label).c_str());
    show_hint(type);
    if (removable && ImGui::BeginPopupContextItem()) {
      if (ImGui::Selectable("remove")) changes_.push_back({YamlChange::Kind::remove, path, ""});
      ImGui::EndPopup();
    }
    if (open) {
      value->kind == FieldValue::Kind::map ? map(type, *value, path) : list(type, *value, path);
      ImGui::TreePop();
    }
  } else {
    ImGui::SetNextItemWidth(widget_width());
    scalar(type, *value, path);
    show_hint(type);
    if (removable && ImGui::BeginPopupContextItem("default")) {
      if (ImGui::Selectable("use the default")) changes_.push_back({YamlChange::Kind::remove, path, ""});
      ImGui::EndPopup();
    }
    ImGui::SameLine();
    ImGui::TextUnformatted(printable(label).c_str());
  }
  ImGui::PopID();
}

void EditForm::shape(const FormType& type, const FieldValue& value, const YamlPath& path) {
  const FieldValue* const now = member_of(value, type.shape_key);
  ImGui::SetNextItemWidth(widget_width());
  if (ImGui::BeginCombo("##shape", now != nullptr ? now->text.c_str() : "")) {
    for (const std::string& name : type.shapes) {
      if (!ImGui::Selectable(name.c_str(), now != nullptr && now->text == name)) continue;
      // Members that the new shape has, too, stay; those that it needs are added.
      FieldValue wanted;
      wanted.kind = FieldValue::Kind::map;
      auto chosen = std::make_shared<FieldValue>();
      chosen->kind = FieldValue::Kind::scalar;
      chosen->text = name;
      wanted.members.push_back({type.shape_key, 0, chosen});
      const FormType other = schema_.type_of(type.part, &wanted);
      std::string text = "{" + type.shape_key + ": " + yaml_text(name);
      for (const FormType::Member& m : other.members) {
        if (m.key == type.shape_key) continue;
        const FieldValue* const old = member_of(value, m.key);
        if (old != nullptr)
          text += ", " + m.key + ": " + yaml_line(*old);
        else if (m.required)
          text += ", " + m.key + ": " + first_value(schema_.type_of(m.part, nullptr));
      }
      set(path, text + "}");
    }
    ImGui::EndCombo();
  }
  ImGui::SameLine();
  ImGui::TextUnformatted(type.shape_key.c_str());
}

void EditForm::list(const FormType& type, const FieldValue& value, const YamlPath& path) {
  for (size_t i = 0; i < value.items.size(); ++i) {
    const FieldValue& item = *value.items[i];
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::SmallButton("-")) changes_.push_back({YamlChange::Kind::remove, below(path, i), ""});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("remove");
    ImGui::SameLine();
    if (ImGui::SmallButton("+")) {
      const std::string copy = yaml_line(renamed(item, fmt::format("_{}", value.items.size() + 1)));
      const std::optional<YamlChange> way_point = insert_behind(root_, below(path, i));
      changes_.push_back(way_point.value_or(YamlChange{YamlChange::Kind::insert, below(path, i + 1), copy}));
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("add a copy");
    ImGui::SameLine();
    member(item_label(item, i), type.items, &item, below(path, i), false);
    ImGui::PopID();
  }
  if (value.items.empty()) line("[]", path, false);
}

void EditForm::scalar(const FormType& type, const FieldValue& value, const YamlPath& path) {
  const bool is_number = value.kind == FieldValue::Kind::scalar && !value.quoted && parse_number(value.text);
  if (value.kind == FieldValue::Kind::list) {
    const bool all_numbers = std::ranges::all_of(
        value.items, [](const auto& item) { return parse_number(item->text).has_value(); });
    if (type.kind == Kind::numbers && all_numbers && value.items.size() == type.count)
      return numbers(type, value, path);
    if (type.kind == Kind::choices) return choices(type, value, path);
    return line(yaml_line(value), path, false);
  }
  if ((type.kind == Kind::number || type.kind == Kind::integer) && is_number)
    return number(type, value, path);
  if (type.kind == Kind::boolean) {
    bool on = value.text == "true";
    if (ImGui::Checkbox("##on", &on)) set(path, on ? "true" : "false");
    return;
  }
  if (type.kind == Kind::choice) {
    if (!ImGui::BeginCombo("##choice", value.text.c_str())) return;
    for (const std::string& choice : type.choices)
      if (ImGui::Selectable(choice.c_str(), choice == value.text)) set(path, yaml_text(choice));
    ImGui::EndCombo();
    return;
  }
  if (type.kind == Kind::fixed) return ImGui::TextUnformatted(value.text.c_str());
  line(value.text, path, !is_number && value.kind == FieldValue::Kind::scalar);
}

void EditForm::number(const FormType& type, const FieldValue& value, const YamlPath& path) {
  const double now = *parse_number(value.text);
  const std::string key = yaml_path_text(path);
  double edited = numbers_.contains(key) ? numbers_[key].front() : now;
  const bool whole = type.kind == Kind::integer;
  ImGui::DragScalar("##number", ImGuiDataType_Double, &edited,
                    whole ? std::max(1.0f / 8.0f, drag_speed(type, now)) : drag_speed(type, now),
                    type.least ? &*type.least : nullptr, type.most ? &*type.most : nullptr,
                    whole ? "%.0f" : "%.8g");
  if (ImGui::IsItemActive()) numbers_[key] = {edited};
  if (!ImGui::IsItemDeactivated()) return;
  const double done = numbers_.contains(key) ? numbers_[key].front() : edited;
  numbers_.erase(key);
  if (whole ? std::round(done) != now : done != now) set(path, number_text(whole ? std::round(done) : done));
}

void EditForm::numbers(const FormType& type, const FieldValue& value, const YamlPath& path) {
  const std::string key = yaml_path_text(path);
  std::vector<double> now;
  for (const auto& item : value.items) now.push_back(*parse_number(item->text));
  std::vector<double> edited = numbers_.contains(key) ? numbers_[key] : now;
  ImGui::DragScalarN("##numbers", ImGuiDataType_Double, edited.data(), static_cast<int>(type.count), 0.1f,
                     nullptr, nullptr, "%.6g");
  if (ImGui::IsItemActive()) numbers_[key] = edited;
  if (!ImGui::IsItemDeactivated()) return;
  if (numbers_.contains(key)) edited = numbers_[key];
  numbers_.erase(key);
  if (edited == now) return;
  std::string text;
  for (const double part : edited) text += (text.empty() ? "" : ", ") + number_text(part);
  set(path, "[" + text + "]");
}

void EditForm::choices(const FormType& type, const FieldValue& value, const YamlPath& path) {
  std::vector<std::string> chosen;
  for (const auto& item : value.items) chosen.push_back(item->text);
  if (!ImGui::BeginCombo("##choices", printable(yaml_line(value)).c_str())) return;
  for (const std::string& choice : type.choices) {
    const auto at = std::ranges::find(chosen, choice);
    bool on = at != chosen.end();
    if (!ImGui::Checkbox(choice.c_str(), &on)) continue;
    if (on)
      chosen.push_back(choice);
    else
      chosen.erase(at);
    std::string text;
    for (const std::string& name : chosen) text += (text.empty() ? "" : ", ") + yaml_text(name);
    set(path, "[" + text + "]");
  }
  ImGui::EndCombo();
}

void EditForm::line(const std::string& now, const YamlPath& path, bool is_text, const char* hint) {
  const std::string key = yaml_path_text(path);
  char buffer[1024] = {};
  const std::string& shown = texts_.contains(key) ? texts_[key] : now;
  std::memcpy(buffer, shown.data(), std::min(shown.size(), sizeof buffer - 1));
  if (shown.size() >= sizeof buffer) return ImGui::TextDisabled("too long: change it in the text");
  ImGui::InputTextWithHint("##line", hint, buffer, sizeof buffer);
  if (ImGui::IsItemActive()) texts_[key] = buffer;
  if (!ImGui::IsItemDeactivated()) return;
  const std::string done = texts_.contains(key) ? texts_[key] : buffer;
  texts_.erase(key);
  if (done != now && !done.empty()) set(path, is_text ? yaml_text(done) : done);
}

}  // namespace greatx::view
