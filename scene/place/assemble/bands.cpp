// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/assemble/bands.h"

#include <algorithm>
#include <cmath>

#include "scene/place/plane/grid.h"

namespace greatx::scene::place {

namespace {

constexpr double hedge_step_m = 5.0, hedge_root_m = 0.5;

class Band {
 public:
  Band(const Deck& deck, const MaterialTable& table)
      : deck_(deck),
        table_(table),
        down_(0.0, 0.0, on_grid(deck.thickness_m)),
        mesh_(dvec3(glm::floor(deck.sections.front().left), std::floor(deck.sections.front().z))) {}

  PlaceMesh make(int top, int side) {
    const size_t last = deck_.sections.size() - 1;
    for (size_t i = 0; i < last; ++i) {
      quad(top, right(i), right(i + 1), left(i + 1), left(i));
      quad(side, left(i) - down_, left(i + 1) - down_, right(i + 1) - down_, right(i) - down_);
      quad(side, right(i) - down_, right(i + 1) - down_, right(i + 1), right(i));
      quad(side, left(i + 1) - down_, left(i) - down_, left(i), left(i + 1));
    }
    quad(side, left(0) - down_, right(0) - down_, right(0), left(0));
    quad(side, right(last) - down_, left(last) - down_, left(last), right(last));
    return std::move(mesh_);
  }

 private:
  dvec3 place(const dvec2& p, double z) const { return dvec3(to_metres(to_grid(p)), on_grid(z)); }
  dvec3 left(size_t i) const { return place(deck_.sections[i].left, deck_.sections[i].z); }
  dvec3 right(size_t i) const { return place(deck_.sections[i].right, deck_.sections[i].z); }

  void quad(int material, const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    for (const auto& t : {std::array<dvec3, 3>{a, b, c}, std::array<dvec3, 3>{a, c, d}}) {
      const dvec3 cross = glm::cross(t[1] - t[0], t[2] - t[0]);
      if (!(glm::length(cross) > 1e-9)) continue;
      std::array<dvec2, 3> uvs;
      for (size_t i = 0; i < 3; ++i)
        uvs[i] = uv_on_plane(table_[material].tile_m, t[i] - mesh_.anchor(), glm::normalize(cross));
      mesh_.triangle(material, t, uvs);
    }
  }

  const Deck& deck_;
  const MaterialTable& table_;
  dvec3 down_;
  PlaceMesh mesh_;
};

}  // namespace

PlaceMesh band_mesh(const Deck& deck, int top, int side, const MaterialTable& table) {
  return deck.sections.size() < 2 ? PlaceMesh() : Band(deck, table).make(top, side);
}

Deck hedge_band(const Hedge& hedge, const std::function<double(const dvec2&)>& ground) {
  std::vector<dvec2> points;
  for (size_t i = 0; i + 1 < hedge.line.size(); ++i) {
    const double length = glm::distance(hedge.line[i], hedge.line[i + 1]);
    if (length < 0.05) continue;
    const int steps = static_cast<int>(std::ceil(length / hedge_step_m));
    for (int k = 0; k < steps; ++k)
      points.push_back(glm::mix(hedge.line[i], hedge.line[i + 1], static_cast<double>(k) / steps));
  }
  if (!points.empty()) points.push_back(hedge.line.back());
  Deck deck;
  deck.thickness_m = hedge.height_m + hedge_root_m;
  for (size_t i = 0; i < points.size(); ++i) {
    const dvec2 before = points[i > 0 ? i - 1 : 0], after = points[std::min(i + 1, points.size() - 1)];
    if (glm::distance(before, after) < 0.01) continue;  // the line turns back on itself
    const dvec2 along = glm::normalize(after - before),
                half = dvec2(-along.y, along.x) * (0.5 * hedge.width_m);
    deck.sections.push_back({points[i] + half, points[i] - half, ground(points[i]) + hedge.height_m});
  }
  return deck;
}

}  // namespace greatx::scene::place
