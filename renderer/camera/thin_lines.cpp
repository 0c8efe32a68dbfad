// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/thin_lines.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "renderer/camera/faces.h"
#include "shaders/shared/lines.h"

namespace greatx::render {

namespace {

constexpr double most_width_m = 0.25, least_slimness = 6.0;
constexpr size_t most_open_sides = 16;      ///< of prisms of which more sides may follow
constexpr uint32_t most_gap_triangles = 8;  ///< between two sides of a prism

/// Holds a long quadrilateral of two triangles: its long edges, in the direction of the first one.
struct LongSide {
  std::array<std::array<vec3, 2>, 2> edges;
  uint32_t triangle = 0;
};

/// Returns the side that two triangles that follow each other form; nothing if they form none.
std::optional<LongSide> long_side(const scene::Scene& scene, uint32_t triangle) {
  std::array<vec3, 6> p;
  for (size_t i = 0; i < 6; ++i) p[i] = scene.positions[scene.indices[3 * size_t{triangle} + i]];
  // The corner of each triangle that the other does not have.
  const auto lone = [&](size_t of, size_t other) -> std::optional<size_t> {
    std::optional<size_t> found;
    for (size_t i = of; i < of + 3; ++i) {
      const auto* begin = p.data() + other;
      if (std::find(begin, begin + 3, p[i]) != begin + 3) continue;
      if (found) return std::nullopt;
      found = i - of;
    }
    return found;
  };
  const auto first = lone(0, 3), second = lone(3, 0);
  if (!first || !second) return std::nullopt;
  const std::array<vec3, 4> quad{p[*first], p[(*first + 1) % 3], p[3 + *second], p[(*first + 2) % 3]};
  const auto edge_m = [&](size_t i) { return glm::distance(dvec3(quad[i]), dvec3(quad[(i + 1) % 4])); };
  const std::array<double, 4> edges_m{edge_m(0), edge_m(1), edge_m(2), edge_m(3)};
  for (size_t k = 0; k < 2; ++k) {
    const double across = std::max(edges_m[k + 1], edges_m[(k + 3) % 4]);
    if (std::min(edges_m[k], edges_m[k + 2]) < least_slimness * across || across > most_width_m) continue;
    return LongSide{{{{quad[k], quad[k + 1]}, {quad[(k + 3) % 4], quad[k + 2]}}}, triangle};
  }
  return std::nullopt;
}

/// Turns a side around so that `edge` is its first. Returns whether the side has that edge.
bool begin_with(LongSide& side, const std::array<vec3, 2>& edge) {
  const auto is = [&](const std::array<vec3, 2>& other) {
    return other == edge || (other[0] == edge[1] && other[1] == edge[0]);
  };
  if (!is(side.edges[0])) std::swap(side.edges[0], side.edges[1]);
  if (!is(side.edges[0])) return false;
  if (side.edges[0] != edge)
    for (auto& each : side.edges) std::swap(each[0], each[1]);
  return true;
}

/// Takes the sides of a prism that the last of `open` closes out of it; empty if it closes none.
std::vector<LongSide> take_ring(std::vector<LongSide>& open) {
  std::vector<LongSide> ring{open.back()};
  std::vector<size_t> taken{open.size() - 1};
  while (ring.size() < 3 || ring.back().edges[1] != ring.front().edges[0]) {
    bool found = false;
    for (size_t i = 0; i < open.size() && !found; ++i) {
      if (std::ranges::find(taken, i) != taken.end()) continue;
      LongSide next = open[i];
      if (!begin_with(next, ring.back().edges[1])) continue;
      ring.push_back(next);
      taken.push_back(i);
      found = true;
    }
    if (!found) return {};
  }
  std::ranges::sort(taken, std::greater<>());
  for (const size_t i : taken) open.erase(open.begin() + static_cast<ptrdiff_t>(i));
  return ring;
}

}  // namespace

bool may_hold_lines(const scene::Scene& scene, uint32_t primitive) {
  const scene::Instance& instance = scene.instances[scene.primitives[primitive].instance];
  if (instance.body != 0 || scene.has_holes(primitive)) return false;
  switch (instance.semantic_class) {
    case scene::SemanticClass::pole:
    case scene::SemanticClass::street_lamp:
    case scene::SemanticClass::mast:
    case scene::SemanticClass::furniture:
      return true;
    default:
      return false;
  }
}

bool wants_lines(const CameraEffects& effects, const CameraDesc& desc) {
  return effects.thin_lines && desc.smooth_edges && !desc.distortion.any() && !has_faces(desc) &&
         !desc.outputs.cells;
}

ThinLines::ThinLines(const scene::Scene& scene) {
  const scene::Body& world = scene.bodies.front();
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i)
    if (may_hold_lines(scene, i)) add_primitive(scene, scene.primitives[i]);
}

