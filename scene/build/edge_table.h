// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace greatx::scene {

/// Gives, for every triangle and side, the triangles that share that edge.
class EdgeTable {
 public:
  /// `vertices` has three numbers per triangle. Equal numbers denote the same place.
  explicit EdgeTable(const std::vector<uint32_t>& vertices);

  /// The triangles around an edge, ascending, including the given one.
  struct Edge {
    uint32_t first = 0, count = 0;  ///< range of triangles(); `first` identifies the edge
  };
  Edge edge(uint32_t triangle, uint32_t side) const { return edges_[size_t{triangle} * 3 + side]; }
  std::span<const uint32_t> triangles(const Edge& edge) const {
    return std::span(triangles_).subspan(edge.first, edge.count);
  }

 private:
  std::vector<uint32_t> triangles_;  ///< edge by edge
  std::vector<Edge> edges_;          ///< [triangle * 3 + side]
};

}  // namespace greatx::scene
