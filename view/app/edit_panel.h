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
  void draw(EditSession& session);
  /// The effects and the knobs of accuracy: each with its setting, and what the last change did. Drawn in the
  /// tab "Effects" above the plan.
  void draw_knobs(EditSession& session);
  /// Times and differences of the last change.
  void draw_comparison(const EditSession& session);
  /// The widget for one effect: auto, on, off.
  void draw_switch(EditSession& session, const std::string& effect);
  /// Opens the form at the node of this name.
  void select(const std::string& node) { selected_ = node; }

 private:
  void buttons(EditSession& session);
  void form(EditSession& session);
  void text(EditSession& session);
  template <typename Act>
  void attempt(Act act);
  void apply(EditSession& session, const std::vector<YamlChange>& changes);

  Schema schema_;
  EditForm form_;
  std::string error_, note_;
  std::string words_;  ///< that the form looks for
  std::string file_;   ///< to save to
  std::string selected_;
  std::vector<char> text_;  ///< of the text's editor
  uint64_t text_version_ = ~uint64_t{0};
};

}  // namespace greatx::view
