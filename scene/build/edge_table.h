// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace greatx::scene {

/// For every triangle and side, the triangles that share that edge.
class EdgeTable {
 public:
  /// Three vertices a triangle: equal numbers are the same place.
  explicit EdgeTable(const std::vector<uint32_t>& vertices);

  /// Those around an edge, this one among them: ascending.
  struct Edge {
    uint32_t first = 0, count = 0;  ///< into triangles(); `first` tells edges apart
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
