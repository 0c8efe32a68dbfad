// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives the transmitters of a radio map a precoder (docs/map.md, "Precoders").
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rf/channel/beams.h"
#include "rf/channel/statistics.h"

namespace greatx::sim {

enum class MapPrecoding : uint8_t {
  mean,           ///< none: the mean over the ports
  beam,           ///< one DFT beam in all cells
  best_beam,      ///< in each cell the DFT beam that brings most power
  maximum_ratio,  ///< in each cell and at each frequency weights matched to the channel
};
inline constexpr std::array<const char*, 4> map_precodings{"mean", "beam", "best_beam", "maximum_ratio"};
/// Returns the precoding of a name. Throws UserError naming `--precoder` and all of them if there is none.
MapPrecoding map_precoding(const std::string& name);

/// Describes the precoder of all transmitters.
struct MapPrecoder {
  MapPrecoding precoding = MapPrecoding::mean;
  std::optional<uint64_t> beam;  ///< of MapPrecoding::beam, an index as in rf::DftBeams
  std::optional<std::array<uint32_t, 2>> oversampling;  ///< of DFT beams, of rows and columns; none: 1 and 1
};
/// Throws UserError naming `--precoder`, `--beam` or `--oversampling` if the values do not fit together.
void check_map_precoder(const MapPrecoder& precoder);

/// Holds the link of a cell: its statistics, and what the precoder makes of it.
struct MapLink : rf::LinkStatistics {
  double beam_gain = 0.0;  ///< power gain with the precoder; path_gain without one; 0: no path
  int32_t beam = -1;       ///< index of the DFT beam; -1: none, or no path
};

/// Applies a precoder to the links of one transmitter.
class MapBeams {
 public:
  /// Throws UserError naming the option and the transmitter `name` if the array has no such DFT beams, or
  /// more weights than most_beam_weights.
  MapBeams(const MapPrecoder& precoder, const rf::AntennaArray& array, const std::string& name);
  static constexpr uint64_t most_beam_weights = uint64_t{1} << 23;  ///< 128 MiB

  /// Thread-safe.
  MapLink link(std::span<const rf::Path> paths, const rf::ArrayPose& transmitter,
               const rf::ArrayPose& receiver, double carrier_hz) const;

 private:
  MapPrecoding precoding_;
  uint32_t ports_;
  uint64_t first_beam_ = 0;
  std::vector<rf::Complex> weights_;  ///< [beams, ports]
};

}  // namespace greatx::sim
