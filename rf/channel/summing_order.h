// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The order in which paths are summed: by what they are, so that a sum's bits do not depend on where they
// stand in a list.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// A permutation of [0, paths): by delay, then by all else of a path that reaches a sum (Doppler shift,
/// directions, transfer, spectrum). Paths that agree in all of it add the same terms and may stand in any
/// order. `spectra`: [paths], or none.
std::vector<uint32_t> summing_order(std::span<const Path> paths,
                                    std::span<const TransferSpectrum> spectra = {});

}  // namespace greatx::rf
