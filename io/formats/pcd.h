// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes and reads point clouds for other tools: binary PCD 0.7 (Point Cloud Library, "The PCD file format")
// and the .bin files of KITTI (A. Geiger et al., "Vision meets robotics: the KITTI dataset", IJRR 32 (2013),
// section 3).
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// Encodes arrays[0], f32 [n, 4], as the fields x, y, z, intensity, and every other array [n] as the field of
/// its name. Throws ContractError for 64-bit integers and complex numbers.
Bytes encode_pcd(const std::vector<std::string>& names, const std::vector<const Array*>& arrays);
/// Returns every field as an array [n], by name. Throws UserError if the file is not a valid PCD file with
/// binary data and one value per field. `name` is the file's name in messages.
std::map<std::string, Array> decode_pcd(std::span<const std::byte> file, const std::string& name);

/// Encodes f32 [n, 4], x, y, z, reflectance, as consecutive values without a header.
Bytes encode_kitti(const Array& points);
/// Returns f32 [n, 4]. Throws UserError if the file's size is not a multiple of 16 bytes.
Array decode_kitti(std::span<const std::byte> file, const std::string& name);

}  // namespace greatx::io
