// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/target_images.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/largest.h"

namespace greatx::rf {
namespace {

/// Room for roundings, in metres and per metre of the numbers involved. It is far more than fp64 needs; an
/// unnecessary candidate costs only one exact solve.
constexpr double room_m = 1e-5, relative_room = 1e-12;
constexpr double side_room_m = 1e-3, most_side_room_m = 1.0;

/// Holds the point in a plane of a line that crosses the plane, whose ends have the distances `a` and `b`
/// from it, and how far roundings can move the point.
struct Crossing {
  dvec3 point{0.0};
  double room = 0.0;
};

Crossing cross_plane(const dvec3& from, const dvec3& along, double a, double b) {
  const double t = a / (a - b);
  const double scale = largest(from) + largest(along);
  return {from + t * along, room_m + relative_room * scale * (1.0 + glm::length(along) / std::abs(a - b))};
}

bool in_rectangle(const Pyramid& pyramid, const Crossing& at) {
  const dvec3 from_center = at.point - pyramid.center;
  const auto inside = [&](const dvec3& half) {
    const double length = glm::length(half);
    return std::abs(glm::dot(from_center, half)) <= length * (length + at.room);
  };
  return inside(pyramid.half_a) && inside(pyramid.half_b);
}

bool in_rectangle(const BeamFacet& facet, const Crossing& at) {
  const dvec3 from_reference = at.point - facet.reference;
  const double a = glm::dot(facet.axis_a, from_reference), b = glm::dot(facet.axis_b, from_reference);
  const double room = at.room + 2.0 * facet.tolerance_m;
  return a >= facet.min_a - room && a <= facet.max_a + room && b >= facet.min_b - room &&
         b <= facet.max_b + room;
}

/// Adds the plane through the apex and one side of the rectangle.
void add_side(Pyramid& pyramid, const dvec3& from, const dvec3& to, double extent_m) {
  const dvec3 u = from - pyramid.apex, v = to - pyramid.apex;
  const double length_u = glm::length(u), length_v = glm::length(v);
  dvec3 normal = glm::cross(u, v);
  const double length = glm::length(normal);
  if (length <= 1e-9 * length_u * length_v) return;
  normal /= length;
  const double inside = glm::dot(normal, pyramid.center - pyramid.apex);
  if (std::abs(inside) <= 1e-9 * glm::length(pyramid.center - pyramid.apex)) return;
  if (inside < 0.0) normal = -normal;
  // The room is the possible turn of the plane times the largest distance of anything. Images of targets lie
  // at up to three times the extent of the scene.
  const double coordinate = largest(pyramid.apex) + extent_m;
  const double turned =
      relative_room * coordinate * (length_u * length_v / length) / std::min(length_u, length_v);
  const double room = side_room_m + turned * (coordinate + 4.0 * extent_m);
  if (room > most_side_room_m) return;
  pyramid.sides[pyramid.side_count++] = {normal, glm::dot(normal, pyramid.apex) - room};
}

}  // namespace

std::optional<Pyramid> make_pyramid(const SequenceBeam& beam, const BeamFacet& mirror, double extent_m) {
  Pyramid pyramid;
  pyramid.apex = beam.image;
  pyramid.mirror = true;
  const double behind = glm::dot(mirror.normal, beam.image) - mirror.offset;
  if (std::abs(behind) <= 0.5 * mirror.tolerance_m) return std::nullopt;
  pyramid.normal = behind > 0.0 ? -mirror.normal : mirror.normal;
  pyramid.offset = behind > 0.0 ? -mirror.offset : mirror.offset;
  pyramid.center = beam.center;
  const double room = room_m + 2.0 * mirror.tolerance_m;
  // The rectangle's own axes, along which its halves lie unless they have no length.
  const bool given = glm::length(beam.half_a) > 0.0;
  const dvec3 axis_a = given ? glm::normalize(beam.half_a) : mirror.axis_a;
  const dvec3 axis_b = glm::cross(mirror.normal, axis_a);
  pyramid.half_a = (glm::length(beam.half_a) + room) * axis_a;
  pyramid.half_b = (glm::length(beam.half_b) + room) * axis_b;
  const dvec3 corners[4] = {
      beam.center - pyramid.half_a - pyramid.half_b, beam.center + pyramid.half_a - pyramid.half_b,
      beam.center + pyramid.half_a + pyramid.half_b, beam.center - pyramid.half_a + pyramid.half_b};
  for (int i = 0; i < 4; ++i) add_side(pyramid, corners[i], corners[(i + 1) % 4], extent_m);
  pyramid.sides[pyramid.side_count++] = {pyramid.normal, pyramid.offset - side_room_m};
  return pyramid;
}

std::optional<SequenceBeam> cut_to(const Pyramid& pyramid, const BeamFacet& facet) {
  const double ahead = glm::dot(facet.normal, pyramid.apex) - facet.offset;
  if (std::abs(ahead) <= 0.5 * facet.tolerance_m) return std::nullopt;
  // The corners of the facet's rectangle along its own axes are cut by one side after the other.
  struct Corner {
    double a, b;
  };
  Corner polygon[16] = {{facet.min_a, facet.min_b},
                        {facet.max_a, facet.min_b},
                        {facet.max_a, facet.max_b},
                        {facet.min_a, facet.max_b}};
  int count = 4;
  for (const HalfSpace& side : pyramid.region()) {
    const double at_a = glm::dot(side.normal, facet.axis_a), at_b = glm::dot(side.normal, facet.axis_b);
    const double at_reference = glm::dot(side.normal, facet.reference) - side.offset;
    Corner kept[16];
    int kept_count = 0;
    for (int i = 0; i < count; ++i) {
      const Corner &from = polygon[i], &to = polygon[(i + 1) % count];
      const double f = at_reference + at_a * from.a + at_b * from.b;
      const double t = at_reference + at_a * to.a + at_b * to.b;
      if (f >= 0.0) kept[kept_count++] = from;
      if ((f < 0.0) != (t < 0.0)) {
        const double share = f / (f - t);
        kept[kept_count++] = {from.a + share * (to.a - from.a), from.b + share * (to.b - from.b)};
      }
    }
    if (kept_count == 0) return std::nullopt;
    std::copy(kept, kept + kept_count, polygon);
    count = kept_count;
  }
  Corner low = polygon[0], high = polygon[0];
  for (int i = 1; i < count; ++i) {
    low = {std::min(low.a, polygon[i].a), std::min(low.b, polygon[i].b)};
    high = {std::max(high.a, polygon[i].a), std::max(high.b, polygon[i].b)};
  }
  SequenceBeam beam;
  beam.image = pyramid.apex - 2.0 * ahead * facet.normal;
  beam.center =
      facet.reference + 0.5 * (low.a + high.a) * facet.axis_a + 0.5 * (low.b + high.b) * facet.axis_b;
  beam.half_a = 0.5 * (high.a - low.a) * facet.axis_a;
  beam.half_b = 0.5 * (high.b - low.b) * facet.axis_b;
  beam.walls = 0;
  return beam;
}

TargetImages::TargetImages(const BeamScene& scene, const dvec3& target) : scene_(&scene) {
  images_.reserve(scene.facet_count());
  for (uint32_t i = 0; i < scene.facet_count(); ++i) add(i, target);
  plant();
}

TargetImages::TargetImages(const BeamScene& scene, const dvec3& target, std::span<const uint32_t> seen)
    : scene_(&scene) {
  images_.reserve(seen.size());
  for (const uint32_t facet : seen) add(facet, target);
  plant();
}

void TargetImages::add(uint32_t index, const dvec3& target) {
  const BeamFacet& facet = scene_->facet(index);
  const double distance = glm::dot(facet.normal, target) - facet.offset;
  if (std::abs(distance) <= 0.5 * facet.tolerance_m) return;  // no path: the target is in the plane
  images_.push_back({target - 2.0 * distance * facet.normal, index});
}

void TargetImages::plant() {
  if (images_.empty()) return;
  for (const Image& image : images_) extent_m_ = std::max(extent_m_, largest(image.position));
  nodes_.emplace_back();
  build(0, 0, static_cast<uint32_t>(images_.size()));
}

void TargetImages::build(uint32_t index, uint32_t first, uint32_t count) {
  // The images are split in halves three times, along the longest side.
  uint32_t bounds[lanes + 1] = {first, first + count};
  uint32_t parts = 1;
  for (; count > lanes && parts < lanes; parts *= 2) {
    for (uint32_t i = parts; i-- > 0;) bounds[2 * i + 2] = bounds[i + 1];
    for (uint32_t i = 0; i < parts; ++i) {
      const uint32_t from = bounds[2 * i], to = bounds[2 * i + 2], middle = (from + to) / 2;
      bounds[2 * i + 1] = middle;
      dvec3 low(1e300), high(-1e300);
      for (uint32_t k = from; k < to; ++k)
        low = glm::min(low, images_[k].position), high = glm::max(high, images_[k].position);
      const dvec3 size = high - low;
      const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
      const auto begin = images_.begin();
      std::nth_element(begin + from, begin + middle, begin + to, [&](const Image& a, const Image& b) {
        return a.position[axis] != b.position[axis] ? a.position[axis] < b.position[axis] : a.facet < b.facet;
      });
    }
  }
  Node node;
  node.leaf = parts == 1;
  node.count = node.leaf ? count : lanes;
  node.first = node.leaf ? first : static_cast<uint32_t>(nodes_.size());
  if (!node.leaf) nodes_.resize(nodes_.size() + lanes);
  for (uint32_t lane = 0; lane < node.count; ++lane) {
    const uint32_t from = node.leaf ? first + lane : bounds[lane],
                   to = node.leaf ? from + 1 : bounds[lane + 1];
    dvec3 low(1e300), high(-1e300);
    for (uint32_t k = from; k < to; ++k)
      low = glm::min(low, images_[k].position), high = glm::max(high, images_[k].position);
    for (int axis = 0; axis < 3; ++axis) {
      node.center[axis][lane] = static_cast<float>(0.5 * (low[axis] + high[axis]));
      node.half[axis][lane] = static_cast<float>(0.5 * (high[axis] - low[axis]));
    }
    if (!node.leaf) build(node.first + lane, from, to - from);
  }
  nodes_[index] = node;
}

TargetImages::Sides TargetImages::sides_of(const Pyramid& pyramid) const {
  Sides sides;
  sides.count = pyramid.side_count;
  for (uint32_t i = 0; i < sides.count; ++i) {
    const HalfSpace& side = pyramid.sides[i];
    // About twenty roundings of 2^-24 of the largest number in the sums.
    const double room = 0x1p-19 * (4.0 * extent_m_ + std::abs(side.offset));
    for (int axis = 0; axis < 3; ++axis) {
      sides.normal[i][axis] = static_cast<float>(side.normal[axis]);
      sides.span[i][axis] = std::abs(sides.normal[i][axis]);
    }
    sides.offset[i] = static_cast<float>(side.offset - room);
  }
  return sides;
}

std::array<float, TargetImages::lanes> TargetImages::within(const Node& node, const Sides& sides) {
  // Vector types of four floats make all compilers use vector instructions; memcpy costs nothing.
  using Four = float __attribute__((vector_size(16)));
  std::array<float, lanes> least;
  for (uint32_t first = 0; first < lanes; first += 4) {
    const auto four = [first](const float(&all)[lanes]) {
      Four some;
      std::memcpy(&some, all + first, sizeof some);
      return some;
    };
    const Four x = four(node.center[0]), y = four(node.center[1]), z = four(node.center[2]);
    const Four half_x = four(node.half[0]), half_y = four(node.half[1]), half_z = four(node.half[2]);
    Four all = Four{} + 1e30f;
    for (uint32_t i = 0; i < sides.count; ++i) {
      const float* n = sides.normal[i];
      const float* s = sides.span[i];
      const Four reach =
          n[0] * x + n[1] * y + n[2] * z + s[0] * half_x + s[1] * half_y + s[2] * half_z - sides.offset[i];
      all = reach < all ? reach : all;
    }
    std::memcpy(least.data() + first, &all, sizeof all);
  }
  return least;
}

/// Tells whether the straight line from the apex to the target's image passes the pyramid's rectangle and
/// then the facet's rectangle.
bool TargetImages::joins(const Pyramid& pyramid, const Image& image) const {
  const BeamFacet& facet = scene_->facet(image.facet);
  const dvec3 along = image.position - pyramid.apex;
  if (pyramid.mirror) {
    const double a = glm::dot(pyramid.normal, pyramid.apex) - pyramid.offset;
    const double b = glm::dot(pyramid.normal, image.position) - pyramid.offset;
    if (b < -room_m) return false;
    if (b > room_m && !in_rectangle(pyramid, cross_plane(pyramid.apex, along, a, b))) return false;
  }
  const double c = glm::dot(facet.normal, pyramid.apex) - facet.offset;
  const double d = glm::dot(facet.normal, image.position) - facet.offset;
  if (std::abs(c) <= 0.5 * facet.tolerance_m) return false;  // edge-on
  if (c * d > 0.0 && std::abs(c) > room_m && std::abs(d) > room_m) return false;
  if (c * d > 0.0) return true;
  const Crossing at = cross_plane(pyramid.apex, along, c, d);
  if (!in_rectangle(facet, at)) return false;
  return !pyramid.mirror || glm::dot(pyramid.normal, at.point) - pyramid.offset >= -at.room;
}

}  // namespace greatx::rf
