// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Assigns a detection to an instance: the one whose echoes' tones account for most of the power of the cell.
#pragma once

#include <span>
#include <vector>

#include "rf/radar/signal/echo.h"
#include "rf/radar/signal/maps.h"

namespace greatx::rf {

/// Holds the expected place of each echo's tone: the bins of range and Doppler at the middle of the slots of
/// its list, with the ambiguities included.
class Attribution {
 public:
  /// An instance must account for this share of the power of a cell.
  static constexpr double least_share = 0.1;

  Attribution(const RadarSignalConfig& config, const RadarMaps& maps, std::span<const EchoList> lists);

  /// Returns the instance that accounts for most of the power of a cell, among those whose echoes lie within
  /// two bins of the cell. The power of an instance is the larger of |sum of tones|^2 and the sum of the
  /// tones' powers, with those of its patches. Of equal instances the one with the lower id counts. Returns 0
  /// if the power of the instance is not more than least_share of `power_w`. An echo with a delay table
  /// counts in all Doppler bins between its slowest and its fastest rate, and shares its power among these
  /// bins.
  uint32_t instance(uint32_t range_bin, uint32_t velocity_bin, double power_w) const;

 private:
  struct Tone {
    uint32_t instance;
    double range, doppler;  ///< range in bins; Doppler in turns over the chirps
    double doppler_spread;  ///< half of the width, turns; 0: a single tone
    std::complex<double> amplitude;
  };
  const RadarMaps& maps_;
  double ranges_, velocities_;
  std::vector<Tone> tones_;  ///< sorted by instance
  /// A patch, which counts by its power alone: thousands of them add up with random phases.
  struct Patch {
    uint32_t instance;
    float range, doppler, power_w;
  };
  void add_patches(const RadarSignalConfig& config, std::span<const EchoList> lists);
  /// Adds the powers that patches have in a cell to powers_of_patches, by instance.
  void add_powers(uint32_t range_bin, double doppler, std::vector<double>& powers) const;
  std::vector<Patch> patches_;         ///< by range bin
  std::vector<uint32_t> first_patch_;  ///< [range bins + 1]
  uint32_t instances_ = 0;             ///< largest instance of a patch + 1
};

}  // namespace greatx::rf