void ThinLines::add_primitive(const scene::Scene& scene, const scene::Primitive& primitive) {
  std::vector<LongSide> open;
  const uint32_t first = primitive.first_index / 3, end = first + primitive.index_count / 3;
  for (uint32_t triangle = first; triangle + 1 < end; ++triangle) {
    const std::optional<LongSide> side = long_side(scene, triangle);
    if (!side) continue;
    if (!open.empty() && triangle > open.back().triangle + most_gap_triangles) open.clear();
    if (open.size() == most_open_sides) open.erase(open.begin());
    open.push_back(*side);
    ++triangle;
    const std::vector<LongSide> ring = take_ring(open);
    if (ring.empty()) continue;
    Prism prism;
    prism.first_edge = static_cast<uint32_t>(edges_.size());
    prism.edge_count = static_cast<uint32_t>(ring.size());
    uint32_t last = 0;
    prism.first_triangle = ~0u;
    const double share = 1.0 / double(ring.size());
    for (const LongSide& each : ring) {
      edges_.push_back({dvec3(each.edges[0][0]), dvec3(each.edges[0][1]), each.triangle});
      prism.from += share * edges_.back().from;
      prism.to += share * edges_.back().to;
      prism.first_triangle = std::min(prism.first_triangle, each.triangle);
      last = std::max(last, each.triangle + 1);
    }
    prism.triangle_count = last + 1 - prism.first_triangle;
    for (size_t i = prism.first_edge; i < edges_.size(); ++i)
      prism.radius = std::max(
          {prism.radius, glm::distance(edges_[i].from, prism.from), glm::distance(edges_[i].to, prism.to)});
    prisms_.push_back(prism);
  }
}

namespace {

/// Projects points into the picture of a view.
struct Projection {
  const CameraView& view;
  double depth(const dvec3& p) const { return glm::dot(view.forward, p - view.eye); }
  dvec2 place(const dvec3& p) const {
    const PinholeView& pinhole = view.pinhole;
    const dvec3 from_eye = p - view.eye;
    return dvec2(glm::dot(view.right, from_eye) * pinhole.fx, glm::dot(view.down, from_eye) * pinhole.fy) /
               glm::dot(view.forward, from_eye) +
           dvec2(pinhole.cx, pinhole.cy);
  }
};

}  // namespace

/// A prism in the picture.
struct ThinLines::Line {
  dvec2 from{0.0}, to{0.0};                     ///< the middles between its rims
  std::array<double, 2> half_width{}, depth{};  ///< where it begins and ends
  std::array<uint32_t, 2> triangle{};           ///< + 1, of its halves
  uint32_t first_triangle = 0, triangle_count = 0;
  double nearest = 0.0;
};

/// The part of a prism's axis before the eye: its shares of the axis, its ends in the picture, and the normal
/// there.
struct ThinLines::Axis {
  double begin = 0.0, end = 1.0;
  std::array<dvec2, 2> ends;
  dvec2 normal{0.0};
};

