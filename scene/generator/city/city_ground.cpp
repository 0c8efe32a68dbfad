// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/city/city_ground.h"

#include <algorithm>
#include <cmath>

#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

/// The frame of a street is a margin without cuts along the kerbs and at both ends, so that neighbours meet a
/// street in single edges.
constexpr double frame_side_m = 0.15;
constexpr double frame_end_m = 0.7;
constexpr double kerb_width_m = 0.2;  ///< of the stones along a pavement

/// A row across the street within the frame. `cuts` are fractions of the width of the street. Cell i lies
/// between the cuts i and i + 1.
struct Row {
  double length_m = 0.0;
  std::vector<double> cuts;
  std::vector<bool> marked;
};

/// Makes a row with a marking [first, second] for each pair of `marks` (fractions of the width, ascending).
Row make_row(double length, double width, const std::vector<std::pair<double, double>>& marks) {
  Row row{length, {frame_side_m / width}, {}};
  for (const auto& [from, to] : marks) {
    row.cuts.insert(row.cuts.end(), {from, to});
    row.marked.insert(row.marked.end(), {false, true});
  }
  row.cuts.push_back(1.0 - frame_side_m / width);
  row.marked.push_back(false);
  return row;
}

/// Makes a row with lines of 0.12 m (dashes or solid lines) around `lines`, fractions of the width.
Row line_row(double length, double width, const std::vector<double>& lines) {
  std::vector<std::pair<double, double>> marks;
  for (const double line : lines) marks.emplace_back(line - 0.06 / width, line + 0.06 / width);
  return make_row(length, width, marks);
}

/// Makes a row of a zebra crossing: bars of 0.5 m, 0.6 m apart, along the direction of travel.
Row zebra_row(double width) {
  const int bars = static_cast<int>((width - 0.6) / 1.1);
  const double first = 0.5 * (width - 1.1 * bars + 0.6);
  std::vector<std::pair<double, double>> marks;
  for (int i = 0; i < bars; ++i)
    marks.emplace_back((first + 1.1 * i) / width, (first + 1.1 * i + 0.5) / width);
  return make_row(3.0, width, marks);
}

/// Makes the rows between the two ends of the frame, which are `length` apart.
std::vector<Row> make_rows(const Street& street, double length, double width) {
  const Row plain = make_row(1.5, width, {});
  const bool head = street.crossing[0], tail = street.crossing[1];
  // Traffic keeps to the right. It stops before the crossing at the far end on the right half, and before the
  // one at the near end on the left half.
  const double rim = 0.35 / width, middle = 0.2 / width;
  const Row stop_left = make_row(0.4, width, {{rim, 0.5 - middle}}),
            stop_right = make_row(0.4, width, {{0.5 + middle, 1.0 - rim}});
  std::vector<Row> rows;
  if (head) rows = {zebra_row(width), plain, stop_left, plain};
  const double used = (head ? 6.4 : 0.0) + (tail ? 6.4 : 0.0);
  // Dashes are 3 m long, every 9 m, stretched to fit. An avenue has a solid line in the middle and two dashed
  // lines.
  const int dashes = std::max(1, static_cast<int>((length - used + 6.0) / 9.0));
  const double unit = (length - used) / (3.0 * dashes - 2.0);
  for (int i = 0; i < dashes; ++i) {
    if (i > 0)
      rows.push_back(street.avenue ? line_row(2 * unit, width, {0.5}) : make_row(2 * unit, width, {}));
    rows.push_back(line_row(unit, width, street.avenue ? std::vector{0.27, 0.5, 0.73} : std::vector{0.5}));
  }
  if (tail) rows.insert(rows.end(), {plain, stop_right, plain, zebra_row(width)});
  return rows;
}

using Chain = std::vector<dvec2>;

/// Gives texture coordinates along a street, so that the wheel tracks of the texture follow the lanes.
struct Lane {
  dvec2 middle{0.0}, along{0.0, 1.0};
  dvec2 uv(int material, const dvec2& p) const {
    const dvec2 tile = material_library()[static_cast<size_t>(material)].tile_m, d = p - middle;
    return {0.5 + (d.x * along.y - d.y * along.x) / tile.x, -glm::dot(d, along) / tile.y};
  }
};

/// Fills the cell between two chains of points (each from left to right) with triangles.
void zip(MeshBuilder& mesh, int material, const Lane& lane, const Chain& low, const Chain& high) {
  const auto triangle = [&](const dvec2& a, const dvec2& b, const dvec2& c) {
    mesh.triangle(material, {dvec3(a, 0.0), dvec3(b, 0.0), dvec3(c, 0.0)},
                  {lane.uv(material, a), lane.uv(material, b), lane.uv(material, c)});
  };
  size_t i = 0, j = 0;
  while (i + 1 < low.size() || j + 1 < high.size()) {
    // Advance on the side that is behind.
    const bool advance_low =
        j + 1 == high.size() ||
        (i + 1 < low.size() && static_cast<double>(i + 1) / static_cast<double>(low.size()) <=
                                   static_cast<double>(j + 1) / static_cast<double>(high.size()));
    if (advance_low) {
      triangle(low[i], low[i + 1], high[j]);
      ++i;
    } else {
      triangle(low[i], high[j + 1], high[j]);
      ++j;
    }
  }
}

