// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The paths of a channel's record, checked. What draws paths and what explains them read the same rows.
#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "draw/paths/facts.h"
#include "view/overlay/record_arrays.h"
#include "view/overlay/record_tables.h"

namespace greatx::view {

/// The arrays of the paths of a record, [paths, ...].
struct PathArrays {
  int64_t count = 0, depth = 0;
  std::span<const int32_t> rx, tx;
  std::span<const uint64_t> id;
  std::span<const double> delay, doppler, departure, arrival, vertex;
  std::span<const std::complex<float>> transfer;
  std::span<const uint8_t> interaction;
  std::span<const uint32_t> object, material;
};

/// Throws UserError if an array is not as docs/dataset.md has it.
PathArrays path_arrays(const RecordArrays& record, const SensorSpec& spec);

/// Path `i`, as far as the record says what it is: its vertices are those of its interactions, in the world.
/// Throws UserError if a value of the row is not valid.
rf::Path path_of(const RecordArrays& record, const PathArrays& arrays, size_t i);

/// Where the ends are; nothing where the run does not say.
std::vector<std::optional<dvec3>> positions_of(const std::vector<AntennaFacts>& ends, const NodePoses& poses);

/// The identity of a path among all links of its channel: `id`, the path's identity in the record, where the
/// link is the channel's first one; otherwise mixed with the link's number (receiver * transmitters +
/// transmitter), because equal interactions of different links have equal identities.
uint64_t path_row_id(uint64_t id, uint64_t link);

}  // namespace greatx::view
