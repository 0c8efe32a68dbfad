// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The paths of a channel in the world, from one of its records.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/record.h"
#include "draw/paths/draw.h"
#include "draw/paths/facts.h"
#include "view/overlay/path_records.h"
#include "view/overlay/record_tables.h"
#include "view/overlay/shapes.h"

namespace greatx::view {

using apps::PathColors;

/// Which paths are shown.
struct PathFilter {
  /// By apps::kind_of(), the kind of a path's rarest interaction; the index is its value.
  std::array<bool, apps::path_kinds.size()> kinds{true, true, true, true, true};
  uint32_t min_order = 0, max_order = std::numeric_limits<uint32_t>::max();  ///< number of interactions
  /// Leaves out what is more than this weaker than the strongest path of the links chosen, whatever its kind
  /// and order.
  double within_db = std::numeric_limits<double>::infinity();
  std::optional<uint32_t> receiver, transmitter;  ///< places in the channel's lists; none: all
};

struct PathOptions {
  PathFilter filter;
  PathColors colors = PathColors::gain;
  /// None: that of all paths of the links chosen, so that other filters change no colour.
  std::optional<apps::GainScale> scale;
};

/// Each path as lines from its transmitter over its interactions to its receiver, the strongest last; a mark
/// at each interaction (dot: reflection, diamond: transmission, triangle: diffraction, cross: scattering),
/// and marks and names of the ends. A row says of each path what `greatx paths` says of it. The row's id is
/// path_row_id(). Without paths in the record, or without poses, the shapes are empty and the legend says
/// why. Throws UserError if an array is not as docs/dataset.md has it.
Shapes path_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                   const NodePoses* poses, const PathOptions& options);

}  // namespace greatx::view
