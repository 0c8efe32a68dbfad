// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/overlay_draw.h"

#include <algorithm>
#include <cmath>

#include "draw/paths/stroke.h"
#include "view/window/style.h"

namespace greatx::view {

namespace {

constexpr double reach_px = 6.0;  ///< of the cursor
constexpr uint32_t faint = 70;    ///< alpha of what is hidden, of 255
constexpr float highlighted_px = 2.5f;
constexpr ImU32 legend_backing = IM_COL32(16, 18, 22, 170);  ///< dark enough for texts over a bright sky

ImU32 packed(io::Color color, uint32_t alpha = 255) { return IM_COL32(color.r, color.g, color.b, alpha); }

/// Keeps the nearest row.
class Nearest {
 public:
  explicit Nearest(const std::optional<ImVec2>& cursor) : cursor_(cursor) {}
  void line(uint32_t row, const ImVec2& a, const ImVec2& b) {
    if (cursor_ && row != ~0u) take(row, distance_to_line(*cursor_, a, b));
  }
  void point(uint32_t row, const ImVec2& at) {
    if (cursor_ && row != ~0u) take(row, std::hypot(at.x - cursor_->x, at.y - cursor_->y));
  }
  const std::optional<OverlayHit>& hit() const { return hit_; }

 private:
  void take(uint32_t row, double distance) {
    if (distance <= reach_px && (!hit_ || distance < hit_->distance_px)) hit_ = OverlayHit{row, distance};
  }
  std::optional<ImVec2> cursor_;
  std::optional<OverlayHit> hit_;
};

bool is_highlighted(const Shapes& shapes, uint32_t row, const Highlights& ids) {
  if (row == ~0u || shapes.rows[row].id == 0) return false;
  return shapes.rows[row].id == ids.hovered || shapes.rows[row].id == ids.pinned;
}

void draw_mark(ImDrawList& list, PointShape::Mark mark, const ImVec2& at, float size, ImU32 color) {
  switch (mark) {
    case PointShape::Mark::dot:
      break;  // paint_dots() has drawn it
    case PointShape::Mark::circle:
      list.AddCircle(at, size, color, 0, 1.5f);
      break;
    case PointShape::Mark::square:
      list.AddRect({at.x - size, at.y - size}, {at.x + size, at.y + size}, color, 0.0f, 0, 1.5f);
      break;
    case PointShape::Mark::diamond:
      list.AddQuad({at.x, at.y - size}, {at.x + size, at.y}, {at.x, at.y + size}, {at.x - size, at.y}, color,
                   1.5f);
      break;
    case PointShape::Mark::cross:
      list.AddLine({at.x - size, at.y - size}, {at.x + size, at.y + size}, color, 1.5f);
      list.AddLine({at.x - size, at.y + size}, {at.x + size, at.y - size}, color, 1.5f);
      break;
    case PointShape::Mark::triangle:
      list.AddTriangle({at.x, at.y - size}, {at.x + size, at.y + size}, {at.x - size, at.y + size}, color,
                       1.5f);
      break;
  }
}

void draw_head(ImDrawList& list, const ImVec2& from, const ImVec2& to, float width, ImU32 color) {
  const dvec2 way(to.x - from.x, to.y - from.y);
  const double length = glm::length(way);
  if (length < 2.0) return;
  const dvec2 along = way / length, across(-along.y, along.x);
  const double size = std::min(0.4 * length, 6.0 + width);
  const auto at = [&](double back, double side) {
    return ImVec2(static_cast<float>(to.x - back * along.x + side * across.x),
                  static_cast<float>(to.y - back * along.y + side * across.y));
  };
  list.AddTriangleFilled(to, at(size, 0.5 * size), at(size, -0.5 * size), color);
}

class Drawing {
 public:
  Drawing(ImDrawList& list, const Shapes& shapes, const OverlayFrame& frame,
          const std::optional<ImVec2>& cursor, const Highlights& highlighted)
      : list_(list), shapes_(shapes), frame_(frame), nearest_(cursor), highlighted_(highlighted) {}

