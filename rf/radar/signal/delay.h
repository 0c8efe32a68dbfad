// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the delay of an echo at any instant of a frame.
#pragma once

#include "rf/config/radar_config.h"
#include "rf/radar/signal/echo.h"

namespace greatx::rf {

/// Holds tau and its derivatives with respect to time.
struct DelayAt {
  double delay_s = 0.0, rate = 0.0, curvature_per_s = 0.0;
};

/// Returns the delay of an echo of `list` at `time_s` after the start of the frame. A row of a table is
/// interpolated by cubic Hermite polynomials between its slots; the last polynomial also extrapolates beyond
/// the start of the last slot. A table of one slot is a straight line.
DelayAt delay_at(const EchoList& list, const DelayTrack& track, double interval_s, double time_s);

/// Throws UserError, naming the radar `radar`, if the echoes of a list cannot be used: a value is not finite,
/// a delay changes faster than light, or a delay is so short that the scatterer lies within the antenna (no
/// farther from its origin than its elements). Slots and tables must fit the waveform.
void check_echoes(const EchoList& list, const RadarSignalConfig& config, const std::string& radar);

}  // namespace greatx::rf
