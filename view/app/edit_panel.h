// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The tab "Edit": the scenario as a form and as a text, undo, save, and what the last change did.
#pragma once

#include <string>

#include "view/app/edit_form.h"
#include "view/app/edit_session.h"

namespace greatx::view {

class EditPanel {
 public:
  EditPanel();
  /// `materials` are the names of the scene's materials.
  void draw(EditSession& session, const std::vector<std::string>& materials);
  /// The effects and the knobs of accuracy: each with its setting, and what the last change did. Drawn in the
  /// tab "Effects" above the plan.
  void draw_knobs(EditSession& session);
  /// Times and differences of the last change.
  void draw_comparison(const EditSession& session);
  /// The widget for one effect: auto, on, off.
  void draw_switch(EditSession& session, const std::string& effect);
  /// Whether a scenario can switch the effect.
  bool is_switch(const std::string& effect) const;
  /// Opens the tab of materials at this one in the next frame.
  void open_material(const std::string& name) { wanted_material_ = name; }

 private:
  void buttons(EditSession& session);
  void form(EditSession& session);
  void text(EditSession& session);
  void materials(EditSession& session, const std::vector<std::string>& names);
  void change_materials(EditSession& session, const std::vector<YamlChange>& changes);
  template <typename Act>
  void attempt(Act act);
  void apply(EditSession& session, const std::vector<YamlChange>& changes);

  Schema schema_, material_schema_;
  EditForm form_, material_form_;
  std::vector<std::string> switches_;  ///< effects that a scenario can switch
  std::string error_, note_;
  float comparison_height_ = 100.0f;  ///< of the last frame
  std::string words_;                 ///< that the form looks for
  std::string file_;                  ///< to save to
  std::string wanted_material_, material_words_;
  std::vector<char> text_;  ///< of the text's editor
  uint64_t text_version_ = ~uint64_t{0};
};

}  // namespace greatx::view
