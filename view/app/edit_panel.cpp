// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/edit_panel.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <imgui.h>
#include <utility>

#include <fmt/format.h>

#include "assets/assets.h"
#include "core/error.h"
#include "core/text.h"

namespace greatx::view {

namespace {

const ImVec4 error_color{1.0f, 0.45f, 0.40f, 1.0f}, note_color{0.95f, 0.80f, 0.40f, 1.0f};
constexpr size_t room_to_type = 16 << 10;

/// The members of channels and sensors that trade accuracy for time.
const std::vector<std::string> knobs_of_channels{"candidates",
                                                 "rays",
                                                 "search",
                                                 "max_depth",
                                                 "max_reflections_before_scattering",
                                                 "max_transmissions",
                                                 "max_paths",
                                                 "max_diffractions",
                                                 "two_edge_floor_db",
                                                 "corner_step_db",
                                                 "max_reflections_beside_diffraction",
                                                 "max_reflections_after",
                                                 "scattering_patch_m",
                                                 "scattering_budget",
                                                 "max_scatterings",
                                                 "scattering_beside_diffraction",
                                                 "subcarriers",
                                                 "time_samples"};
const std::vector<std::string> knobs_of_sensors{
    "width",  "height",        "antialiasing", "motion_blur_samples", "steps",     "max_events_per_pixel",
    "beam",   "azimuth_steps", "channels",     "max_range_m",         "detection", "returns",
    "echoes", "processing",    "device",       "samples_per_record",  "errors",    "rolling_shutter"};

std::string name_of(const FieldValue& item) {
  const auto member = std::ranges::find(item.members, "name", &FieldValue::Member::key);
  return member == item.members.end() ? "" : member->value->text;
}

/// Returns a row for each difference. Arrays of one sensor that differ in the same way share one.
std::vector<std::pair<std::string, std::string>> grouped(const std::vector<Difference>& differences) {
  struct Group {
    std::string sensor, text, arrays;
    size_t count = 0;
  };
  std::vector<Group> groups;
  for (const Difference& difference : differences) {
    if (difference.equal) continue;
    const auto same = std::ranges::find_if(groups, [&](const Group& group) {
      return group.sensor == difference.sensor && group.text == difference.text;
    });
    if (same == groups.end()) {
      groups.push_back({difference.sensor, difference.text, difference.array, 1});
    } else {
      ++same->count;
      if (same->count <= 3) same->arrays += ", " + difference.array;
    }
  }
  std::vector<std::pair<std::string, std::string>> rows;
  for (const Group& group : groups)
    rows.emplace_back(group.sensor + (group.arrays.empty() ? "" : ": ") + group.arrays +
                          (group.count > 3 ? fmt::format(" and {} more", group.count - 3) : ""),
                      group.text);
  return rows;
}

}  // namespace

EditPanel::EditPanel()
    : schema_(scenario_schema()),
      material_schema_(materials_schema()),
      form_(schema_),
      material_form_(material_schema_) {
  for (const FormType::Member& member : schema_.type_of(schema_.root(), nullptr).members)
    if (member.key == "effects")
      for (const FormType::Member& effect : schema_.type_of(member.part, nullptr).members)
        switches_.push_back(effect.key);
}

bool EditPanel::is_switch(const std::string& effect) const {
  return std::ranges::find(switches_, effect) != switches_.end();
}

template <typename Act>
void EditPanel::attempt(Act act) {
  try {
    error_.clear();
    note_.clear();
    act();
  } catch (const UserError& error) {
    error_ = error.what();
  }
}

void EditPanel::apply(EditSession& session, const std::vector<YamlChange>& changes) {
  if (changes.empty()) return;
  attempt([&] {
    session.change(changes, yaml_path_text(changes.front().path));
    if (session.lost_comments())
      note_ = "The change did not fit into the text as it was; it was written anew, without comments.";
  });
}

void EditPanel::draw(EditSession& session, const std::vector<std::string>& materials) {
  if (session.document() == nullptr) {
    ImGui::TextWrapped("A data set cannot be edited. `greatx view SCENARIO` runs a scenario that can.");
    return;
  }
  buttons(session);
  for (const std::string* const error : std::array<const std::string*, 2>{&error_, &session.error()})
    if (!error->empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, error_color);
      ImGui::TextWrapped("%s", printable_lines(*error).c_str());
      ImGui::PopStyleColor();
    }
  if (!note_.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, note_color);
    ImGui::TextWrapped("%s", note_.c_str());
    ImGui::PopStyleColor();
  }
  if (ImGui::CollapsingHeader("Before and after", ImGuiTreeNodeFlags_DefaultOpen)) {
    const float most = 0.35f * ImGui::GetWindowHeight();
    ImGui::BeginChild("before and after", {0.0f, std::min(most, comparison_height_)});
    const float top = ImGui::GetCursorPosY();
    draw_comparison(session);
    comparison_height_ = ImGui::GetCursorPosY() - top + 4.0f;
    ImGui::EndChild();
  }
  if (!ImGui::BeginTabBar("edit tabs")) return;
  if (ImGui::BeginTabItem("Form")) {
    form(session);
    ImGui::EndTabItem();
  }
  const bool to_material = !wanted_material_.empty();
  if (ImGui::BeginTabItem("Radio materials", nullptr, to_material ? ImGuiTabItemFlags_SetSelected : 0)) {
    this->materials(session, materials);
    ImGui::EndTabItem();
  }
  if (ImGui::BeginTabItem("Text")) {
    text(session);
    ImGui::EndTabItem();
  }
  ImGui::EndTabBar();
}

