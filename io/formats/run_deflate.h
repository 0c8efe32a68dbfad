// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Packs bytes into zlib's format (RFC 1950, RFC 1951) by runs and Huffman codes alone. Pictures whose lines
// hold differences compress by their skewed values and by long runs; a search for other matches takes most of
// the time of a general compressor and gains little on them (sizes and times: io/formats/png.cpp, exr.cpp).
// The result depends on nothing but the bytes and the period.
#pragma once

#include <cstddef>
#include <span>

#include "io/files/file.h"

namespace greatx::io {

/// Appends the packed bytes to `out`. `period`, 1 to 4, is the distance at which runs repeat: the bytes of a
/// pixel.
void append_run_deflated(std::span<const std::byte> bytes, size_t period, Bytes& out);

}  // namespace greatx::io