  void line(const LineShape& line) {
    const bool wide = is_highlighted(shapes_, line.row, highlighted_);
    const float width = scaled(line.width_px) * (wide ? highlighted_px : 1.0f);
    const auto draw = [&](const apps::Stretch& stretch) {
      const ImVec2 a = window(stretch.a), b = window(stretch.b);
      list_.AddLine(a, b, packed(line.color, stretch.hidden ? faint : 255), width);
      nearest_.line(line.row, a, b);
    };
    if (const std::optional<apps::Stretch> whole = short_stretch(line))
      draw(*whole);
    else
      for (const apps::Stretch& stretch : visible(line)) draw(stretch);
    if (!line.arrow) return;
    const dvec3 from = frame_.place(line.a), to = frame_.place(line.b);
    if (from.z > 0.0 && to.z > 0.0)
      draw_head(list_, {static_cast<float>(from.x), static_cast<float>(from.y)},
                {static_cast<float>(to.x), static_cast<float>(to.y)}, width, packed(line.color));
  }

  void point(const PointShape& point) {
    const dvec3 local = point.at - frame_.origin;
    const dvec3 place = frame_.view.project(local);
    if (place.z <= 0.0 || place.x < 0.0 || place.y < 0.0 || place.x >= frame_.view.width ||
        place.y >= frame_.view.height)
      return;
    const bool hidden = !point.always && is_hidden(place);
    if (hidden && point.mark == PointShape::Mark::dot) return;
    const ImVec2 at = window({place.x, place.y});
    const bool wide = is_highlighted(shapes_, point.row, highlighted_);
    draw_mark(list_, point.mark, at, scaled(point.size_px) * (wide ? 1.6f : 1.0f),
              packed(point.color, hidden ? faint : 255));
    nearest_.point(point.row, at);
  }

  void rectangle(const PictureShape& shape) {
    const double scale = frame_.size.x / shapes_.picture_width;
    const auto at = [&](const dvec2& pixel) {
      return ImVec2(static_cast<float>(frame_.corner.x + scale * pixel.x),
                    static_cast<float>(frame_.corner.y + scale * pixel.y));
    };
    const ImVec2 low = at(shape.low), high = at(shape.high);
    if (shape.filled) {
      list_.AddRectFilled(low, high, packed(shape.color));
      return;
    }
    const bool wide = is_highlighted(shapes_, shape.row, highlighted_);
    list_.AddRect(low, high, packed(shape.color), 0.0f, 0, wide ? 3.0f : 1.5f);
    nearest_.line(shape.row, low, {high.x, low.y});
    nearest_.line(shape.row, {high.x, low.y}, high);
    nearest_.line(shape.row, high, {low.x, high.y});
    nearest_.line(shape.row, {low.x, high.y}, low);
  }

  void label(const LabelShape& label) {
    const dvec3 place = frame_.view.project(label.at - frame_.origin);
    if (place.z <= 0.0) return;
    const ImVec2 at = window({place.x, place.y});
    list_.AddText({at.x + scaled(6.0f) + 1.0f, at.y - scaled(14.0f) + 1.0f}, IM_COL32(0, 0, 0, 200),
                  label.text.c_str());
    list_.AddText({at.x + scaled(6.0f), at.y - scaled(14.0f)}, packed(label.color), label.text.c_str());
  }

  const std::optional<OverlayHit>& hit() const { return nearest_.hit(); }

