// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "io/files/file.h"

namespace greatx::io {

/// Packs bytes into zlib's format (RFC 1950, RFC 1951) by libdeflate at a level from 1 to 12, and appends
/// them to `out`. The same version of libdeflate gives the same bytes.
void append_deflated(std::span<const std::byte> bytes, int level, Bytes& out);
/// Unpacks zlib's format. Returns false unless the bytes fill `to` exactly.
bool inflate_exactly(std::span<const std::byte> packed, std::span<std::byte> to);

}  // namespace greatx::io
