// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Point clouds for other tools: PCD 0.7 (Point Cloud Library, "The PCD file format"), binary, and the .bin
// files of KITTI (A. Geiger et al., "Vision meets robotics: the KITTI dataset", IJRR 32 (2013), section 3).
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// arrays[0] f32 [n, 4] gives the fields x, y, z, intensity, every other array [n] that of its name. 64-bit
/// integers and complex numbers: ContractError.
Bytes encode_pcd(const std::vector<std::string>& names, const std::vector<const Array*>& arrays);
/// Every field as an array [n], by name. Throws UserError for anything but one value a field and binary data.
std::map<std::string, Array> decode_pcd(std::span<const std::byte> file, const std::string& name);

/// f32 [n, 4]: x, y, z, reflectance, one behind the other, and nothing else.
Bytes encode_kitti(const Array& points);
Array decode_kitti(std::span<const std::byte> file, const std::string& name);

}  // namespace greatx::io
