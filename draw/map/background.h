// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Renders the background of a radio map on a device.
#pragma once

#include "draw/map/draw.h"
#include "sim/channel/channel_snapshot.h"

namespace greatx::apps {

/// Renders the scene under a map from straight above, at the snapshot's moment, without fog and rain. Objects
/// appear within a quarter of a cell of their true positions (top_view()). `plan` is a picture_plan(), and
/// the snapshot's GpuScene was made with its options. `side` is that of map_pixels().
MapBackground map_background(const sim::MapCells& cells, const sim::EffectPlan& plan,
                             sim::ChannelSnapshot& snapshot, uint32_t side);

}  // namespace greatx::apps
