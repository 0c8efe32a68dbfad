// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/gizmo.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"

namespace greatx::view {

namespace {

constexpr float handle_px = 7.0f, grip_px = 9.0f;
constexpr double arrow_px = 70.0, ring_px = 52.0;  ///< of the view's width of 1000 pixels, see scale_of()
constexpr int ring_parts = 48;
constexpr ImU32 axis_colors[] = {IM_COL32(235, 80, 80, 255), IM_COL32(90, 210, 90, 255),
                                 IM_COL32(90, 140, 255, 255)};
constexpr ImU32 ring_colors[] = {IM_COL32(90, 140, 255, 255), IM_COL32(90, 210, 90, 255),
                                 IM_COL32(235, 80, 80, 255)};
constexpr ImU32 handle_color = IM_COL32(255, 210, 60, 255), ghost_color = IM_COL32(255, 255, 255, 255);

double distance_to(const ImVec2& a, const ImVec2& b) { return std::hypot(a.x - b.x, a.y - b.y); }

std::optional<ImVec2> shown_at(const OverlayFrame& frame, const dvec3& world) {
  const dvec3 at = frame.place(world);
  if (!(at.z > 0.0)) return {};
  return ImVec2(static_cast<float>(at.x), static_cast<float>(at.y));
}

/// Returns the metres at a point that cover `pixels` of the window.
double metres_for(const OverlayFrame& frame, const dvec3& world, double pixels) {
  const double depth = frame.place(world).z;
  return pixels * std::max(depth, frame.view.near_m) / (frame.view.fx * frame.scale());
}

std::vector<dvec3> ring_of(const dvec3& center, const dvec3& axis, double radius) {
  const dvec3 other = std::abs(axis.z) < 0.9 ? dvec3(0.0, 0.0, 1.0) : dvec3(1.0, 0.0, 0.0);
  const dvec3 first = glm::normalize(other - glm::dot(other, axis) * axis), second = glm::cross(axis, first);
  std::vector<dvec3> ring;
  for (int i = 0; i <= ring_parts; ++i) {
    const double angle = 2.0 * pi * i / ring_parts;
    ring.push_back(center + radius * (std::cos(angle) * first + std::sin(angle) * second));
  }
  return ring;
}

}  // namespace

CursorRay cursor_ray(const OverlayFrame& frame, const ImVec2& at) {
  const double x = (at.x - frame.corner.x) / frame.scale(), y = (at.y - frame.corner.y) / frame.scale();
  const dvec3 seen(1.0, (frame.view.cx - x) / frame.view.fx, (frame.view.cy - y) / frame.view.fy);
  const Pose& pose = frame.view.local_from_sensor;
  return {pose.position + frame.origin, glm::normalize(pose.orientation * seen)};
}

template <typename Act>
void Gizmo::attempt(Act act) {
  try {
    error_.clear();
    act();
  } catch (const UserError& error) {
    error_ = error.what();
  }
}

void Gizmo::select(const EditSession& session, const std::string& node) {
  if (session.document() == nullptr) throw_user_error("there is no scenario to edit");
  for (const Handle& handle : handles_of(session.document()->values()))
    if (handle.node == node || handle.label == node || yaml_path_text(handle.path) == node) {
      selected_ = yaml_path_text(handle.path);
      on = true;
      return;
    }
  throw_user_error("expected a node or an object with a place of its own, found '{}'", printable(node));
}

std::vector<Gizmo::Grip> Gizmo::grips(const Handle& handle) const {
  std::vector<Grip> all;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 direction(0.0);
    direction[axis] = 1.0;
    all.push_back({false, axis, direction});
  }
  if (handle.rotation_path.empty()) return all;
  const std::vector<dvec3> axes = turn_axes(handle.rotation_deg);
  for (int axis = 0; axis < 3; ++axis) all.push_back({true, axis, axes[static_cast<size_t>(axis)]});
  return all;
}

/// Draws arrows and rings. Returns the one under the cursor.
std::optional<Gizmo::Grip> Gizmo::draw_grips(ImDrawList& list, const Handle& handle,
                                             const OverlayFrame& frame) const {
  const ImVec2 cursor = ImGui::GetMousePos();
  const dvec3 center = drag_ ? drag_->position : handle.position;
  std::optional<Grip> nearest;
  double least = grip_px;
  for (const Grip& grip : grips(handle)) {
    const double size = metres_for(frame, center, grip.turns ? ring_px : arrow_px);
    const std::vector<dvec3> line = grip.turns ? ring_of(center, grip.direction, size)
                                               : std::vector{center, center + size * grip.direction};
    const ImU32 color = grip.turns ? ring_colors[grip.axis] : axis_colors[grip.axis];
    const bool held = drag_ && drag_->grip.turns == grip.turns && drag_->grip.axis == grip.axis;
    std::optional<ImVec2> before;
    for (const dvec3& point : line) {
      const std::optional<ImVec2> at = shown_at(frame, point);
      if (at && before) {
        list.AddLine(*before, *at, color, held ? 4.0f : 2.0f);
        const double distance = distance_to_line(cursor, *before, *at);
        if (distance < least) {
          least = distance;
          nearest = grip;
        }
      }
      before = at;
    }
    if (!grip.turns && before) list.AddCircleFilled(*before, held ? 6.0f : 4.5f, color);
  }
  return nearest;
}

