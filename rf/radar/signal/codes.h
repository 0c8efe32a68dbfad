// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the binary codes of a phase-modulated radar.
#pragma once

#include <cstdint>
#include <vector>

#include "rf/config/radar_waveform.h"

namespace greatx::rf {

/// Returns the chips, +1 and -1, of a code for which code_exists().
///
/// - m_sequence: the output of a linear feedback shift register with a primitive polynomial. Its periodic
///   autocorrelation is N at 0 and -1 elsewhere (S. W. Golomb, "Shift Register Sequences", 1967).
/// - apas: an almost perfect sequence of N = 2 (p + 1) chips. Its periodic autocorrelation is N at 0, 4 - N
///   at N/2 and 0 elsewhere (J. Wolfmann, "Almost perfect autocorrelation sequences", IEEE Trans. Inf. Theory
///   38(4), 1992). Chip i is the quadratic character of the trace of a^i from GF(p^2) to GF(p), a primitive;
///   the two chips where the trace is 0 are +1.
std::vector<float> code_chips(RadarCode code, uint32_t chips);

}  // namespace greatx::rf