bool ThinLines::project(const Prism& prism, const CameraView& view, Line& line) const {
  const PinholeView& pinhole = view.pinhole;
  const Projection picture{view};
  const double focal = std::max(pinhole.fx, pinhole.fy), near = view.constants.near_m;
  const double from_depth = picture.depth(prism.from), to_depth = picture.depth(prism.to);
  const double least = near + prism.radius;
  Axis axis;
  if (from_depth < least && to_depth < least) return false;
  if (from_depth < least) axis.begin = (least - from_depth) / (to_depth - from_depth);
  if (to_depth < least) axis.end = (least - from_depth) / (to_depth - from_depth);
  line.depth = {glm::mix(from_depth, to_depth, axis.begin), glm::mix(from_depth, to_depth, axis.end)};
  line.nearest = std::min(line.depth[0], line.depth[1]);
  // A prism is at least 1.4 times as wide as its edges lie away from its axis.
  if (1.4 * prism.radius * std::min(pinhole.fx, pinhole.fy) > shared::line_most_pixels * line.nearest)
    return false;
  if (view.outside(0.5 * (prism.from + prism.to) - view.eye,
                   0.5 * glm::distance(prism.from, prism.to) + prism.radius))
    return false;
  axis.ends = {picture.place(glm::mix(prism.from, prism.to, axis.begin)),
               picture.place(glm::mix(prism.from, prism.to, axis.end))};
  const double length = glm::distance(axis.ends[0], axis.ends[1]);
  if (length < 0.25 || prism.radius * focal < 1e-3 * line.nearest) return false;
  const dvec2 along = (axis.ends[1] - axis.ends[0]) / length;
  axis.normal = {-along.y, along.x};
  find_rims(prism, view, axis, line);
  if (2.0 * std::max(line.half_width[0], line.half_width[1]) > shared::line_most_pixels) return false;
  find_sides(prism, view, axis, line);
  line.first_triangle = prism.first_triangle;
  line.triangle_count = prism.triangle_count;
  return line.triangle[0] != 0 && line.triangle[1] != 0;
}

void ThinLines::find_rims(const Prism& prism, const CameraView& view, const Axis& axis, Line& line) const {
  const Projection picture{view};
  std::array<dvec2, 2> middles = axis.ends;
  for (size_t k = 0; k < 2; ++k) {
    double low = 0.0, high = 0.0;
    for (uint32_t i = prism.first_edge; i < prism.first_edge + prism.edge_count; ++i) {
      const dvec3 corner = glm::mix(edges_[i].from, edges_[i].to, k == 0 ? axis.begin : axis.end);
      const double away = glm::dot(picture.place(corner) - axis.ends[k], axis.normal);
      low = std::min(low, away);
      high = std::max(high, away);
    }
    line.half_width[k] = 0.5 * (high - low);
    middles[k] += 0.5 * (low + high) * axis.normal;
  }
  line.from = middles[0];
  line.to = middles[1];
}

void ThinLines::find_sides(const Prism& prism, const CameraView& view, const Axis& axis, Line& line) const {
  const Projection picture{view};
  std::array<double, 2> nearest{1e300, 1e300};
  const double half = 0.5 * (line.half_width[0] + line.half_width[1]), t = 0.5 * (axis.begin + axis.end);
  const dvec2 middle = picture.place(glm::mix(prism.from, prism.to, t));
  const double shift = 0.5 * glm::dot(line.from - axis.ends[0] + line.to - axis.ends[1], axis.normal);
  for (uint32_t i = 0; i < prism.edge_count; ++i) {
    const Edge &edge = edges_[prism.first_edge + i],
               &next = edges_[prism.first_edge + (i + 1) % prism.edge_count];
    const dvec3 a = glm::mix(edge.from, edge.to, t), b = glm::mix(next.from, next.to, t);
    const double at_a = glm::dot(picture.place(a) - middle, axis.normal) - shift,
                 at_b = glm::dot(picture.place(b) - middle, axis.normal) - shift;
    for (size_t k = 0; k < 2; ++k) {
      const double wanted = k == 0 ? -0.5 * half : 0.5 * half;
      if (wanted < std::min(at_a, at_b) || wanted > std::max(at_a, at_b) || at_a == at_b) continue;
      const double depth = picture.depth(glm::mix(a, b, (wanted - at_a) / (at_b - at_a)));
      if (depth >= nearest[k]) continue;
      nearest[k] = depth;
      line.triangle[k] = edge.triangle + 1;
    }
  }
}

