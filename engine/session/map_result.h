// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts a radio map to named arrays.
#pragma once

#include <span>

#include "engine/session/session.h"
#include "sim/channel/radio_map_run.h"

namespace greatx::engine {

/// Returns all quantities of the map, the cells' z [rows, columns], placement [rows, columns], x [columns]
/// and y [rows], and transmitter_position [tx, 3].
MapResult map_result(const sim::RadioMapRun& run, std::span<const sim::MapLink> links,
                     const sim::ChannelConfig& config);

}  // namespace greatx::engine
