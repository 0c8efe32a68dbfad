// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/present/ui_changes.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace greatx::gpu {

namespace {

/// More rectangles become one. Each costs a walk through all commands.
constexpr size_t most_rects = 24;

bool is_empty(const VkRect2D& rect) { return rect.extent.width == 0 || rect.extent.height == 0; }

struct Corners {
  int64_t x0, y0, x1, y1;
  friend bool operator==(const Corners&, const Corners&) = default;
};
Corners corners(const VkRect2D& r) {
  return {r.offset.x, r.offset.y, int64_t{r.offset.x} + r.extent.width,
          int64_t{r.offset.y} + r.extent.height};
}
VkRect2D rect_of(const Corners& c) {
  if (c.x1 <= c.x0 || c.y1 <= c.y0) return {};
  return {{static_cast<int32_t>(c.x0), static_cast<int32_t>(c.y0)},
          {static_cast<uint32_t>(c.x1 - c.x0), static_cast<uint32_t>(c.y1 - c.y0)}};
}
VkRect2D around(const VkRect2D& a, const VkRect2D& b) {
  const Corners p = corners(a), q = corners(b);
  return rect_of({std::min(p.x0, q.x0), std::min(p.y0, q.y0), std::max(p.x1, q.x1), std::max(p.y1, q.y1)});
}

/// Mixes a number into a hash, after MurmurHash3's 64-bit finalizer.
void mix(uint64_t& hash, uint64_t value) {
  hash ^= value;
  hash *= 0xff51afd7ed558ccdULL;
  hash ^= hash >> 33;
}
uint64_t pair_of(float a, float b) {
  return (uint64_t{std::bit_cast<uint32_t>(a)} << 32) | std::bit_cast<uint32_t>(b);
}

/// Adds a rectangle. Those that overlap become one.
void add(std::vector<VkRect2D>& rects, VkRect2D rect) {
  if (is_empty(rect)) return;
  for (size_t i = 0; i < rects.size();) {
    if (is_empty(intersection(rects[i], rect))) {
      ++i;
      continue;
    }
    rect = around(rects[i], rect);  // it may overlap with more of them now
    rects.erase(rects.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;
  }
  rects.push_back(rect);
  if (rects.size() <= most_rects) return;
  VkRect2D all = rects.front();
  for (const VkRect2D& each : rects) all = around(all, each);
  rects.assign(1, all);
}

}  // namespace

std::optional<VkRect2D> opaque_quad(const UiCommand& command, const UiDrawing& drawing) {
  if (command.index_count != 6) return {};
  const auto corner = [&](uint32_t i) -> const UiVertex& {
    return drawing.vertices[drawing.indices[command.first_index + i] + command.first_vertex];
  };
  // As ImGui draws pictures: upper left, upper right, lower right; upper left, lower right, lower left.
  const UiVertex &a = corner(0), &b = corner(1), &c = corner(2), &d = corner(5);
  const auto same = [&](uint32_t i, const UiVertex& v) { return corner(i).x == v.x && corner(i).y == v.y; };
  if (a.y != b.y || b.x != c.x || c.y != d.y || d.x != a.x || !same(3, a) || !same(4, c)) return {};
  for (uint32_t i = 0; i < 6; ++i)
    if (corner(i).rgba != 0xffffffffu) return {};
  const float x0 = std::min(a.x, c.x), y0 = std::min(a.y, c.y), x1 = std::max(a.x, c.x),
              y1 = std::max(a.y, c.y);
  const auto pixel = [](float value) { return static_cast<int64_t>(std::clamp(value, -1e6f, 1e6f)); };
  return rect_of({pixel(std::ceil(x0)), pixel(std::ceil(y0)), pixel(std::floor(x1)), pixel(std::floor(y1))});
}

bool same_rect(const VkRect2D& a, const VkRect2D& b) { return corners(a) == corners(b); }

VkRect2D intersection(const VkRect2D& a, const VkRect2D& b) {
  const Corners p = corners(a), q = corners(b);
  return rect_of({std::max(p.x0, q.x0), std::max(p.y0, q.y0), std::min(p.x1, q.x1), std::min(p.y1, q.y1)});
}

std::vector<VkRect2D> UiChanges::update(VkExtent2D extent, const UiDrawing& drawing,
                                        const std::function<uint64_t(PresentTextureId)>& version_of) {
  const VkRect2D whole{{0, 0}, extent};
  std::vector<Drawn> drawn;
  drawn.reserve(drawing.commands.size());
  for (const UiCommand& command : drawing.commands) {
    Drawn& now = drawn.emplace_back();
    mix(now.content, command.texture);
    mix(now.content, version_of(command.texture));
    // As floats, so that corners far outside do no harm.
    float x0 = 1e9f, y0 = 1e9f, x1 = -1e9f, y1 = -1e9f;
    for (uint32_t i = 0; i < command.index_count; ++i) {
      const UiVertex& v = drawing.vertices[drawing.indices[command.first_index + i] + command.first_vertex];
      mix(now.content, pair_of(v.x, v.y));
      mix(now.content, pair_of(v.u, v.v) + v.rgba);
      x0 = std::min(x0, v.x), y0 = std::min(y0, v.y);
      x1 = std::max(x1, v.x), y1 = std::max(y1, v.y);
    }
    const auto clamped = [](float value, uint32_t most) {
      return static_cast<int64_t>(std::clamp(value, 0.0f, static_cast<float>(most)));
    };
    const VkRect2D box =
        rect_of({clamped(std::floor(x0), extent.width), clamped(std::floor(y0), extent.height),
                 clamped(std::ceil(x1), extent.width), clamped(std::ceil(y1), extent.height)});
    now.place = intersection(box, command.clip);
  }
  std::vector<VkRect2D> changed;
  if (extent.width != extent_.width || extent.height != extent_.height) {
    add(changed, whole);
  } else {
    for (size_t i = 0; i < std::max(drawn.size(), last_.size()); ++i) {
      const Drawn then = i < last_.size() ? last_[i] : Drawn{}, now = i < drawn.size() ? drawn[i] : Drawn{};
      if (then.content == now.content && corners(then.place) == corners(now.place)) continue;
      add(changed, then.place);
      add(changed, now.place);
    }
  }
  extent_ = extent;
  last_ = std::move(drawn);
  return changed;
}

}  // namespace greatx::gpu
