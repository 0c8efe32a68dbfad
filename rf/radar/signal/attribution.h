// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which instance a detection is of: the one whose echoes' tones account for most of the cell's power.
#pragma once

#include <span>
#include <vector>

#include "rf/radar/signal/echo.h"
#include "rf/radar/signal/maps.h"

namespace greatx::rf {

/// Where each echo's tone is expected: bins of range and Doppler at the middle of its list's slots,
/// ambiguities included.
class Attribution {
 public:
  /// An instance must account for this share of a cell's power.
  static constexpr double least_share = 0.1;

  Attribution(const RadarSignalConfig& config, const RadarMaps& maps, std::span<const EchoList> lists);

  /// Of instances whose echoes lie within two bins of the cell: that with the largest of |sum of tones|^2 and
  /// the sum of their powers (the lower id of equals), if that is least_share of `power_w`; else 0. Echoes by
  /// tables count in all Doppler bins between their slowest and fastest, their power shared among those.
  uint32_t instance(uint32_t range_bin, uint32_t velocity_bin, double power_w) const;

 private:
  struct Tone {
    uint32_t instance;
    double range, doppler;  ///< bins, turns over the chirps
    double doppler_spread;  ///< half of the width, turns; 0: a tone
    std::complex<double> amplitude;
  };
  const RadarMaps& maps_;
  double ranges_, velocities_;
  std::vector<Tone> tones_;  ///< by instance
};

}  // namespace greatx::rf
