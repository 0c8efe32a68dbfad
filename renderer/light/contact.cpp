// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/contact.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/units.h"
#include "shaders/shared/contact.h"

namespace greatx::render {

namespace {

constexpr double contact_cell_m = 4.0;
/// The most cells along a side of the grid. Where bodies are far apart, cells are larger.
constexpr uint32_t most_contact_cells = 128;

/// A raster over one side of a box that counts the places where something stands before it.
class Silhouette {
 public:
  void add(std::array<dvec2, 3> corners) {
    const dvec2 a = corners[0], ab = corners[1] - a, ac = corners[2] - a;
    const double area = ab.x * ac.y - ab.y * ac.x;
    if (std::abs(area) < 1e-12) return;
    const dvec2 low = glm::min(a, glm::min(corners[1], corners[2])),
                high = glm::max(a, glm::max(corners[1], corners[2]));
    for (int j = first_of(low.y); j <= last_of(high.y); ++j)
      for (int i = first_of(low.x); i <= last_of(high.x); ++i) {
        const dvec2 p = dvec2(i + 0.5, j + 0.5) / double(edge) - a;
        const double v = (p.x * ac.y - p.y * ac.x) / area, w = (ab.x * p.y - ab.y * p.x) / area;
        if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) filled_[static_cast<size_t>(j * edge + i)] = true;
      }
  }
  double share() const {
    return double(std::count(filled_.begin(), filled_.end(), true)) / double(filled_.size());
  }

 private:
  static constexpr int edge = 32;
  static int first_of(double x) { return std::clamp(static_cast<int>(std::ceil(x * edge - 0.5)), 0, edge); }
  static int last_of(double x) {
    return std::clamp(static_cast<int>(std::floor(x * edge - 0.5)), -1, edge - 1);
  }
  std::vector<bool> filled_ = std::vector<bool>(size_t{edge} * edge);
};

/// Calls visit(corners) for each triangle of a body and its parts, which are not turned, in the body's frame.
template <typename Visit>
void over_triangles(const scene::Scene& scene, uint32_t body, uint32_t last_part, const Visit& visit) {
  for (uint32_t part = body; part <= last_part; ++part) {
    const Pose pose = scene.bodies[part].joint ? scene.bodies[part].joint->pose(0.0) : Pose{};
    const scene::Body& mesh = scene.bodies[part];
    for (uint32_t i = mesh.first_primitive; i < mesh.first_primitive + mesh.primitive_count; ++i) {
      const scene::Primitive& primitive = scene.primitives[i];
      for (uint32_t k = 0; k < primitive.index_count; k += 3) {
        std::array<dvec3, 3> corners;
        for (uint32_t c = 0; c < 3; ++c)
          corners[c] = pose.apply(dvec3(scene.positions[scene.indices[primitive.first_index + k + c]]));
        visit(corners);
      }
    }
  }
}

double filled_share(const scene::Scene& scene, const ContactBox& box) {
  std::array<Silhouette, 3> sides;
  const dvec3 low = box.center - box.half_size, size = 2.0 * box.half_size;
  over_triangles(scene, box.body, box.last_part, [&](const std::array<dvec3, 3>& corners) {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::array<dvec2, 3> flat;
      for (int c = 0; c < 3; ++c)
        flat[c] = {(corners[c][u] - low[u]) / size[u], (corners[c][v] - low[v]) / size[v]};
      sides[axis].add(flat);
    }
  });
  double filled = 0.0, whole = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double area = size[(axis + 1) % 3] * size[(axis + 2) % 3];
    filled += area * sides[axis].share();
    whole += area;
  }
  return filled / whole;
}

/// The reach of a box over level ground: a side of area A whose middle is at height h / 2 hides A h / (2 pi
/// d^3) from a distance d.
double contact_reach(const dvec3& half_size) {
  const double area = 4.0 * std::max(half_size.x, half_size.y) * half_size.z, height = 2.0 * half_size.z;
  return std::min(std::cbrt(area * height / (2.0 * pi * contact_least_share)), contact_farthest_m);
}

