// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts boxes to the arrays that a camera writes.
#pragma once

#include <span>
#include <vector>

#include "core/record.h"
#include "sim/sensors/camera/boxes.h"

namespace greatx::sim {

/// Adds the arrays of boxes, [object, ...], and their files, boxes/NAME, to the spec.
void describe_boxes(SensorSpec& spec);
/// Returns the arrays that describe_boxes() declares, in the same order. `node_of_body` gives the node of
/// each body; -1: none.
std::vector<Array> box_arrays(const Boxes& boxes, std::span<const ObjectBox> found,
                              std::span<const int32_t> node_of_body);

}  // namespace greatx::sim
