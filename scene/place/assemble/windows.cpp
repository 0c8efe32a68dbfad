// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/assemble/windows.h"

#include <algorithm>
#include <cmath>

#include "scene/place/plane/polygons.h"
#include "scene/place/plane/triangulation.h"

namespace greatx::scene::place {

namespace {

constexpr double share_of_bay = 0.45, share_of_storey = 0.45, sill_share = 0.3, margin_m = 0.2;

/// The wall in its own plane: s along it from 0 to `length`, and z.
struct WallPlane {
  const WallPiece& wall;
  dvec2 from, along;
  double length;

  explicit WallPlane(const WallPiece& piece) : wall(piece), from(to_metres(piece.from)) {
    const dvec2 way = to_metres(piece.to) - from;
    length = glm::length(way);
    along = way / length;
  }
  double low(double s) const { return glm::mix(wall.from_z.front(), wall.to_z.front(), s / length); }
  double high(double s) const { return glm::mix(wall.from_z.back(), wall.to_z.back(), s / length); }
  /// Back to space. The ends of the wall keep their exact places.
  dvec3 place(const GridPoint& p, const GridPoint& end) const {
    if (p.x == 0) return dvec3(from, to_metres(p.y));
    if (p.x == end.x) return dvec3(to_metres(wall.to), to_metres(p.y));
    return dvec3(to_metres(to_grid(from + along * to_metres(p.x))), to_metres(p.y));
  }
};

std::vector<Box> windows_of(const WallPlane& plane, const WindowLattice& lattice) {
  std::vector<Box> windows;
  const int first = static_cast<int>(std::floor(lattice.start_m / lattice.bay_m)),
            last = static_cast<int>(std::ceil((lattice.start_m + plane.length) / lattice.bay_m));
  for (int bay = first; bay < last; ++bay)
    for (int storey = 0; storey < lattice.storeys; ++storey) {
      const double middle = (bay + 0.5) * lattice.bay_m - lattice.start_m,
                   half = 0.5 * share_of_bay * lattice.bay_m;
      const double sill = lattice.base_z + (storey + sill_share) * lattice.storey_m;
      const Box window{{middle - half, sill}, {middle + half, sill + share_of_storey * lattice.storey_m}};
      const Box room = window.grown(margin_m);
      if (room.low.x < 0.0 || room.high.x > plane.length) continue;
      if (room.low.y < std::max(plane.low(room.low.x), plane.low(room.high.x))) continue;
      if (room.high.y > std::min(plane.high(room.low.x), plane.high(room.high.x))) continue;
      windows.push_back(window);
    }
  return windows;
}

}  // namespace

std::vector<WallTriangle> with_windows(const WallPiece& wall, const WindowLattice& lattice) {
  const WallPlane plane(wall);
  const std::vector<Box> windows = windows_of(plane, lattice);
  std::vector<WallTriangle> result;
  if (windows.empty()) {
    for (const auto& corners : triangles_of(wall)) result.push_back({corners, false});
    return result;
  }
  const int64_t end = to_grid(plane.length), margin = to_grid(1.0);
  const double bottom = std::min(wall.from_z.front(), wall.to_z.front()),
               top = std::max(wall.from_z.back(), wall.to_z.back());
  Triangulation mesh({-margin, to_grid(bottom) - margin}, {end + margin, to_grid(top) + margin});
  // The outline, counter-clockwise from outside: the lower edge, up at `to`, back, down at `from`.
  std::vector<uint32_t> outline;
  for (const double z : wall.to_z) outline.push_back(mesh.add({end, to_grid(z)}));
  for (size_t i = wall.from_z.size(); i-- > 0;) outline.push_back(mesh.add({0, to_grid(wall.from_z[i])}));
  std::vector<std::array<uint32_t, 4>> panes;
  for (const Box& w : windows)
    panes.push_back({mesh.add(to_grid(w.low)), mesh.add(to_grid(dvec2(w.high.x, w.low.y))),
                     mesh.add(to_grid(w.high)), mesh.add(to_grid(dvec2(w.low.x, w.high.y)))});
  for (size_t i = 0; i < outline.size(); ++i) mesh.force(outline[i], outline[(i + 1) % outline.size()]);
  for (const auto& pane : panes)
    for (size_t i = 0; i < 4; ++i) mesh.force(pane[i], pane[(i + 1) % 4]);
  for (const Triangulation::Triangle& triangle : mesh.triangles()) {
    dvec2 middle(0.0);
    for (const uint32_t c : triangle.corners) middle += to_metres(mesh.points()[c]) / 3.0;
    if (middle.x < 0.0 || middle.x > plane.length || middle.y < plane.low(middle.x) ||
        middle.y > plane.high(middle.x))
      continue;
    WallTriangle out;
    for (size_t i = 0; i < 3; ++i) out.corners[i] = plane.place(mesh.points()[triangle.corners[i]], {end, 0});
    out.window = std::any_of(windows.begin(), windows.end(), [&](const Box& w) { return w.holds(middle); });
    result.push_back(out);
  }
  return result;
}

}  // namespace greatx::scene::place