/// The level grid around all boxes.
struct ContactGrid {
  dvec2 corner{0.0};
  double cell_m = contact_cell_m;
  uint32_t columns = 1, rows = 1;
};

ContactGrid grid_around(std::span<const dvec3> centers, std::span<const double> radii) {
  ContactGrid grid;
  if (centers.empty()) return grid;
  dvec2 low(1e300), high(-1e300);
  for (size_t i = 0; i < centers.size(); ++i) {
    low = glm::min(low, dvec2(centers[i]) - radii[i]);
    high = glm::max(high, dvec2(centers[i]) + radii[i]);
  }
  const dvec2 size = high - low;
  grid.corner = low;
  grid.cell_m = std::max(contact_cell_m, std::max(size.x, size.y) / most_contact_cells);
  grid.columns = static_cast<uint32_t>(size.x / grid.cell_m) + 1;
  grid.rows = static_cast<uint32_t>(size.y / grid.cell_m) + 1;
  return grid;
}

/// The part of the level plane above and below which a box may hide anything: a rectangle around the box and
/// what is within its reach of it.
class ContactArea {
 public:
  ContactArea(const ContactBox& box, const Pose& pose, const dvec3& center)
      : center_(center), reach_(box.reach + slack_m) {
    const dvec2 level(pose.rotate({1.0, 0.0, 0.0}));
    const double length = glm::length(level);
    if (length > 1e-6) along_ = level / length;
    for (int axis = 0; axis < 3; ++axis) {
      dvec3 side(0.0);
      side[axis] = box.half_size[axis];
      const dvec2 turned(pose.rotate(side));
      half_ += glm::abs(dvec2(glm::dot(turned, along_), turned.y * along_.x - turned.x * along_.y));
    }
  }
  /// Whether some point of a disc may lie in it. The shader's window is 0 at all others.
  bool meets(const dvec2& place, double radius) const {
    const dvec2 apart = place - dvec2(center_);
    const dvec2 beside(glm::dot(apart, along_), apart.y * along_.x - apart.x * along_.y);
    return glm::length(glm::max(glm::abs(beside) - half_, dvec2(0.0))) <= reach_ + radius;
  }

 private:
  static constexpr double slack_m = 0.02;  ///< for the shader's roundings
  dvec3 center_;
  double reach_;
  dvec2 along_{1.0, 0.0}, half_{0.0};
};

/// Calls visit(index) for the cells in which a box may hide something.
template <typename Visit>
void over_cells(const ContactGrid& grid, const ContactArea& area, const dvec3& center, double radius,
                const Visit& visit) {
  const dvec2 low = (dvec2(center) - radius - grid.corner) / grid.cell_m,
              high = (dvec2(center) + radius - grid.corner) / grid.cell_m;
  const auto last = [](double x, uint32_t count) {
    return std::min(static_cast<uint32_t>(std::max(x, 0.0)), count - 1);
  };
  const double half_diagonal = std::sqrt(0.5) * grid.cell_m;
  for (uint32_t row = last(low.y, grid.rows); row <= last(high.y, grid.rows); ++row)
    for (uint32_t column = last(low.x, grid.columns); column <= last(high.x, grid.columns); ++column)
      if (area.meets(grid.corner + grid.cell_m * dvec2(column + 0.5, row + 0.5), half_diagonal))
        visit(size_t{row} * grid.columns + column);
}

