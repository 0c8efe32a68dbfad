// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Objects as boxes in the world.
#pragma once

#include <set>
#include <string>

#include "core/record.h"
#include "view/overlay/record_tables.h"
#include "view/overlay/shapes.h"

namespace greatx::view {

struct BoxOptions {
  /// Classes that get no box while they never move: a camera's own default for `box_classes`.
  std::set<std::string, std::less<>> hidden_classes{
      "unlabeled", "ground", "road", "pavement", "lane_marking", "building", "roof", "window", "water"};
  bool labels = true;   ///< the names of what moves
  size_t most = 5'000;  ///< boxes; the legend says how many more there are
};

/// The boxes of a camera's truth (docs/truth.md): only what the camera could see, hidden objects thin. Empty,
/// with a line in the legend, if the camera does not record boxes. Throws UserError if an array is not as
/// docs/truth.md has it. `poses`, for speeds, may be null.
Shapes camera_box_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                         const NodePoses* poses, const BoxOptions& options);

/// The boxes of the run's instances (docs/dataset.md, box_m) at the tick of the poses. What a node carries is
/// one object. A box of something with parts that turn holds them however they are turned. Static boxes have
/// the axes of the world.
Shapes instance_box_shapes(const RecordTables& tables, const NodePoses* poses, const BoxOptions& options);

/// The camera's boxes where it records them, else those of the instances. Spec and record may be null.
Shapes box_shapes(const RecordTables& tables, const SensorSpec* spec, const Record* record,
                  const NodePoses* poses, const BoxOptions& options);

}  // namespace greatx::view
