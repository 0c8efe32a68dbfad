// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes PNG (ISO/IEC 15948) for speed or for size, and reads it by libpng. The same pixels always give the
// same bytes; of depth in 24 bits and of the codings for size, with the same versions of libdeflate, libpng
// and zlib.
#pragma once

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

enum class PngCoding {
  fast,  ///< for every frame of a run: filters Sub and Up, runs and Huffman codes
  /// For every frame of a run whose data set is to be small: the same filters, libdeflate. Files are 11 %
  /// smaller than those of `fast` and take six times as long.
  matched,
  small,  ///< for files that are written once: libpng and zlib, with a palette where 256 colours suffice
  /// As `small`, but drops up to 3 of the lowest bits of each channel if the picture has more than 256
  /// colours. It drops as few bits as possible. If 3 bits are not enough, the picture stays exact.
  small_inexact,
  quick,          ///< as `small`, but packed in a hurry: for a file that is read back at once
  quick_inexact,  ///< as `small_inexact`, with the same pixels, packed in a hurry
};

/// Encodes u8 [h, w, 3] as 8-bit RGB, u8 [h, w] as 8-bit grey, and u16 [h, w] or u32 [h, w] as 16-bit grey.
/// Throws UserError if a u32 value does not fit into 16 bits. `small` and those below it accept RGB, and u8
/// [h, w, 4] as 8-bit RGB with alpha, which has no palette and of which the inexact ones drop 3 bits.
Bytes encode_png(const Array& image, PngCoding coding = PngCoding::fast);
/// Decodes 8-bit RGB, 8-bit grey and 16-bit grey without interlacing. `name` is the file's name in messages.
/// Throws UserError for every other file, for everything that libpng reports as an error or a warning, and
/// for a picture that does not have the expected shape. The shape is checked before memory is allocated; a
/// negative extent accepts any value.
Array decode_png(std::span<const std::byte> file, const std::string& name,
                 const std::vector<int64_t>& expected_shape = {});

// CARLA's 24-bit coding of depth: 1000 m * (R + 256 G + 65536 B) / (2^24 - 1), rounded to nearest.
inline constexpr double depth24_range_m = 1000.0;
inline constexpr uint32_t depth24_full_scale = (1u << 24) - 1;
/// Returns the code of one depth. Depths from 1000 m on, including +inf (sky), give full scale. Throws
/// ContractError for NaN and negative depths.
uint32_t depth24_code(float depth_m);
/// Encodes depths, f32 [h, w] in metres, as an 8-bit RGB PNG.
Bytes encode_png_depth24(const Array& depth);
/// Decodes such a PNG to f32 [h, w] in metres. Full scale gives 1000 m. `expected_shape` is [h, w]. Throws
/// UserError like decode_png().
Array decode_png_depth24(std::span<const std::byte> file, const std::string& name,
                         const std::vector<int64_t>& expected_shape = {});

}  // namespace greatx::io
