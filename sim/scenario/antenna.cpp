// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/antenna.h"

#include "core/units.h"

namespace greatx::sim {

rf::AntennaArray array_of(const AntennaConfig& config, double carrier_hz) {
  const double wavelength = speed_of_light / carrier_hz;
  rf::AntennaArray array;
  array.pattern = config.pattern;
  array.polarization = config.polarization;
  array.single_slant = config.single_slant;
  array.plane = config.plane;
  array.rows = config.rows;
  array.columns = config.columns;
  array.row_spacing_m = config.row_spacing_wl * wavelength;
  array.column_spacing_m = config.column_spacing_wl * wavelength;
  for (const dvec3& element : config.elements_wl) array.positions_m.push_back(element * wavelength);
  return array;
}

}  // namespace greatx::sim
