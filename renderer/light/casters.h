// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lists what casts shadows in the light of lamps: the static world in small blocks, and bodies that move with
// their parts.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// Triangles that follow one another: of one primitive, or of several without holes. They take one draw.
struct CasterRange {
  uint32_t first_index = 0, index_count = 0;
  uint32_t primitive = 0;  ///< the first of them
};

/// A body that is no part of another, with its parts.
struct BodyCaster {
  uint32_t body = 0;
  dvec3 center{0.0};  ///< of the bounding sphere of body and parts, body frame
  double radius = 0.0;
  std::vector<CasterRange> opaque, masked;  ///< masked: with holes
};
/// With `alpha_mask`, primitives with holes are listed apart.
std::vector<BodyCaster> body_casters(const scene::Scene& scene, bool alpha_mask);

/// A part of the static world and its bounds.
struct CasterBlock {
  CasterRange range;
  dvec3 center{0.0}, half{0.0};
};
struct StaticCasters {
  std::vector<CasterBlock> opaque, masked;
};
/// Returns the static world in blocks that stay small, or have few triangles.
StaticCasters static_casters(const scene::Scene& scene, bool alpha_mask);

}  // namespace greatx::render
