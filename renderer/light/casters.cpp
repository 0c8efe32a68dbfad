// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/casters.h"

#include <algorithm>

#include "scene/description/index_bounds.h"

namespace greatx::render {

namespace {

/// Large primitives are cut into blocks of so many triangles; small ones in a row share a block whose
/// diagonal stays below this, or hardly grows.
constexpr uint32_t caster_block_triangles = 128;
constexpr double free_diagonal_m = 8.0, most_diagonal_growth = 1.2;

bool range_follows(const CasterRange& last, const CasterRange& next) {
  return last.first_index + last.index_count == next.first_index;
}

/// Adds a block to the last one if one draw serves both and their box stays small. Ranges with holes need
/// their own primitive.
void add_block(std::vector<CasterBlock>& blocks, const CasterRange& range, const scene::Bounds& bounds,
               bool joins) {
  const CasterBlock next{range, bounds.center(), 0.5 * bounds.size()};
  if (joins && !blocks.empty() && range_follows(blocks.back().range, range) &&
      blocks.back().range.index_count < 3 * caster_block_triangles) {
    CasterBlock& last = blocks.back();
    const dvec3 least = glm::min(last.center - last.half, bounds.min),
                most = glm::max(last.center + last.half, bounds.max);
    const double larger = std::max(glm::length(2.0 * last.half), glm::length(bounds.size()));
    if (glm::length(most - least) <= std::max(free_diagonal_m, most_diagonal_growth * larger)) {
      last.range.index_count += range.index_count;
      last.center = 0.5 * (least + most);
      last.half = 0.5 * (most - least);
      return;
    }
  }
  blocks.push_back(next);
}

}  // namespace

std::vector<BodyCaster> body_casters(const scene::Scene& scene, bool alpha_mask) {
  std::vector<BodyCaster> casters;
  for (uint32_t b = 1; b < scene.bodies.size(); ++b) {
    if (scene.owner_of(b) != b || scene.reach_of(b).empty()) continue;
    BodyCaster caster;
    caster.body = b;
    caster.center = scene.reach_of(b).center();
    caster.radius = 0.5 * glm::length(scene.reach_of(b).size());
    for (uint32_t part = b; part < scene.bodies.size() && scene.owner_of(part) == b; ++part) {
      const scene::Body& body = scene.bodies[part];
      bool new_part = true;  // a draw moves with one part
      for (uint32_t i = body.first_primitive; i < body.first_primitive + body.primitive_count; ++i) {
        const CasterRange range{scene.primitives[i].first_index, scene.primitives[i].index_count, i};
        if (alpha_mask && scene.has_holes(i)) {
          caster.masked.push_back(range);
        } else if (!new_part && range_follows(caster.opaque.back(), range)) {
          caster.opaque.back().index_count += range.index_count;
        } else {
          caster.opaque.push_back(range);
          new_part = false;
        }
      }
    }
    casters.push_back(std::move(caster));
  }
  return casters;
}

StaticCasters static_casters(const scene::Scene& scene, bool alpha_mask) {
  StaticCasters casters;
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    const bool masked = alpha_mask && scene.has_holes(i);
    for (uint32_t first = 0; first < primitive.index_count; first += 3 * caster_block_triangles) {
      const CasterRange range{primitive.first_index + first,
                              std::min(3 * caster_block_triangles, primitive.index_count - first), i};
      add_block(masked ? casters.masked : casters.opaque, range,
                scene::bounds_of_indices(scene, range.first_index, range.index_count), !masked);
    }
  }
  return casters;
}

}  // namespace greatx::render
