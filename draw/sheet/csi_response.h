// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A channel's H(f) as people look at it: decibels over delay and over frequency (csi_panels.cpp).
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace greatx::io {

/// What colours cover, below the strongest value.
inline constexpr double csi_range_db = 50.0;

/// Number of cells of impulse_response_db(): a power of two, at least four times the subcarriers.
size_t impulse_size(size_t subcarriers);
/// |h(tau)| in dB: the inverse DFT of H(f) under a Hann window, zero-padded to impulse_size() cells, scaled
/// so that one path of amplitude a peaks at |a|. Cell i lies at i / (impulse_size() * spacing); delays
/// repeat after 1 / spacing.
std::vector<double> impulse_response_db(std::span<const std::complex<float>> cfr);
/// |H| in dB of each subcarrier.
std::vector<double> magnitudes_db(std::span<const std::complex<float>> cfr);
/// Of a magnitude; -400 dB and less are -400 dB.
double decibels_of(double magnitude);

}  // namespace greatx::io
