// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/shapes.h"

#include "core/error.h"

namespace greatx::view {

void Shapes::append(const Shapes& other) {
  if (&other == this) {
    const Shapes copy = other;
    append(copy);
    return;
  }
  GREATX_CHECK(rows.size() + other.rows.size() < ~0u, "{} and {} rows", rows.size(), other.rows.size());
  const auto first = static_cast<uint32_t>(rows.size());
  const auto add = [first](auto& to, const auto& from) {
    to.reserve(to.size() + from.size());
    for (auto shape : from) {
      if (shape.row != ~0u) shape.row += first;
      to.push_back(shape);
    }
  };
  add(lines, other.lines);
  add(points, other.points);
  if (!other.picture.empty()) {
    GREATX_CHECK(picture.empty() || picture_width == other.picture_width, "pictures of {} and {} columns",
                 picture_width, other.picture_width);
    picture_width = other.picture_width;
    add(picture, other.picture);
  }
  labels.insert(labels.end(), other.labels.begin(), other.labels.end());
  rows.insert(rows.end(), other.rows.begin(), other.rows.end());
  legend.insert(legend.end(), other.legend.begin(), other.legend.end());
}

uint32_t Shapes::add_row(std::string text, uint64_t id) {
  GREATX_CHECK(rows.size() + 1 < ~0u, "{} rows", rows.size());
  rows.push_back({std::move(text), id});
  return static_cast<uint32_t>(rows.size() - 1);
}

void Shapes::note(std::string text) { legend.emplace_back(std::move(text), io::Color{200, 204, 212}); }

}  // namespace greatx::view
