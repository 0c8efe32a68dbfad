// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Handles over the main view by which nodes, way-points and objects are moved and turned with the mouse.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "view/app/edit_session.h"
#include "view/app/overlay_draw.h"
#include "view/edit/handles.h"

namespace greatx::view {

/// Returns the ray of the camera through a place of the window.
CursorRay cursor_ray(const OverlayFrame& frame, const ImVec2& at);

class Gizmo {
 public:
  bool on = false;

  /// Draws the handles over the picture, and takes the mouse if the cursor is over one. Returns whether it
  /// has the mouse. Called inside of the main view's window, after its item.
  bool draw(EditSession& session, const OverlayFrame& frame, bool hovered);
  /// The message of a change that was refused; empty if none was.
  const std::string& error() const { return error_; }
  /// Selects the first handle of a node or object. Throws UserError if it has none.
  void select(const EditSession& session, const std::string& node);

 private:
  /// One arrow or ring of the gizmo.
  struct Grip {
    bool turns = false;
    int axis = 0;
    dvec3 direction{0.0};  ///< of the arrow, or the ring's axis
  };
  struct Drag {
    Grip grip;
    double begin = 0.0;                      ///< metres along the axis, or radians around it
    dvec3 position{0.0}, rotation_deg{0.0};  ///< wanted
    double moved = 0.0;
  };
  std::vector<Grip> grips(const Handle& handle) const;
  std::optional<Grip> draw_grips(ImDrawList& list, const Handle& handle, const OverlayFrame& frame) const;
  void begin(const Handle& handle, const Grip& grip, const OverlayFrame& frame);
  void drag(const Handle& handle, const OverlayFrame& frame);
  void finish(EditSession& session, const Handle& handle);
  void popup(EditSession& session, const Handle& handle);
  template <typename Act>
  void attempt(Act act);

  std::vector<Handle> handles_;
  uint64_t version_ = ~uint64_t{0};
  const ScenarioDocument* document_ = nullptr;
  std::string selected_;  ///< the path of the handle
  std::optional<Drag> drag_;
  std::string error_;
};

}  // namespace greatx::view
