// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "apps/place/report.h"
#include "draw/canvas/canvas.h"
#include "scene/place/ground/cover_map.h"

namespace greatx::apps {

namespace {

using namespace scene::place;

constexpr int panel_px = 900, margin_px = 12, title_px = 28;

io::Color color_of(Cover cover) {
  switch (cover) {
    case Cover::road:
      return {96, 96, 100};
    case Cover::parking:
      return {124, 124, 128};
    case Cover::path:
    case Cover::square:
      return {178, 170, 158};
    case Cover::rail:
      return {120, 104, 96};
    case Cover::water:
      return {86, 132, 176};
    case Cover::wood:
      return {70, 110, 62};
    case Cover::grass:
    case Cover::pitch:
      return {134, 172, 96};
    case Cover::meadow:
    case Cover::scrub:
    case Cover::wetland:
      return {150, 172, 112};
    case Cover::farmland:
      return {196, 186, 128};
    case Cover::sand:
      return {222, 206, 160};
    case Cover::rock:
      return {160, 158, 152};
    default:
      return {196, 200, 180};
  }
}

/// One of the two panels: places to pixels, north up.
struct Panel {
  io::Rect rect;
  Box box;
  double scale = 1.0;  ///< pixels per metre
  dvec2 pixel(const dvec2& p) const {
    return {rect.x + (p.x - box.low.x) * scale, rect.y + (box.high.y - p.y) * scale};
  }
  dvec2 place(int x, int y) const {
    return {box.low.x + (x - rect.x + 0.5) / scale, box.high.y - (y - rect.y + 0.5) / scale};
  }
};

void draw_ring(io::Canvas& canvas, const Panel& panel, const Ring& ring, bool closed, io::Color color) {
  for (size_t i = 0; i + (closed ? 0 : 1) < ring.size(); ++i) {
    const dvec2 a = panel.pixel(ring[i]), b = panel.pixel(ring[(i + 1) % ring.size()]);
    canvas.line(a.x, a.y, b.x, b.y, 1.0, color);
  }
}

void draw_sources(io::Canvas& canvas, const Panel& panel, const PlaceInput& input) {
  canvas.fill(panel.rect, {250, 250, 248});
  canvas.clip(panel.rect);
  for (const Feature& feature : input.features) {
    const bool building = feature.tag("building") || feature.tag("building:part");
    const io::Color color = building ? io::Color{150, 40, 30} : io::Color{110, 130, 150};
    for (const Polygon& polygon : feature.polygons) {
      draw_ring(canvas, panel, polygon.outer, true, color);
      for (const Ring& hole : polygon.holes) draw_ring(canvas, panel, hole, true, color);
    }
    for (const auto& line : feature.lines) draw_ring(canvas, panel, line, false, color);
    for (const SolidFace& face : feature.faces) {
      if (face.kind == SolidFace::Kind::wall) continue;
      for (const auto& ring : face.rings) {
        Ring plan;
        for (const dvec3& p : ring) plan.emplace_back(p);
        draw_ring(canvas, panel, plan, true, color);
      }
    }
    if (feature.point) {
      const dvec2 p = panel.pixel(*feature.point);
      canvas.disc(p.x, p.y, 1.6, color);
    }
  }
  canvas.unclip();
}

void draw_built(io::Canvas& canvas, const Panel& panel, const BuiltPlace& built) {
  const CoverMap covers(built.ground.areas, panel.box);
  for (int y = panel.rect.y; y < panel.rect.bottom(); ++y)
    for (int x = panel.rect.x; x < panel.rect.right(); ++x)
      canvas.blend(x, y, color_of(covers.at(panel.place(x, y))));
  for (const Bridge& bridge : built.ground.bridges)
    for (const Polygon& polygon : band(bridge.line, bridge.width_m)) {
      const Box box = box_of(polygon);
      const dvec2 low = panel.pixel(box.low), high = panel.pixel(box.high);
      for (int y = std::max(panel.rect.y, int(high.y)); y <= std::min(panel.rect.bottom() - 1, int(low.y));
           ++y)
        for (int x = std::max(panel.rect.x, int(low.x)); x <= std::min(panel.rect.right() - 1, int(high.x));
             ++x)
          if (contains(polygon, panel.place(x, y))) canvas.blend(x, y, color_of(bridge.cover));
    }
  double highest = 10.0;
  for (const Building& building : built.buildings)
    for (const Part& part : building.parts) highest = std::max(highest, part.top_z - building.ground_z);
  std::vector<double> top(size_t(panel.rect.width) * size_t(panel.rect.height), -1e300);
  for (const Building& building : built.buildings)
    for (const Part& part : building.parts)
      for (const RoofFace& face : part.roof) {
        // Light from the north-west, as on maps.
        const dvec3 normal = glm::normalize(dvec3(-face.plane.slope, 1.0));
        const double light =
            0.35 + 0.65 * std::max(0.0, glm::dot(normal, glm::normalize(dvec3(-1.0, 1.0, 1.4))));
        for (const Polygon& polygon : face.area) {
          const Box box = box_of(polygon);
          const dvec2 low = panel.pixel(box.low), high = panel.pixel(box.high);
          for (int y = std::max(panel.rect.y, int(high.y));
               y <= std::min(panel.rect.bottom() - 1, int(low.y)); ++y)
            for (int x = std::max(panel.rect.x, int(low.x));
                 x <= std::min(panel.rect.right() - 1, int(high.x)); ++x) {
              const dvec2 p = panel.place(x, y);
              if (!contains(polygon, p)) continue;
              double& height =
                  top[size_t(y - panel.rect.y) * size_t(panel.rect.width) + size_t(x - panel.rect.x)];
              if (face.plane.z(p) <= height) continue;
              height = face.plane.z(p);
              io::Color color = io::viridis(std::clamp((height - building.ground_z) / highest, 0.0, 1.0));
              for (uint8_t* channel : {&color.r, &color.g, &color.b})
                *channel = static_cast<uint8_t>(std::min(255.0, *channel * light * 1.1));
              canvas.blend(x, y, color);
            }
        }
      }
}

}  // namespace

Array picture_of(const BuiltPlace& built, const PlaceInput& input) {
  const Box& box = built.report.rectangle;
  const dvec2 size = box.high - box.low;
  const double scale = panel_px / std::max(size.x, size.y);
  const int width = std::max(1, int(std::lround(size.x * scale))),
            height = std::max(1, int(std::lround(size.y * scale)));
  io::Canvas canvas(2 * width + 3 * margin_px, height + title_px + 2 * margin_px, {255, 255, 255});
  const Panel left{{margin_px, title_px, width, height}, box, scale};
  const Panel right{{2 * margin_px + width, title_px, width, height}, box, scale};
  draw_sources(canvas, left, input);
  draw_built(canvas, right, built);
  canvas.text(margin_px, 8, "sources", 2, {30, 30, 30});
  canvas.text(right.rect.x, 8,
              fmt::format("built, roofs by height; {:.0f} m x {:.0f} m, north up", size.x, size.y), 2,
              {30, 30, 30});
  return canvas.image();
}

}  // namespace greatx::apps