void put_contact_box(std::vector<uint32_t>& words, const ContactBox& box, const Pose& pose,
                     const dvec3& center, double radius) {
  const auto put = [&](const dvec3& value, double fourth) {
    for (int i = 0; i < 3; ++i) words.push_back(std::bit_cast<uint32_t>(float(value[i])));
    words.push_back(std::bit_cast<uint32_t>(float(fourth)));
  };
  put(center, box.reach);
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 unit(0.0);
    unit[axis] = 1.0;
    put(pose.rotate(unit), box.half_size[axis]);
  }
  words.push_back(std::bit_cast<uint32_t>(float(box.opacity)));
  words.push_back(box.body | box.last_part << 16);
  words.push_back(std::bit_cast<uint32_t>(float(radius * radius)));
  words.push_back(0u);
}

}  // namespace

std::vector<ContactBox> contact_boxes(const scene::Scene& scene) {
  std::vector<ContactBox> boxes;
  for (uint32_t body = 1; body < scene.bodies.size(); ++body) {
    if (scene.owner_of(body) != body) continue;
    ContactBox box;
    box.body = box.last_part = body;
    while (box.last_part + 1 < scene.bodies.size() && scene.owner_of(box.last_part + 1) == body)
      ++box.last_part;
    scene::Bounds bounds;
    over_triangles(scene, body, box.last_part, [&](const std::array<dvec3, 3>& corners) {
      for (const dvec3& corner : corners) bounds.add(corner);
    });
    if (bounds.empty()) continue;
    box.center = bounds.center();
    box.half_size = glm::max(0.5 * bounds.size(), dvec3(1e-3));
    box.opacity = filled_share(scene, box);
    box.reach = contact_reach(box.half_size);
    boxes.push_back(box);
  }
  return boxes;
}

std::vector<uint32_t> contact_words(std::span<const ContactBox> boxes, std::span<const Pose> body_poses) {
  std::vector<dvec3> centers;
  std::vector<double> radii;
  std::vector<ContactArea> areas;
  for (const ContactBox& box : boxes) {
    const Pose& pose = body_poses[box.body];
    centers.push_back(pose.apply(box.center));
    radii.push_back(glm::length(box.half_size) + box.reach);
    areas.emplace_back(box, pose, centers.back());
  }
  const ContactGrid grid = grid_around(centers, radii);
  // Counts the boxes of each cell, and then puts them in their places.
  std::vector<uint32_t> counts(size_t{grid.columns} * grid.rows, 0);
  for (size_t i = 0; i < boxes.size(); ++i)
    over_cells(grid, areas[i], centers[i], radii[i], [&](size_t cell) { ++counts[cell]; });
  const size_t lists = shared::contact_header_words + 2 * counts.size();
  std::vector<uint32_t> words(lists);
  words[shared::contact_corner_word] = std::bit_cast<uint32_t>(float(grid.corner.x));
  words[shared::contact_corner_word + 1] = std::bit_cast<uint32_t>(float(grid.corner.y));
  words[shared::contact_inverse_word] = std::bit_cast<uint32_t>(float(1.0 / grid.cell_m));
  words[shared::contact_columns_word] = grid.columns;
  words[shared::contact_rows_word] = grid.rows;
  size_t entry = lists;
  for (size_t cell = 0; cell < counts.size(); ++cell) {
    words[shared::contact_header_words + 2 * cell] = static_cast<uint32_t>(entry);
    entry += counts[cell];
  }
  const auto first_box = static_cast<uint32_t>((entry + 3) / 4);  // quadruples
  words.resize(size_t{4} * first_box);
  words.reserve(words.size() + size_t{4} * shared::contact_box_quads * boxes.size());
  for (uint32_t i = 0; i < boxes.size(); ++i)
    over_cells(grid, areas[i], centers[i], radii[i], [&](size_t cell) {
      const size_t at = shared::contact_header_words + 2 * cell;
      words[words[at] + words[at + 1]++] = first_box + shared::contact_box_quads * i;
    });
  for (uint32_t i = 0; i < boxes.size(); ++i)
    put_contact_box(words, boxes[i], body_poses[boxes[i].body], centers[i], radii[i]);
  return words;
}

}  // namespace greatx::render
