// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/build/edge_table.h"

#include <algorithm>
#include <compare>

namespace greatx::scene {
namespace {

struct Entry {
  uint32_t low, high, triangle, side;
  auto operator<=>(const Entry&) const = default;
};

void sides_of(const std::vector<uint32_t>& vertices, const auto& visit) {
  for (size_t corner = 0; corner < vertices.size(); ++corner) {
    const uint32_t from = vertices[corner], to = vertices[corner % 3 == 2 ? corner - 2 : corner + 1];
    visit(Entry{std::min(from, to), std::max(from, to), static_cast<uint32_t>(corner / 3),
                static_cast<uint32_t>(corner % 3)});
  }
}

/// Returns all sides in order. If the vertices are numbered densely, the sides are first distributed by their
/// lower vertex, which leaves few sides to compare with each other.
std::vector<Entry> sorted_sides(const std::vector<uint32_t>& vertices) {
  const size_t most = vertices.empty() ? 0 : size_t{*std::max_element(vertices.begin(), vertices.end())} + 1;
  std::vector<Entry> entries;
  if (most > vertices.size()) {
    entries.reserve(vertices.size());
    sides_of(vertices, [&](const Entry& entry) { entries.push_back(entry); });
    std::sort(entries.begin(), entries.end());
    return entries;
  }
  std::vector<uint32_t> ends(most + 1, 0);
  sides_of(vertices, [&](const Entry& entry) { ++ends[entry.low + 1]; });
  for (size_t vertex = 0; vertex < most; ++vertex) ends[vertex + 1] += ends[vertex];
  entries.resize(vertices.size());
  sides_of(vertices, [&](const Entry& entry) { entries[ends[entry.low]++] = entry; });
  for (size_t vertex = 0, begin = 0; vertex < most; begin = ends[vertex++])
    std::sort(entries.begin() + static_cast<std::ptrdiff_t>(begin), entries.begin() + ends[vertex]);
  return entries;
}

}  // namespace

EdgeTable::EdgeTable(const std::vector<uint32_t>& vertices) : edges_(vertices.size()) {
  const std::vector<Entry> entries = sorted_sides(vertices);
  triangles_.reserve(entries.size());
  for (const Entry& entry : entries) triangles_.push_back(entry.triangle);
  for (uint32_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    while (end < entries.size() && entries[end].low == entries[begin].low &&
           entries[end].high == entries[begin].high)
      ++end;
    for (uint32_t index = begin; index < end; ++index)
      edges_[size_t{entries[index].triangle} * 3 + entries[index].side] = {begin, end - begin};
  }
}

}  // namespace greatx::scene
