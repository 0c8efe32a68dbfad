// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes and reads PLY point clouds, binary little endian, with one element "vertex". NaN and infinities are
// stored bit for bit.
#pragma once

#include <map>
#include <string>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// Encodes arrays[0], f32 [n, 4], as the properties x, y, z, intensity, and every other array [n] as the
/// property of its name. Types get the names that Open3D's tensor reader knows: u32 becomes "int", u16
/// "uint16". Throws UserError for a number of u32 beyond 2^31 - 1, and ContractError for 64-bit integers and
/// complex numbers, which have no PLY type, and for i8.
Bytes encode_ply(const std::vector<std::string>& names, const std::vector<const Array*>& arrays);
/// Returns every property as an array [n], by name, with the type that the file has; u32 comes back as i32.
/// Throws UserError if the file is not such a PLY file.
/// `name` is the file's name in messages.
std::map<std::string, Array> decode_ply(std::span<const std::byte> file, const std::string& name);

}  // namespace greatx::io
