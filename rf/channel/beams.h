// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes what a transmitting array gains by sending one signal from all its ports (docs/precoding.md).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// The phases between the polarizations of a DFT beam of cross-polarized elements: quarter turns.
inline constexpr uint32_t beam_phases = 4;

/// Describes the DFT beams of an array of rows and columns. A beam is the product of one beam of the rows and
/// one of the columns, w[m] = e^{j 2 pi b m/(O n)}/sqrt(n) for n elements and O beams per element. Both
/// polarizations of an element send it, the second one turned by n/beam_phases of a turn (3GPP TS 38.214,
/// 5.2.2.2.1, codebookMode 1, for any number of rows and columns). Beam = (row_beam * (O_columns * columns) +
/// column_beam) * phases + n, where phases is 1 for one polarization: as in python/greatx/precoding.py.
struct DftBeams {
  uint32_t rows = 1, columns = 1, polarizations = 1;
  std::array<uint32_t, 2> oversampling{1, 1};  ///< of rows and columns

  uint32_t phases() const { return polarizations == 2 ? beam_phases : 1; }
  uint64_t count() const { return uint64_t{rows} * oversampling[0] * columns * oversampling[1] * phases(); }
  size_t ports() const { return size_t{rows} * columns * polarizations; }
  /// Returns the weights of a beam, [ports], of unit norm.
  std::vector<Complex> weights(uint64_t beam) const;
};
/// Returns the DFT beams of an array, whose elements must stand in rows and columns.
DftBeams dft_beams(const AntennaArray& array, const std::array<uint32_t, 2>& oversampling);

/// Returns the power gain of each beam, [beams]: the sum over the paths of the mean over the receiving ports
/// of |sum over transmitting ports of a w|^2, with a as in ImpulseResponse. `weights` is [beams, ports of the
/// transmitter]. Powers of different paths are added, as in LinkStatistics::path_gain, so that the gain does
/// not fade with the wavelength. Over beams that form an orthonormal basis the gains add up to the number of
/// ports times path_gain. Any order of the paths gives the same bits. Thread-safe.
std::vector<double> beam_gains(std::span<const Path> paths, const ArrayPose& transmitter,
                               const ArrayPose& receiver, double carrier_hz,
                               std::span<const Complex> weights);

}  // namespace greatx::rf