void EditPanel::buttons(EditSession& session) {
  const ScenarioDocument& document = *session.document();
  const auto button = [&](const char* name, bool possible, auto act) {
    if (!possible) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.4f);
    if (ImGui::Button(name) && possible) attempt(act);
    if (!possible) ImGui::PopStyleVar();
    ImGui::SameLine();
  };
  button("undo", document.can_undo(), [&] { session.undo(); });
  button("redo", document.can_redo(), [&] { session.redo(); });
  button("reload files", true, [&] { session.reload(); });
  button("copy command", true, [&] {
    ImGui::SetClipboardText(session.command().c_str());
    note_ = session.command() + (document.is_changed() ? "   (save first: the text has changed)" : "");
  });
  if (session.preparing())
    ImGui::TextDisabled("%s ...", session.activity().c_str());
  else
    ImGui::NewLine();
  char file[1024] = {};
  const std::string shown = file_.empty() ? document.file().string() : file_;
  std::memcpy(file, shown.data(), std::min(shown.size(), sizeof file - 1));
  ImGui::SetNextItemWidth(std::max(100.0f, ImGui::GetContentRegionAvail().x - 130.0f));
  if (ImGui::InputText("##file", file, sizeof file)) file_ = file;
  ImGui::SameLine();
  button(document.is_changed() ? "save *" : "save", true, [&] {
    session.save(file_);
    note_ = "saved " + document.file().string();
    file_.clear();
  });
  ImGui::NewLine();
}

void EditPanel::form(EditSession& session) {
  char words[128] = {};
  std::memcpy(words, words_.data(), std::min(words_.size(), sizeof words - 1));
  if (ImGui::InputTextWithHint("##words", "find a field: sun, max_depth, uav ...", words, sizeof words))
    words_ = words;
  ImGui::BeginChild("form");
  const auto& root = session.document()->values();
  apply(session, words_.empty() ? form_.draw(root, {}) : form_.draw_found(root, words_));
  ImGui::EndChild();
}

void EditPanel::materials(EditSession& session, const std::vector<std::string>& names) {
  if (!wanted_material_.empty()) material_words_ = std::exchange(wanted_material_, {});
  char words[128] = {};
  std::memcpy(words, material_words_.data(), std::min(material_words_.size(), sizeof words - 1));
  if (ImGui::InputTextWithHint("##words", "find a material", words, sizeof words)) material_words_ = words;
  ImGui::TextWrapped(
      "An entry here goes before the scene file's own material; an empty one changes nothing.");
  ImGui::BeginChild("materials");
  const auto root = session.document()->materials();
  for (const std::string& name : names) {
    if (name.find(material_words_) == std::string::npos) continue;
    const YamlPath path{YamlStep("materials"), YamlStep(name)};
    ImGui::PushID(name.c_str());
    const bool given = value_at(root, path) != nullptr;
    if (!given && ImGui::SmallButton("change"))
      change_materials(session, {{YamlChange::Kind::set, path, "{}"}});
    if (given && ImGui::SmallButton("back"))
      change_materials(session, {{YamlChange::Kind::remove, path, ""}});
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip(given ? "use the scene file's own radio material" : "give it a radio material here");
    ImGui::SameLine();
    if (!given) ImGui::TextDisabled("%s", printable(name).c_str());
    if (given && ImGui::TreeNodeEx("entry", ImGuiTreeNodeFlags_DefaultOpen, "%s", printable(name).c_str())) {
      change_materials(session, material_form_.draw(root, path));
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
  ImGui::EndChild();
}

void EditPanel::change_materials(EditSession& session, const std::vector<YamlChange>& changes) {
  if (!changes.empty()) attempt([&] { session.change_materials(changes); });
}

void EditPanel::text(EditSession& session) {
  const ScenarioDocument& document = *session.document();
  if (text_version_ != document.version()) {
    text_version_ = document.version();
    text_.assign(document.text().begin(), document.text().end());
    text_.resize(document.text().size() + room_to_type, '\0');
  }
  if (ImGui::Button("apply (ctrl+enter)") ||
      (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter)) && ImGui::GetIO().KeyCtrl))
    attempt([&] { session.replace(text_.data()); });
  ImGui::SameLine();
  if (ImGui::Button("discard")) text_version_ = ~uint64_t{0};
  ImGui::InputTextMultiline("##text", text_.data(), text_.size(), ImGui::GetContentRegionAvail(),
                            ImGuiInputTextFlags_AllowTabInput);
}