void add_street(const Street& street, MeshBuilder& road, MeshBuilder& markings) {
  const double length =
      0.5 * (glm::length(street.left[1] - street.left[0]) + glm::length(street.right[1] - street.right[0]));
  const double width =
      0.5 * (glm::length(street.left[0] - street.right[0]) + glm::length(street.left[1] - street.right[1]));
  const std::vector<Row> rows = make_rows(street, length - 2.0 * frame_end_m, width);
  const int asphalt = material("asphalt"), paint = material("road_marking");

  const dvec2 start_middle = 0.5 * (street.left[0] + street.right[0]);
  const Lane lane{start_middle, glm::normalize(0.5 * (street.left[1] + street.right[1]) - start_middle)};

  // The points on the boundary below row i are the cuts of both rows that meet there.
  std::vector<std::vector<double>> cuts(rows.size() + 1);
  for (size_t i = 0; i < rows.size(); ++i)
    for (const size_t boundary : {i, i + 1})
      cuts[boundary].insert(cuts[boundary].end(), rows[i].cuts.begin(), rows[i].cuts.end());
  for (auto& c : cuts) {
    std::sort(c.begin(), c.end());
    c.erase(std::unique(c.begin(), c.end(), [](double a, double b) { return b - a < 1e-9; }), c.end());
  }
  const auto point = [&](double along, double across) {
    const dvec2 left = glm::mix(street.left[0], street.left[1], along);
    const dvec2 right = glm::mix(street.right[0], street.right[1], along);
    return snap(glm::mix(left, right, across));
  };
  const auto chain = [&](size_t boundary, double along, double from, double to) {
    Chain points;
    for (const double cut : cuts[boundary])
      if (cut >= from - 1e-9 && cut <= to + 1e-9) points.push_back(point(along, cut));
    return points;
  };
  double start = frame_end_m / length;
  Chain inner_left{point(start, cuts[0].front())}, inner_right{point(start, cuts[0].back())};
  zip(road, asphalt, lane, {street.left[0], street.right[0]}, chain(0, start, 0.0, 1.0));
  for (size_t i = 0; i < rows.size(); ++i) {
    const double end = start + rows[i].length_m / length;
    for (size_t cell = 0; cell + 1 < rows[i].cuts.size(); ++cell) {
      const double from = rows[i].cuts[cell], to = rows[i].cuts[cell + 1];
      const bool marked = rows[i].marked[cell];
      zip(marked ? markings : road, marked ? paint : asphalt, lane, chain(i, start, from, to),
          chain(i + 1, end, from, to));
    }
    start = end;
    inner_left.push_back(point(start, cuts[i + 1].front()));
    inner_right.push_back(point(start, cuts[i + 1].back()));
  }
  zip(road, asphalt, lane, chain(rows.size(), start, 0.0, 1.0), {street.left[1], street.right[1]});
  zip(road, asphalt, lane, inner_left, {street.left[0], street.left[1]});
  zip(road, asphalt, lane, {street.right[0], street.right[1]}, inner_right);
}

}  // namespace

void add_streets(const CityPlan& plan, MeshBuilder& road, MeshBuilder& markings) {
  for (const std::vector<dvec2>& outline : plan.junctions)
    road.flat_polygon(material("asphalt"), outline, 0.0, true);
  for (const Street& street : plan.streets) add_street(street, road, markings);
}

void add_block_ground(const Block& block, int surface, MeshBuilder& pavement, MeshBuilder& courtyard) {
  const std::vector<dvec2> outer = block.outline();
  const std::vector<dvec2> inner = inset(outer, block.outline_insets()), behind = inset(outer, kerb_width_m);
  const int slabs = material("pavement"), kerb = material("kerb");
  const double z = pavement_height_m;
  size_t index = 0;
  for (size_t corner = 0; corner < 4; ++corner)
    for (size_t k = 0; k < block.corners[corner].size(); ++k, ++index) {
      const size_t next = (index + 1) % outer.size();
      pavement.quad(kerb, dvec3(outer[index], z), dvec3(outer[next], z), dvec3(behind[next], z),
                    dvec3(behind[index], z));
      pavement.quad(slabs, dvec3(behind[index], z), dvec3(behind[next], z), dvec3(inner[next], z),
                    dvec3(inner[index], z));
      const bool last = k + 1 == block.corners[corner].size();
      if (last && !block.street[corner]) continue;  // the base closes the model's edge
      pavement.quad(kerb, dvec3(outer[index], 0.0), dvec3(outer[next], 0.0), dvec3(outer[next], z),
                    dvec3(outer[index], z));
    }
  courtyard.flat_polygon(surface, inner, z, true);
}

void add_base(const CityPlan& plan, MeshBuilder& base) {
  const int subsoil = material("subsoil");
  const double bottom = -1.0;
  const dvec3 middle(0.0, 0.0, bottom);
  const auto side = [&](const dvec2& a, const dvec2& b, bool block) {
    base.quad(subsoil, dvec3(a, bottom), dvec3(b, bottom), dvec3(b, 0.0), dvec3(a, 0.0));
    if (block)
      base.quad(subsoil, dvec3(a, 0.0), dvec3(b, 0.0), dvec3(b, pavement_height_m),
                dvec3(a, pavement_height_m));
    const dvec3 pa(a, bottom), pb(b, bottom), down(0, 0, -1);
    base.triangle(
        subsoil, {middle, pb, pa},
        {planar_uv(subsoil, middle, down), planar_uv(subsoil, pb, down), planar_uv(subsoil, pa, down)});
  };
  const int last = plan.blocks - 1;
  for (int edge = 0; edge < 4; ++edge)
    for (int i = 0; i <= last; ++i) {
      // The edges are counter-clockwise around the model. Between two blocks a street ends.
      const auto block = [&](int k) -> const Block& {
        switch (edge) {
          case 0:
            return plan.at(k, 0);
          case 1:
            return plan.at(last, k);
          case 2:
            return plan.at(last - k, last);
          default:
            return plan.at(0, last - k);
        }
      };
      side(block(i).edge_start(edge), block(i).edge_end(edge), true);
      if (i < last) side(block(i).edge_end(edge), block(i + 1).edge_start(edge), false);
    }
}

}  // namespace greatx::scene::generator