void Gizmo::begin(const Handle& handle, const Grip& grip, const OverlayFrame& frame) {
  const CursorRay ray = cursor_ray(frame, ImGui::GetMousePos());
  const std::optional<double> at = grip.turns ? around_axis(ray, handle.position, grip.direction)
                                              : along_axis(ray, handle.position, grip.direction);
  if (at) drag_ = Drag{grip, *at, handle.position, handle.rotation_deg, 0.0};
}

void Gizmo::drag(const Handle& handle, const OverlayFrame& frame) {
  const Grip& grip = drag_->grip;
  const CursorRay ray = cursor_ray(frame, ImGui::GetMousePos());
  const std::optional<double> at = grip.turns ? around_axis(ray, handle.position, grip.direction)
                                              : along_axis(ray, handle.position, grip.direction);
  if (!at) return;
  drag_->moved = *at - drag_->begin;
  if (grip.turns) {
    drag_->moved = std::remainder(drag_->moved, 2.0 * pi);
    drag_->rotation_deg = handle.rotation_deg;
    drag_->rotation_deg[grip.axis] += drag_->moved * 180.0 / pi;
  } else {
    drag_->position = handle.position + drag_->moved * grip.direction;
  }
}

void Gizmo::finish(EditSession& session, const Handle& handle) {
  const Drag done = *drag_;
  drag_.reset();
  if (done.moved == 0.0) return;
  attempt([&] {
    session.change(done.grip.turns ? turn_handle(handle, done.rotation_deg)
                                   : move_handle(handle, done.position));
  });
}

void Gizmo::popup(EditSession& session, const Handle& handle) {
  if (!ImGui::BeginPopup("handle")) return;
  ImGui::TextDisabled("%s", printable(handle.label).c_str());
  const std::optional<YamlChange> insert = insert_behind(session.document()->values(), handle.path);
  if (insert && ImGui::Selectable("insert a way-point behind it")) attempt([&] { session.change(*insert); });
  if (insert && ImGui::Selectable("remove the way-point")) {
    const YamlPath point(handle.path.begin(), handle.path.end() - 1);
    attempt([&] { session.change({YamlChange::Kind::remove, point, ""}); });
  }
  ImGui::EndPopup();
}

bool Gizmo::draw(EditSession& session, const OverlayFrame& frame, bool hovered) {
  if (!on || session.document() == nullptr) {
    drag_.reset();
    return false;
  }
  if (document_ != session.document() || version_ != session.document()->version()) {
    document_ = session.document();
    version_ = document_->version();
    handles_ = handles_of(document_->values());
    drag_.reset();
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 cursor = ImGui::GetMousePos();
  const Handle *selected = nullptr, *under = nullptr;
  double least = grip_px;
  for (const Handle& handle : handles_) {
    const bool is_selected = yaml_path_text(handle.path) == selected_;
    if (is_selected) selected = &handle;
    const std::optional<ImVec2> at = shown_at(frame, handle.position);
    if (!at) continue;
    list.AddCircleFilled(*at, handle_px, IM_COL32(0, 0, 0, 140));
    list.AddCircle(*at, handle_px, handle_color, 0, is_selected ? 3.0f : 1.5f);
    if (distance_to(*at, cursor) < least) {
      least = distance_to(*at, cursor);
      under = &handle;
    }
  }
  std::optional<Grip> grip;
  if (selected != nullptr) {
    grip = draw_grips(list, *selected, frame);
    popup(session, *selected);
  }
  const bool pressed = hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
  if (drag_ && selected != nullptr) {
    drag(*selected, frame);
    if (const std::optional<ImVec2> at = shown_at(frame, drag_->position)) {
      const dvec3& p = drag_->position;
      const std::string text = drag_->grip.turns ? fmt::format("{:+.1f} degrees", drag_->moved * 180.0 / pi)
                                                 : fmt::format("{:.2f}, {:.2f}, {:.2f} m  ({:+.2f} m)", p.x,
                                                               p.y, p.z, drag_->moved);
      list.AddText({at->x + 12.0f, at->y - 24.0f}, ghost_color, text.c_str());
    }
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) finish(session, *selected);
    return true;
  }
  if (grip && pressed) {
    begin(*selected, *grip, frame);
    return true;
  }
  if (under != nullptr && hovered) {
    ImGui::SetTooltip("%s", printable(under->label).c_str());
    if (pressed) selected_ = yaml_path_text(under->path);
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
      selected_ = yaml_path_text(under->path);
      ImGui::OpenPopup("handle");
    }
  }
  return hovered && (grip || under != nullptr);
}

}  // namespace greatx::view
