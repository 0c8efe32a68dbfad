// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// An echo's delay at any instant of a frame.
#pragma once

#include "rf/config/radar_config.h"
#include "rf/radar/signal/echo.h"

namespace greatx::rf {

/// tau and its derivatives by time.
struct DelayAt {
  double delay_s = 0.0, rate = 0.0, curvature_per_s = 0.0;
};

/// Of an echo of `list` at `time_s` after the frame's start. A row of a table is read by cubic Hermite
/// interpolation between its slots; the last piece serves beyond the last slot's start, too. A table of one
/// slot is a straight line.
DelayAt delay_at(const EchoList& list, const DelayTrack& track, double interval_s, double time_s);

/// Throws UserError where a list is of no use: slots or tables that do not fit the waveform, what is not
/// finite, or a delay so short that the scatterer lies within the antenna (no farther than its elements from
/// its origin). `radar` is its name in the message.
void check_echoes(const EchoList& list, const RadarSignalConfig& config, const std::string& radar);

}  // namespace greatx::rf
