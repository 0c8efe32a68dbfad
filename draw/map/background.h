// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "draw/map/draw.h"
#include "sim/channel/channel_snapshot.h"

namespace greatx::apps {

/// Renders what lies beneath a map: the scene at the snapshot's moment from straight above, in clear air.
/// What stands in the scene is shown within a quarter of a cell of where it is (top_view). `plan`: a
/// picture_plan(), whose options the snapshot's GpuScene has. `side`: as map_pixels().
MapBackground map_background(const sim::MapCells& cells, const sim::EffectPlan& plan,
                             sim::ChannelSnapshot& snapshot, uint32_t side);

}  // namespace greatx::apps
