// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// OpenEXR by its library: single part, scan lines, 32-bit float, ZIP compression. NaN and infinities are
// stored bit for bit. The same pixels always give the same bytes (of one library): no attribute holds a time
// or an owner.
#pragma once

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// f32 [h, w] as one channel "Y", f32 [h, w, 3] as channels R, G, B. Readers of pictures know a single
/// channel by that name alone: OpenCV and FreeImage (imageio) give zeros for "Z" (docs/dataset.md).
Bytes encode_exr(const Array& image);
/// The inverse: [h, w] of channel "Y", or of "Z" (data sets of before), else [h, w, 3] of R, G, B. Throws
/// UserError, also for compressions that greatx does not write, and for a picture that has not the expected
/// shape (negative extents: any), before room is made for it.
Array read_exr(const std::filesystem::path& path, const std::vector<int64_t>& expected_shape = {});

}  // namespace greatx::io
