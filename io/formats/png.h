// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// PNG (ISO/IEC 15948), written for speed or for size, and read by libpng. The same pixels always give the
// same bytes (of one libdeflate, libpng and zlib).
#pragma once

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

enum class PngCoding {
  fast,   ///< for every frame of a run: libdeflate, the filter Up in every line
  small,  ///< for files that are written once: libpng and zlib, a palette where 256 colours suffice
  /// As `small`. Where more than 256 colours are left, each channel loses up to 3 of its lowest bits, as few
  /// as it takes to get along with 256; if that is not enough, the picture stays exact.
  small_inexact,
};

/// u8 [h, w, 3] as 8-bit RGB; u8 [h, w] as 8-bit grey; u16 [h, w] as 16-bit grey; u32 [h, w] as 16-bit grey
/// if every value fits, otherwise UserError. The codings for size take RGB alone.
Bytes encode_png(const Array& image, PngCoding coding = PngCoding::fast);
/// 8-bit RGB and grey, 16-bit grey, not interlaced; `name` stands for the file in messages. Throws UserError,
/// also for whatever libpng only warns of, and for a picture that has not the expected shape (negative
/// extents: any), before room is made for it.
Array decode_png(std::span<const std::byte> file, const std::string& name,
                 const std::vector<int64_t>& expected_shape = {});

/// Depth in metres as CARLA's 24-bit coding: 1000 m * (R + 256 G + 65536 B) / (2^24 - 1), rounded to nearest.
inline constexpr double depth24_range_m = 1000.0;
inline constexpr uint32_t depth24_full_scale = (1u << 24) - 1;
/// The code of one depth: 1000 m and beyond, also +inf (sky), are full scale. NaN and negative depths are
/// broken contracts: ContractError.
uint32_t depth24_code(float depth_m);
/// f32 [h, w] in metres to an 8-bit RGB PNG.
Bytes encode_png_depth24(const Array& depth);
/// Back to f32 [h, w] in metres; full scale reads 1000 m.
Array decode_png_depth24(std::span<const std::byte> file, const std::string& name,
                         const std::vector<int64_t>& expected_shape = {});

}  // namespace greatx::io
