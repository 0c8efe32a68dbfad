// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parts that several overlays draw.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/hash.h"
#include "core/record.h"
#include "view/overlay/record_tables.h"
#include "view/overlay/shapes.h"

namespace greatx::view {

inline constexpr io::Color white{255, 255, 255}, dim_color{140, 146, 158};
inline constexpr uint32_t no_row = ~0u;

/// The identity of a row that belongs to a thing with a name or a number: `kind` keeps things apart.
inline uint64_t row_id(std::string_view kind, uint64_t number) {
  return (uint64_t{fnv1a32(kind)} << 32) | (number & 0xffffffffu);
}

/// The twelve edges of the box between `low` and `high` in a frame of its own.
inline void add_box(Shapes& shapes, const Pose& world_from_box, const dvec3& low, const dvec3& high,
                    io::Color color, float width_px, uint32_t row) {
  const auto corner = [&](int i) {
    return world_from_box.apply(
        {(i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z});
  };
  for (int i = 0; i < 8; ++i)
    for (const int bit : {1, 2, 4})
      if ((i & bit) == 0) shapes.lines.push_back({corner(i), corner(i | bit), color, width_px, row});
}

/// x red, y green, z blue.
inline void add_axes(Shapes& shapes, const Pose& world_from_frame, double length_m, uint32_t row) {
  constexpr io::Color colors[] = {{255, 92, 92}, {110, 225, 120}, {96, 160, 255}};
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 tip(0.0);
    tip[axis] = length_m;
    shapes.lines.push_back(
        {world_from_frame.position, world_from_frame.apply(tip), colors[axis], 2.0f, row, true});
  }
}

/// The poses, if they are there. If not, or if they are of another tick than the record, the legend says so.
inline const NodePoses* poses_for(Shapes& shapes, const SensorSpec& spec, const Record& record,
                                  const NodePoses* poses) {
  if (poses == nullptr)
    shapes.note(spec.name + ": the poses of its tick are not known, so it cannot be placed");
  else if (poses->tick() != record.tick)
    shapes.note(
        fmt::format("{}: of tick {}, placed by the poses of tick {}", spec.name, record.tick, poses->tick()));
  return poses;
}

}  // namespace greatx::view
