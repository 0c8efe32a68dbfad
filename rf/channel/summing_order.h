// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Orders paths for summation by their properties, so that the bits of a sum do not depend on the places of
// the paths in a list.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Returns a permutation of [0, paths) by delay and then by all other properties that enter a sum (Doppler
/// shift, directions, transfer, spectrum). Paths that agree in all of these add the same terms and may be in
/// any order. `spectra`: [paths], or empty.
std::vector<uint32_t> summing_order(std::span<const Path> paths,
                                    std::span<const TransferSpectrum> spectra = {});

}  // namespace greatx::rf