/// Lists the lines of each tile of a picture, and the pixels of each tile that lie under any of them.
class ThinLines::Tiles {
 public:
  Tiles(uint32_t width, uint32_t height)
      : width_(width),
        height_(height),
        columns_(in_tiles(width)),
        lists_(size_t{columns_} * in_tiles(height)),
        masks_(lists_.size()) {}

  /// Adds a line to the tiles that it comes near. Lines come in the order of the lists.
  void list(const Line& line, uint32_t number);
  /// Marks the pixels whose squares the line may touch.
  void mark(const Line& line);
  /// Returns the words that the shaders read.
  LinesInView words(std::span<const Line> lines) const;

 private:
  static constexpr uint32_t tile = shared::line_tile_pixels;
  static uint32_t in_tiles(uint32_t pixels) { return (pixels + tile - 1) / tile; }

  uint32_t width_, height_, columns_;
  std::vector<std::vector<uint32_t>> lists_;
  std::vector<std::array<uint16_t, tile>> masks_;  ///< rows of a tile; a bit is a column
};

void ThinLines::Tiles::list(const Line& line, uint32_t number) {
  const double reach = std::max(line.half_width[0], line.half_width[1]) + shared::line_margin_pixels + 1.0;
  const auto rows = static_cast<uint32_t>(lists_.size() / columns_);
  const dvec2 low = (glm::min(line.from, line.to) - reach) / double(tile),
              high = (glm::max(line.from, line.to) + reach) / double(tile);
  if (high.x < 0.0 || high.y < 0.0 || low.x >= columns_ || low.y >= rows) return;
  const dvec2 along = glm::normalize(line.to - line.from), normal(-along.y, along.x);
  const double wide = 0.5 * tile * (std::abs(normal.x) + std::abs(normal.y)) + reach;
  const auto first_column = static_cast<uint32_t>(std::max(low.x, 0.0)),
             last_column = static_cast<uint32_t>(std::min(high.x, columns_ - 1.0)),
             last_row = static_cast<uint32_t>(std::min(high.y, rows - 1.0));
  for (auto row = static_cast<uint32_t>(std::max(low.y, 0.0)); row <= last_row; ++row)
    for (uint32_t column = first_column; column <= last_column; ++column) {
      const dvec2 center = double(tile) * (dvec2(column, row) + 0.5);
      if (std::abs(glm::dot(center - line.from, normal)) > wide) continue;
      lists_[size_t{row} * columns_ + column].push_back(number);
    }
}

void ThinLines::Tiles::mark(const Line& line) {
  const double length = glm::distance(line.from, line.to);
  const dvec2 along = (line.to - line.from) / length, normal(-along.y, along.x);
  // A pixel's square reaches so far across the line and along it. A little more makes up for fp32.
  const double square = 0.5 * (std::abs(normal.x) + std::abs(normal.y)) + 1.0 / 64.0,
               across = std::max(line.half_width[0], line.half_width[1]) + square;
  const double low = std::min(line.from.y, line.to.y) - across - square,
               high = std::max(line.from.y, line.to.y) + across + square;
  if (high < 0.0 || low >= height_) return;
  const auto last_row = static_cast<uint32_t>(std::min(high, height_ - 1.0));
  for (auto row = static_cast<uint32_t>(std::max(low, 0.0)); row <= last_row; ++row) {
    double first = 0.0, last = width_ - 1.0;
    // Keeps the columns whose centre lies between two places of an axis.
    const auto keep_between = [&](const dvec2& axis, double from, double to) {
      const double rest = axis.y * (row + 0.5 - line.from.y);
      if (std::abs(axis.x) < 1e-9) {
        if (rest < from || rest > to) last = -1.0;
        return;
      }
      double begin = line.from.x - 0.5 + (from - rest) / axis.x,
             end = line.from.x - 0.5 + (to - rest) / axis.x;
      if (begin > end) std::swap(begin, end);
      first = std::max(first, std::ceil(begin));
      last = std::min(last, std::floor(end));
    };
    keep_between(normal, -across, across);
    keep_between(along, -square, length + square);
    if (last < first) continue;
    const auto end = static_cast<uint32_t>(last);
    for (auto column = static_cast<uint32_t>(first); column <= end; ++column)
      masks_[size_t{row / tile} * columns_ + column / tile][row % tile] |=
          static_cast<uint16_t>(1u << column % tile);
  }
}

