// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the antennas of a scenario.
#pragma once

#include <vector>

#include "core/vec.h"
#include "rf/antenna/antenna.h"

namespace greatx::sim {

/// Describes an array of equal elements, as in rf::AntennaArray. Lengths are in wavelengths at the carrier.
struct AntennaConfig {
  rf::ElementPattern pattern;
  rf::Polarization polarization = rf::Polarization::v;
  double single_slant = 0.0;  ///< rad, of Polarization::single
  rf::ArrayPlane plane = rf::ArrayPlane::yz;
  uint32_t rows = 1, columns = 1;
  double row_spacing_wl = 0.5, column_spacing_wl = 0.5;
  std::vector<dvec3> elements_wl;  ///< if there are any, they replace rows and columns
};

rf::AntennaArray array_of(const AntennaConfig& config, double carrier_hz);

}  // namespace greatx::sim