 private:
  ImVec2 window(const dvec2& pixel) const {
    return {static_cast<float>(frame_.corner.x + pixel.x * frame_.scale()),
            static_cast<float>(frame_.corner.y + pixel.y * frame_.scale())};
  }
  bool is_hidden(const dvec3& place) const {
    if (frame_.depth.empty()) return false;
    const size_t pixel = static_cast<size_t>(place.y) * frame_.view.width + static_cast<size_t>(place.x);
    return apps::is_hidden(place.z, frame_.depth[pixel]);
  }
  /// A line of a few pixels, hidden or visible as its middle is: meshes and outlines have thousands of them,
  /// and looking along each one costs ten times as much.
  std::optional<apps::Stretch> short_stretch(const LineShape& line) const {
    constexpr double short_px = 8.0;
    const dvec3 a = frame_.view.project(line.a - frame_.origin),
                b = frame_.view.project(line.b - frame_.origin);
    if (a.z <= frame_.view.near_m || b.z <= frame_.view.near_m) return {};
    if (glm::distance(dvec2(a), dvec2(b)) > short_px) return {};
    const dvec3 middle = 0.5 * (a + b);
    if (middle.x < 0.0 || middle.y < 0.0 || middle.x >= frame_.view.width || middle.y >= frame_.view.height)
      return {};
    return apps::Stretch{dvec2(a), dvec2(b), !line.always && is_hidden(middle)};
  }
  std::vector<apps::Stretch> visible(const LineShape& line) const {
    std::vector<apps::Stretch> stretches =
        apps::stretches_of(frame_.view, frame_.depth, line.a - frame_.origin, line.b - frame_.origin);
    if (line.always)
      for (apps::Stretch& stretch : stretches) stretch.hidden = false;
    return stretches;
  }

  ImDrawList& list_;
  const Shapes& shapes_;
  const OverlayFrame& frame_;
  Nearest nearest_;
  Highlights highlighted_;
};

}  // namespace

double distance_to_line(const ImVec2& p, const ImVec2& a, const ImVec2& b) {
  const dvec2 way(b.x - a.x, b.y - a.y), from(p.x - a.x, p.y - a.y);
  const double length2 = glm::dot(way, way);
  const double share = length2 > 0.0 ? std::clamp(glm::dot(from, way) / length2, 0.0, 1.0) : 0.0;
  return glm::length(from - share * way);
}

dvec3 OverlayFrame::place(const dvec3& world) const {
  const dvec3 pixel = view.project(world - origin);
  return {corner.x + pixel.x * scale(), corner.y + pixel.y * scale(), pixel.z};
}

std::optional<OverlayHit> draw_shapes(ImDrawList& list, const Shapes& shapes, const OverlayFrame& frame,
                                      const std::optional<ImVec2>& cursor, const Highlights& highlights,
                                      bool through_camera) {
  Drawing drawing(list, shapes, frame, cursor, highlights);
  if (through_camera && shapes.picture_width > 0.0)
    for (const PictureShape& shape : shapes.picture) drawing.rectangle(shape);
  if (cursor)  // dots are in the picture already; the nearest one is looked for
    for (const PointShape& point : shapes.points)
      if (point.mark == PointShape::Mark::dot) drawing.point(point);
  for (const LineShape& line : shapes.lines) drawing.line(line);
  for (const PointShape& point : shapes.points)
    if (point.mark != PointShape::Mark::dot) drawing.point(point);
  for (const LabelShape& label : shapes.labels) drawing.label(label);
  return drawing.hit();
}

void draw_legend(ImDrawList& list, const Shapes& shapes, const ImVec2& corner) {
  if (shapes.legend.empty()) return;
  const float line = ImGui::GetTextLineHeightWithSpacing(), margin = 0.4f * line;
  float width = 0.0f;
  for (const auto& [text, color] : shapes.legend)
    width = std::max(width, ImGui::CalcTextSize(text.c_str()).x);
  list.AddRectFilled({corner.x - margin, corner.y - margin},
                     {corner.x + line + width + margin,
                      corner.y + line * static_cast<float>(shapes.legend.size()) + 0.5f * margin},
                     legend_backing, margin);
  for (size_t i = 0; i < shapes.legend.size(); ++i) {
    const auto& [text, color] = shapes.legend[i];
    const ImVec2 at(corner.x, corner.y + line * static_cast<float>(i));
    list.AddRectFilled({at.x, at.y + 0.1f * line}, {at.x + line * 0.65f, at.y + line * 0.75f}, packed(color));
    list.AddText({at.x + line, at.y}, IM_COL32(235, 235, 235, 255), text.c_str());
  }
}

}  // namespace greatx::view