LinesInView ThinLines::Tiles::words(std::span<const Line> lines) const {
  size_t entries = 0, pixels = 0;
  for (size_t i = 0; i < lists_.size(); ++i) {
    entries += lists_[i].size();
    for (const uint16_t row : masks_[i]) pixels += static_cast<size_t>(std::popcount(row));
  }
  const size_t header = shared::line_header_words + 2 * lists_.size();
  const size_t first_quad = (header + entries + pixels + 3) / 4;
  LinesInView view;
  view.pixels = static_cast<uint32_t>(pixels);
  if (pixels == 0) return view;
  std::vector<uint32_t>& words = view.words;
  words.resize(4 * first_quad);
  words[shared::line_columns_word] = columns_;
  words[shared::line_pixels_word] = static_cast<uint32_t>(header + entries);
  words[shared::line_pixel_count_word] = view.pixels;
  size_t at = header, pixel = header + entries;
  for (size_t i = 0; i < lists_.size(); ++i) {
    words[shared::line_header_words + 2 * i] = static_cast<uint32_t>(at);
    words[shared::line_header_words + 2 * i + 1] = static_cast<uint32_t>(lists_[i].size());
    for (const uint32_t line : lists_[i])
      words[at++] = static_cast<uint32_t>(first_quad) + shared::line_record_quads * line;
    const auto column = static_cast<uint32_t>(i % columns_) * tile,
               row = static_cast<uint32_t>(i / columns_) * tile;
    for (uint32_t y = 0; y < tile; ++y)
      for (uint32_t bits = masks_[i][y]; bits != 0; bits &= bits - 1)
        words[pixel++] = (column + static_cast<uint32_t>(std::countr_zero(bits))) | (row + y) << 16;
  }
  words.reserve(words.size() + 4 * shared::line_record_quads * lines.size());
  for (const Line& line : lines) {
    const double length = glm::distance(line.from, line.to);
    const dvec2 along = (line.to - line.from) / length;
    for (const double value : {line.from.x, line.from.y, along.x, along.y, line.half_width[0],
                               line.half_width[1], 1.0 / line.depth[0], 1.0 / line.depth[1]})
      words.push_back(std::bit_cast<uint32_t>(float(value)));
    for (const uint32_t value : {line.triangle[0], line.triangle[1], line.first_triangle, line.triangle_count,
                                 std::bit_cast<uint32_t>(float(length)), 0u, 0u, 0u})
      words.push_back(value);
  }
  return view;
}

LinesInView ThinLines::in_view(const CameraView& view) const {
  std::vector<Line> lines;
  for (const Prism& prism : prisms_)
    if (Line line; project(prism, view, line)) lines.push_back(line);
  if (lines.empty()) return {};
  std::ranges::stable_sort(lines, {}, &Line::nearest);
  Tiles tiles(view.pinhole.width, view.pinhole.height);
  for (uint32_t i = 0; i < lines.size(); ++i) {
    tiles.list(lines[i], i);
    tiles.mark(lines[i]);
  }
  return tiles.words(lines);
}

}  // namespace greatx::render