void EditPanel::draw_comparison(const EditSession& session) {
  const std::optional<EditComparison>& comparison = session.comparison();
  if (!comparison) {
    ImGui::TextDisabled(
        "Nothing was changed yet. The times and the results of the tick will be compared here.");
    return;
  }
  ImGui::TextUnformatted(printable(comparison->label).c_str());
  const auto time = [](const TickSamples& samples) {
    const std::optional<double> median = samples.median_ms();
    if (!median) return std::string("no tick yet; play or step");
    const size_t count = samples.milliseconds.size();
    return fmt::format("{:.1f} ms ({})", *median,
                       count == 1 ? "one tick" : fmt::format("median of {}", count));
  };
  if (!ImGui::BeginTable("comparison", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
  const auto row = [](const std::string& what, const std::string& value, bool grey) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", printable(what).c_str());
    ImGui::TableNextColumn();
    grey ? ImGui::TextDisabled("%s", value.c_str()) : ImGui::TextWrapped("%s", printable(value).c_str());
  };
  row("a tick takes, before", time(comparison->before), false);
  row("a tick takes, after", time(session.samples()), false);
  for (const auto& [what, value] : grouped(comparison->rows)) row(what, value, false);
  const auto equal = std::ranges::count_if(comparison->rows, &Difference::equal);
  row(fmt::format("{} arrays of tick {}", equal, comparison->tick), "equal, byte by byte", true);
  ImGui::EndTable();
}

void EditPanel::draw_switch(EditSession& session, const std::string& effect) {
  const auto value = value_at(session.document()->values(), {YamlStep("effects"), YamlStep(effect)});
  const std::string now = value != nullptr ? value->text : "auto";
  ImGui::PushID(effect.c_str());
  ImGui::SetNextItemWidth(62.0f);
  if (ImGui::BeginCombo("##switch", now.c_str(), ImGuiComboFlags_NoArrowButton)) {
    for (const char* const choice : {"auto", "on", "off"})
      if (ImGui::Selectable(choice, now == choice) && now != choice)
        apply(session, {{YamlChange::Kind::set, {YamlStep("effects"), YamlStep(effect)}, choice}});
    ImGui::EndCombo();
  }
  ImGui::PopID();
}

void EditPanel::draw_knobs(EditSession& session) {
  if (!error_.empty()) ImGui::TextColored(error_color, "%s", printable_lines(error_).c_str());
  const std::shared_ptr<const FieldValue> root = session.document()->values();
  std::vector<YamlChange> changes = form_.draw_members(root, {}, {"tolerance_db"});
  const auto draw = [&](const std::string& title, const YamlPath& path,
                        const std::vector<std::string>& keys) {
    if (!form_.has_members(root, path, keys) || !ImGui::TreeNode(title.c_str())) return;
    const std::vector<YamlChange> more = form_.draw_members(root, path, keys);
    changes.insert(changes.end(), more.begin(), more.end());
    ImGui::TreePop();
  };
  if (const auto channels = value_at(root, {YamlStep("channels")}))
    for (size_t i = 0; i < channels->items.size(); ++i)
      draw("channel " + name_of(*channels->items[i]), {YamlStep("channels"), i}, knobs_of_channels);
  if (const auto nodes = value_at(root, {YamlStep("nodes")}))
    for (size_t i = 0; i < nodes->items.size(); ++i)
      if (const auto sensors = value_at(nodes->items[i], {YamlStep("sensors")}))
        for (size_t j = 0; j < sensors->items.size(); ++j)
          draw(name_of(*nodes->items[i]) + "/" + name_of(*sensors->items[j]),
               {YamlStep("nodes"), i, YamlStep("sensors"), j}, knobs_of_sensors);
  apply(session, changes);
}

}  // namespace greatx::view
