// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What belongs to the pixels of a camera: drawn while one looks through it. Each function throws UserError if
// an array is not as docs/dataset.md has it. Where an array that it needs was not recorded, the shapes are
// empty and the legend says so.
#pragma once

#include <cstddef>

#include "core/record.h"
#include "view/overlay/record_tables.h"
#include "view/overlay/shapes.h"

namespace greatx::view {

enum class BoxRectangle { visible, whole };

/// The 2-D boxes of a camera (docs/truth.md): the bounds of the pixels that show an object, or the bounds of
/// the whole object as if nothing hid it. Objects that nothing shows have no bounds of the first sort.
Shapes picture_box_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                          BoxRectangle rectangle);

struct EventOptions {
  double window_s = 0.0;  ///< the last so many seconds of the record's events; 0: all
  size_t most = 50'000;   ///< the newest; the legend says how many there are
};

/// The pixels that fired between the last record and this one: red became brighter, blue darker. The newest
/// event of a pixel counts. `spec` is an event camera.
Shapes event_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                    const EventOptions& options);

}  // namespace greatx::view
