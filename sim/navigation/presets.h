// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Names inertial sensors by their data sheets.
#pragma once

#include <span>
#include <string_view>

#include "sim/navigation/triad.h"

namespace greatx::navigation {

/// A row of the table of devices.
struct ImuPreset {
  std::string_view name;   ///< as in a scenario
  std::string_view words;  ///< what it is
  TriadErrors accelerometer, gyroscope;
};

/// Returns the devices; docs/navigation.md lists their sources. The first one, `ideal`, has no errors.
std::span<const ImuPreset> imu_presets();

}  // namespace greatx::navigation
