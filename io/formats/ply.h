// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// PLY point clouds, binary little endian, one element "vertex". NaN and infinities are stored bit for bit.
#pragma once

#include <map>
#include <string>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// arrays[0] f32 [n, 4] gives the properties x, y, z, intensity; each other array [n] gives the property of
/// its name. 64-bit integers and complex numbers have no PLY type: ContractError.
Bytes encode_ply(const std::vector<std::string>& names, const std::vector<const Array*>& arrays);
/// Every property as an array [n], by name. Throws UserError.
std::map<std::string, Array> decode_ply(std::span<const std::byte> file, const std::string& name);

}  // namespace greatx::io
