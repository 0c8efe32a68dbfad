// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/box_shell.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "scene/generator/objects/smooth_mesh.h"

namespace greatx::scene::generator {

namespace {

/// One column along the side: its x on the higher levels, and its corner on the lowest one.
struct SideColumn {
  double x;
  dvec2 foot;    ///< x, z
  double order;  ///< x of the station or the axle
};

std::vector<SideColumn> side_columns(const BoxShell& shell) {
  std::vector<SideColumn> columns;
  const double sill = shell.levels.front().z, r = shell.arch_radius;
  for (const double x : shell.stations) columns.push_back({x, {x, sill}, x});
  for (const double axle : shell.arches) {
    const double start = std::asin(std::clamp((sill - shell.wheel_radius) / r, -1.0, 1.0));
    for (int i = 0; i <= 6; ++i) {
      const double angle = start + (pi - 2.0 * start) * i / 6.0;
      columns.push_back({axle + (i < 2   ? r
                                 : i > 4 ? -r
                                         : 0.0),
                         {axle + r * std::cos(angle), shell.wheel_radius + r * std::sin(angle)},
                         axle});
    }
  }
  std::stable_sort(columns.begin(), columns.end(),
                   [](const SideColumn& a, const SideColumn& b) { return a.order > b.order; });
  return columns;
}

}  // namespace

void add_box_shell(MeshBuilder& mesh, const BoxShell& shell) {
  const std::vector<SideColumn> sides = side_columns(shell);
  const size_t columns = sides.size() + 6;
  HalfGrid grid;
  for (size_t k = 0; k < shell.levels.size(); ++k) {
    const BoxShell::Level& level = shell.levels[k];
    const double y = shell.half_width - level.inset, c = shell.corner;
    const double front = shell.front_x - level.front, rear = shell.rear_x + level.rear;
    std::vector<dvec3> row{
        {front, y - c, level.z}, {front - 0.29 * c, y - 0.29 * c, level.z}, {front - c, y, level.z}};
    for (const SideColumn& column : sides)
      row.push_back(k == 0 ? dvec3(column.foot.x, y, column.foot.y)
                           : dvec3(std::clamp(column.x, rear + c, front - c), y, level.z));
    row.insert(row.end(),
               {{rear + c, y, level.z}, {rear + 0.29 * c, y - 0.29 * c, level.z}, {rear, y - c, level.z}});
    grid.rows.push_back(std::move(row));
  }
  grid.cell = [&](size_t k, size_t cell) {
    const ShellZone zone = cell == 0             ? ShellZone::front
                           : cell <= 2           ? ShellZone::front_corner
                           : cell == columns     ? ShellZone::rear
                           : cell >= columns - 2 ? ShellZone::rear_corner
                                                 : ShellZone::side;
    const std::vector<dvec3>& row = grid.rows[k + 1];
    const double x = cell == 0         ? row.front().x
                     : cell == columns ? row.back().x
                                       : 0.5 * (row[cell - 1].x + row[cell].x);
    return shell.cell(k, zone, x);
  };
  grid.bottom = shell.bottom;
  grid.top = [&](size_t) { return shell.roof; };
  SmoothMesh body;
  add_half_grid(body, grid);
  body.add_to(mesh, 38.0 * pi / 180.0);
}

}  // namespace greatx::scene::generator
