// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes and reads OpenEXR by its library: single part, scan lines, 32-bit float, ZIP compression. NaN and
// infinities are stored bit for bit. With the same versions of OpenEXR and libdeflate, the same pixels always
// give the same bytes, because no attribute holds a time or an owner.
#pragma once

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// Encodes f32 [h, w] as one channel "Y", and f32 [h, w, 3] as channels R, G, B. A single channel is named
/// "Y" because OpenCV and FreeImage (imageio) read zeros from a channel "Z" (docs/dataset.md). Blocks are
/// packed by libdeflate at `level`, or by runs if it is 0, which is faster.
Bytes encode_exr(const Array& image, int level = 0);
/// Reads [h, w] from channel "Y" or, if there is none, "Z", which some data sets have; otherwise reads [h, w,
/// 3] from R, G, B. Throws UserError if the file cannot be read, has a compression other than none, ZIPS and
/// ZIP, or does not have the expected shape. The shape is checked before memory is allocated; a negative
/// extent accepts any value.
Array read_exr(const std::filesystem::path& path, const std::vector<int64_t>& expected_shape = {});

}  // namespace greatx::io
